//! Planes together with other objects: in all structures, in shadow, and in values that the compiler derives.

use super::plane;
use glam::DVec3;
use gridel_core::{Kind, Number, Structure};
use gridel_host::blob::Blob;
use gridel_host::compile::{CompileError, Options, compile};
use gridel_host::scene::{Scene, Shape};
use gridel_host::shape::{Cuboid, Sphere};
use gridel_host::verify::verify;
use gridel_tests::agreement::compare;
use gridel_tests::effort::part_of;
use gridel_tests::query::{HitBits, UnitRay, closest, held, through};
use gridel_tests::random::Random;
use gridel_tests::{every_format, rays, scenes};

/// Scenes with planes within, below and far above what has a box.
fn with_planes(seed: u64, count: usize) -> Scene {
    let mut scene = scenes::soup(seed, count, 0.4);
    let below = scenes::of([
        plane(DVec3::new(3.0, -1.5, 8.0), DVec3::Y),
        plane(DVec3::new(0.1, 0.2, 0.3), DVec3::new(1.0, -2.0, 0.5)),
        plane(DVec3::new(0.1, 1.8, 0.3), DVec3::new(0.1, 1.0, 0.0)),
        // The first plane again; of both the first counts.
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

/// If planes and boxes coincide, the first in the scene file counts.
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

/// A plane that leans so little that its normal is rounded still passes the scene where it was.
#[test]
fn planes_with_a_far_point_pass_the_scene_in_their_place() {
    fn one<N: Number>(scene: &gridel_core::Scene<'_>, t: f64) {
        let ray = UnitRay::new(FROM, [0.0, -1.0, 0.0]);
        let ready = ray.ready::<N>(scene).expect("a ray");
        let (hit, _) = through::<N>(Structure::List, scene, &ready);
        let hit = hit.expect("a hit");
        let apart = N::far_to_f64(hit.t) - t;
        assert!(apart.abs() < 0.05, "{:?}: {apart} units off", N::FORMAT);
    }
    // In units, above the plane and beside the top of the ball.
    const FROM: [f64; 3] = [3000.0, 60_000.0, 0.0];
    let ball = Shape::Sphere(Sphere {
        center: DVec3::ZERO,
        radius: 1.0,
    });
    for far in [1e4, 1e8, 1e12] {
        let leaning = DVec3::new(1.0 / far, 1.0, 0.0);
        let scene = scenes::of([plane(DVec3::new(far, 0.0, 2.0), leaning), ball.clone()]);
        let compiled = compile(&scene, &Options::default()).expect("compiles");
        assert!(compiled.report.largest_displacement < 1e-3, "{far}");
        let blob = scenes::blob(&scene, 24);
        let scene = blob.scene().expect("a scene");
        let unit = f64::powi(2.0, scene.header().unit_exponent.into());
        let [x, y, _] = scene.header().origin;
        let height = (1.0 - (x + FROM[0] * unit) / far - y) / unit;
        every_format!(one(&scene, FROM[1] - height));
    }
}

#[test]
fn a_plane_that_is_too_far_away_or_not_finite_is_rejected() {
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
        assert_eq!(report.broken(), 0, "{:#?}", report.properties);
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

/// Two planes that cross: a ray hits the nearer one, on both sides of the line where they meet.
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
