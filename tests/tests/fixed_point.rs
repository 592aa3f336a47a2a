//! Fixed point (hard cases E). The operations themselves are tested with `Fixed` in the core, mirrors and scales in
//! `transforms`, watertight meshes in `watertight`.
//!
//! A number that wraps panics, in these and in all other tests of the project. They are built with the core's feature
//! `strict-ranges`.

use glam::DVec3;
use gridel_core::format::record::UnitBox;
use gridel_core::{Fixed, Kind, List, NoCount, Scene, Structure};
use gridel_host::compile::{Options, compile};
use gridel_host::scene::Shape;
use gridel_host::shape::Solid;
use gridel_host::shape::{Cone, Cuboid, Disc, Sphere};
use gridel_tests::cases::{BOUNDED, SHAPES, cases};
use gridel_tests::effort::part_of;
use gridel_tests::exact::{Real, cross, dot, minus, norm, unit, vector};
use gridel_tests::judge::blob_of;
use gridel_tests::query::{UnitRay, closest, held, through};
use gridel_tests::random::Random;
use gridel_tests::scenes;
use gridel_tests::shapes::reach;

/// The largest coordinate of a scene, in units.
const END: f64 = 32_764.0;

/// Covers every corner of the ranges: triangles whose corners are at the lattice's ends, middle and next to them. Rays
/// from and to such places hit them (E1, E2, E5). A number that wraps panics.
#[test]
fn no_number_wraps_at_the_corners_of_the_lattice() {
    let places = [-END, -END + 1.0 / 256.0, 0.0, 1.0 / 256.0, END];
    let mut random = Random(71);
    let mut hits = 0;
    let place = |random: &mut Random| DVec3::from_array([0; 3].map(|_| places[random.below(5)]));
    for _ in 0..part_of(3000, 100_000) {
        let (a, b, c) = (place(&mut random), place(&mut random), place(&mut random));
        let solids = if (b - a).cross(c - a) != DVec3::ZERO {
            vec![Solid::Triangle([a, b, c])]
        } else {
            corner_solid(&mut random, a, b)
        };
        let blob = blob_of(&solids);
        let scene = blob.scene().expect("a scene");
        for _ in 0..40 {
            let origin = place(&mut random) * [1.0, 1.0, 3.0, 1e6][random.below(4)];
            let target = match random.below(3) {
                0 => a + (b - a) * random.unit(),
                1 => (a + b + c) / 3.0,
                _ => place(&mut random),
            };
            if origin == target {
                continue;
            }
            let ray = UnitRay::new(origin.to_array(), (target - origin).to_array());
            let ready = ray.ready::<Fixed>(&scene).expect("a ray");
            for structure in held(&scene) {
                hits += usize::from(through(structure, &scene, &ready).0.is_some());
            }
        }
    }
    assert!(hits > 1000, "{hits}");
}

/// A solid as large as the lattice between two of its places.
fn corner_solid(random: &mut Random, a: DVec3, b: DVec3) -> Vec<Solid> {
    if a == b {
        return vec![Solid::Sphere(Sphere {
            center: [0.0; 3].into(),
            radius: END,
        })];
    }
    match random.below(3) {
        0 => vec![Solid::Box(Cuboid {
            min: a.min(b),
            max: a.max(b),
        })],
        1 => vec![Solid::Disc(Disc {
            center: ((a + b) * 0.25),
            normal: DVec3::AXES[random.below(3)],
            radius: 16_000.0,
        })],
        _ => {
            let (a, b) = (a * 0.5, b * 0.5);
            vec![Solid::Cone(Cone {
                base: a,
                apex: b,
                base_radius: 16_000.0,
                apex_radius: [0.0, 16_000.0, 8000.0][random.below(3)],
            })]
        }
    }
}

/// The box of every primitive holds the whole primitive (E3), and is no larger than it needs to be.
#[test]
fn boxes_hold_their_primitives() {
    let mut most = 0.0_f64;
    for &shape in &*BOUNDED {
        let name = SHAPES[shape];
        for case in cases(700 + shape as u64, shape, part_of(500, 20_000), 0) {
            let blob = blob_of([&case.solid]);
            let scene = blob.scene().expect("a scene");
            let kind = Kind::ALL
                .into_iter()
                .find(|&kind| scene.count(kind) > if kind == Kind::Sphere { 2 } else { 0 })
                .expect("a primitive");
            // The specks are spheres too; the primitive's box is the one that reaches as far.
            let boxes =
                (0..scene.count(kind)).filter_map(|slot| scene.primitive_bounds(kind, slot));
            let holds = |bounds: &UnitBox| {
                (0..3).all(|axis| {
                    let [low, high] = bounds.0[axis].map(f64::from);
                    reach(&case.solid, axis, 1.0) <= Real::of(high)
                        && reach(&case.solid, axis, -1.0) <= Real::of(-low)
                })
            };
            let boxes: Vec<UnitBox> = boxes.filter(holds).collect();
            assert_eq!(boxes.len(), 1, "{name}: {:?}", case.solid);
            for axis in 0..3 {
                let spare =
                    Real::of(f64::from(boxes[0].0[axis][1])) - reach(&case.solid, axis, 1.0);
                most = most.max(spare.to_f64());
            }
        }
    }
    eprintln!("boxes reach at most {most} units beyond their primitives");
    assert!(most <= 2.0);
}

/// No hit is nearer than the exact t less the bound of the point along the ray, at any angle (E2). The reference is an
/// exact plane.
#[test]
fn grazing_rays_do_not_hit_too_early() {
    let mut random = Random(72);
    let mut hits = 0;
    for _ in 0..part_of(300, 5000) {
        let point = |random: &mut Random| [0; 3].map(|_| f64::from(random.within(-32_000, 32_000)));
        let corners = [point(&mut random), point(&mut random), point(&mut random)];
        let [a, b, c] = corners.map(vector);
        let normal = cross(&minus(&b, &a), &minus(&c, &a));
        if norm(&normal).is_zero() {
            continue;
        }
        let blob = blob_of([&Solid::Triangle(corners.map(DVec3::from_array))]);
        let scene = blob.scene().expect("a scene");
        for _ in 0..50 {
            // From just above the plane to somewhere in it.
            let mix = |s: f64, t: f64| {
                DVec3::from_array([0, 1, 2].map(|k| {
                    corners[0][k]
                        + s * (corners[1][k] - corners[0][k])
                        + t * (corners[2][k] - corners[0][k])
                }))
            };
            let s = random.unit();
            let target = mix(s, random.unit() * (1.0 - s));
            let side = unit(&normal).map(|x| x.to_f64());
            let lift = DVec3::from_array(side) * random.magnitude(1e-2, 10.0);
            let way = gridel_tests::cases::slope(target - mix(random.unit(), random.unit()) - lift);
            let origin = (target - DVec3::from_array(way) * random.unit() * 9000.0) * 256.0;
            let origin = origin.round() / 256.0;
            let ray = UnitRay::new(origin.to_array(), way);
            let ready = ray.ready::<Fixed>(&scene).expect("a ray");
            let Some(hit) = closest::<Fixed, List>(&scene, &ready, &mut NoCount) else {
                continue;
            };
            if hit.primitive != 0 {
                continue;
            }
            let tilt = dot(&normal, &vector(way));
            if tilt.is_zero() {
                continue;
            }
            let exact = dot(&normal, &minus(&a, &vector(origin.to_array()))) / &tilt;
            let t = hit.t.0 as f64 / 8192.0;
            // The plane's place, 8 sub-steps, seen at this angle.
            let bound = Real::of(8.0 / 8192.0) * norm(&normal) / tilt.abs();
            let apart = (exact - Real::of(t)).abs();
            assert!(apart <= bound, "{corners:?} {ray:?} {t}");
            hits += 1;
        }
    }
    assert!(hits > 100, "{hits}");
}

/// Rays from far outside the scene, given by end points, meet what they are aimed at (E7).
#[test]
fn far_rays_meet_what_they_are_aimed_at() {
    let mut random = Random(73);
    let ball = |radius: f64| {
        Solid::Sphere(Sphere {
            center: [100.0, -200.0, 300.0].into(),
            radius,
        })
    };
    // A direction keeps 30 fraction bits: over 2^17 units from the scene's edge, a sub-step or two.
    let blob = blob_of([&ball(1.0 / 256.0)]);
    let scene = blob.scene().expect("a scene");
    for _ in 0..part_of(20_000, 1_000_000) {
        let from = DVec3::from_array(random.direction()) * random.magnitude(1.0, 1e9);
        let target = DVec3::new(100.0, -200.0, 300.0);
        let origin = (target + from).round();
        let ray = UnitRay::new(origin.to_array(), (target - origin).to_array());
        let ready = ray.ready::<Fixed>(&scene).expect("a ray");
        let hit = closest::<Fixed, List>(&scene, &ready, &mut NoCount);
        assert!(hit.is_some_and(|hit| hit.primitive == 0), "{ray:?}");
    }
}

/// Scenes that no lattice can hold are rejected by name (E8); any other takes up at least half of its lattice.
#[test]
fn the_lattice_fits_the_scene() {
    let mut random = Random(74);
    for _ in 0..200 {
        let size = random.magnitude(1e-200, 1e200);
        let place = DVec3::from_array(random.direction()) * size * random.magnitude(1e-3, 1e3);
        let scene = scenes::of([Shape::Box(Cuboid {
            min: place,
            max: place + DVec3::splat(size),
        })]);
        let options = Options {
            structures: vec![Structure::List],
            ..Options::default()
        };
        let compiled = compile(&scene, &options).expect("compiles");
        let scene: Scene<'_> = compiled.blob.scene().expect("a scene");
        let bounds = scene.bounds().0[0];
        assert!(bounds[1] >= 16_380 && bounds[0] <= -16_380, "{bounds:?}");
    }
}
