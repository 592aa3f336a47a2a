//! The surface at a hit.

use crate::number::Arithmetic;
use crate::ray::Ray;

/// The surface at a hit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surface<N> {
    /// Outward, or to the front; of length 1.
    pub(crate) normal: [N; 3],
    /// The point of the surface next to the point at the ray's t.
    pub(crate) point: [N; 3],
    /// The surface lies within this length of `point`. A ray that starts this far away along the normal does not hit it
    /// again.
    pub(crate) error: N,
    /// True if `point` lies on the surface exactly, so that t is 0 for a ray that starts there.
    pub(crate) is_exact: bool,
}

impl<N: Arithmetic> Surface<N> {
    /// The normal for a ray that grazes the surface, at right angles to the ray.
    ///
    /// It is certain whether the ray enters or leaves. The normal is not certain: where a solid is as thin as an error
    /// bound, rounding of the point turns it. For a grazing ray a bit is enough to turn it too far.
    #[cold]
    pub(crate) fn level_with(&self, ray: &Ray<N>) -> [N; 3] {
        let turned = N::wide_scale(N::dot(self.normal, ray.slope), N::recip_norm2(ray.slope));
        let turned = N::from_wide(turned);
        let axis = |k: usize| self.normal[k] - turned * ray.slope[k];
        let (normal, length) = N::normalize([axis(0), axis(1), axis(2)]);
        if length == N::ZERO {
            self.normal.map(|x| -x)
        } else {
            normal
        }
    }
}
