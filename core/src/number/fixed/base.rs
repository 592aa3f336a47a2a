//! A number in fixed point, and its sums.

use core::ops::{Add, Neg, Sub};

/// A number in fixed point. The place of its binary point depends on the quantity: a length
/// has 13 fraction bits, a ratio 30, a radiance 20 (see [`Number`](crate::Number)).
///
/// All operators wrap; none panics, whatever the build's overflow checks. Kernels stay within ranges that they
/// document. Tests check these ranges with the feature `strict-ranges`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(transparent)]
pub struct Fixed(pub i32);

/// Does nothing, or with the feature `strict-ranges` panics where a kernel left its documented range.
#[inline(always)]
pub(crate) fn assert_in_range(in_range: impl FnOnce() -> bool) {
    #[cfg(feature = "strict-ranges")]
    super::strict::check(in_range());
    #[cfg(not(feature = "strict-ranges"))]
    let _ = in_range;
}

/// Fraction bits of a length.
pub(crate) const LENGTH_BITS: u32 = 13;
/// Fraction bits of a ratio.
pub(crate) const RATIO_BITS: u32 = 30;
/// Fraction bits of a radiance.
pub(in crate::number) const RADIANCE_BITS: u32 = 20;

/// Rounds away a product's `bits` lowest bits, 1 to 31: to nearest, ties away from zero, so that a mirrored scene gives
/// mirrored numbers.
#[inline(always)]
pub(in crate::number) const fn round_off(product: i64, bits: u32) -> i64 {
    // A half, less 1 where that turns a tie down. It is not negative, so that one addition of 64 bits is enough.
    let half = (1_u32 << (bits & 31) >> 1).wrapping_add((product >> 63) as u32);
    product.wrapping_add(half as i64) >> (bits & 31)
}

#[inline(always)]
pub(crate) const fn saturate(value: i64) -> Fixed {
    if value > i32::MAX as i64 {
        Fixed(i32::MAX)
    } else if value < -(i32::MAX as i64) {
        Fixed(-i32::MAX)
    } else {
        Fixed(value as i32)
    }
}

/// Gives a magnitude the sign of `sign`.
#[inline(always)]
pub(in crate::number) const fn with_sign(magnitude: u64, sign: i64) -> Fixed {
    let magnitude = if magnitude > i32::MAX as u64 {
        i32::MAX
    } else {
        magnitude as i32
    };
    Fixed(if sign < 0 { -magnitude } else { magnitude })
}

/// Sums and differences that wrap, of numbers and of their products.
macro_rules! wrapping_sums {
    ($number:ident) => {
        impl Add for $number {
            type Output = Self;
            #[inline(always)]
            fn add(self, other: Self) -> Self {
                assert_in_range(|| self.0.checked_add(other.0).is_some());
                Self(self.0.wrapping_add(other.0))
            }
        }

        impl Sub for $number {
            type Output = Self;
            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                assert_in_range(|| self.0.checked_sub(other.0).is_some());
                Self(self.0.wrapping_sub(other.0))
            }
        }

        impl Neg for $number {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                assert_in_range(|| self.0.checked_neg().is_some());
                Self(self.0.wrapping_neg())
            }
        }
    };
}
pub(in crate::number) use wrapping_sums;

wrapping_sums!(Fixed);
