//! GGX, compared with formulas and quadrature in double precision.

use super::*;
use crate::number::{Fixed, Format};
use crate::shade::sampler::Sampler;
use std::f64::consts::{LN_2, PI};

const ROUGHNESSES: [f64; 6] = [0.05, 0.1, 0.3, 0.5, 0.8, 1.0];
const COSINES: [f64; 5] = [1.0, 0.9, 0.5, 0.2, 0.05];

type Vector = [f64; 3];

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit(v: Vector) -> Vector {
    let length = dot(v, v).sqrt();
    v.map(|x| x / length)
}

/// The α of a roughness, with 30 fraction bits.
fn q30(roughness: f64) -> i32 {
    (roughness * roughness * f64::from(1 << 30)).round() as i32
}

fn alpha(roughness: f64) -> f64 {
    f64::from(q30(roughness)) / f64::from(1 << 30)
}

/// GGX of Walter et al. over cos of the normal's angle, by its tangent.
fn distribution(alpha: f64, cos: f64) -> f64 {
    let tan2 = (1.0 - cos * cos) / (cos * cos);
    let spread = alpha * alpha + tan2;
    alpha * alpha / (PI * cos.powi(4) * spread * spread)
}

/// Smith's Λ.
fn lambda(alpha: f64, cos: f64) -> f64 {
    let tan2 = (1.0 - cos * cos) / (cos * cos);
    ((1.0 + alpha * alpha * tan2).sqrt() - 1.0) / 2.0
}

/// The BRDF of facets that reflect all light, for directions over the normal z.
fn brdf(alpha: f64, i: Vector, o: Vector) -> f64 {
    let half = unit([0, 1, 2].map(|k| i[k] + o[k]));
    let both = 1.0 / (1.0 + lambda(alpha, i[2]) + lambda(alpha, o[2]));
    distribution(alpha, half[2]) * both / (4.0 * i[2] * o[2])
}

/// A direction back to a ray's origin, given its cosine with z.
fn over(cos: f64, turn: f64) -> Vector {
    let sin = (1.0 - cos * cos).sqrt();
    [sin * turn.cos(), sin * turn.sin(), cos]
}

/// A sum over the visible facets of a surface, in cells of normals that are equal in the slopes' distribution. Returns
/// the sum of weights, and of weights times values.
fn over_visible(alpha: f64, i: Vector, value: impl Fn(Vector) -> f64) -> (f64, f64) {
    const CELLS: usize = 400;
    let masked = 1.0 / (1.0 + lambda(alpha, i[2]));
    let (mut whole, mut sum) = (0.0, 0.0);
    for ring in 0..CELLS {
        // D cos dω is spread evenly over a part from 0 to 1, of which this remains. The tail is long.
        let root = (ring as f64 + 0.5) / CELLS as f64;
        let (left, width) = (root.powi(4), 4.0 * root.powi(3));
        let tan2 = alpha * alpha * (1.0 - left) / left;
        let cos = 1.0 / (1.0 + tan2).sqrt();
        for step in 0..CELLS {
            let turn = (step as f64 + 0.5) / CELLS as f64 * 2.0 * PI;
            let m = over(cos, turn);
            let seen = width * dot(i, m).max(0.0) * masked / i[2] / cos;
            let seen = seen / (CELLS * CELLS) as f64;
            whole += seen;
            sum += seen * value(m);
        }
    }
    (whole, sum)
}

/// The part of light that facets reflect, by the BRDF over the hemisphere.
fn albedo(alpha: f64, cos: f64) -> f64 {
    let i = over(cos, 0.0);
    over_visible(alpha, i, |m| {
        let o = [0, 1, 2].map(|k| 2.0 * dot(i, m) * m[k] - i[k]);
        if o[2] <= 0.0 {
            return 0.0;
        }
        // The density of directions is that of facets over 4 i·m.
        let masked = 1.0 / (1.0 + lambda(alpha, i[2]));
        let density = masked * distribution(alpha, m[2]) / (4.0 * i[2]);
        brdf(alpha, i, o) * o[2] / density
    })
    .1
}

fn facets<N: Number>(roughness: f64, normal: Vector, i: Vector) -> Facets<N> {
    let cos = N::ratio_from_f64(dot(normal, i));
    Facets::new(q30(roughness), normal.map(N::ratio_from_f64), cos)
}

/// Points in the order in which one pixel draws them, 16 times with other scrambles.
fn each_scramble(samples: u16, mut visit: impl FnMut(usize, [u32; 2])) {
    for scramble in 0..16 {
        for sample in 0..samples {
            let sampler = Sampler::new([scramble, 3], sample);
            visit(usize::from(scramble), sampler.point(0, 0x1010));
        }
    }
}

/// Mean and standard error.
fn mean_of(sums: [f64; 16], samples: u16) -> (f64, f64) {
    let values = sums.map(|sum| sum / f64::from(samples));
    let mean = values.iter().sum::<f64>() / 16.0;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (mean, (squares / 240.0).sqrt())
}

#[test]
fn distribution_of_visible_normals_integrates_to_one() {
    for roughness in ROUGHNESSES {
        for cos in COSINES {
            let (whole, _) = over_visible(alpha(roughness), over(cos, 0.4), |_| 1.0);
            assert!((whole - 1.0).abs() < 2e-3, "{roughness} {cos}: {whole}");
        }
    }
}

/// The mean of drawn normals, across and along, and of their squares.
fn check_drawn<N: Number>() {
    const SAMPLES: u16 = 512;
    for roughness in ROUGHNESSES {
        for cos in COSINES {
            // A frame of its own.
            let normal = unit([0.3, -0.8, 0.5]);
            let beside = unit([0.8, 0.3, 0.0]);
            let sin = (1.0 - cos * cos).sqrt();
            let i = [0, 1, 2].map(|k| cos * normal[k] + sin * beside[k]);
            let facets = facets::<N>(roughness, normal, i);
            let direction = i.map(|x| N::ratio_from_f64(-x));
            let mut sums = [[0.0; 16]; 4];
            each_scramble(SAMPLES, |scramble, point| {
                let m = facets.draw(direction, point).map(N::ratio_to_f64);
                assert!((dot(m, m) - 1.0).abs() < 1e-5, "{m:?}");
                assert!(dot(m, i) > -1e-6 && dot(m, normal) > -1e-6, "{m:?}");
                let (up, aside) = (dot(m, normal), dot(m, beside));
                for (sum, value) in sums.iter_mut().zip([up, aside, up * up, aside * aside]) {
                    sum[scramble] += value;
                }
            });
            let values: [fn(Vector) -> f64; 4] =
                [|m| m[2], |m| m[0], |m| m[2] * m[2], |m| m[0] * m[0]];
            for (sums, value) in sums.into_iter().zip(values) {
                let (whole, exact) = over_visible(alpha(roughness), over(cos, 0.0), value);
                let exact = exact / whole;
                let (mean, error) = mean_of(sums, SAMPLES);
                assert!(
                    (mean - exact).abs() <= 3.5 * error + 4e-4,
                    "{:?} {roughness} {cos}: {mean} +- {error}, {exact}",
                    N::FORMAT
                );
            }
        }
    }
}

#[test]
fn drawn_normals_have_the_means_of_quadrature() {
    check_drawn::<Fixed>();
    check_drawn::<f32>();
    check_drawn::<f64>();
}

/// White facets under white light everywhere: no result is above 1, and the missing light is lost between facets.
fn check_furnace<N: Number>() {
    const SAMPLES: u16 = 512;
    for roughness in ROUGHNESSES {
        for cos in COSINES {
            let i = over(cos, 1.0);
            let facets = facets::<N>(roughness, [0.0, 0.0, 1.0], i);
            let mut sums = [0.0; 16];
            each_scramble(SAMPLES, |scramble, point| {
                let m = facets.draw(i.map(|x| N::ratio_from_f64(-x)), point);
                let m = m.map(N::ratio_to_f64);
                let up = 2.0 * dot(i, m) * m[2] - i[2];
                if up > 0.0 {
                    let left = facets.unmasked_reflection(N::ratio_from_f64(up));
                    let left = left.ratio_to_f64();
                    assert!((0.0..=1.0).contains(&left), "{left}");
                    sums[scramble] += left;
                }
            });
            let (mean, error) = mean_of(sums, SAMPLES);
            let exact = albedo(alpha(roughness), cos);
            assert!(mean <= 1.0 && exact <= 1.001);
            assert!(
                (mean - exact).abs() <= 3.5 * error + 1.5e-3,
                "{:?} {roughness} {cos}: {mean} +- {error}, {exact}",
                N::FORMAT
            );
        }
    }
}

#[test]
fn white_furnace_loses_what_bounces_between_facets() {
    // At a roughness of 1 seen from above, 1 - ln 2 remains.
    assert!((albedo(1.0, 1.0) - (1.0 - LN_2)).abs() < 1e-3);
    // Nearly nothing is lost at a mirror.
    assert!(albedo(alpha(0.05), 1.0) > 0.999);
    check_furnace::<Fixed>();
    check_furnace::<f32>();
    check_furnace::<f64>();
}

fn reflected<N: Number>(roughness: f64, i: Vector, o: Vector) -> f64 {
    let facets = facets::<N>(roughness, [0.0, 0.0, 1.0], i);
    let halfway = unit([0, 1, 2].map(|k| i[k] + o[k])).map(N::ratio_from_f64);
    let (ratio, power) = facets.reflect(N::ratio_from_f64(o[2]), halfway);
    ratio.ratio_to_f64() * f64::exp2(power.into())
}

/// Lights are reflected by π f cos, and f is the same both ways.
fn check_lights<N: Number>() {
    let most = if N::FORMAT == Format::F64 { 1e-9 } else { 2e-3 };
    for roughness in ROUGHNESSES {
        for cos_in in COSINES {
            for cos_out in COSINES {
                for turn in [PI, PI + 0.01, PI - 0.1, 2.0, 1.0, 0.0] {
                    let (i, o) = (over(cos_in, 0.0), over(cos_out, turn));
                    let f = brdf(alpha(roughness), i, o);
                    let exact = PI * f * o[2];
                    let found = reflected::<N>(roughness, i, o);
                    assert!(
                        (found - exact).abs() <= most * exact + 1e-6,
                        "{:?} {roughness} {cos_in} {cos_out} {turn}: {found} {exact}",
                        N::FORMAT
                    );
                    let back = reflected::<N>(roughness, o, i);
                    let (there, back) = (found / o[2], back / i[2]);
                    assert!(
                        (there - back).abs() <= 2.0 * most * there + 1e-6,
                        "{there} {back}"
                    );
                }
            }
        }
    }
}

#[test]
fn lights_are_reflected_by_the_formula_and_reciprocally() {
    check_lights::<Fixed>();
    check_lights::<f32>();
    check_lights::<f64>();
}

/// At the edges of their ranges numbers stay in range.
fn check_edges<N: Number>() {
    for alpha in [i32::MIN, 0, 1, LEAST_ROUGHNESS, 1 << 30, i32::MAX] {
        for cos in [-1.0, 0.0, 1e-9, 1e-4, 1.0] {
            let normal = [N::ZERO, N::ZERO, N::ONE];
            let facets = Facets::new(alpha, normal, N::ratio_from_f64(cos));
            for point in [[0, 0], [u32::MAX; 2], [0, u32::MAX], [1 << 31, 1 << 30]] {
                let m = facets.draw([N::ONE, N::ZERO, N::ZERO], point);
                assert!(m.iter().all(|x| x.ratio_to_f64().abs() < 1.001), "{m:?}");
            }
            for cos in [1e-9, 1e-4, 1.0] {
                let (ratio, power) = facets.reflect(N::ratio_from_f64(cos), normal);
                let ratio = ratio.ratio_to_f64();
                assert!((0.0..=1.0).contains(&ratio) && power <= 60);
                let left = facets.unmasked_reflection(N::ratio_from_f64(cos));
                assert!((0.0..=1.0).contains(&left.ratio_to_f64()));
            }
        }
    }
}

#[test]
fn edges_of_ranges_are_harmless() {
    check_edges::<Fixed>();
    check_edges::<f32>();
    check_edges::<f64>();
}
