//! Products of 16-bit halves, compared with the machine's own.

use crate::geometry::Project;
use crate::number::Fixed;
use crate::number::fixed::halves::{
    leading_zeros_by_shifts, product_of_halves, product_of_halves_unsigned, quotient_by_products,
    surround,
};
use proptest::prelude::*;

#[test]
fn quotients_by_products_are_exact() {
    for d in 1 << 15..=1 << 16 {
        assert_eq!(quotient_by_products(d), u32::MAX / d, "{d}");
    }
}

proptest! {
    #[test]
    fn leading_zeros_are_counted(x in 1_u32.., shift in 0_u32..32) {
        let x = (x >> shift).max(1);
        prop_assert_eq!(leading_zeros_by_shifts(x), x.leading_zeros());
    }

    #[test]
    fn products_of_halves_are_products(a: i32, b: i32) {
        prop_assert_eq!(product_of_halves(a, b), i64::from(a) * i64::from(b));
        let (a, b) = (a as u32, b as u32);
        prop_assert_eq!(product_of_halves_unsigned(a, b), u64::from(a) * u64::from(b));
    }

    /// Tests with 16 bits agree with tests of all bits, if they decide.
    #[test]
    fn coarse_triangles_are_the_triangles(corners: [[i32; 2]; 3], shift in 1_u32..32) {
        let [a, b, c] = corners.map(|corner| corner.map(|x| Fixed(x >> shift)));
        if let Some(decided) = surround(a, b, c) {
            prop_assert_eq!(decided, Fixed::surrounds_origin(a, b, c));
        }
    }
}

/// Tests with 16 bits decide if corners lie apart.
#[test]
fn coarse_triangles_are_mostly_decided() {
    let mut decided = 0;
    for step in 0..10_000_u32 {
        let coordinate = |k: u32| Fixed((step * 6 + k).wrapping_mul(2_654_435_761) as i32 >> 5);
        let corner = |k: u32| [coordinate(k), coordinate(k + 1)];
        decided += u32::from(surround(corner(0), corner(2), corner(4)).is_some());
    }
    assert!(decided > 9_900, "{decided}");
}
