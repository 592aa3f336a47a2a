//! Surfaces in the faces of the scene's box, where rays from outside start.

use glam::DVec3;
use gridel_core::{Number, Ray, Scene};
use gridel_host::scene::Shape;
use gridel_host::shape::{Cone, Cuboid, Disc};
use gridel_tests::effort::part_of;
use gridel_tests::every_format;
use gridel_tests::query::{held, through};
use gridel_tests::random::Random;
use gridel_tests::scenes;

/// Shapes that end in the plane at 1/4 along an axis, with a face of at least 1/4 around the axis there.
fn shapes(axis: DVec3) -> Vec<Shape> {
    let (low, high) = (-0.25 * axis, 0.25 * axis);
    let across = DVec3::ONE - axis.abs();
    let frustum = |base_radius, apex_radius| {
        Shape::Cone(Cone {
            base: low,
            base_radius,
            apex: high,
            apex_radius,
        })
    };
    vec![
        frustum(0.25, 0.25),
        frustum(0.5, 0.25),
        frustum(0.125, 0.5),
        Shape::Box(Cuboid {
            min: low.min(high) - 0.25 * across,
            max: low.max(high) + 0.25 * across,
        }),
        Shape::Disc(Disc {
            center: high,
            normal: axis,
            radius: 0.25,
        }),
    ]
}

fn meets_faces_in<N: Number>(scene: &Scene<'_>, axis: DVec3, random: &mut Random) {
    let header = scene.header();
    let unit = f64::powi(2.0, header.unit_exponent.into());
    let origin = DVec3::from_array(header.origin);
    for _ in 0..part_of(200, 20_000) {
        let mut way = DVec3::from_array(random.direction());
        if way.dot(axis) > 0.0 {
            way = -way;
        }
        let across = DVec3::from_array(random.direction()) * (DVec3::ONE - axis.abs());
        let target = 0.25 * axis + 0.24 * random.unit() * across;
        let from = target - way * random.magnitude(0.5, 1e4);
        // Skips flat rays, which may pass beside the face.
        if way.dot(axis).abs() < 1e-2 {
            continue;
        }
        let from = (from - origin) / unit;
        let ray = Ray::<N>::from_f64(scene.bounds(), from.into(), way.into(), 0.0, 1e9);
        let ray = ray.expect("a ray");
        for structure in held(scene) {
            let (hit, any) = through(structure, scene, &ray);
            let hit = hit.filter(|_| any).expect("a hit");
            let normal = DVec3::from_array(hit.normal.map(N::ratio_to_f64));
            assert!(
                hit.front && normal.dot(axis) > 0.999,
                "{:?} {}: {hit:?}",
                N::FORMAT,
                structure.name()
            );
        }
    }
}

/// A cap of a cylinder in the nearest face of the scene's box was lost by rounding, and its inside hit.
#[test]
fn faces_in_the_scenes_box_are_met_from_outside() {
    let random = &mut Random(0xface);
    for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
        for axis in [axis, -axis] {
            for shape in shapes(axis) {
                let blob = scenes::compact_blob(&scenes::of([shape]), 24);
                let scene = blob.scene().expect("a scene");
                every_format!(meets_faces_in(&scene, axis, random));
            }
        }
    }
}
