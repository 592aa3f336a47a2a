//! Rays and a single plane: which meet it, where, and on which side.

use super::plane;
use crate::shapes::{hold, of_every_sort};
use glam::DVec3;
use gridel_core::geometry::{self, Geometry};
use gridel_core::{Kind, Number, Scene};
use gridel_host::shape::rounding;
use gridel_host::shape::{Plane, Solid};
use gridel_tests::cases::{Case, lattice, slope};
use gridel_tests::effort::part_of;
use gridel_tests::query::{UnitRay, closest, through};
use gridel_tests::random::Random;
use gridel_tests::{every_format, scenes};

/// The first plane of a scene.
fn stored(scene: &Scene<'_>) -> geometry::plane::Plane {
    match scene.geometry(Kind::Plane, 0) {
        Some(Geometry::Plane(record)) => record,
        other => panic!("{other:?} is no plane"),
    }
}

#[test]
fn planes_and_rays_of_every_sort_hold_the_bounds() {
    of_every_sort(8);
}

/// No ray along the plane, within it or next to it, hits it; the slightest slope towards it does.
#[test]
fn rays_in_and_along_a_plane_miss_it_and_grazing_rays_meet_it() {
    fn judge<N: Number>() {
        let mut random = Random(151);
        let mut cases = |height: f64, rise: f64| -> Vec<Case> {
            (0..part_of(60, 1000))
                .map(|_| {
                    let axis = random.below(3);
                    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                    let point =
                        DVec3::from_array([0; 3].map(|_| random.signed() * 9000.0)).map(lattice);
                    let mut origin = point;
                    origin[axis] += height;
                    origin[u] = lattice(random.signed() * 9000.0);
                    let mut way = DVec3::ZERO;
                    (way[u], way[v]) = (random.signed(), random.signed());
                    way /= way.abs().max_element();
                    way[axis] = rise;
                    Case {
                        class: "graze",
                        solid: Solid::Plane(Plane {
                            point,
                            normal: DVec3::AXES[axis],
                        }),
                        rays: vec![(origin.to_array(), slope(way))],
                    }
                })
                .collect()
        };
        assert_eq!(
            hold::<N>("rays in planes", "plane", &cases(0.0, 0.0)).hits,
            0
        );
        assert_eq!(
            hold::<N>("rays along planes", "plane", &cases(1.0, 0.0)).hits,
            0
        );
        let graze = f64::powi(2.0, -20);
        assert_eq!(hold::<N>("rays away", "plane", &cases(1.0, graze)).hits, 0);
        let worst = hold::<N>("grazing rays", "plane", &cases(1.0, -graze));
        assert_eq!(worst.hits, worst.rays);
    }
    every_format!(judge());
}

/// On an axis-parallel plane a hit's coordinate is the plane's own, from wherever the ray comes.
#[test]
fn axis_parallel_planes_are_exact_from_everywhere() {
    fn judge<N: Number>(height: f64) {
        let solid = Solid::Plane(Plane {
            point: DVec3::new(0.0, height, 0.0),
            normal: DVec3::Y,
        });
        let blob = gridel_tests::judge::blob_of([&solid]);
        let scene = blob.scene().expect("a scene");
        let mut random = Random(152);
        for _ in 0..2000 {
            let target = DVec3::new(random.signed() * 2e4, height, random.signed() * 2e4);
            let mut way = DVec3::from_array(random.direction());
            way.y = -(way.y.abs() + 0.1);
            let back = random.magnitude(1.0, 1e10);
            let origin = target - way * back;
            let ray = UnitRay::new(origin.to_array(), way.to_array());
            let ready = ray.ready::<N>(&scene).expect("a ray");
            let hit = closest::<N, gridel_core::List>(&scene, &ready, &mut gridel_core::NoCount);
            let hit = hit.expect("a hit");
            // A speck lies to the side, never before the plane.
            assert_eq!(hit.primitive, 0, "{ray:?}");
            assert_eq!(hit.point[1].length_to_f64(), height, "{ray:?} {hit:?}");
            assert_eq!(hit.normal.map(N::ratio_to_f64), [0.0, 1.0, 0.0]);
            let t = N::far_to_f64(hit.t);
            let exact = (origin.y - height) / -way.y * way.abs().max_element();
            let step = rounding::step(N::FORMAT, exact.max(4e4));
            // The direction is rounded, too.
            let cosine = -way.normalize().y;
            let most = 8.0 * step / cosine
                + exact * gridel_tests::bounds::ratio_step::<N>() * 16.0 / cosine;
            assert!((t - exact).abs() <= most, "{ray:?}: {t} {exact}");
            // From far away, too, the point is where the ray comes to the scene.
            let near = rounding::step(N::FORMAT, 1e5) * 32.0 / cosine
                + back.min(1e5) * gridel_tests::bounds::ratio_step::<N>() * 32.0 / cosine
                + back * f64::powi(2.0, -50);
            for k in [0, 2] {
                let off = (hit.point[k].length_to_f64() - target[k]).abs();
                assert!(off <= near, "{ray:?}: {off} {near}");
            }
        }
    }
    every_format!(judge(0.0));
    every_format!(judge(-20_000.0));
}

/// No format rounds the side of a plane of small integers on which a point of the lattice lies.
#[test]
fn planes_of_small_integers_have_exact_sides() {
    const STEP: f64 = 1.0 / 256.0;
    fn judge<N: Number>(normal: [f64; 3], seed: u64) {
        let normal = DVec3::from_array(normal);
        let mut random = Random(seed);
        let mut whole = |most: f64| (random.signed() * most).round();
        let point = DVec3::new(whole(1000.0), whole(1000.0), whole(1000.0)) * STEP;
        let solid = Solid::Plane(Plane { point, normal });
        let blob = gridel_tests::judge::blob_of([&solid]);
        let scene = blob.scene().expect("a scene");
        // Integers at right angles to the normal.
        let across = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| normal.cross(axis));
        let major = normal.to_array().map(f64::abs);
        let major = (0..3)
            .max_by(|&a, &b| major[a].total_cmp(&major[b]))
            .expect("three axes");
        let mut met = [0; 3];
        for _ in 0..500 {
            let on = across
                .into_iter()
                .fold(point, |at, across| at + across * whole(2000.0) * STEP);
            let way = DVec3::from_array(slope(DVec3::new(whole(9e3), whole(9e3), whole(9e3))));
            let approach = way.dot(normal);
            if approach.abs() < 1e-2 {
                continue;
            }
            for (index, side) in [-1.0, 0.0, 1.0].into_iter().enumerate() {
                let mut origin = on;
                origin[major] += side * STEP * normal[major].signum();
                let ray = UnitRay::new(origin.to_array(), way.to_array());
                let ready = ray.ready::<N>(&scene).expect("a ray");
                let hit =
                    closest::<N, gridel_core::List>(&scene, &ready, &mut gridel_core::NoCount);
                let hit = hit.filter(|hit| hit.primitive == 0);
                let name = N::FORMAT.name();
                assert_eq!(
                    hit.is_some(),
                    side * approach <= 0.0,
                    "{name} {solid:?} {ray:?} {side} {hit:?}"
                );
                let Some(hit) = hit else { continue };
                assert_eq!(hit.front, approach < 0.0);
                let t = N::far_to_f64(hit.t);
                assert_eq!(t == 0.0, side == 0.0, "{name} {solid:?} {ray:?} {t}");
                met[index] += 1;
            }
        }
        assert!(met.into_iter().all(|met| met > 100), "{met:?}");
    }
    let normals = [
        [0.0, 3.0, 0.0],
        [1.0, 1.0, 0.0],
        [1.0, -2.0, 2.0],
        [3.0, 4.0, -5.0],
        [-7.0, 5.0, 1.0],
    ];
    for (normal, seed) in normals.into_iter().zip(170..) {
        every_format!(judge(normal, seed));
    }
}

/// A ray that leaves a plane does not hit it again, however far from the scene's box that is.
#[test]
fn rays_that_leave_a_plane_do_not_meet_it_again() {
    fn judge<N: Number>(normal: DVec3, farthest: f64) {
        let mut scene = scenes::soup(171, 8, 0.5);
        let ground = plane(DVec3::new(0.3, -2.0, 0.1), normal);
        scene.objects.splice(0..0, scenes::of([ground]).objects);
        let blob = scenes::blob(&scene, 24);
        let scene = blob.scene().expect("a scene");
        let mut random = Random(172);
        let mut left = 0;
        for _ in 0..part_of(2000, 20_000) {
            let origin = DVec3::from_array(random.direction()) * random.magnitude(10.0, 6e4);
            // Often at a flat angle: far away.
            let mut way = DVec3::from_array(random.direction());
            way -= normal.normalize()
                * (way.dot(normal.normalize()) * (1.0 - random.magnitude(1e-7, 1.0)));
            let ray = UnitRay::new(origin.to_array(), way.to_array());
            let ready = ray.ready::<N>(&scene).expect("a ray");
            let hit = closest::<N, gridel_core::List>(&scene, &ready, &mut gridel_core::NoCount);
            let Some(hit) = hit.filter(|hit| hit.primitive == 0) else {
                continue;
            };
            for outward in [true, false] {
                let from = gridel_tests::query::depart(&scene, &hit, outward);
                if from.iter().any(|x| x.abs() > farthest) {
                    continue;
                }
                let mut way = DVec3::from_array(random.direction());
                let side = DVec3::from_array(hit.normal.map(N::ratio_to_f64))
                    * if outward { 1.0 } else { -1.0 };
                let lift = if random.one_in(3) {
                    1e-5 + random.unit() * 1e-3
                } else {
                    1e-5 + way.dot(side).abs()
                };
                way += (lift - way.dot(side)) * side;
                let ray = UnitRay::new(from, way.to_array());
                let again = ray.ready::<N>(&scene).and_then(|ready| {
                    closest::<N, gridel_core::List>(&scene, &ready, &mut gridel_core::NoCount)
                });
                let again = again.filter(|again| again.primitive == 0);
                assert!(
                    again.is_none(),
                    "{} {hit:?} {outward}: {ray:?} {again:?}",
                    N::FORMAT.name()
                );
                left += 1;
            }
        }
        assert!(left > 500, "{left}");
    }
    for normal in [
        DVec3::Y,
        DVec3::new(1.0, 2.0, -2.0),
        DVec3::new(0.123, 1.0, 0.377),
    ] {
        every_format!(judge(normal, 1e9));
    }
}

/// Rays start at 2^20 times the width of the largest scene: above, below and at a slant.
#[test]
fn planes_are_met_from_two_to_the_twentieth_scene_widths() {
    fn judge<N: Number>(normal: DVec3) {
        let mut scene = scenes::soup(173, 8, 0.5);
        let ground = plane(DVec3::new(0.25, -2.0, 0.5), normal);
        scene.objects.splice(0..0, scenes::of([ground]).objects);
        let blob = scenes::blob(&scene, 24);
        let scene = blob.scene().expect("a scene");
        let record = stored(&scene);
        let through = DVec3::from_array(record.point.map(|x| f64::from(x) / 256.0));
        let unit = DVec3::from_array(record.normal.map(f64::from)).normalize();
        let mut random = Random(174);
        for _ in 0..part_of(500, 5000) {
            let way = DVec3::from_array(random.direction());
            let sine = way.dot(unit);
            if sine.abs() < 0.05 {
                continue;
            }
            let around = DVec3::from_array(random.direction());
            let target = through + (around - around.dot(unit) * unit) * random.magnitude(1.0, 3e4);
            let origin = target - way * f64::powi(2.0, 36);
            let ray = UnitRay::new(origin.to_array(), way.to_array());
            let ready = ray.ready::<N>(&scene).expect("a ray");
            let hit = closest::<N, gridel_core::List>(&scene, &ready, &mut gridel_core::NoCount);
            // Little stands on it.
            let Some(hit) = hit.filter(|hit| hit.primitive == 0) else {
                assert!(hit.is_some(), "{} {ray:?}", N::FORMAT.name());
                continue;
            };
            assert_eq!(hit.front, sine < 0.0);
            let point = DVec3::from_array(hit.point.map(N::length_to_f64));
            let off = (point - through).dot(unit).abs();
            assert!(off <= hit.error.length_to_f64(), "{hit:?} {off}");
            // Two roundings where the ray comes to the box, and those of its slopes on the way.
            let step =
                rounding::step(N::FORMAT, 1e5) + 1e5 * gridel_tests::bounds::ratio_step::<N>();
            let most = 32.0 * step / sine.abs() + f64::powi(2.0, 36 - 50);
            let aside = (point - target).length();
            assert!(
                aside <= most,
                "{} {ray:?} {hit:?}: {aside} {most}",
                N::FORMAT.name()
            );
        }
    }
    every_format!(judge(DVec3::Y));
    every_format!(judge(DVec3::new(1.0, 2.0, -2.0)));
    every_format!(judge(DVec3::new(0.123, 1.0, 0.377)));
}

/// Far beside the scene as well, `t` is that of exact arithmetic within the bounds of hits, up to 2^49 units. A plane
/// farther away is not met.
#[test]
fn planes_far_beside_the_scene_are_met_in_their_place() {
    /// Parts of a slope, which no format rounds.
    const PARTS: i64 = 1 << 13;
    fn judge<N: Number>(normal: DVec3) {
        let mut scene = scenes::soup(175, 8, 0.5);
        let ground = plane(DVec3::new(0.25, 0.5, 0.5), normal);
        scene.objects.splice(0..0, scenes::of([ground]).objects);
        let blob = scenes::blob(&scene, 24);
        let scene = blob.scene().expect("a scene");
        let record = stored(&scene);
        let dot = |v: [i64; 3]| -> i128 {
            let products = v.iter().zip(record.normal);
            products.map(|(&x, n)| i128::from(x) * i128::from(n)).sum()
        };
        let length = DVec3::from_array(record.normal.map(f64::from)).length();
        let mut random = Random(176);
        let (mut farthest, mut beyond) = (0.0_f64, 0);
        for _ in 0..part_of(4000, 40_000) {
            let far = 0.99 * f64::powi(2.0, 18 + random.below(20) as i32);
            let mut origin = [(); 3].map(|()| (far * random.signed()) as i64);
            // Beside the scene on one axis, and so on all of the ray's way.
            let major = random.below(3);
            let aside = (major + 1) % 3;
            origin[aside] += if origin[aside] < 0 { -1 << 18 } else { 1 << 18 };
            let mut slope = [(); 3].map(|()| i64::from(random.within(-64, 64)) * PARTS / 64);
            slope[major] = if random.one_in(2) { PARTS } else { -PARTS };
            slope[aside] = 0;
            if random.one_in(2) {
                // Nearly along the plane.
                let third = (major + 2) % 3;
                let lean = record.normal.map(i64::from);
                let along = (-slope[major] * lean[major]).checked_div(lean[third]);
                let along = along.unwrap_or(0) + i64::from(random.within(-2, 2));
                slope[third] = along.clamp(-PARTS, PARTS);
            }
            let approach = dot(slope);
            let apart = [0, 1, 2].map(|k| i64::from(record.point[k]) - 256 * origin[k]);
            if approach == 0 {
                continue;
            }
            let exact = (i128::from(PARTS) * dot(apart)) as f64 / approach as f64 / 256.0;
            let sine = (approach as f64 / PARTS as f64 / length).abs();
            let ray = UnitRay::new(origin.map(|x| x as f64), slope.map(|x| x as f64));
            let ready = ray.ready::<N>(&scene).expect("a ray");
            let hit = closest::<N, gridel_core::List>(&scene, &ready, &mut gridel_core::NoCount);
            let about = || format!("{} {ray:?}: {exact} {hit:?}", N::FORMAT.name());
            let end = f64::powi(2.0, 49);
            if exact < 0.0 || exact > end * 1.001 {
                assert!(hit.is_none(), "{}", about());
                beyond += usize::from(exact > end);
            } else if exact < end * 0.999 {
                let Some(hit) = hit else {
                    panic!("{}", about());
                };
                assert_eq!(hit.primitive, 0, "{}", about());
                let off = (N::far_to_f64(hit.t) - exact).abs() * sine;
                let most = 8.0 * rounding::step(N::FORMAT, far.max(exact));
                assert!(off <= most, "{off} {most}, {}", about());
                farthest = farthest.max(exact);
            }
        }
        assert!(farthest > f64::powi(2.0, 45), "{farthest}");
        assert!(normal != DVec3::Y || beyond > 0);
    }
    every_format!(judge(DVec3::Y));
    every_format!(judge(DVec3::new(1.0, 3.0, 2.0)));
}

/// A ray's interval holds for planes, before the scene's box and behind it.
#[test]
fn planes_are_met_in_the_interval_that_was_given() {
    fn one<N: Number>() {
        let blob = scenes::blob(&scenes::of([plane(DVec3::ZERO, DVec3::Y)]), 24);
        let scene = blob.scene().expect("a scene");
        let t = |tmin: f64, tmax: f64| {
            let mut ray = UnitRay::new([5.0, 1000.0, -7.0], [0.0, -2.0, 1.0]);
            (ray.tmin, ray.tmax) = (tmin, tmax);
            let ready = ray.ready::<N>(&scene).expect("a ray");
            let hit = through::<N>(gridel_core::Structure::Bvh, &scene, &ready).0;
            hit.map(|hit| (N::far_to_f64(hit.t), hit.front))
        };
        let met = Some((1000.0, true));
        assert_eq!(t(0.0, f64::INFINITY), met);
        assert_eq!(t(1000.0, 1000.0), met);
        assert_eq!(t(-1e6, 1e6), met);
        assert_eq!(t(0.0, 999.0), None);
        assert_eq!(t(1001.0, f64::INFINITY), None);
        assert_eq!(t(f64::NEG_INFINITY, 0.0), None);
    }
    every_format!(one());
}
