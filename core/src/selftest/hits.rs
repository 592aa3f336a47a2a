//! Every shape is hit where geometry says.

use crate::accel::Number;
use crate::accel::list::List;
use crate::observe::count::NoCount;
use crate::selftest::checks::{Checks, name};
use crate::selftest::scene::TinyBlob;
use crate::{Hit, Ray, Scene, Stack, any_hit, closest_hit};

/// The expected hit of one ray.
struct Expected {
    what: &'static str,
    origin: [f64; 3],
    direction: [f64; 3],
    interval: [f64; 2],
    /// Object, t, normal, front; `None` for a miss.
    hit: Option<(u32, f64, [f64; 3], bool)>,
}

const ENDLESS: [f64; 2] = [0.0, f64::INFINITY];

/// The cone falls by 40 units over a radius of 20: its normal is (2, 1) / sqrt(5).
const CONE: [f64; 3] = [0.894_427_190_999_915_9, 0.447_213_595_499_957_9, 0.0];

const RAYS: [Expected; 15] = [
    Expected {
        what: "torus from its middle",
        origin: [0.0, -80.0, 0.0],
        direction: [1.0, 0.0, 0.0],
        interval: ENDLESS,
        hit: Some((5, 25.0, [-1.0, 0.0, 0.0], true)),
    },
    Expected {
        what: "torus from within its tube",
        origin: [0.0, -80.0, -30.0],
        direction: [0.0, 2.0, 0.0],
        interval: ENDLESS,
        hit: Some((5, 5.0, [0.0, 1.0, 0.0], false)),
    },
    Expected {
        what: "triangle from its front",
        origin: [-40.0, -5.0, 200.0],
        direction: [0.0, 0.0, -1.0],
        interval: ENDLESS,
        hit: Some((0, 210.0, [0.0, 0.0, 1.0], true)),
    },
    Expected {
        what: "triangle from its back, through a corner",
        origin: [-60.0, -20.0, -1e6],
        direction: [0.0, 0.0, 0.25],
        interval: ENDLESS,
        hit: Some((0, 999_990.0, [0.0, 0.0, 1.0], false)),
    },
    Expected {
        what: "sphere at its pole",
        origin: [30.0, 30.0, 200.0],
        direction: [0.0, 0.0, -7.0],
        interval: ENDLESS,
        hit: Some((1, 175.0, [0.0, 0.0, 1.0], true)),
    },
    Expected {
        what: "sphere off its pole",
        origin: [45.0, 30.0, 200.0],
        direction: [0.0, 0.0, -1.0],
        interval: ENDLESS,
        hit: Some((1, 180.0, [0.6, 0.0, 0.8], true)),
    },
    Expected {
        what: "sphere from within",
        origin: [30.0, 30.0, 0.0],
        direction: [1.0, 0.0, 0.0],
        interval: ENDLESS,
        hit: Some((1, 25.0, [1.0, 0.0, 0.0], false)),
    },
    Expected {
        what: "sphere's far side, the near one lying before tmin",
        origin: [30.0, 30.0, 200.0],
        direction: [0.0, 0.0, -1.0],
        interval: [180.0, 300.0],
        hit: Some((1, 225.0, [0.0, 0.0, -1.0], false)),
    },
    Expected {
        what: "sphere beyond tmax",
        origin: [30.0, 30.0, 200.0],
        direction: [0.0, 0.0, -1.0],
        interval: [0.0, 174.0],
        hit: None,
    },
    Expected {
        what: "box from above",
        origin: [80.0, 200.0, 40.0],
        direction: [0.0, -1.0, 0.0],
        interval: ENDLESS,
        hit: Some((2, 270.0, [0.0, 1.0, 0.0], true)),
    },
    Expected {
        what: "disc from above",
        origin: [-45.0, 200.0, 25.0],
        direction: [0.0, -1.0, 0.0],
        interval: ENDLESS,
        hit: Some((3, 140.0, [0.0, 1.0, 0.0], true)),
    },
    Expected {
        what: "disc from below",
        origin: [-45.0, -60.0, 25.0],
        direction: [0.0, 1.0, 0.0],
        interval: ENDLESS,
        hit: Some((3, 120.0, [0.0, 1.0, 0.0], false)),
    },
    Expected {
        what: "cone at a quarter of its height",
        origin: [200.0, -50.0, 20.0],
        direction: [-1.0, 0.0, 0.0],
        interval: ENDLESS,
        hit: Some((4, 145.0, CONE, true)),
    },
    Expected {
        what: "cone's base",
        origin: [45.0, -65.0, 25.0],
        direction: [0.0, 1.0, 0.0],
        interval: ENDLESS,
        hit: Some((4, 5.0, [0.0, -1.0, 0.0], true)),
    },
    Expected {
        what: "nothing, away from all",
        origin: [200.0, 200.0, 200.0],
        direction: [1.0, 0.5, -0.25],
        interval: ENDLESS,
        hit: None,
    },
];

/// Tolerance of lengths, which is more than any format's error bound here.
const LENGTH: f64 = 1.0 / 512.0;
/// Tolerance of normals.
const RATIO: f64 = 1.0 / 65_536.0;

pub(super) fn every_shape<N: Number>(checks: &mut Checks<'_>) {
    let blob = TinyBlob::new();
    let Ok(scene) = Scene::from_bytes(blob.bytes()) else {
        return checks.equal(format_args!("the blob"), "rejected", "read");
    };
    let mut stack = Stack::<0>::new();
    for ray in &RAYS {
        let [tmin, tmax] = ray.interval;
        let traced = Ray::<N>::from_f64(scene.bounds(), ray.origin, ray.direction, tmin, tmax);
        let Ok(traced) = traced else {
            checks.equal(format_args!("ray to the {}", ray.what), "rejected", "made");
            continue;
        };
        let (stack, count) = (stack.as_view(), &mut NoCount);
        let any = any_hit::<N, List, _>(&scene, &traced, stack, count);
        checks.equal(
            format_args!("any hit: {}", ray.what),
            any,
            ray.hit.is_some(),
        );
        let found = closest_hit::<N, List, _>(&scene, &traced, stack, count);
        compare(checks, ray, found);
    }
    let none = [0.0; 3];
    let rejected = Ray::<N>::from_f64(scene.bounds(), none, none, 0.0, 1.0).is_err();
    checks.equal(
        format_args!("a ray without direction is rejected"),
        rejected,
        true,
    );
}

fn compare<N: Number>(checks: &mut Checks<'_>, ray: &Expected, found: Option<Hit<N>>) {
    let what = ray.what;
    let (found, (object, t, normal, front)) = match (found, ray.hit) {
        (Some(found), Some(expected)) => (found, expected),
        (found, expected) => {
            let found = found.map(|hit| hit.object);
            return checks.equal(
                format_args!("object: {what}"),
                found,
                expected.map(|hit| hit.0),
            );
        }
    };
    checks.equal(format_args!("object: {what}"), found.object, object);
    checks.equal(format_args!("front: {what}"), found.front, front);
    // A far t has no more than the 24 binary digits of `f32`, so rounding moves it by half of the
    // last. The point must still be right.
    let tolerance = LENGTH.max(t / 16_777_216.0);
    checks.near(
        format_args!("t in {}: {what}", name::<N>()),
        N::far_to_f64(found.t),
        t,
        tolerance,
    );
    for (axis, &expected) in normal.iter().enumerate() {
        let largest = ray
            .direction
            .iter()
            .fold(0.0, |most, d: &f64| d.abs().max(most));
        checks.near(
            format_args!("point on axis {axis}: {what}"),
            found.point[axis].length_to_f64(),
            ray.origin[axis] + t * ray.direction[axis] / largest,
            LENGTH,
        );
        checks.near(
            format_args!("normal on axis {axis}: {what}"),
            found.normal[axis].ratio_to_f64(),
            expected,
            RATIO,
        );
    }
    let bound = found.error.length_to_f64();
    checks.that(
        format_args!("error bound: {what}"),
        bound > 0.0 && bound <= LENGTH,
        format_args!("is {bound}"),
    );
}
