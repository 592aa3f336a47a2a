//! Bounds of what arithmetic rounds.

use crate::number::scalar::Scalar;

/// Error bounds of hits.
pub trait ErrorBounds: Scalar {
    /// The slope of [`error_bound`](Self::error_bound): zero in [`Fixed`](crate::Fixed), whose resolution is the same
    /// everywhere.
    const RELATIVE_ERROR: Self;
    /// The constant part of [`error_bound`](Self::error_bound), a length.
    const ABSOLUTE_ERROR: Self;
    /// The bound of what one hit's arithmetic can be off by, where all coordinates of ray and surface
    /// are below a magnitude.
    #[inline(always)]
    fn error_bound(magnitude: Self) -> Self {
        magnitude * Self::RELATIVE_ERROR + Self::ABSOLUTE_ERROR
    }
    /// A length that leads from a coordinate to the next number, whichever way it is taken; beside 0
    /// the least that keeps products exact.
    fn step_beside(coordinate: Self) -> Self;
    /// The error bound of a point of a plane: `normal` has the length 1, and `relative` leads from the
    /// point to that of the plane with which t is computed. Derived where it is implemented.
    fn plane_error(normal: [Self; 3], relative: [Self; 3], point: [Self; 3]) -> Self;
    /// The error bound of a point of a sphere, whose radius is `size`. Derived where it is implemented.
    fn curve_error(size: Self, normal: [Self; 3], point: [Self; 3]) -> Self;
}
