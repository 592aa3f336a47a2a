//! Conversions between numbers and the values of blobs, displays and reports.

use crate::number::scalar::Scalar;

/// Conversions of numbers.
pub trait Convert: Scalar {
    /// A length from a coordinate of the storage lattice, in 1/256 unit; exact for 24 bits.
    fn from_lattice(steps: i32) -> Self;
    /// A length from whole units; exact.
    fn from_unit(unit: i16) -> Self;
    /// A ratio from an integer with 30 fraction bits.
    fn ratio(q30: i32) -> Self;
    /// A radiance from an integer with 20 fraction bits.
    fn radiance(q20: i32) -> Self;
    /// The sum of two radiances that are not negative. In `fixed` it is at most the largest number, 2048 times display
    /// white.
    fn radiance_sum(self, other: Self) -> Self;
    /// Radiance clamped to \[0, 1\] as an integer of 16 bits: 65535 is display white. NaN is 0.
    fn to_linear16(self) -> u16;
    /// A length from scene data in double precision: rounded, NaN to 0. Beyond its range it saturates in `fixed`, and is
    /// infinite in the float formats.
    fn length_from_f64(units: f64) -> Self;
    /// A far coordinate in units from double precision, as [`length_from_f64`](Self::length_from_f64).
    fn far_from_f64(units: f64) -> Self::Wide;
    /// A far coordinate in units in double precision, for reports.
    fn far_to_f64(wide: Self::Wide) -> f64;
    /// A far coordinate in units as an integer with 13 fraction bits: rounded to nearest, saturating, NaN to 0.
    fn far_to_q13(wide: Self::Wide) -> i64;
    /// A ratio in -2 to 2 from double precision: rounded, saturating in `fixed`, NaN to 0.
    fn ratio_from_f64(value: f64) -> Self;
    /// A length or a ratio in single precision, for culling on machines with SIMD registers.
    fn to_f32(self) -> f32;
    /// A length as an integer with 13 fraction bits, rounded towards zero; saturates.
    fn to_q13(self) -> i32;
    /// A ratio as an integer with 30 fraction bits, rounded towards zero; saturates.
    fn to_q30(self) -> i32;
    /// A length in units in double precision, for reports.
    fn length_to_f64(self) -> f64;
    /// A ratio in double precision, for reports.
    fn ratio_to_f64(self) -> f64;
    /// A radiance in double precision, for reports.
    fn radiance_to_f64(self) -> f64;
}
