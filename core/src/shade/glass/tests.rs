//! Hard cases F6 to F9 and F11: glass, compared with the laws in double precision, by other
//! formulas.

use super::*;
use crate::number::{Fixed, Format};
use crate::shade::absorption::absorb;
use bytemuck::Zeroable;
use proptest::prelude::*;

/// A unit of last place about 1/2.
fn u<N: Number>() -> f64 {
    match N::FORMAT {
        Format::Fixed => f64::powi(2.0, -30),
        Format::F32 => f64::powi(2.0, -24),
        Format::F64 => f64::powi(2.0, -53),
    }
}

/// The reflected part by the sines and tangents of the two angles, of rounded inputs.
fn reflected(k: f64, entering: bool, cos_in: f64) -> f64 {
    let (n_in, n_out) = if entering { (k, 1.0) } else { (1.0, k) };
    let sin_in = (1.0 - cos_in * cos_in).max(0.0).sqrt();
    let sin_out = n_in / n_out * sin_in;
    if sin_out >= 1.0 {
        return 1.0;
    }
    let cos_out = ((1.0 - sin_out) * (1.0 + sin_out)).sqrt();
    let across = (n_in * cos_in - n_out * cos_out) / (n_in * cos_in + n_out * cos_out);
    let along = (n_out * cos_in - n_in * cos_out) / (n_out * cos_in + n_in * cos_out);
    0.5 * (across * across + along * along)
}

/// Tests one split against the laws; the angle is in the plane of x and the normal z.
fn judge<N: Number>(inverse_ior: i32, entering: bool, sin: f64) -> Result<(), TestCaseError> {
    let k = N::ratio(inverse_ior);
    let cos = ((1.0 - sin) * (1.0 + sin)).sqrt();
    let (x, z) = (N::ratio_from_f64(sin), N::ratio_from_f64(cos));
    let normal = [N::ZERO, N::ZERO, N::ONE];
    let Split {
        reflected: found,
        refracted,
    } = split(
        Interface {
            k,
            to_denser: entering,
        },
        [x, N::ZERO, -z],
        normal,
        z,
    );
    let found = found.ratio_to_f64();
    let way = refracted.map(N::ratio_to_f64);
    prop_assert!((0.0..=1.0).contains(&found), "{found}");
    prop_assert!(
        way.iter().all(|x| x.is_finite() && x.abs() <= 2.0),
        "{way:?}"
    );
    let (k, cos) = (k.ratio_to_f64(), z.ratio_to_f64());
    let sin2 = 1.0 - cos * cos;
    // The distance from the angle at which all light is reflected.
    let margin = if entering {
        1.0 - k * k * sin2
    } else {
        (k * k - sin2) / (k * k)
    };
    let rounding = if entering { 8.0 } else { 8.0 / (k * k) };
    if margin.abs() < rounding * u::<N>() {
        return Ok(());
    }
    let exact = reflected(k, entering, cos);
    // The other angle is uncertain where the margin is small. Where glass is almost like air, this
    // angle can be as flat, and the reflected part depends on the ratio of the two.
    let flat = cos.max(1.0 - k);
    let bound = 256.0 * u::<N>() * (1.0 / (margin.abs().sqrt() * flat)).max(1.0);
    prop_assert!((found - exact).abs() <= bound, "{found} {exact} {margin}");
    if !entering && margin < 0.0 {
        prop_assert_eq!(found, 1.0);
        return Ok(());
    }
    // Snell's law: the refracted direction's tangent.
    let ratio = if entering { k } else { 1.0 / k };
    let sin_out = ratio * x.ratio_to_f64();
    let length = way[0].hypot(way[2]);
    let bound = 64.0 * u::<N>() * (1.0 / margin.sqrt()) / k;
    prop_assert!(
        (way[0] / length - sin_out).abs() <= bound,
        "{way:?} {sin_out}"
    );
    prop_assert!(way[2] <= 0.0, "{way:?}");
    Ok(())
}

/// Inverse indices of 1/4 to 1, and sines: any, near the critical angle, near 0 and 1.
fn angles() -> impl Strategy<Value = (i32, bool, f64)> {
    let one = 1_i32 << 30;
    let k = prop_oneof![one / 4..=one, one - 1000..=one, Just(715_827_883)];
    (k, any::<bool>(), 0..5_u8, 0.0..1.0_f64).prop_map(move |(k, entering, sort, part)| {
        let critical = f64::from(k) / f64::from(one);
        let near = f64::powf(10.0, -12.0 * part);
        let sin = match sort {
            0 => part,
            1 => near,
            2 => 1.0 - near,
            3 => critical - near * critical,
            _ => critical + near * (1.0 - critical),
        };
        (k, entering, sin.clamp(0.0, 1.0))
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100_000))]

    #[test]
    fn glass_obeys_snell_and_fresnel((k, entering, sin) in angles()) {
        judge::<Fixed>(k, entering, sin)?;
        judge::<f32>(k, entering, sin)?;
        judge::<f64>(k, entering, sin)?;
    }

    /// Light that passes one piece of glass and then another passes both (F11).
    #[test]
    fn absorption_multiplies(coefficient: u32, a in 0.0..30_000.0_f64, b in 0.0..30_000.0_f64) {
        fn judge<N: Number>(coefficient: u32, a: f64, b: f64) -> Result<(), TestCaseError> {
            let mut material = Material::zeroed();
            material.absorption = [coefficient, 0, 0];
            let left = |length: f64| absorb::<N>(&material, N::length_from_f64(length)).0;
            let (first, second, both) = (left(a), left(b), left(a + b));
            let product = first[0].ratio_to_f64() * second[0].ratio_to_f64();
            // The rounding of the lengths counts in proportion to the exponent.
            let exponent = f64::from(coefficient) / f64::powi(2.0, 32) * (a + b);
            let step = if N::FORMAT == Format::Fixed { f64::powi(2.0, -13) } else { 0.0 };
            let rounded = (exponent * u::<N>() + step * f64::from(coefficient) / f64::powi(2.0, 32)) * product;
            let bound = 8.0 * u::<N>() + 8.0 * rounded;
            prop_assert!((both[0].ratio_to_f64() - product).abs() <= bound, "{product} {both:?}");
            // Clear glass absorbs nothing, to the last bit.
            prop_assert_eq!(both[1], N::ONE);
            Ok(())
        }
        judge::<Fixed>(coefficient, a, b)?;
        judge::<f32>(coefficient, a, b)?;
        judge::<f64>(coefficient, a, b)?;
    }
}

/// Straight on, all formulas have one value (F7); and glass like air is invisible (F9).
#[test]
fn glass_obeys_fresnel_straight_on_and_is_invisible_like_air() {
    fn judge<N: Number>() {
        let normal = [N::ZERO, N::ZERO, N::ONE];
        for step in 1..=100 {
            let k = N::ratio((1 << 30) / 100 * step);
            let exact = ((1.0 - k.ratio_to_f64()) / (1.0 + k.ratio_to_f64())).powi(2);
            for entering in [true, false] {
                let split = split(
                    Interface {
                        k,
                        to_denser: entering,
                    },
                    [N::ZERO, N::ZERO, -N::ONE],
                    normal,
                    N::ONE,
                );
                let found = split.reflected.ratio_to_f64();
                assert!((found - exact).abs() <= 8.0 * u::<N>(), "{found} {exact}");
            }
        }
        for cos in [0.0, 1e-9, 0.3, 1.0] {
            let cos = N::ratio_from_f64(cos);
            let d = [N::ratio_from_f64(0.8), N::ZERO, -cos];
            for entering in [true, false] {
                let split = split(
                    Interface {
                        k: N::ONE,
                        to_denser: entering,
                    },
                    d,
                    normal,
                    cos,
                );
                assert_eq!(split.reflected, N::ZERO);
                assert_eq!(split.refracted, d);
            }
            assert_eq!(straight_through(N::ONE, cos), N::ONE);
        }
    }
    judge::<Fixed>();
    judge::<f32>();
    judge::<f64>();
}
