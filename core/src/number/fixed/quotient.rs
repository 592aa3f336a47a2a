//! Quotients that are compared before a division: of the three times at which a ray enters a box's slabs, only the last
//! is needed.

use crate::number::fixed::base::{Fixed, with_sign};
use crate::number::fixed::halves::{product, product_unsigned};
use crate::number::fixed::reciprocal::reciprocal;
use core::cmp::Ordering;

/// A number over another. The order is that of the exact quotients. A quotient of another number by 0 is infinite; 0 by 0
/// compares as equal to everything.
#[derive(Clone, Copy, Debug)]
pub struct Quotient {
    numerator: i32,
    /// Not negative.
    denominator: i32,
}

impl Quotient {
    #[inline(always)]
    pub(super) fn new(numerator: Fixed, denominator: Fixed) -> Self {
        let turned = if denominator.0 < 0 {
            numerator.0.saturating_neg()
        } else {
            numerator.0
        };
        Self {
            numerator: turned,
            denominator: denominator.0.saturating_abs(),
        }
    }

    /// Rounds to nearest, ties away from zero; saturates.
    ///
    /// Cost: the quotient of 16 bits that [`reciprocal`] needs, and six products.
    pub(super) fn rounded(self) -> Fixed {
        let magnitude = self.numerator.unsigned_abs();
        let denominator = self.denominator.unsigned_abs();
        let sign = self.numerator.into();
        if magnitude >> 1 >= denominator {
            return with_sign(if magnitude == 0 { 0 } else { u64::MAX }, sign);
        }
        let up = denominator.leading_zeros().wrapping_sub(1) & 31;
        let (dividend, divisor) = (magnitude << up, denominator << up);
        let inverse = reciprocal(divisor);
        // To a part in 2^29: at most 5 too much or too little.
        let coarse = (product_unsigned(dividend, inverse) >> 31) as u32;
        let whole = (dividend as u64) << 30;
        let rest = whole.wrapping_sub(product_unsigned(coarse, divisor)) as i64;
        let rest = rest.wrapping_add(divisor as i64 / 2);
        let fine = (product((rest >> 4) as i32, (inverse >> 1) as i32) >> 56) as i32;
        // At most 1 too much or too little.
        let rest = rest.wrapping_sub(product(fine, divisor as i32));
        let fine = if rest < 0 {
            fine.wrapping_sub(1)
        } else {
            fine.wrapping_add((rest >= divisor as i64).into())
        };
        with_sign(coarse.wrapping_add_signed(fine).into(), sign)
    }
}

impl PartialEq for Quotient {
    fn eq(&self, other: &Self) -> bool {
        self.partial_cmp(other) == Some(Ordering::Equal)
    }
}

impl PartialOrd for Quotient {
    #[inline(always)]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        let left = product(self.numerator, other.denominator);
        let right = product(other.numerator, self.denominator);
        Some(left.cmp(&right))
    }
}
