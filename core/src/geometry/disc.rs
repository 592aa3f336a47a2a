//! Flat discs: the crossing of their plane, if it lies no farther than the radius from the centre.

use crate::format::record::Disc;
use crate::geometry::{Crossing, Surface, cross_plane, plane};
use crate::number::Arithmetic;
use crate::ray::Ray;

impl Disc {
    fn normal<N: Arithmetic>(&self) -> [N; 3] {
        N::direction(self.normal.map(i64::from))
    }

    /// The crossing, both sides alike; `None` for a ray along the plane.
    #[inline(always)]
    pub(crate) fn cross<N: Arithmetic>(&self, ray: &Ray<N>) -> Option<Crossing<N>> {
        let axis = |k: usize| N::from_lattice(self.center[k]) - ray.origin[k];
        let relative = [axis(0), axis(1), axis(2)];
        let normal = self.normal();
        let t = cross_plane(normal, relative, N::dot(normal, ray.slope))?;
        // A ray passes through the scene within 2^16 units; more would leave the range of `fixed`
        // below, where the point may be as far again from the centre.
        let within_scene = t.abs() <= N::FAR.half();
        if !within_scene {
            return None;
        }
        let radius = N::from_lattice(self.radius);
        let axis = |k: usize| t * ray.slope[k] - relative[k];
        let apart = [axis(0), axis(1), axis(2)];
        // The box first, so that squares stay in range.
        let near = |k: usize| apart[k].abs() <= radius;
        let inside = near(0) && near(1) && near(2) && N::dot(apart, apart) <= radius.wide(radius);
        inside.then_some(Crossing::flat(t))
    }

    /// The front is where the normal points.
    pub(crate) fn surface<N: Arithmetic>(&self, point: [N; 3]) -> Surface<N> {
        plane::surface(self.normal(), self.center, point)
    }
}
