//! Planes: unbounded, outside of all structures.

use super::{hold, of_every_sort};
use glam::DVec3;
use gridel_core::{Kind, Number};
use gridel_host::blob::Blob;
use gridel_host::compile::{CompileError, Options, compile};
use gridel_host::scene::{Scene, Shape};
use gridel_host::shape::{Cuboid, Plane, Solid, Sphere};
use gridel_host::verify::verify;
use gridel_tests::agreement::compare;
use gridel_tests::cases::{Case, lattice, slope};
use gridel_tests::effort::part_of;
use gridel_tests::every_format;
use gridel_tests::query::{HitBits, UnitRay, closest, held, through};
use gridel_tests::random::Random;
use gridel_tests::{rays, scenes};

fn plane(point: DVec3, normal: DVec3) -> Shape {
    Shape::Plane(Plane { point, normal })
}

#[test]
fn planes_and_rays_of_every_sort() {
    of_every_sort(8);
}

/// Along the plane, within it or beside it, no ray meets it; the slightest slope towards it does.
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
            // A speck lies beside, never before the plane.
            assert_eq!(hit.primitive, 0, "{ray:?}");
            assert_eq!(hit.point[1].length_to_f64(), height, "{ray:?} {hit:?}");
            assert_eq!(hit.normal.map(N::ratio_to_f64), [0.0, 1.0, 0.0]);
            let t = N::far_to_f64(hit.t);
            let exact = (origin.y - height) / -way.y * way.abs().max_element();
            let step = gridel_tests::bounds::length_step::<N>(exact.max(4e4));
            // The direction is rounded, too.
            let cosine = -way.normalize().y;
            let most = 8.0 * step / cosine
                + exact * gridel_tests::bounds::ratio_step::<N>() * 16.0 / cosine;
            assert!((t - exact).abs() <= most, "{ray:?}: {t} {exact}");
            // From far away, too, the point is where the ray comes to the scene.
            let near = gridel_tests::bounds::length_step::<N>(1e5) * 32.0 / cosine
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

/// On which side of a plane of small integers a point of the lattice lies, no format rounds.
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

/// What leaves a plane does not meet it again, however far from the scene's box that is.
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

/// From 2^20 times the width of the largest scene: above, below and at a slant.
#[test]
fn planes_are_met_from_two_to_the_twentieth_scene_widths() {
    fn judge<N: Number>(normal: DVec3) {
        let mut scene = scenes::soup(173, 8, 0.5);
        let ground = plane(DVec3::new(0.25, -2.0, 0.5), normal);
        scene.objects.splice(0..0, scenes::of([ground]).objects);
        let blob = scenes::blob(&scene, 24);
        let scene = blob.scene().expect("a scene");
        let gridel_core::geometry::Geometry::Plane(record) =
            scene.geometry(Kind::Plane, 0).expect("a plane")
        else {
            unreachable!("it is a plane")
        };
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
            let step = gridel_tests::bounds::length_step::<N>(1e5)
                + 1e5 * gridel_tests::bounds::ratio_step::<N>();
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

/// Scenes with planes within, below and far above what has a box.
fn with_planes(seed: u64, count: usize) -> Scene {
    let mut scene = scenes::soup(seed, count, 0.4);
    let below = scenes::of([
        plane(DVec3::new(3.0, -1.5, 8.0), DVec3::Y),
        plane(DVec3::new(0.1, 0.2, 0.3), DVec3::new(1.0, -2.0, 0.5)),
        plane(DVec3::new(0.1, 1.8, 0.3), DVec3::new(0.1, 1.0, 0.0)),
        // The same again: the first counts.
        plane(DVec3::new(-5.0, -1.5, 0.0), -DVec3::Y),
    ]);
    scene.objects.splice(0..0, below.objects[..2].to_vec());
    scene.objects.extend(below.objects[2..].to_vec());
    scene
}

#[test]
fn all_structures_agree_on_scenes_with_planes() {
    fn one<N: Number>(name: &str, scene: &gridel_core::Scene<'_>) {
        let rays = rays::rays(scene, 7).take(part_of(2000, 20_000));
        compare::<N>(name, scene, rays, 1 << 22).report::<N>(name);
    }
    for count in [0, 4, 24, 200] {
        let blob = scenes::blob(&with_planes(160, count), 24);
        let scene = blob.scene().expect("a scene");
        assert_eq!(scene.count(Kind::Plane), 4);
        every_format!(one("planes", &scene));
    }
    let blob = scenes::compact_blob(&with_planes(161, 40), 24);
    every_format!(one("planes and tables", &blob.scene().expect("a scene")));
}

/// Of planes and boxes that coincide the one that comes first in the scene file counts.
#[test]
fn coincident_planes_and_boxes_are_met_in_file_order() {
    fn one<N: Number>(scene: &gridel_core::Scene<'_>, first: u32) {
        for origin in [
            [0.25, 20_000.0, 0.5],
            [0.25, 9e6, 0.5],
            [8.0, 30_000.0, -900.0],
        ] {
            let ray = UnitRay::new(origin, [0.0, -1.0, 0.0]);
            let ready = ray.ready::<N>(scene).expect("a ray");
            for structure in held(scene) {
                let (hit, any) = through::<N>(structure, scene, &ready);
                assert!(any);
                assert_eq!(
                    hit.map(|hit| hit.primitive),
                    Some(first),
                    "{}",
                    structure.name()
                );
            }
        }
    }
    let slab = Shape::Box(Cuboid {
        min: DVec3::new(-1.0, -1.0, -1.0),
        max: DVec3::new(1.0, 0.0, 1.0),
    });
    let ground = plane(DVec3::new(7.0, 0.0, 5.0), DVec3::Y);
    let orders = [
        [slab.clone(), ground.clone(), ground.clone()],
        [ground.clone(), slab.clone(), ground.clone()],
        [ground.clone(), ground, slab],
    ];
    for shapes in orders {
        let blob = scenes::blob(&scenes::of(shapes), 24);
        every_format!(one(&blob.scene().expect("a scene"), 0));
    }
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

/// The scene's box and lattice are those of the other objects.
#[test]
fn a_plane_enlarges_neither_box_nor_lattice() {
    let soup = scenes::soup(162, 40, 0.3);
    let mut grounded = soup.clone();
    let far = DVec3::new(1e3, -1.25, 1e3);
    grounded
        .objects
        .extend(scenes::of([plane(far, DVec3::Y)]).objects);
    let header = |scene: &Scene| {
        let blob = scenes::blob(scene, 24);
        let header = *blob.scene().expect("a scene").header();
        (header.bounds, header.unit_exponent, header.origin)
    };
    assert_eq!(header(&soup), header(&grounded));
}

#[test]
fn scenes_of_planes_alone_work() {
    fn one<N: Number>(scene: &gridel_core::Scene<'_>) {
        let ray = UnitRay::new([40.0, 900.0, 3.0], [0.0, -1.0, 0.0]);
        let ready = ray.ready::<N>(scene).expect("a ray");
        for structure in held(scene) {
            let (hit, any) = through::<N>(structure, scene, &ready);
            let hit = hit.expect("a hit");
            assert_eq!((hit.primitive, hit.front, any), (0, true, true));
            assert_eq!(HitBits::of(&hit).t, 900_f64.to_bits());
        }
    }
    let scene = scenes::of([plane(DVec3::ZERO, DVec3::Y)]);
    let blob = scenes::blob(&scene, 24);
    every_format!(one(&blob.scene().expect("a scene")));
}

#[test]
fn a_plane_that_is_too_far_away_or_not_finite_is_refused() {
    let speck = Shape::Sphere(Sphere {
        center: DVec3::ZERO,
        radius: 0.99,
    });
    let compiled = |shape: Shape| {
        let scene = scenes::of([speck.clone(), shape]);
        compile(&scene, &Options::default()).err()
    };
    let at = |y: f64| compiled(plane(DVec3::new(0.0, y, 0.0), DVec3::Y));
    assert!(at(3.9).is_none());
    assert!(at(-3.9).is_none());
    for far in [4.1, -4.1, 1e6] {
        assert!(matches!(at(far), Some(CompileError::OutOfReach { .. })));
    }
    // Only its distance counts.
    let aside = compiled(plane(DVec3::new(1e6, 0.0, 0.0), DVec3::Y));
    assert!(aside.is_none(), "{aside:?}");
    for wrong in [f64::NAN, f64::INFINITY] {
        assert!(matches!(at(wrong), Some(CompileError::NotFinite { .. })));
        let normal = compiled(plane(DVec3::ZERO, DVec3::new(0.0, wrong, 1.0)));
        assert!(matches!(normal, Some(CompileError::NotFinite { .. })));
    }
    // Without a normal there is nothing of it.
    let nowhere = scenes::of([speck.clone(), plane(DVec3::ZERO, DVec3::ZERO)]);
    let compiled = gridel_host::compile::compile(&nowhere, &Options::default()).expect("compiles");
    assert_eq!(compiled.report.collapsed.count(), 1);
}

#[test]
fn verify_holds_scenes_with_planes_to_every_promise() {
    for count in [0, 24] {
        let mut scene = with_planes(163, count);
        scene.lights = vec![gridel_host::scene::Light::Directional {
            direction: DVec3::new(-1.0, -2.0, -0.75),
            color: [0.7; 3],
        }];
        let blob = scenes::blob(&scene, 24);
        let report = verify(&blob.scene().expect("a scene"), 3000, &|| ());
        assert_eq!(report.broken(), 0, "{:#?}", report.promises);
    }
}

/// Light from above: a plane keeps it from all that lies beneath, and what stands on a plane keeps it from the plane.
#[test]
fn planes_cast_and_receive_shadows() {
    fn lit<N: Number>(blob: &Blob, eye: DVec3, target: DVec3) -> bool {
        let scene = blob.scene().expect("a scene");
        let way = target - eye;
        let ray = UnitRay::new(eye.to_array(), way.to_array());
        let ready = ray.ready::<N>(&scene).expect("a ray");
        let hit = closest::<N, gridel_core::List>(&scene, &ready, &mut gridel_core::NoCount);
        let hit = hit.expect("a hit");
        let from = gridel_tests::query::depart(&scene, &hit, hit.front);
        let light = UnitRay::new(from, [0.25, 1.0, 0.125]);
        let ready = light.ready::<N>(&scene).expect("a ray");
        held(&scene).for_each(|structure| {
            let (hit, any) = through::<N>(structure, &scene, &ready);
            assert_eq!(hit.is_some(), any);
        });
        !through::<N>(gridel_core::Structure::Bvh, &scene, &ready).1
    }
    fn judge<N: Number>() {
        let ball = Shape::Sphere(Sphere {
            center: DVec3::new(0.0, 1.0, 0.0),
            radius: 1.0,
        });
        let ground = plane(DVec3::new(9.0, 0.0, 3.0), DVec3::Y);
        let roof = plane(DVec3::new(0.0, 3.0, 0.0), DVec3::new(0.25, -1.0, 0.0));
        let open = scenes::blob(&scenes::of([ball.clone(), ground.clone()]), 24);
        let closed = scenes::blob(&scenes::of([ball, ground, roof]), 24);
        // Places in units, whatever the lattice is.
        let at = |blob: &Blob, x: f64, y: f64, z: f64| {
            let header = *blob.scene().expect("a scene").header();
            let unit = f64::powi(2.0, header.unit_exponent.into());
            (DVec3::new(x, y, z) - DVec3::from_array(header.origin)) / unit
        };
        let place = |blob: &Blob, x: f64, z: f64| {
            lit::<N>(blob, at(blob, x - 0.5, 2.0, z + 3.0), at(blob, x, 0.0, z))
        };
        // Next to the ball and under it, and as far away as pictures show grounds.
        assert!(!place(&open, -0.125, 0.0));
        assert!(!place(&open, -0.25, -0.125));
        for (x, z) in [(5.0, 0.0), (-400.0, 30.0), (12_345.0, -54_321.0)] {
            assert!(place(&open, x, z), "{x} {z}");
            // The roof comes down to the ground at x = -12.
            if x > -12.0 {
                assert!(!place(&closed, x, z), "{x} {z}");
            }
        }
        let top = |blob: &Blob| lit::<N>(blob, at(blob, 0.0, 2.5, 0.0), at(blob, 0.0, 1.0, 0.0));
        assert!(top(&open));
        assert!(!top(&closed));
    }
    every_format!(judge());
}

/// A camera that the compiler chooses frames the other objects.
#[test]
fn planes_are_out_of_the_frame() {
    let soup = scenes::soup(164, 12, 0.3);
    let view = |scene: &Scene| {
        let blob = scenes::blob(scene, 24);
        let view = *blob.scene().expect("a scene").view();
        (view.eye, view.forward)
    };
    let mut grounded = soup.clone();
    let ground = plane(DVec3::new(700.0, -1.25, 1e3), DVec3::Y);
    grounded.objects.extend(scenes::of([ground]).objects);
    assert!(soup.camera.is_none());
    assert_eq!(view(&soup), view(&grounded));
}

/// Two planes that cross: whichever a ray meets first, on both sides of the line where they meet.
#[test]
fn of_two_crossing_planes_the_nearer_is_met() {
    fn judge<N: Number>() {
        let normals = [DVec3::new(1.0, 2.0, 0.0), DVec3::new(-2.0, 1.0, 1.0)];
        let shapes = normals.map(|normal| plane(DVec3::ZERO, normal));
        let blob = scenes::blob(&scenes::of(shapes), 24);
        let scene = blob.scene().expect("a scene");
        let mut random = Random(175);
        let mut met = [0; 2];
        for _ in 0..part_of(2000, 20_000) {
            let origin = DVec3::from_array(random.direction()) * random.magnitude(1.0, 30_000.0);
            let way = DVec3::from_array(random.direction());
            let ray = UnitRay::new(origin.to_array(), way.to_array());
            let ready = ray.ready::<N>(&scene).expect("a ray");
            let major = way.abs().max_element();
            let t = normals.map(|normal| -origin.dot(normal) / way.dot(normal) * major);
            // Where both are as far, rounding decides.
            if (t[0] - t[1]).abs() <= 1e-2 * t[0].abs().max(t[1].abs()) {
                continue;
            }
            let ahead = (0..2).filter(|&k| t[k] > 0.0);
            let first = ahead.min_by(|&a, &b| t[a].total_cmp(&t[b]));
            let (hit, any) = through::<N>(gridel_core::Structure::Bvh, &scene, &ready);
            assert_eq!(any, first.is_some());
            let primitive = hit.map(|hit| hit.primitive as usize);
            assert_eq!(primitive, first, "{ray:?} {t:?} {hit:?}");
            met.iter_mut()
                .enumerate()
                .for_each(|(k, met)| *met += u32::from(first == Some(k)));
        }
        assert!(met.iter().all(|&met| met > 300), "{met:?}");
    }
    every_format!(judge());
}
