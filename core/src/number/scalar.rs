//! Single numbers.

use crate::number::format::Format;
use core::fmt::Debug;
use core::ops::{Add, Mul, Neg, Sub};

/// Closes [`Scalar`] to other crates, because a fourth format would have to keep the exactness on which the watertight
/// tests rely.
pub(in crate::number) trait Sealed {}

/// A number of one format; see the [module](crate::number) for the four quantities.
#[expect(private_bounds, reason = "no other crate implements it")]
pub trait Scalar:
    Sealed
    + Copy
    + Default
    + Debug
    + PartialEq
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Neg<Output = Self>
    + Mul<Output = Self>
    + Send
    + Sync
    + 'static
{
    /// Products of two numbers, and coordinates beyond the scene.
    type Wide: Copy
        + Default
        + Debug
        + PartialEq
        + PartialOrd
        + Add<Output = Self::Wide>
        + Sub<Output = Self::Wide>
        + Neg<Output = Self::Wide>
        + Send
        + Sync
        + 'static;
    /// A number over another. In integers it is exact, because integers divide slowly and compare fast.
    type Quotient: Copy + PartialOrd;
    /// The name of this format.
    const FORMAT: Format;
    /// Zero of every quantity.
    const ZERO: Self;
    /// The ratio 1.
    const ONE: Self;
    /// A length beyond every scene, for a ray without end.
    const FAR: Self;
    /// Magnitude; the most negative number becomes the largest.
    fn abs(self) -> Self;
    /// Half; exact in floats, rounded down in [`Fixed`](crate::Fixed).
    fn half(self) -> Self;
    /// Returns a coordinate, or 0 if its digits are so small that exact products would lose them.
    fn flush_tiny(self) -> Self;
    /// The smaller; the first where they are equal.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if other < self { other } else { self }
    }

    /// The larger; the first where they are equal.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if other > self { other } else { self }
    }

    /// Square root of a ratio in \[0, 2\]; 0 for anything negative.
    fn sqrt(self) -> Self;
    /// Undoes `*`: length over ratio is a length, and two of one quantity make a ratio. Saturates
    /// at the range's end; anything over 0 saturates, 0 over 0 is 0.
    #[inline(always)]
    fn div(self, divisor: Self) -> Self {
        Self::rounded(self.quotient(divisor))
    }

    /// The quotient of [`div`](Self::div) before it is rounded, for comparisons.
    fn quotient(self, divisor: Self) -> Self::Quotient;
    /// Rounds a quotient to the result of [`div`](Self::div).
    fn rounded(quotient: Self::Quotient) -> Self;
    /// Returns e to the power of minus a product, as a ratio in \[0, 1\]. The factors are a non-negative length and a
    /// coefficient in 1/unit. It is given with 32 fraction bits and times 2 to the power of `shift`, at most 15.
    fn exp_neg(self, coefficient_q32: u32, shift: u32) -> Self;
    /// The greatest integer at or below `self / size`, for lengths and `size` above 0.
    fn cell(self, size: Self) -> i32;
}
