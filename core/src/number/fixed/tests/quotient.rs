//! Quotients, compared with long division.

use crate::number::Fixed;
use crate::number::fixed::quotient::Quotient;
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

/// Halves, and numbers a step away from them; divisors at both ends of their range.
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
