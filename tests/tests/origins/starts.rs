//! Starts of rays in the numbers of each format, up to the farthest origin.

use super::{LIMIT, ball, exact_line};
use glam::DVec3;
use gridel_core::format::limits::FARTHEST;
use gridel_core::{Format, List, NoCount, Number, Pencil, Ray, RayError};
use gridel_host::shape::rounding::step;
use gridel_tests::effort::part_of;
use gridel_tests::every_format;
use gridel_tests::exact::{minus, vector};
use gridel_tests::query::closest;
use gridel_tests::random::Random;

/// The start of a ray whose numbers are those of its own format.
fn native_starts<N: Number>() {
    let blob = ball(DVec3::ZERO);
    let scene = blob.scene().expect("a scene");
    let mut random = Random(0x9a71);
    let mut worst = 0.0_f64;
    let mut within = 0;
    for number in 0..part_of(20_000, 2_000_000) {
        let distance = f64::powf(2.0, 17.0 + random.unit() * 19.9);
        let toward = random.direction();
        let target = [0; 3].map(|_| random.signed() * 3e4);
        // As the format has it.
        let native = |x: f64| N::far_from_f64(x);
        let origin = [0, 1, 2].map(|k| native(target[k] - distance * toward[k]));
        let from = origin.map(N::far_to_f64);
        let length = match (N::FORMAT, number % 4) {
            (_, 0) => 1.0,
            (Format::Fixed, exponent) => f64::powi(2.0, 3 * exponent as i32 - 6),
            (Format::F32, _) => f64::powi(10.0, random.within(-38, 24)) / distance * 1e5,
            (Format::F64, _) => f64::powi(10.0, random.within(-300, 290)),
        };
        let direction = [0, 1, 2].map(|k| native((target[k] - from[k]) * length));
        let given = direction.map(N::far_to_f64);
        // A pencil's rays have no end.
        let (zero, end) = (N::Wide::default(), N::far(i64::MAX));
        let ray = Ray::<N>::new(scene.bounds(), origin, direction, zero, end).expect("a ray");
        let pencil = Pencil::<N>::new(scene.bounds(), origin).expect("a pencil");
        let shared = pencil.ray(direction).expect("a ray");
        assert_eq!(format!("{ray:?}"), format!("{shared:?}"));
        let [tmin, tmax] = ray.interval();
        if tmax < tmin {
            continue;
        }
        within += 1;
        let major = ray.major_axis();
        let start = ray.start().map(N::length_to_f64);
        let (line, moved) = exact_line(from, given, major, start[major]);
        let apart = minus(&vector(start), &line.origin);
        let apart = apart
            .iter()
            .fold(0.0_f64, |most, x| most.max(x.abs().to_f64()));
        let steps = apart / step(N::FORMAT, 32_768.0);
        // For a ray from near by, the way to the box is rounded with its slope.
        let is_far = N::far_to_f64(ray.start_t()) > 3.0 * 32_767.0;
        let most = if is_far { 2.0 } else { 5.0 };
        assert!(
            steps <= most,
            "{from:?} {given:?}: {start:?}, off by {steps}"
        );
        if is_far {
            worst = worst.max(steps);
        }
        let (t, exact) = (N::far_to_f64(ray.start_t()), moved.to_f64());
        assert!((t - exact).abs() <= step(N::FORMAT, exact), "{t} {exact}");
    }
    assert!(within > 10_000, "{within}");
    eprintln!(
        "{}: starts are off by {worst} steps at worst",
        N::FORMAT.name()
    );
}

#[test]
fn starts_are_right_in_the_rays_own_format() {
    every_format!(native_starts());
}

/// At the limit and one step beyond it, on every axis.
fn limits<N: Number>() {
    let blob = ball(DVec3::ZERO);
    let scene = blob.scene().expect("a scene");
    let most = N::far(FARTHEST);
    let beyond = match N::FORMAT {
        Format::Fixed => N::far(FARTHEST + 1),
        Format::F32 => N::far_from_f64(f64::from((LIMIT as f32).next_up())),
        Format::F64 => N::far_from_f64(LIMIT.next_up()),
    };
    let zero = N::Wide::default();
    let extremes = [N::far(i64::MAX), N::far(i64::MIN + 1), N::far(i64::MIN)];
    for axis in 0..3 {
        let make = |x: N::Wide, forward: bool| {
            let (mut origin, mut direction) = ([zero; 3], [zero; 3]);
            origin[axis] = x;
            direction[axis] = N::far(if forward { 1 << 13 } else { -1 << 13 });
            let ray = Ray::<N>::new(scene.bounds(), origin, direction, zero, N::far(1 << 60));
            let pencil = Pencil::<N>::new(scene.bounds(), origin);
            assert_eq!(ray.as_ref().err(), pencil.as_ref().err());
            ray
        };
        for forward in [true, false] {
            let farthest = if forward { -most } else { most };
            let ray = make(farthest, forward).expect("a ray");
            let hit = closest::<N, List>(&scene, &ray, &mut NoCount).expect("a hit");
            let radius = f64::powi(2.0, -i32::from(scene.header().unit_exponent));
            let off = N::far_to_f64(hit.t) - (LIMIT - radius);
            assert!(off.abs() <= 8.0 * step(N::FORMAT, LIMIT), "{hit:?}");
            assert!(make(-farthest, forward).is_ok());
            let mut wrong = vec![beyond, -beyond];
            wrong.extend(extremes);
            for x in wrong {
                assert_eq!(make(x, forward).err(), Some(RayError::Distance));
            }
        }
    }
    // However long an interval is.
    for tmin in extremes.into_iter().chain([zero]) {
        for tmax in extremes.into_iter().chain([zero]) {
            for x in [-most, most, zero, N::far(5 << 28)] {
                let (origin, direction) = ([zero, zero, x], [zero, zero, N::far(1)]);
                let ray = Ray::<N>::new(scene.bounds(), origin, direction, tmin, tmax);
                let Ok(ray) = ray else {
                    assert!(tmin > tmax);
                    continue;
                };
                let hit = closest::<N, List>(&scene, &ray, &mut NoCount);
                let (backward, forward) = (tmin < zero, tmax > zero);
                // The ball lies ahead, around the origin, or behind.
                let expected = if x < zero {
                    tmin <= zero && forward
                } else if x == zero {
                    tmin <= zero && forward || backward && tmax == zero
                } else {
                    backward && tmax >= zero
                };
                assert_eq!(hit.is_some(), expected, "{tmin:?} {tmax:?} {x:?}");
            }
        }
    }
}

#[test]
fn origins_beyond_the_limit_are_rejected() {
    every_format!(limits());
}
