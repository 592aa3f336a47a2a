//! Square roots, compared with the standard library's.

use crate::number::fixed::root::root;
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(50_000))]

    #[test]
    fn roots_are_those_of_the_standard_library(square: u64, shrink in 0..64_u32) {
        let square = square >> shrink;
        prop_assert_eq!(root(square), square.isqrt(), "{}", square);
    }

    #[test]
    fn squares_and_what_lies_beside_them_have_the_right_roots(x: u32, shrink in 0..32_u32) {
        let x = u64::from(x >> shrink);
        let square = x * x;
        for beside in [square.saturating_sub(1), square, square + 1] {
            prop_assert_eq!(root(beside), beside.isqrt(), "{}", beside);
        }
    }
}

#[test]
fn roots_at_the_ends_of_guesses_are_exact() {
    for i in 0..=96_u64 {
        for beside in -2..=2_i64 {
            let square = (32 + i).wrapping_shl(57).wrapping_add_signed(beside);
            assert_eq!(root(square), square.isqrt(), "{square}");
        }
    }
    for square in (0..70_000).chain([u64::MAX, u64::MAX - 1, u64::MAX << 32]) {
        assert_eq!(root(square), square.isqrt(), "{square}");
    }
}
