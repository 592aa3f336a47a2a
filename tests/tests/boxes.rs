//! Boxes and traversal (hard cases A). A box that a ray meets is never skipped, and the form of a
//! tree does not change an answer. That structures agree ray by ray is in `structures`.

use glam::DVec3;
use gridel_core::format::record::UnitBox;
use gridel_core::shared::{Culling, PairCulling};
use gridel_core::{Kind, NoCount, Number, Ray, Scene, Structure};
use gridel_host::compile::{Options, compile};
use gridel_host::scene::Shape;
use gridel_host::shape::{Cone, Cuboid, Disc, Sphere};
use gridel_tests::cases::slope;
use gridel_tests::effort::{part_of, sixth_of};
use gridel_tests::exact_box::{ExactRay, SLOPE_BITS};
use gridel_tests::query::{HitBits, UnitRay, closest, held, through};
use gridel_tests::random::Random;
use gridel_tests::{every_format, rays, scenes};
use rayon::prelude::*;

const WORLD: UnitBox = UnitBox([[-32_767, 32_767]; 3]);

/// A box and a ray at it, both exact.
struct Case {
    bounds: UnitBox,
    /// In 2^-8 units.
    origin: [i64; 3],
    direction: [f64; 3],
    /// The direction in 2^-96, its largest magnitude 1.
    slope: [i128; 3],
    tmax: i64,
}

/// Beyond every scene, in 2^-8 units.
const ENDLESS: i64 = 1 << 26;

/// A name, and what makes cases.
type Sort = (&'static str, fn(&mut Random) -> Case);

/// Sorts of rays, with the hard cases that they are.
const SORTS: [Sort; 9] = [
    ("A1 in a face", |random| in_planes(random, 1)),
    ("A1 along an edge", |random| in_planes(random, 2)),
    ("A4 directions below every normal number", |random| {
        let mut case = in_planes(random, 2);
        // Down to the smallest number that there is: on the lattice's scale all are one.
        let tiny = [5e-324, 1e-310, 1e-45, 1e-40][random.below(4)];
        for axis in 0..3 {
            if case.slope[axis] == 0 {
                let sign = if random.one_in(2) { 1.0 } else { -1.0 };
                case.direction[axis] = sign * tiny;
                case.slope[axis] = sign as i128;
            }
        }
        case
    }),
    ("A3 slopes about the limit of 2^-12", |random| {
        let mut case = at_the_box(random);
        let major = random.below(3);
        for axis in 0..3 {
            let steps = match random.below(3) {
                0 => random.within(2040, 2056),
                1 => random.within(0, 40),
                _ => 2048,
            };
            let steps = if axis == major { 1 << 23 } else { steps };
            let sign = if random.one_in(2) { 1 } else { -1 };
            case.direction[axis] = f64::from(sign * steps) / f64::from(1 << 23);
        }
        aimed(random, case)
    }),
    ("A6 origin inside, on faces, on corners", |random| {
        let mut case = at_the_box(random);
        case.origin = place_in(random, &case.bounds);
        case
    }),
    ("A7 without height, without area, a point", |random| {
        let mut case = at_the_box(random);
        for axis in 0..3 {
            if random.one_in(2) {
                case.bounds.0[axis][1] = case.bounds.0[axis][0];
            }
        }
        aimed(random, case)
    }),
    ("A9 ends exactly where the box begins", |random| {
        let mut case = in_planes(random, 0);
        // Along an axis the way to the box is exact.
        let major = (0..3).find(|&k| case.slope[k] != 0).unwrap_or(0);
        let [low, high] = case.bounds.0[major].map(|plane| i64::from(plane) << 8);
        let way = if case.slope[major] > 0 {
            low - case.origin[major]
        } else {
            case.origin[major] - high
        };
        case.tmax = way.max(0);
        case
    }),
    ("through corners and edges", |random| {
        let case = at_the_box(random);
        aimed(random, case)
    }),
    ("anywhere", at_the_box),
];

fn a_box(random: &mut Random) -> UnitBox {
    let size = [10, 1000, 32_000][random.below(3)];
    UnitBox([0; 3].map(|_| {
        let (a, b) = (random.within(-size, size), random.within(-size, size));
        [a.min(b) as i16, a.max(b) as i16]
    }))
}

/// A place in the closed box, often on its faces, edges and corners.
fn place_in(random: &mut Random, bounds: &UnitBox) -> [i64; 3] {
    bounds.0.map(|[low, high]| match random.below(3) {
        0 => i64::from(low) << 8,
        1 => i64::from(high) << 8,
        _ => i64::from(random.within(i32::from(low) << 8, i32::from(high) << 8)),
    })
}

fn exact(direction: [f64; 3]) -> [i128; 3] {
    direction.map(|x| ((x * f64::from(1 << 23)) as i128) << (SLOPE_BITS - 23))
}

/// A ray from somewhere at somewhere in the box.
fn at_the_box(random: &mut Random) -> Case {
    let bounds = a_box(random);
    let target = place_in(random, &bounds);
    let origin = [0; 3].map(|_| i64::from(random.within(-8_388_000, 8_388_000)));
    let way = DVec3::from_array([0, 1, 2].map(|k| (target[k] - origin[k]) as f64));
    let direction = slope(if way == DVec3::ZERO { DVec3::X } else { way });
    Case {
        bounds,
        origin,
        direction,
        slope: exact(direction),
        tmax: ENDLESS,
    }
}

/// The case with its origin where the ray passes exactly through a place of the box that matters.
fn aimed(random: &mut Random, mut case: Case) -> Case {
    case.slope = exact(case.direction);
    let target = place_in(random, &case.bounds);
    // Back by a whole number of steps along the slope's 23 bits, so that the origin is exact.
    let back = i64::from(random.within(0, 2)) << 23;
    case.origin = [0, 1, 2].map(|axis| {
        let steps = (case.slope[axis] >> (SLOPE_BITS - 23)) as i64;
        target[axis] - ((steps * back) >> 23)
    });
    case
}

/// A ray along an axis (or, with one plane only, along a face), in as many planes of the box.
fn in_planes(random: &mut Random, planes: usize) -> Case {
    let mut case = at_the_box(random);
    let major = random.below(3);
    case.origin = place_in(random, &case.bounds);
    for turn in 1..=2 {
        let axis = (major + turn) % 3;
        let zero = if random.one_in(2) { 0.0 } else { -0.0 };
        let inside = turn > planes && planes == 1;
        case.direction[axis] = if inside {
            f64::from(random.within(-(1 << 23), 1 << 23)) / f64::from(1 << 23)
        } else {
            zero
        };
        if turn <= planes {
            case.origin[axis] = i64::from(case.bounds.0[axis][random.below(2)]) << 8;
        }
    }
    case.direction[major] = if random.one_in(2) { 1.0 } else { -1.0 };
    case.slope = exact(case.direction);
    let back = i64::from(random.within(0, 30_000)) << 8;
    case.origin[major] -= case.slope[major].signum() as i64 * back;
    case
}

/// Returns whether the core finds that the ray may meet the box: in the form that this machine
/// culls with, and in integers.
fn taken<N: Number>(case: &Case) -> bool {
    let origin = case.origin.map(|x| x as f64 / 256.0);
    let tmax = case.tmax as f64 / 256.0;
    let ray = Ray::<N>::from_f64(&WORLD, origin, case.direction, 0.0, tmax).expect("a ray");
    let last = N::length_from_f64(tmax.min(200_000.0));
    let cull = N::Cull::new(&ray);
    let taken = cull.root(&case.bounds, N::Cull::limit(last));
    let exact = PairCulling::<N>::root(&cull.exact(&ray), &case.bounds, N::Cull::limit(last));
    taken.near <= taken.far && exact.near <= exact.far
}

/// Chapter A in one: 10^7 rays in every format in the full run.
#[test]
fn boxes_that_are_met_are_never_passed_by() {
    fn judge<N: Number>(sort: usize, rays: usize) {
        let (name, make) = SORTS[sort];
        const BATCH: usize = 10_000;
        let counts = (0..rays.div_ceil(BATCH)).into_par_iter().map(|batch| {
            let mut random = Random((sort * 1_000_003 + batch) as u64);
            let (mut met, mut taken_too) = (0_usize, 0_usize);
            for _ in 0..BATCH {
                let case = make(&mut random);
                let exact = ExactRay {
                    origin: case.origin,
                    slope: case.slope,
                    tmax: case.tmax,
                };
                let inside = taken::<N>(&case);
                if exact.meets(&case.bounds) {
                    met += 1;
                    assert!(
                        inside,
                        "{name}, {}: {:?} {:?} {:?} {}",
                        N::FORMAT.name(),
                        case.bounds,
                        case.origin,
                        case.direction,
                        case.tmax
                    );
                } else {
                    taken_too += usize::from(inside);
                }
            }
            (met, taken_too)
        });
        let (met, extra) = counts.reduce(|| (0, 0), |a, b| (a.0 + b.0, a.1 + b.1));
        eprintln!(
            "{name:40} {:5}: {met:8} boxes met, none passed by; {extra} taken for nothing",
            N::FORMAT.name()
        );
        assert!(met > 0, "{name}: no box is met");
    }
    for sort in 0..SORTS.len() {
        let rays = part_of(100_000, 10_000_000 / SORTS.len());
        every_format!(judge(sort, rays));
    }
}

/// Neither the sign of a zero (A2) nor the length of a direction (A8) matters: the bits are the
/// same through every structure.
#[test]
fn signs_of_zero_and_lengths_of_directions_change_no_bit() {
    fn judge<N: Number>(scene: &Scene<'_>, rays: usize) {
        let mut random = Random(31);
        let mut hits = 0;
        for ray in rays::rays(scene, 9).take(rays) {
            let plain = UnitRay {
                direction: ray.direction.map(|x| x + 0.0),
                ..ray
            };
            let of = |ray: &UnitRay, structure| {
                let ready = ray.ready::<N>(scene).expect("a ray");
                through::<N>(structure, scene, &ready)
                    .0
                    .map(|hit| HitBits::of(&hit))
            };
            let exponent = random.within(-400, 400);
            let largest = plain
                .direction
                .iter()
                .fold(0.0_f64, |most, x| most.max(x.abs()));
            // Powers of two, as far as the numbers go.
            let scale = f64::powi(2.0, exponent) / f64::powi(2.0, largest.log2() as i32);
            for structure in held(scene) {
                let expected = of(&plain, structure);
                hits += usize::from(expected.is_some());
                for signs in 0..8 {
                    let mut signed = plain;
                    for axis in 0..3 {
                        if plain.direction[axis] == 0.0 && signs & 1 << axis != 0 {
                            signed.direction[axis] = -0.0;
                        }
                    }
                    assert_eq!(of(&signed, structure), expected, "{signed:?}");
                }
                let scaled = UnitRay {
                    direction: plain.direction.map(|x| x * scale),
                    ..plain
                };
                // Where the scale takes digits away, it is another ray.
                if (0..3).all(|k| scaled.direction[k] / scale == plain.direction[k]) {
                    assert_eq!(of(&scaled, structure), expected, "{scaled:?} {plain:?}");
                }
            }
        }
        assert!(hits > 0);
    }
    let blob = scenes::blob(&scenes::soup(8, 60, 0.5), 24);
    let scene = blob.scene().expect("a scene");
    every_format!(judge(&scene, part_of(sixth_of(20_000), 100_000)));
}

/// Any hit is a closest hit at or before the end (A9): ends exactly at hits, and about them.
#[test]
fn any_hit_is_a_closest_hit_before_the_end() {
    fn judge<N: Number>(scene: &Scene<'_>, rays: usize) {
        let mut random = Random(32);
        let mut segments = 0;
        for mut ray in rays::rays(scene, 10).take(rays) {
            let ready = ray.ready::<N>(scene).expect("a ray");
            let Some(hit) = closest::<N, gridel_core::List>(scene, &ready, &mut NoCount) else {
                continue;
            };
            let t = N::far_to_f64(hit.t);
            ray.tmax = match random.below(3) {
                0 => t,
                1 => t * random.unit(),
                _ => t * (1.0 + random.unit()),
            };
            if ray.tmin > ray.tmax {
                continue;
            }
            let ready = ray.ready::<N>(scene).expect("a ray");
            for structure in held(scene) {
                let (hit, any) = through::<N>(structure, scene, &ready);
                segments += 1;
                assert_eq!(hit.is_some(), any, "{}: {ray:?}", structure.name());
                let beyond = hit.is_some_and(|hit| N::far_to_f64(hit.t) > ray.tmax + 1e-3);
                assert!(!beyond, "{}: {ray:?}", structure.name());
            }
        }
        assert!(segments > 0);
    }
    let blob = scenes::blob(&scenes::soup(9, 200, 0.3), 24);
    let scene = blob.scene().expect("a scene");
    every_format!(judge(&scene, part_of(20_000, 500_000)));
}

/// Builds every structure with as many copies of one primitive as could overflow leaves and
/// counters (A12). The first of them is hit (A15).
#[test]
fn the_first_of_any_number_of_equal_primitives_is_hit() {
    fn first<N: Number>(scene: &Scene<'_>, count: usize) {
        let ray = UnitRay::new([0.0, 0.0, -60_000.0], [0.01, 0.02, 1.0]);
        let ready = ray.ready::<N>(scene).expect("a ray");
        for structure in held(scene) {
            let (hit, any) = through::<N>(structure, scene, &ready);
            let found = hit.map(|hit| hit.primitive);
            assert_eq!(found, (count > 0).then_some(0), "{}", structure.name());
            assert_eq!(any, count > 0);
        }
    }
    for count in [0, 1, 2, 3, 31, 32, 255, 256, 257, sixth_of(4096)] {
        let sphere = Shape::Sphere(Sphere {
            center: DVec3::new(1.0, 2.0, 3.0),
            radius: 2.0,
        });
        let blob = scenes::blob(&scenes::of((0..count).map(|_| sphere.clone())), 24);
        let scene = blob.scene().expect("a scene");
        assert_eq!(scene.count(Kind::Sphere), count);
        every_format!(first(&scene, count));
    }
}

/// NaN anywhere in a scene (A13) is an error that says so, and no blob is made.
#[test]
fn nan_is_rejected() {
    let shapes = |bad: f64| {
        let v = |k: usize| {
            let mut v = DVec3::new(1.0, 2.0, 3.0);
            v[k] = bad;
            v
        };
        [
            Shape::Sphere(Sphere {
                center: v(0),
                radius: 1.0,
            }),
            Shape::Sphere(Sphere {
                center: DVec3::ONE,
                radius: bad,
            }),
            Shape::Box(Cuboid {
                min: DVec3::ZERO,
                max: v(1),
            }),
            Shape::Disc(Disc {
                center: DVec3::ONE,
                normal: v(2),
                radius: 1.0,
            }),
            Shape::Cone(Cone {
                base: DVec3::ZERO,
                apex: v(0),
                base_radius: 1.0,
                apex_radius: 0.0,
            }),
            Shape::Cone(Cone {
                base: DVec3::ZERO,
                apex: DVec3::ONE,
                base_radius: 1.0,
                apex_radius: bad,
            }),
            Shape::Mesh {
                vertices: vec![DVec3::ZERO, DVec3::X, v(1)],
                triangles: vec![[0, 1, 2]],
            },
        ]
    };
    let options = Options {
        structures: Structure::ALL.to_vec(),
        ..Options::default()
    };
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for shape in shapes(bad) {
            let scene = scenes::of([shape.clone(), shapes(1.0)[0].clone()]);
            let result = compile(&scene, &options);
            assert!(result.is_err(), "{shape:?}");
        }
    }
}
