//! Quotients that are compared before anything is divided: of the three times at which a ray enters a
//! box's slabs, only the last is needed.

use crate::number::fixed::base::{Fixed, with_sign};
use crate::number::fixed::halves::{product, product_unsigned};
use crate::number::fixed::reciprocal::reciprocal;
use core::cmp::Ordering;

/// A number over another. The order is that of the exact quotients; where something is divided by 0,
/// everything compares as equal.
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

    /// To nearest, away from zero where two are; saturates.
    ///
    /// Cost: the quotient of 16 bits that [`reciprocal`] takes, and six products.
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn exact(a: i64, b: i64) -> i64 {
        if b == 0 {
            return a.signum() * i64::from(i32::MAX);
        }
        let numerator = i128::from(a.abs()) << 30;
        let rounded = (numerator + i128::from(b.abs()) / 2) / i128::from(b.abs());
        let magnitude = rounded.min(i128::from(i32::MAX)) as i64;
        if (a < 0) != (b < 0) {
            -magnitude
        } else {
            magnitude
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[test]
        fn quotients_are_those_of_long_division(
            a in -i32::MAX..=i32::MAX, b in -i32::MAX..=i32::MAX, shrink in 0..31_u32, other in 0..31_u32,
        ) {
            let (a, b) = (a >> shrink, b >> other);
            let found = Quotient::new(Fixed(a), Fixed(b)).rounded();
            prop_assert_eq!(i64::from(found.0), exact(a.into(), b.into()), "{} {}", a, b);
        }

        #[test]
        fn the_order_is_that_of_the_quotients(
            a in -i32::MAX..=i32::MAX, b in 1..=i32::MAX, c in -9..9_i32, d in 1..9_i32, shrink in 0..31_u32,
        ) {
            let a = a >> shrink;
            let order = (i64::from(a) * i64::from(d)).cmp(&(i64::from(c) * i64::from(b)));
            let pairs = [(a, b, c, d), (-a, -b, c, d), (a, b, -c, -d), (-a, -b, -c, -d)];
            for (a, b, c, d) in pairs {
                let quotient = |a, b| Quotient::new(Fixed(a), Fixed(b));
                prop_assert_eq!(quotient(a, b).partial_cmp(&quotient(c, d)), Some(order));
            }
        }
    }

    /// Halves, and what lies a step beside them; divisors at both ends of their range.
    #[test]
    fn halves_are_rounded_away_from_zero() {
        for b in [
            1,
            2,
            3,
            7,
            1 << 30,
            (1 << 30) - 1,
            (1 << 30) + 1,
            i32::MAX - 1,
            i32::MAX,
        ] {
            let near = |a: i32| [a, a.saturating_add(b / 2), a.saturating_add(b)];
            for a in (-40..=40).flat_map(near) {
                let found = Quotient::new(Fixed(a), Fixed(b)).rounded();
                assert_eq!(i64::from(found.0), exact(a.into(), b.into()), "{a} {b}");
            }
        }
    }
}
