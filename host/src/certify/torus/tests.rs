//! Every crossing of a line with a torus lies in an enclosed one, by the roots of 320 bits that `verify` finds.

use super::*;
use crate::certify::crossing::Start;
use crate::certify::deep::{self, Ball};
use crate::certify::interval::Interval;
use crate::random::Random;
use crate::shape::Solid;
use crate::shape::exact::{Line, Real};
use gridel_core::geometry::Geometry;
use gridel_core::geometry::torus::Torus as Record;

fn within(random: &mut Random, most: i64) -> i64 {
    random.within(-most as i32, most as i32).into()
}

fn vector(random: &mut Random, most: i64) -> [i64; 3] {
    [0; 3].map(|_| within(random, most))
}

fn record(center: [i64; 3], axis: [i64; 3], [major, minor]: [i64; 2]) -> Record {
    Record {
        center: center.map(|x| x as i32),
        axis: axis.map(|x| x as i32),
        major_radius: major as i32,
        minor_radius: minor as i32,
        ..bytemuck::Zeroable::zeroed()
    }
}

/// The crossings in exact arithmetic: t, and whether the ray leaves there.
fn truth(torus: Record, origin: [i64; 3], direction: [i64; 3]) -> Vec<(Real, bool)> {
    // The records count 1/256 unit.
    let unit = |v: [i64; 3]| v.map(|x| Real::of(x as f64 / 256.0));
    let line = Line {
        origin: unit(origin),
        slope: unit(direction),
    };
    let spans = Solid::of(Geometry::Torus(torus)).spans(&line, &Real::of(0.0));
    let both = spans
        .into_iter()
        .flat_map(|(enter, leave)| [(enter, false), (leave, true)]);
    both.filter(|(t, _)| t.is_positive()).collect()
}

/// Compares the crossings of a ray, and says how many there are and how many of them are sure.
fn check<N: Enclosure + std::fmt::Debug>(
    torus: &Torus,
    ray: &Ray<N>,
    truth: &[(Real, bool)],
    skipped: usize,
) -> usize {
    let mut found = Vec::new();
    let is_itself = ray.start != Start::Free;
    if crossings(torus, is_itself, ray, &mut found).is_err() {
        return 0;
    }
    let holds = |it: &Crossing<N>, (t, leaves): &(Real, bool)| {
        let [low, high] = it.t.bounds();
        it.leaves == *leaves && Real::of(low) <= *t && *t <= Real::of(high)
    };
    for crossing in &truth[skipped..] {
        assert!(
            found.iter().any(|it| holds(it, crossing)),
            "{torus:?} {ray:?}: {:?} is not among {found:?}",
            crossing.0.to_f64()
        );
    }
    for crossing in found.iter().filter(|it| it.sure) {
        let count = truth[skipped..].iter().filter(|it| holds(crossing, it));
        assert_eq!(count.count(), 1, "{torus:?} {ray:?}: {crossing:?}");
    }
    found.iter().filter(|it| it.sure).count()
}

fn free<N: Enclosure>(origin: [i64; 3], direction: [i64; 3]) -> Ray<N> {
    Ray {
        origin: exact(origin),
        direction: exact(direction),
        start: Start::Free,
    }
}

#[test]
fn crossings_hold_those_of_320_bits() {
    let mut random = Random(7);
    let (mut all, mut sure, mut deep_sure) = (0, 0, 0);
    for number in 0..3_000_usize {
        // Rings, hairs, horns and spindles, near and far.
        let radii = [[1000, 300], [5000, 20], [400, 400], [300, 900], [2, 800]][number % 5];
        let center = vector(&mut random, [0, 1 << 10, 1 << 22][number % 3]);
        let axis = match number % 4 {
            0 => [0, 1, 0],
            _ => vector(&mut random, 1 << [3, 24, 14][number % 3]),
        };
        if axis == [0; 3] {
            continue;
        }
        let recorded = record(center, axis, radii);
        let torus = Torus {
            center,
            axis,
            major: radii[0],
            minor: radii[1],
        };
        // Towards some point in or next to the solid.
        let reach = radii[0] + radii[1];
        let origin = [0, 1, 2].map(|k| center[k] + within(&mut random, 3 * reach));
        let target = [0, 1, 2].map(|k| center[k] + within(&mut random, reach));
        let direction = [0, 1, 2].map(|k| target[k] - origin[k]);
        let exact = truth(recorded, origin, direction);
        all += exact.len();
        sure += check(&torus, &free::<Interval>(origin, direction), &exact, 0);
        deep_sure += deep::with_bits(128, || {
            check(&torus, &free::<Ball>(origin, direction), &exact, 0)
        });
    }
    assert!(all > 2_000, "{all} crossings");
    assert!(sure * 1000 >= all * 995, "{sure} of {all} are sure");
    assert!(deep_sure * 1000 >= all * 999, "{deep_sure} of {all} are");
}

/// The rays start at points exactly on the surface: 3-4-5 triangles give some with integer coordinates.
#[test]
fn rays_from_the_surface_do_not_meet_it_where_they_start() {
    let (center, axis, [major, minor]) = ([0; 3], [0, 0, 1], [1000, 250]);
    let recorded = record(center, axis, [major, minor]);
    let torus = Torus {
        center,
        axis,
        major,
        minor,
    };
    // Outward by 150 from the circle and up by 200.
    let origin = [690, 920, 200];
    let mut random = Random(3);
    let (mut all, mut sure) = (0, 0);
    for _ in 0..500 {
        let direction = vector(&mut random, 1000);
        // Level rays start on both sides.
        if 9 * direction[0] + 12 * direction[1] + 20 * direction[2] == 0 {
            continue;
        }
        let exact: Vec<_> = truth(recorded, origin, direction)
            .into_iter()
            .filter(|(t, _)| *t > Real::of(1e-30))
            .collect();
        let start = Start::On {
            instance: u32::MAX,
            twin: 0,
            part: 0,
            surface: u32::MAX,
            also: [u32::MAX; 2],
            inward: false,
        };
        let from = Ray {
            start,
            ..free::<Interval>(origin, direction)
        };
        all += exact.len();
        sure += check(&torus, &from, &exact, 0);
    }
    assert!(all > 200 && sure * 100 >= all * 99, "{sure} of {all}");
}

/// Touching is open with any number of bits, and is said to be.
#[test]
fn rays_that_touch_a_torus_are_open() {
    let torus = Torus {
        center: [0; 3],
        axis: [0, 0, 1],
        major: 1000,
        minor: 250,
    };
    let ray = free::<Interval>([-3000, 1000, 250], [1, 0, 0]);
    let mut found = Vec::new();
    if crossings(&torus, false, &ray, &mut found).is_ok() {
        assert!(found.iter().all(|it| !it.sure), "{found:?}");
        assert!(!found.is_empty());
        for crossing in &found {
            assert!(crossing.t.low <= 3000.0 && 3000.0 <= crossing.t.high);
        }
    }
    // Beside it by one lattice step nothing is open.
    let ray = free::<Interval>([-3000, 1000, 251], [1, 0, 0]);
    let mut found = Vec::new();
    assert!(crossings(&torus, false, &ray, &mut found).is_ok());
    assert!(found.is_empty(), "{found:?}");
}
