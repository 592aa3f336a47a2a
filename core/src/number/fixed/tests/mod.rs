mod halves;
mod quotient;
mod root;

use crate::geometry::Project;
use crate::number::Convert;
use crate::number::Fixed;
use crate::number::Products;
use crate::number::Scalar;
use crate::number::Vectors;
use crate::number::fixed::base::round_off;
use crate::number::fixed::base::with_sign;
use crate::number::fixed::reciprocal::reciprocal;
use crate::number::fixed::root::nearest_root;
use crate::number::fixed::wide::Product;
use proptest::prelude::*;

#[test]
fn roots_are_the_nearest_integers() {
    for k in (1..1_u64 << 16).chain((1 << 31) - 1000..1 << 31) {
        for square in [k * k - 1, k * k, k * k + 1] {
            let root = nearest_root(square);
            // (root - 1/2)^2 < square < (root + 1/2)^2, times four.
            let doubled = u128::from(root) * 2;
            assert!((doubled + 1).pow(2) > 4 * u128::from(square));
            assert!(root == 0 || (doubled - 1).pow(2) <= 4 * u128::from(square));
        }
        assert_eq!(Fixed::root(Product((k * k) as i64)), with_sign(k, 0));
    }
}

#[test]
fn reciprocals_are_right_to_28_bits() {
    for d in (1_u32 << 30..1 << 31)
        .step_by(997)
        .chain([1 << 30, (1 << 31) - 1])
    {
        let exact = f64::powi(2.0, 61) / f64::from(d);
        assert!(
            (f64::from(reciprocal(d)) / exact - 1.0).abs() < f64::powi(2.0, -28),
            "{d}"
        );
    }
}

#[test]
fn rounding_is_the_same_on_both_sides_of_zero() {
    for product in -100_000..100_000_i64 {
        for bits in 1..8 {
            assert_eq!(round_off(-product, bits), -round_off(product, bits));
        }
    }
}

#[test]
fn exponentials_are_right_to_28_bits() {
    for step in 0..2_000_000_u32 {
        // Short lengths of dense glass, too.
        let shift = step % 16;
        let length = (step.wrapping_mul(2_654_435_761) >> 4 >> shift) as i32;
        let coefficient = step.wrapping_mul(40_503) << 12 | step;
        let value = f64::from(coefficient) * f64::powi(2.0, shift as i32 - 32);
        let exact = -(f64::from(length) / 8192.0) * value;
        let found = Fixed(length).exp_neg(coefficient, shift).ratio_to_f64();
        assert!(
            (found - exact.exp()).abs() < f64::powi(2.0, -28),
            "{length} {coefficient} {shift}"
        );
    }
    assert_eq!(Fixed(0).exp_neg(u32::MAX, 15), Fixed::ONE);
    assert_eq!(Fixed(i32::MAX).exp_neg(0, 15), Fixed::ONE);
    assert_eq!(Fixed(i32::MAX).exp_neg(u32::MAX, 15), Fixed(0));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200_000))]

    /// A quotient is right to one part in 2^30, or one step.
    #[test]
    fn quotients_agree_with_long_division(
        numerator: i64, denominator: i64, shrink in 0..62_u32, other in 0..62_u32,
    ) {
        let (a, b) = (numerator >> shrink, denominator >> other);
        prop_assume!(b != 0 && a != i64::MIN && b != i64::MIN);
        let exact = (i128::from(a) << 30) as f64 / b as f64;
        let limit = f64::from(i32::MAX);
        let exact = exact.clamp(-limit, limit);
        let found = f64::from(Fixed::divide(Product(a), Product(b)).0);
        prop_assert!((found - exact).abs() <= 1.0 + exact.abs() / f64::from(1 << 30), "{found} {exact}");
    }

    #[test]
    fn ratios_of_numbers_are_rounded_to_nearest(a: i32, b: i32) {
        prop_assume!(b != 0);
        let exact = (i128::from(a) << 31) / i128::from(b);
        // Twice the quotient, rounded towards zero: half of it lies within one of the nearest.
        let found = i128::from(Fixed(a).div(Fixed(b)).0);
        let saturated = exact.abs() / 2 >= i128::from(i32::MAX);
        prop_assert!(saturated && found.abs() == i128::from(i32::MAX) || (2 * found - exact).abs() <= 1);
    }

    #[test]
    fn unit_vectors_have_length_1(v: [i32; 3], shrink in 0..31_u32) {
        let v = v.map(|x| Fixed(x >> shrink));
        let (unit, length) = Fixed::normalize(v);
        let exact = v.iter().map(|x| f64::from(x.0).powi(2)).sum::<f64>().sqrt();
        if exact == 0.0 {
            prop_assert_eq!((unit, length), ([Fixed(0); 3], Fixed(0)));
            return Ok(());
        }
        for (found, whole) in unit.iter().zip(v) {
            let exact = f64::from(whole.0) / exact * f64::from(1 << 30);
            prop_assert!((f64::from(found.0) - exact).abs() <= 4.0, "{found:?} {exact}");
        }
        let exact = exact.min(f64::from(i32::MAX));
        prop_assert!((f64::from(length.0) - exact).abs() <= 2.0, "{length:?} {exact}");
    }

    #[test]
    fn slopes_are_right_to_two_steps(v: [i64; 3], shrink in 1..60_u32) {
        let v = v.map(|x| x >> shrink);
        let largest = v.iter().map(|x| x.unsigned_abs()).max().unwrap_or(0);
        let slopes = Fixed::slopes(v.map(Product));
        prop_assert_eq!(slopes.is_none(), largest == 0);
        if let Some((slopes, axis)) = slopes {
            prop_assert_eq!(slopes[axis].0.abs(), Fixed::ONE.0);
            for (slope, component) in slopes.iter().zip(v) {
                let exact = (i128::from(component) << 30) as f64 / largest as f64;
                prop_assert!((f64::from(slope.0) - exact).abs() <= 4.0, "{slope:?} {exact}");
            }
        }
    }

    #[test]
    fn norms_are_inverted(x in -(1 << 30)..=1 << 30_i32, y in -(1 << 30)..=1 << 30_i32) {
        let slopes = [Fixed(x), Fixed::ONE, Fixed(y)];
        let norm2: f64 = slopes.iter().map(|slope| slope.ratio_to_f64().powi(2)).sum();
        let found = Fixed::recip_norm2(slopes).ratio_to_f64();
        prop_assert!((found * norm2 - 1.0).abs() < f64::powi(2.0, -27), "{found} {norm2}");
    }

    /// Shortcuts change nothing, and a triangle that lies on one side of the origin is not hit.
    #[test]
    fn triangles_are_met_by_the_signs_of_their_edges(
        corners: [[i32; 2]; 3], shift in 2_u32..32, flat in 0..4_usize,
    ) {
        let [a, b, mut c] = corners.map(|corner| corner.map(|x| Fixed(x >> shift)));
        if flat == 0 {
            c = a;
        }
        let cross = |p: [Fixed; 2], q: [Fixed; 2]| {
            let product = |x: Fixed, y: Fixed| i128::from(x.0) * i128::from(y.0);
            (product(p[0], q[1]) - product(p[1], q[0])).signum()
        };
        let sides = [cross(b, c), cross(c, a), cross(a, b)];
        let met = sides.contains(&-1) != sides.contains(&1);
        prop_assert_eq!(Fixed::surrounds_origin(a, b, c), met);
        let beside = |axis: usize| Fixed::same_sign([a[axis], b[axis], c[axis]]);
        prop_assert!(!met || !beside(0) && !beside(1));
    }

    /// The projection of a vertex does not depend on the direction of axes.
    #[test]
    fn projections_are_mirrored(
        vertex in -(1_i32 << 23)..1_i32 << 23, depth in -(1_i32 << 23)..1_i32 << 23,
        origin in -(1_i32 << 28)..1_i32 << 28, slope in -(1_i32 << 30)..=1_i32 << 30,
    ) {
        let project = |turn: i32, turn_depth: i32| {
            let slope = Fixed(turn * slope);
            let major = Fixed(turn_depth * Fixed::ONE.0);
            let across = Fixed::axis_projection(Fixed(turn * origin), slope, 8);
            let along = Fixed::depth_projection(Fixed(0), major, 8);
            let stray = Fixed::shear_by(
                Fixed::project(turn_depth * depth, &along),
                Fixed::shear(slope, major),
            );
            let across = Fixed::project(turn * vertex, &across) + stray;
            // Without a slope the ray has no direction.
            if slope.0 == 0 { across.0.abs() } else { across.0 }
        };
        let plain = project(1, 1);
        prop_assert_eq!([plain; 3], [project(-1, 1), project(1, -1), project(-1, -1)]);
        let exact = f64::from((vertex << 5) - origin) * f64::from(slope.signum() | 1)
            - f64::from(depth << 5) * Fixed(slope.abs()).ratio_to_f64();
        let exact = if slope == 0 { exact.abs() } else { exact };
        prop_assert!((f64::from(plain) - exact).abs() <= 1.0, "{plain} {exact}");
    }

    /// Ratios by ratios of products, as kernels scale them.
    #[test]
    fn scaled_products_agree_with_128_bits(wide: i64, ratio in -(1 << 30)..=1 << 30_i32) {
        let exact = (i128::from(wide) * i128::from(ratio)) >> 30;
        let found = i128::from(Fixed::wide_scale(Product(wide), Fixed(ratio)).0);
        prop_assert!((found - exact).abs() <= 1);
    }

    /// Quotients of any magnitude, to a part in 2^30, up to where they saturate.
    #[test]
    fn far_quotients_agree_with_128_bits(
        wide: i64, ratios in 1..=i64::MAX, bits in [0..64_u32, 0..63], negative: bool,
    ) {
        let (wide, ratios) = (wide >> bits[0], (ratios >> bits[1]).max(1));
        let ratios = if negative { -ratios } else { ratios };
        let far = 1_i128 << 62;
        let exact = (i128::from(wide) << 60) / i128::from(ratios);
        let exact = exact.clamp(-far, far);
        let found = i128::from(Fixed::far_over(Product(wide), Product(ratios)).0);
        prop_assert!((found - exact).abs() <= 1 + (exact.abs() >> 30), "{found} {exact}");
    }

    #[test]
    fn remainders_lie_within_their_period(wide: i64, period in 1..=i32::MAX) {
        let found = Fixed::remainder(Product(wide), Fixed(period)).0;
        prop_assert_eq!(i64::from(found), wide.rem_euclid(period.into()));
    }
}
