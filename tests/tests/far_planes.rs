//! Infinite planes that are hit many times as far away as the scene's box is wide.

use crate::large_scenes::{differing, picture};
use glam::DVec3;
use gridel_core::{Format, List, NoCount, Number, Scene};
use gridel_host::scene::Shape;
use gridel_host::shape::{Cuboid, Plane};
use gridel_tests::measured::compiled;
use gridel_tests::query::{UnitRay, closest, point_of};
use gridel_tests::{every_format, scenes};

/// Rays leave planes from where they are hit, also beyond the lengths of `fixed`: mirrored rays, shadow rays and diffuse
/// ones. The eye is many times as far from the ball as that is wide.
#[test]
fn rays_leave_planes_at_any_distance() {
    const MIRROR: &str = "background = [0, 0, 0.3]
        [camera]
        eye = [0, 0.6, 12]
        target = [0, 0.4, 0]
        fov = 40
        [[light]]
        kind = 'directional'
        direction = [-0.2, -0.3, -1]
        [material.water]
        diffuse = 0.1
        mirror = 0.7
        [material.wall]
        checker = { even = [0.9, 0.2, 0.1], odd = 0.1, size = 1 }
        [[object]]
        kind = 'sphere'
        center = [0, 0.5, 0]
        radius = 0.5
        [[object]]
        kind = 'plane'
        point = [0, 0, 0]
        normal = [0, 1, 0]
        material = 'water'
        [[object]]
        kind = 'plane'
        point = [0, 0, -1.5]
        normal = [0, 0, 1]
        material = 'wall'";
    const SHADOW: &str = "[camera]
        eye = [0, 3, 60]
        target = [0, 0, 20]
        fov = 40
        [[light]]
        kind = 'directional'
        direction = [0, -0.05, 1]
        [[object]]
        kind = 'sphere'
        center = [0, 0.5, 0]
        radius = 0.5
        [[object]]
        kind = 'plane'
        point = [0, 0, 0]
        normal = [0, 1, 0.01]";
    let sky =
        format!("{SHADOW}\n[environment]\nhorizon = 0.2\nzenith = [0.1, 0.2, 0.9]\nground = 0.1");
    let sun = "kind = 'directional'\n        direction = [0, -0.05, 1]";
    assert!(SHADOW.contains(sun));
    let lit_by = |light: &str| SHADOW.replace(sun, light);
    let point = lit_by("kind = 'point'\nposition = [1, 4, -6]\ncolor = 800\nfalloff = 'square'");
    let area = lit_by("kind = 'sphere'\ncenter = [1, 6, -6]\nradius = 0.5\nradiance = 2000");
    for file in [MIRROR, SHADOW, &sky, &point, &area] {
        let imported =
            gridel_host::scene::read("far.toml".as_ref(), file.into(), &Default::default());
        let blob = compiled(&imported.expect("a scene").scene);
        let size = [160, 120];
        let exact = picture(&blob, Format::F64, size);
        for format in [Format::Fixed, Format::F32] {
            let found = differing(&exact, &picture(&blob, format, size));
            assert!(found <= 8, "{file}\n{format:?}: {found} pixels");
        }
    }
}

/// Hits have their own point up to 2^18 units less 16. Farther away in `fixed` the point is another one of the plane,
/// with room for starts beside it.
#[test]
fn points_of_planes_are_exact_up_to_room_for_errors() {
    const EDGE: f64 = 262_144.0;
    const HEIGHT: f64 = 524_288.0;
    fn one<N: Number>(scene: &Scene<'_>, [strip, upright]: [usize; 2], rise: f64) {
        let unit = f64::powi(2.0, scene.header().unit_exponent.into());
        for sign in [1.0, -1.0] {
            for short in [
                300.0, 40.0, 33.0, 32.0, 31.0, 17.0, 16.25, 15.75, 8.0, 1.0, 0.0, -1.0, -40.0, -1e6,
            ] {
                let place = sign * (EDGE - short);
                let (mut origin, mut down) = ([0.0; 3], [0.0; 3]);
                (origin[strip], origin[upright], down[upright]) = (place, HEIGHT, -1.0);
                let ray = UnitRay::new(origin, down).ready::<N>(scene);
                let ray = ray.expect("a ray");
                let hit = closest::<N, List>(scene, &ray, &mut NoCount).expect("a hit");
                let about = || format!("{} {origin:?} {rise}: {hit:?}", N::FORMAT.name());
                let middle = scene.header().origin;
                let line = |at: f64| (rise * (at + middle[strip] / unit)) - middle[upright] / unit;
                let error = 4.0 * hit.error.length_to_f64() + 0.01;
                let t = HEIGHT - line(place);
                assert!((N::far_to_f64(hit.t) - t).abs() <= 0.25, "{}", about());
                let point = point_of(&hit);
                let off = (point[upright] - line(point[strip])).abs();
                assert!(off <= error, "{off} {}", about());
                let is_there = (point[strip] - place).abs() <= error;
                let is_exact = N::FORMAT != Format::Fixed || short > 16.0;
                assert_eq!(is_there, is_exact, "{}", about());
                for start in [hit.outside(), hit.inside(scene)] {
                    let apart = start.map(N::length_to_f64)[strip] - point[strip];
                    assert!(apart.abs() <= error, "{}", about());
                }
            }
        }
    }
    for strip in 0..3 {
        let upright = (strip + 1) % 3;
        for rise in [0.0, 0.25, -1.0 / 1024.0] {
            let mut normal = DVec3::AXES[upright];
            normal[strip] = -rise;
            let ground = Shape::Plane(Plane {
                point: DVec3::ZERO,
                normal,
            });
            let cube = Shape::Box(Cuboid {
                min: DVec3::NEG_ONE,
                max: DVec3::ONE,
            });
            let blob = scenes::blob(&scenes::of([ground, cube]), 24);
            let scene = blob.scene().expect("a scene");
            every_format!(one(&scene, [strip, upright], rise));
        }
    }
}

/// Light and mirrored rays leave a plane just inside of 2^18 units and just beyond from where they are, along every axis.
/// A unit is 2^-13 here.
#[test]
fn rays_leave_planes_at_the_end_of_lengths_from_their_place() {
    for axis in 0..3 {
        for sign in [1.0, -1.0] {
            for (mirror, eye, look) in [
                // Down on the strip from the scene, and along it to the scene.
                (0.0, [0.0, 0.05, 31.9], [0.0, 0.0, 31.9985]),
                (0.9, [0.5, 0.005, 32.1], [0.5, 0.0, 31.999]),
            ] {
                let turned = |v: [f64; 3]| {
                    let mut turned = [0.0; 3];
                    for (k, x) in v.into_iter().enumerate() {
                        turned[(axis + 1 + k) % 3] = x * [1.0, 1.0, sign][k];
                    }
                    turned
                };
                let [eye, look, light, first, second, up] = [
                    eye,
                    look,
                    [2.0, 6.0, -4.0],
                    [0.0, 1.0, 0.0],
                    [2.0, 1.0, 0.0],
                    [0.0, 1.0, 0.0],
                ]
                .map(turned);
                let fov = if mirror == 0.0 { 4.0 } else { 0.2 };
                let file = format!(
                    "background = [0.4, 0.6, 0.9]
                    ambient = 0.02
                    [camera]
                    eye = {eye:?}
                    target = {look:?}
                    up = {up:?}
                    fov = {fov}
                    [[light]]
                    kind = 'point'
                    position = {light:?}
                    color = 3
                    [material.ground]
                    diffuse = 0.8
                    mirror = {mirror}
                    [[object]]
                    kind = 'sphere'
                    center = {first:?}
                    radius = 1
                    [[object]]
                    kind = 'sphere'
                    center = {second:?}
                    radius = 1
                    [[object]]
                    kind = 'plane'
                    point = [0, 0, 0]
                    normal = {up:?}
                    material = 'ground'"
                );
                let name = "strip.toml".as_ref();
                let imported =
                    gridel_host::scene::read(name, file.clone().into(), &Default::default());
                let blob = compiled(&imported.expect("a scene").scene);
                let scene = blob.scene().expect("a scene");
                assert_eq!(scene.header().unit_exponent, -13, "{file}");
                let middle = scene.header().origin;
                assert_eq!(middle[axis], 0.0, "{file}");
                let size = [64, 64];
                let exact = picture(&blob, Format::F64, size);
                for format in [Format::Fixed, Format::F32] {
                    let found = differing(&exact, &picture(&blob, format, size));
                    assert!(found <= 8, "{file}\n{format:?}: {found} pixels");
                }
            }
        }
    }
}
