//! Crossings: where the line of a ray enters and leaves a primitive, behind the origin too.
//!
//! [`accept`] decides for all primitives which part of a crossing is a hit.

use crate::number::Arithmetic;
use crate::ray::Ray;

/// The part of a primitive's surface that a crossing lies on; each kernel numbers its own.
pub(crate) type Part = u8;

/// Added to the part where a ray leaves a solid.
pub(crate) const LEAVING: Part = 1 << 7;

/// Added to the part where a ray enters a solid for the second time, and where it leaves it then.
pub(crate) const LATER: Part = 1 << 6;

/// The places where a line enters and leaves a primitive; the same place twice for a flat one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossing<N> {
    pub(crate) enter: (N, Part),
    pub(crate) leave: (N, Part),
}

impl<N: Copy> Crossing<N> {
    #[inline(always)]
    pub(crate) fn flat(t: N) -> Self {
        Self {
            enter: (t, 0),
            leave: (t, 0),
        }
    }
}

/// The hit of a crossing in `tmin <= t <= tmax`, if there is one. A NaN is no hit.
#[inline(always)]
pub(crate) fn accept<N: Arithmetic>(
    ray: &Ray<N>,
    crossing: Crossing<N>,
    tmax: N,
) -> Option<(N, Part)> {
    let Crossing { enter, leave } = crossing;
    if enter.0 >= ray.tmin && enter.0 <= tmax {
        return Some(enter);
    }
    (leave.0 >= ray.tmin && leave.0 <= tmax).then_some((leave.0, leave.1 | LEAVING))
}

/// Returns where a ray crosses a plane through `relative`, a point as seen from the ray's origin. The normal has any
/// length, and `approach` is its product with the ray's slope. Returns `None` if the ray runs along the plane.
#[inline(always)]
pub(crate) fn cross_plane<N: Arithmetic>(
    normal: [N; 3],
    relative: [N; 3],
    approach: N::Wide,
) -> Option<N> {
    if approach == N::Wide::default() {
        return None;
    }
    Some(N::divide(N::dot(normal, relative), approach))
}
