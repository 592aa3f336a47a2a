//! Wide numbers: products in 64 bits, their multiplication and division.

use crate::number::fixed::base::wrapping_sums;
use crate::number::fixed::base::{Fixed, RATIO_BITS, assert_in_range, with_sign};
use crate::number::fixed::halves::{product_unsigned, wide_leading_zeros};
use crate::number::fixed::reciprocal::reciprocal;
use crate::target::{NARROW_PRODUCTS, inline_unless_small};
use core::ops::{Add, Neg, Sub};

/// A product in 64 bits; its operators wrap like those of [`Fixed`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(transparent)]
pub struct Product(pub i64);

wrapping_sums!(Product);

impl Product {
    /// [`Products::wide_times`](crate::number::Products::wide_times).
    #[inline(always)]
    pub(super) fn times(self, factor: i32) -> Self {
        if !NARROW_PRODUCTS {
            return Self(self.0.wrapping_mul(factor as i64));
        }
        let low = product_unsigned(self.0 as u32, factor as u32);
        // As a signed number, a negative factor is 2^32 less.
        let correction = self.0 as i32 & factor >> 31;
        let high = ((self.0 >> 32) as i32)
            .wrapping_mul(factor)
            .wrapping_sub(correction);
        Self((low as i64).wrapping_add((high as i64) << 32))
    }

    /// Multiplies by a ratio of at most 1, given as two products of one kind: exactly, then rounded to nearest.
    pub(super) fn times_ratio(self, numerator: Self, denominator: Self) -> Self {
        let (step, stride) = (numerator.0.unsigned_abs(), denominator.0.unsigned_abs());
        // The magnitude bit by bit, as a quotient of strides and a rest below one.
        let (mut quotient, mut rest) = (0_u64, 0_u64);
        let add = |rest: u64, more: u64| {
            let room = stride.wrapping_sub(more);
            if rest >= room {
                (1, rest.wrapping_sub(room))
            } else {
                (0, rest.wrapping_add(more))
            }
        };
        let mut left = self.0.unsigned_abs();
        for _ in 0..64 {
            let (carry, twice) = add(rest, rest);
            quotient = (quotient << 1).wrapping_add(carry);
            rest = twice;
            if left >> 63 != 0 {
                let (carry, more) = add(rest, step);
                quotient = quotient.wrapping_add(carry);
                rest = more;
            }
            left <<= 1;
        }
        let (round_up, _) = add(rest, rest);
        let quotient = quotient.wrapping_add(round_up) as i64;
        Self(if self.0 ^ numerator.0 ^ denominator.0 < 0 {
            quotient.wrapping_neg()
        } else {
            quotient
        })
    }

    /// [`Products::wide_over`](crate::number::Products::wide_over).
    // Only the set-up of cameras uses it.
    #[inline(never)]
    pub(super) fn div(self, divisor: i32) -> Self {
        assert_in_range(|| divisor > 0 && divisor < 1 << 24);
        let divisor = divisor.unsigned_abs();
        // Byte by byte, in 32 bits, because a division in 64 bits would cost cores without one a kilobyte.
        let (mut quotient, mut rest) = (0_u64, 0_u32);
        let mut left = self.0.unsigned_abs();
        for _ in 0..8 {
            let dividend = rest << 8 | (left >> 56) as u32;
            let digit = dividend.checked_div(divisor).unwrap_or(0);
            rest = dividend.wrapping_sub(digit.wrapping_mul(divisor));
            quotient = quotient << 8 | u64::from(digit);
            left <<= 8;
        }
        let quotient = quotient as i64;
        Self(if self.0 < 0 {
            quotient.wrapping_neg()
        } else {
            quotient
        })
    }

    inline_unless_small!(
        /// [`Products::wide_scale`](crate::number::Products::wide_scale).
        pub(super) fn scaled(self, ratio: Fixed) -> Self {
            assert_in_range(|| {
                i64::try_from((self.0 as i128 * ratio.0 as i128) >> RATIO_BITS).is_ok()
            });
            let high = (self.0 >> 32).wrapping_mul(ratio.0 as i64);
            let low = (self.0 & 0xffff_ffff).wrapping_mul(ratio.0 as i64);
            // Rounded as a product of two numbers is.
            let half = (1 << (RATIO_BITS - 1)) + ((self.0 ^ ratio.0 as i64) >> 63);
            let low = low.wrapping_add(half) >> RATIO_BITS;
            Self((high << (32 - RATIO_BITS)).wrapping_add(low))
        }
    );

    /// Multiplies by a power of two: up without a check, or down and rounded to nearest, away from zero at a tie.
    pub(super) fn shifted(self, exponent: i32) -> Self {
        let bits = exponent.unsigned_abs() & 63;
        if exponent >= 0 {
            return Self(self.0.wrapping_shl(bits));
        }
        let half = (1_u64 << bits >> 1) as i64;
        let rounded = self.0.wrapping_add(half).wrapping_add(self.0 >> 63);
        Self(rounded >> bits)
    }

    /// [`Products::far_over`](crate::number::Products::far_over).
    pub(super) fn over_ratios(self, denominator: Self) -> Self {
        let sign = self.0 ^ denominator.0;
        let (a, b) = (self.0.unsigned_abs(), denominator.0.unsigned_abs());
        let (up, down) = (wide_leading_zeros(a), wide_leading_zeros(b));
        // The divisor's upper 32 bits, and all of the dividend's: to a part in 2^31.
        let Some(quotient) = a
            .wrapping_shl(up)
            .checked_div(b.wrapping_shl(down) >> 32)
            .filter(|_| b != 0)
        else {
            return Self(0);
        };
        // From a / b times 2^(up + 32 - down) to a / b times 2^(2 * RATIO_BITS).
        let (left, right) = (down.wrapping_add(2 * RATIO_BITS), up.wrapping_add(32));
        let magnitude = match left.checked_sub(right) {
            Some(left) if left >= wide_leading_zeros(quotient) => i64::MAX as u64,
            Some(left) => quotient.wrapping_shl(left),
            None => {
                let right = right.wrapping_sub(left);
                quotient.checked_shr(right).unwrap_or(0)
            }
        };
        // Leaves room for the coordinates of an origin.
        let magnitude = magnitude.min(1 << 62) as i64;
        Self(if sign < 0 { -magnitude } else { magnitude })
    }

    /// [`Products::divide`](crate::number::Products::divide).
    pub(super) fn divided_by(self, denominator: Self) -> Fixed {
        let sign = self.0 ^ denominator.0;
        let a = self.0.unsigned_abs();
        let b = denominator.0.unsigned_abs();
        if b == 0 {
            return if a == 0 {
                Fixed(0)
            } else {
                with_sign(u64::MAX, sign)
            };
        }
        // The divisor's upper 32 bits are enough: t is a length of at most 31 bits.
        let shift = wide_leading_zeros(b);
        let divisor = b.wrapping_shl(shift) >> 32;
        let dividend = match shift.checked_sub(32 - RATIO_BITS) {
            Some(up) if up > wide_leading_zeros(a) => return with_sign(u64::MAX, sign),
            Some(up) => a.wrapping_shl(up),
            None => a >> ((32 - RATIO_BITS).wrapping_sub(shift) & 63),
        };
        if dividend >> 31 >= divisor {
            return with_sign(u64::MAX, sign);
        }
        // By the reciprocal, to a part in 2^29, and then by that of the rest: within one sub-step.
        let inverse = reciprocal((divisor >> 1) as u32) as u64;
        // All factors have at most 32 bits.
        let coarse = product_unsigned((dividend >> 31) as u32, inverse as u32) >> 31;
        let rest = product_unsigned(coarse as u32, divisor as u32);
        let rest = dividend.wrapping_sub(rest) as i64;
        assert_in_range(|| rest.unsigned_abs() < 1 << 37);
        let fine = (rest >> 8).wrapping_mul(inverse as i64);
        let fine = fine.wrapping_add(1 << 53) >> 54;
        with_sign(coarse.wrapping_add(fine as u64), sign)
    }
}
