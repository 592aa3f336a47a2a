//! Answers in scene units, of every structure and format.

use super::{LIMIT, ball};
use glam::DVec3;
use gridel_core::{Format, RayError, Scene, Structure};
use gridel_host::scene::Shape;
use gridel_host::shape::Sphere;
use gridel_host::shape::rounding::step;
use gridel_host::trace::{Query, Rejection, SceneHit, SceneRay, trace};
use gridel_tests::query::held;
use gridel_tests::scenes;

/// Every structure's answers to a ray in scene units, in every format; all must be the same.
fn answers(scene: &Scene<'_>, ray: SceneRay) -> [(Format, SceneHit, Option<Rejection>); 3] {
    Format::ALL.map(|format| {
        let ask = |structure: Structure, any: bool| {
            let (mut hits, query) = (
                [SceneHit::MISS],
                Query {
                    format,
                    structure,
                    any,
                },
            );
            let rejections = trace(scene, &[ray], query, &mut hits).expect("a structure");
            assert_eq!(rejections.count, usize::from(hits[0].is_rejected()));
            (hits[0], rejections.first.map(|(_, why)| why))
        };
        let (hit, why) = ask(Structure::List, false);
        for structure in held(scene) {
            let (other, other_why) = ask(structure, false);
            let same = other == hit || other.is_rejected() && hit.is_rejected();
            assert!(
                same && why == other_why,
                "{} {structure:?} {ray:?}",
                format.name()
            );
            let (any, any_why) = ask(structure, true);
            // A query for any hit returns no t that could leave its range.
            if !matches!(
                any_why.or(why),
                Some(Rejection::TooShort | Rejection::TooLong)
            ) {
                assert_eq!(any_why, why);
                assert_eq!(any.object == 0, hit.object == 0, "{structure:?} {ray:?}");
            }
        }
        (format, hit, why)
    })
}

pub(super) fn endless(origin: DVec3, direction: DVec3) -> SceneRay {
    let (tmin, tmax) = (0.0, f64::INFINITY);
    SceneRay {
        origin,
        tmin,
        direction,
        tmax,
    }
}

/// The error bound of t: its own rounding, and the ball's.
fn slack(format: Format, t: f64, unit: f64) -> f64 {
    let rounding = match format {
        Format::Fixed => 0.0,
        Format::F32 => f64::powi(2.0, -23),
        Format::F64 => f64::powi(2.0, -52),
    };
    t * rounding.max(f64::powi(2.0, -52)) + 8.0 * step(format, 65_536.0) * unit
}

/// Issue 16: from 1e11 `fixed` answered t 6.87e10, from 1e20 a negative one; `f32` infinity, of an object.
#[test]
fn origins_at_every_power_of_ten_are_answered_or_rejected() {
    let blob = ball(DVec3::ZERO);
    let scene = blob.scene().expect("a scene");
    let unit = f64::powi(2.0, scene.header().unit_exponent.into());
    let (mut answered, mut rejected) = (0, 0);
    for k in 1..=300 {
        for axis in 0..3 {
            for sign in [1.0, -1.0] {
                let away = f64::powi(10.0, k) * sign;
                let axis = DVec3::AXES[axis];
                for (format, hit, why) in answers(&scene, endless(axis * away, -axis * sign)) {
                    let t = away.abs() - 1.0;
                    if away.abs() > LIMIT * unit {
                        assert_eq!(why, Some(RayError::Distance.into()), "1e{k}");
                        rejected += 1;
                    } else {
                        let off = (hit.t - t).abs();
                        assert!(off <= slack(format, t, unit), "{format:?} 1e{k}: {hit:?}");
                        assert_eq!(
                            (hit.object, hit.normal),
                            (0, (axis * sign).as_vec3().into())
                        );
                        answered += 1;
                    }
                }
                // Away from the ball, and past it by far.
                let sideways = DVec3::new(axis.y, axis.z, axis.x) * away;
                for ray in [endless(axis * away, axis * sign), endless(sideways, axis)] {
                    for (_, hit, why) in answers(&scene, ray) {
                        assert!(hit == SceneHit::MISS || why == Some(RayError::Distance.into()));
                    }
                }
            }
        }
    }
    // From 2^20 times the ball's width, and from no nearer than promised.
    assert!(LIMIT * unit >= 2.0 * f64::powi(2.0, 20));
    assert!(
        answered >= 6 * 3 * 6 && rejected >= 6 * 3 * 290,
        "{answered} {rejected}"
    );
}

#[test]
fn directions_of_every_length_are_answered_or_leave_the_range_of_t() {
    let blob = ball(DVec3::new(0.25, -0.5, 0.0));
    let scene = blob.scene().expect("a scene");
    let unit = f64::powi(2.0, scene.header().unit_exponent.into());
    let mut rejected = 0;
    let powers = (-323..=307).map(|k| format!("1e{k}").parse().expect("a number"));
    let ends = [5e-324, 1e-323, f64::MIN_POSITIVE, 1.7e308, f64::MAX, 2.0];
    for length in powers.chain(ends) {
        let length: f64 = length;
        for origin in [3.0, 1000.0] {
            let ray = endless(
                DVec3::new(0.25, -0.5, origin),
                DVec3::new(0.0, 0.0, -length),
            );
            // 1 from the middle; exact.
            let (distance, t) = (origin - 1.0, (origin - 1.0) / length);
            for (format, hit, why) in answers(&scene, ray) {
                if t > f64::MAX {
                    assert_eq!(why, Some(Rejection::TooShort), "{length:e}");
                    rejected += 1;
                    continue;
                }
                let off = hit.t * length - distance;
                let denormal = f64::powi(2.0, -1074) * length;
                let bound = slack(format, distance, unit) + denormal;
                assert!(off.abs() <= bound, "{format:?} {length:e}: {hit:?}");
                assert_eq!((hit.object, hit.normal), (0, [0.0, 0.0, 1.0]));
            }
        }
    }
    assert!(rejected > 3 * 2 * 10, "{rejected}");
    // Slanted, so that a short direction has few digits in any component.
    for (direction, met) in [
        ([5e-324, 0.0, -5e-324], false),
        ([0.0, 0.0, -5e-324], true),
        ([5e-324, -1e-323, -1.6e-322], true),
        ([1.7e308, 0.0, -1.7e308], false),
        ([1e307, -2e307, -1.7e308], true),
    ] {
        let ray = endless(DVec3::new(0.0, 0.0, 4.0), DVec3::from_array(direction));
        for (format, hit, why) in answers(&scene, ray) {
            let answer = if met {
                hit != SceneHit::MISS
            } else {
                hit == SceneHit::MISS
            };
            assert!(answer, "{format:?} {direction:?}: {hit:?} {why:?}");
        }
    }
}

/// In a scene so small that t in multiples of the longest directions has few digits.
#[test]
fn t_with_too_few_digits_is_rejected() {
    let (center, radius) = (DVec3::ZERO, 1e-200);
    let blob = scenes::compact_blob(&scenes::of([Shape::Sphere(Sphere { center, radius })]), 16);
    let scene = blob.scene().expect("a scene");
    for (length, why) in [
        (1e-200, None),
        (1.0, None),
        (1e100, None),
        (1e123, Some(Rejection::TooLong)),
        (1e307, Some(Rejection::TooLong)),
    ] {
        let ray = endless(DVec3::Z * 4e-200, DVec3::NEG_Z * length);
        for (format, hit, found) in answers(&scene, ray) {
            assert_eq!(found, why, "{length:e}");
            if why.is_none() {
                let off = hit.t * length / 3e-200 - 1.0;
                assert!(off.abs() < 1e-4, "{format:?} {length:e}: {hit:?}");
            }
        }
    }
}
