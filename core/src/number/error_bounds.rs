//! Bounds of rounding errors.

use crate::number::scalar::Scalar;

/// Error bounds of hits.
pub trait ErrorBounds: Scalar {
    /// The slope of [`error_bound`](Self::error_bound): zero in [`Fixed`](crate::Fixed), whose resolution is the same
    /// everywhere.
    const RELATIVE_ERROR: Self;
    /// The constant part of [`error_bound`](Self::error_bound), a length.
    const ABSOLUTE_ERROR: Self;
    /// The error bound of one hit's arithmetic, where all coordinates of ray and surface are below a magnitude.
    #[inline(always)]
    fn error_bound(magnitude: Self) -> Self {
        magnitude * Self::RELATIVE_ERROR + Self::ABSOLUTE_ERROR
    }

    /// Returns a length that leads from a coordinate to the next number, in either direction; next to 0 the least that
    /// keeps products exact.
    fn step_beside(coordinate: Self) -> Self;
    /// Returns the error bound of a point of a plane. `normal` has the length 1, and `relative` leads from the point to
    /// that of the plane from which t is computed. Derived where it is implemented.
    fn plane_error(normal: [Self; 3], relative: [Self; 3], point: [Self; 3]) -> Self;
    /// The error bound of a point of a sphere, whose radius is `size`. Derived where it is implemented.
    fn curve_error(size: Self, normal: [Self; 3], point: [Self; 3]) -> Self;
}
