//! Errors of invalid rays.

use core::fmt;

/// The reason why a ray is invalid.
// As wide as a number in single precision. So a value with which it shares its place in a `Result` is loaded as it was
// stored.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RayError {
    /// The direction is zero, infinite or NaN.
    Direction,
    /// The origin is infinite or NaN.
    Origin,
    /// The origin is farther than [`FARTHEST`](crate::format::limits::FARTHEST) along an axis.
    Distance,
    /// `tmin` is greater than `tmax`, or one of them is NaN.
    Interval,
}

impl fmt::Display for RayError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            RayError::Direction => "the ray's direction is zero, infinite or NaN",
            RayError::Origin => "the ray's origin is infinite or NaN",
            RayError::Distance => {
                "the ray's origin is too far from the scene: more than 2^37 units of the lattice, which \
                 is 2^21 times the lattice's width; move it closer along the ray"
            }
            RayError::Interval => "the ray's tmin is greater than its tmax, or one of them is NaN",
        })
    }
}

impl core::error::Error for RayError {}
