//! Directions of every sort, at the poles and at the edge of the cap, compared with their definition in double precision.

use super::*;
use crate::number::Fixed;

type Vector = [f64; 3];

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// A direction by its z and its angle around the axis.
fn at(z: f64, angle: f64) -> Vector {
    let away = (1.0 - z * z).max(0.0).sqrt();
    [away * angle.cos(), away * angle.sin(), z]
}

/// The directions around one, which is rounded to the number format.
fn around<N: Number>(direction: Vector) -> [Vector; 3] {
    let rounded = direction.map(|x| N::ratio((x * f64::from(1 << 30)).round() as i32));
    let [first, second] = perpendicular(rounded);
    [first, second, rounded].map(|it| it.map(N::ratio_to_f64))
}

/// The z from pole to pole, and both sides of the edge of the cap.
fn heights() -> impl Iterator<Item = f64> {
    let edge = f64::from(CAP) / f64::from(1 << 30);
    let all = (-64..=64).map(|step| f64::from(step) / 64.0);
    all.chain([
        edge - 1e-6,
        edge,
        edge + 1e-6,
        -1.0 + 1e-9,
        1.0 - 1e-9,
        1e-9,
        -1e-9,
    ])
}

fn are_perpendicular<N: Number>(rounding: f64) {
    // With h = 1 + z, at least 2^-8: the square of a length is off by 2 / h times that of the direction, which three
    // roundings change by √3 of one, and by 2 / h times the rounding of the products, their halves and the quotients.
    let most = 2.0 * 256.0 * (3_f64.sqrt() + 2.0) * rounding;
    for z in heights() {
        for step in 0..32 {
            let [first, second, direction] = around::<N>(at(z, f64::from(step) * 0.2));
            for (a, b, expected) in [
                (first, first, 1.0),
                (second, second, 1.0),
                (first, second, 0.0),
                (first, direction, 0.0),
                (second, direction, 0.0),
            ] {
                let found = dot(a, b);
                assert!((found - expected).abs() <= most, "{direction:?}: {found}");
            }
            let [x, y, z] = [0, 1, 2].map(|k| {
                let (k, l) = ((k + 1) % 3, (k + 2) % 3);
                first[k] * second[l] - first[l] * second[k]
            });
            assert!(dot([x, y, z], direction) > 0.0, "{direction:?}");
        }
    }
}

#[test]
fn directions_are_perpendicular_and_right_handed() {
    are_perpendicular::<Fixed>(f64::powi(2.0, -30));
    are_perpendicular::<f32>(f64::powi(2.0, -24));
    are_perpendicular::<f64>(f64::powi(2.0, -30));
}

/// Nearby directions have nearby ones around them.
#[test]
fn directions_turn_steadily_outside_of_the_cap() {
    const STEP: f64 = 1e-4;
    let edge = f64::from(CAP) / f64::from(1 << 30);
    for z in heights().filter(|z| *z > edge + STEP && *z < 1.0 - STEP) {
        for step in 0..32 {
            let angle = f64::from(step) * 0.2;
            let here = around::<f64>(at(z, angle));
            for near in [at(z - STEP, angle), at(z, angle + STEP)] {
                for (a, b) in here.into_iter().zip(around::<f64>(near)) {
                    let moved = [0, 1, 2].map(|k| a[k] - b[k]);
                    // At the edge of the cap, once around turns them twice.
                    let most = 40.0 * STEP;
                    assert!(dot(moved, moved).sqrt() < most, "{z} {angle}: {moved:?}");
                }
            }
        }
    }
}
