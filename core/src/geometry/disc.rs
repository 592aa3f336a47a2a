//! Flat discs: the crossing of their plane, if it lies no farther than the radius from the center.

use crate::format::layout::records;
use crate::format::range::Ranges;
use crate::format::record::UnitBox;
use crate::format::{BlobError, Field, Reason};
use crate::geometry::primitive::{InScene, MAX_RADIUS, Primitive};
use crate::geometry::{Crossing, Part, Surface, cross_plane, flat};
use crate::number::Arithmetic;
use crate::ray::Ray;
use bytemuck::{Pod, Zeroable};

records! {
    /// A flat disc.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(40)]
    pub struct Disc {
        /// Center in 1/256 unit.
        pub center: [i32; 3],
        /// Normal of any length, not zero.
        #[valid(Normal: -(1 << 24)..=1 << 24)]
        pub normal: [i32; 3],
        /// Radius in 1/256 unit.
        #[valid(Radius: 1..=MAX_RADIUS)]
        pub radius: i32,
        /// The box, rounded outward from the true shape. A ray that misses the box misses the shape, and hits are
        /// clamped to the box.
        pub bounds: UnitBox,
    }
}

impl Disc {
    fn normal<N: Arithmetic>(&self) -> [N; 3] {
        N::direction(self.normal.map(i64::from))
    }
}

impl Primitive for Disc {
    const FLAT: bool = true;

    #[inline(always)]
    fn bounds(&self) -> UnitBox {
        self.bounds
    }

    /// The crossing, both sides alike; `None` for a ray along the plane.
    #[inline(always)]
    fn cross<N: Arithmetic>(&self, ray: &Ray<N>, _: N) -> Option<Crossing<N>> {
        let axis = |k: usize| N::from_lattice(self.center[k]) - ray.origin[k];
        let relative = [axis(0), axis(1), axis(2)];
        let normal = self.normal();
        let t = cross_plane(normal, relative, N::dot(normal, ray.slope))?;
        // A ray passes through the scene within 2^16 units. A longer way would leave the range of `fixed` below, where
        // the point can be equally far again from the center.
        let within_scene = t.abs() <= N::FAR.half();
        if !within_scene {
            return None;
        }
        let radius = N::from_lattice(self.radius);
        let axis = |k: usize| t * ray.slope[k] - relative[k];
        let apart = [axis(0), axis(1), axis(2)];
        // The box is tested first, so that squares stay in range.
        let near = |k: usize| apart[k].abs() <= radius;
        let inside = near(0) && near(1) && near(2) && N::dot(apart, apart) <= radius.wide(radius);
        inside.then_some(Crossing::flat(t))
    }

    /// The front is the side to which the normal points.
    fn surface<N: Arithmetic>(&self, _: &Ray<N>, _: Part, point: [N; 3]) -> Surface<N> {
        flat::surface(self.normal(), self.center, point)
    }

    fn validate(&self, scene: InScene<'_>) -> Result<(), BlobError> {
        let at = scene.at;
        scene.point(Field::Center, self.center)?;
        self.check_ranges(at.location())?;
        at.ensure(self.normal != [0; 3], Reason::ZeroNormal)?;
        scene.inner(&self.bounds)
    }
}
