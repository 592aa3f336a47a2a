//! The trait of shapes that have one form of records.

use crate::format::range::At;
use crate::format::record::UnitBox;
use crate::format::{BlobError, Field, Reason};
use crate::geometry::{Crossing, Part, Surface};
use crate::number::Arithmetic;
use crate::ray::Ray;
use bytemuck::Pod;

/// The record of a shape: everything that the core knows of it.
///
/// The registry of shapes, `shapes!` in [`format::kind`](crate::format::Kind), names every record. Other differences
/// between shapes are constants here, so that a search is compiled for each of them.
pub(crate) trait Primitive: Pod {
    /// True if [`cross`](Self::cross) needs the norm of the ray's slopes.
    const NEEDS_NORM: bool = false;
    /// True if a test is so expensive that the ray is first tested against the box.
    const TESTS_BOX: bool = false;
    /// True if rounding can move a crossing out of the box. Then it is clamped to the box.
    const CLAMPS: bool = true;
    /// True if the shape has no inside: its front is the side to which its normal points.
    const FLAT: bool = false;
    /// True if the caller makes a normal level with the ray when it lies on the wrong side of the ray.
    const LEVELED: bool = true;
    /// True if the shape has a box. A shape without one is in no structure: every query tests it first.
    const BOUNDED: bool = true;

    /// The box on the box lattice; the box of all points for a shape without a box.
    fn bounds(&self) -> UnitBox;

    /// The crossing of a ray's line: where it enters and leaves the shape, behind the origin too. `recip_norm2` is
    /// [`Vectors::recip_norm2`](crate::number::Vectors::recip_norm2) of the ray's slopes, where it is needed.
    ///
    /// A shape that a line can enter more than once returns the first interval that ends at or after the ray's `tmin`.
    fn cross<N: Arithmetic>(&self, ray: &Ray<N>, recip_norm2: N) -> Option<Crossing<N>>;

    /// Returns the crossing behind one that leaves the shape at `after`; `None` if the line does not enter again, as
    /// for most shapes.
    fn cross_after<N: Arithmetic>(&self, _: &Ray<N>, _: N, _after: N) -> Option<Crossing<N>> {
        None
    }

    /// The distance from a point of a ray to where its line crosses a shape without a box, for which
    /// [`cross`](Self::cross) is not called.
    fn cross_far<N: Arithmetic>(&self, _place: [N::Wide; 3], _slope: [N; 3]) -> Option<N::Wide> {
        None
    }

    /// Returns the surface where a ray hits it: the normal points outward, or to the front. `part` is that of the
    /// crossing, with [`LEAVING`](crate::geometry::LEAVING) where the ray leaves.
    fn surface<N: Arithmetic>(&self, ray: &Ray<N>, part: Part, point: [N; 3]) -> Surface<N>;

    /// Returns a point of a solid near a point of its surface, `depth` beneath all faces. Where the solid is thinner,
    /// the point lies halfway between them.
    fn inside<N: Arithmetic>(&self, [point, normal]: [[N; 3]; 2], depth: N) -> [N; 3] {
        offset_inward(point, normal, depth)
    }

    /// Proves the ranges of all fields.
    fn validate(&self, at: InScene<'_>) -> Result<(), BlobError>;
}

/// The point at a depth along a normal.
#[inline(always)]
pub(crate) fn offset_inward<N: Arithmetic>(point: [N; 3], normal: [N; 3], depth: N) -> [N; 3] {
    let axis = |k: usize| point[k] - depth * normal[k];
    [axis(0), axis(1), axis(2)]
}

/// The largest radius in 1/256 unit.
pub(crate) const MAX_RADIUS: i64 = (i16::MAX as i64) << 9;

/// Errors for a record that lies in the scene's box.
#[derive(Clone, Copy)]
pub(crate) struct InScene<'a> {
    pub(crate) at: At,
    /// The scene's box.
    pub(crate) bounds: &'a UnitBox,
}

impl InScene<'_> {
    /// Returns an error unless a point in 1/256 unit lies in the scene's box.
    #[inline(always)]
    pub(crate) fn point(self, field: Field, point: [i32; 3]) -> Result<(), BlobError> {
        let mut sides = self.bounds.0.iter().zip(point);
        let inside = sides.all(|(&[low, high], coordinate)| {
            i32::from(low) << 8 <= coordinate && coordinate <= i32::from(high) << 8
        });
        if inside {
            return Ok(());
        }
        self.point_outside(field, point)
    }

    /// The error for a point outside the scene's box.
    #[cold]
    #[inline(never)]
    fn point_outside(self, field: Field, point: [i32; 3]) -> Result<(), BlobError> {
        let mut sides = self.bounds.0.iter().zip(point);
        sides.try_for_each(|(sides, coordinate)| {
            let [low, high] = sides.map(|unit| i64::from(unit) << 8);
            self.at.within(field, coordinate.into(), low, high)
        })
    }

    /// Returns an error unless the box of the record lies in the scene's.
    pub(crate) fn inner(self, bounds: &UnitBox) -> Result<(), BlobError> {
        let inside = self.bounds.contains(bounds);
        self.at.ensure(inside, Reason::OutsideScene)
    }
}
