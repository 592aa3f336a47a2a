//! Projections along a ray: see [`triangle`](crate::geometry::triangle).

mod fixed;
mod float;
#[cfg(test)]
mod tests;

use crate::number::Arithmetic;
use core::cmp::Ordering;

/// Arithmetic of vertices that are projected along a ray.
pub trait Project: Arithmetic {
    /// The projection along an axis of vertices whose coordinates count `2^bits` steps per unit, from a ray's
    /// origin and with its slope there.
    fn axis_projection(origin: Self, slope: Self, bits: u32) -> AxisProjection<Self>;
    /// The projection along the ray's major axis, for the depths of [`shear_by`](Self::shear_by).
    #[inline(always)]
    fn depth_projection(origin: Self, slope: Self, bits: u32) -> AxisProjection<Self> {
        Self::axis_projection(origin, slope, bits)
    }

    /// Projects a coordinate of at most 24 bits: to steps in floats, to a length along the ray's direction in
    /// [`Fixed`](crate::Fixed).
    fn project(coordinate: i32, axis: &AxisProjection<Self>) -> Self;
    /// Returns the shear, given the slopes along the minor and the major axis. It is how far a
    /// [projected](Self::project) point departs from the ray along a minor axis per step along its major one.
    fn shear(slope: Self, major: Self) -> Self;
    /// The shear over a depth of less than 2^17 units, by the same arithmetic for every vertex; in
    /// [`Fixed`](crate::Fixed) rounded down.
    fn shear_by(depth: Self, shear: Self) -> Self;
    /// Returns true if the triangle of three points of the plane contains the origin, edges included. Returns false if
    /// all edges lead through the origin. Exact for either orientation.
    fn surrounds_origin(a: [Self; 2], b: [Self; 2], c: [Self; 2]) -> bool;
    /// Returns the side of the origin on which a line from one point of the plane to another runs: how `p x q` compares
    /// to 0, exactly.
    fn side(p: [Self; 2], q: [Self; 2]) -> Ordering;
    /// Returns true if three numbers are certainly all above or all below zero. Can return false where the exact answer
    /// would cost more than it saves.
    #[inline(always)]
    fn same_sign(_: [Self; 3]) -> bool {
        false
    }

    /// Returns true if a ray hits a surface steeply, given the product of the normal's
    /// [`direction`](crate::number::Vectors::direction) with a slope. Steep means that the error of t is bounded: at
    /// least 2^-8 in [`Fixed`](crate::Fixed), see `geometry/triangle.rs`.
    #[inline(always)]
    fn is_steep(_: Self::Wide) -> bool {
        false
    }
}

/// The projection of vertices along one axis of a ray: see [`Project::axis_projection`].
#[derive(Clone, Copy, Debug)]
pub struct AxisProjection<N> {
    /// The offset to the ray's origin, in the unit of projected coordinates.
    pub(crate) offset: N,
    /// The factor that makes a coordinate a length, with the sign of the slope; for integers.
    pub(in crate::geometry) scale: i32,
}
