//! Every structure against the plain list, ray by ray, to the last bit.
//!
//! By default 4,000 rays per scene and format, 60,000 with `GRIDEL_FULL=1`. `cargo
//! test -- --ignored --nocapture` traces the 10^6 that the project promises, and takes some
//! minutes.

use glam::DVec3;
use gridel_core::Number;
use gridel_host::blob::Blob;
use gridel_host::scene::{Scene, Shape};
use gridel_host::shape::{Cuboid, Disc, Sphere};
use gridel_tests::agreement::{Tally, compare};
use gridel_tests::effort::part_of;
use gridel_tests::every_format;
use gridel_tests::{rays, scenes};
use rayon::prelude::*;

/// The amount of a scene to compare in one format.
#[derive(Clone, Copy)]
struct Amount {
    rays: usize,
    /// Tests of primitives in the list.
    list_tests: u64,
}

fn quick() -> Amount {
    Amount {
        rays: part_of(4_000, 60_000),
        list_tests: part_of(1_000_000, 20_000_000) as u64,
    }
}
/// The list's share is what takes the time: 3 x 10^9 tests of primitives per scene, 10 s per core.
const FULL: Amount = Amount {
    rays: 1_000_000,
    list_tests: 1_000_000_000,
};
/// Parts that a scene's rays are compared in, at the same time.
const PARTS: usize = 8;

/// The amount with tables of candidates, too.
fn tables() -> Amount {
    Amount {
        rays: part_of(1_000, 3_000),
        list_tests: part_of(500_000, 2_000_000) as u64,
    }
}

fn compare_scene(name: &str, scene: &Scene, lattice_bits: u8, amount: Amount) {
    compare_blob(name, &scenes::blob(scene, lattice_bits), amount);
}

fn compare_blob(name: &str, blob: &Blob, amount: Amount) {
    let scene = blob.scene().expect("a scene");
    fn compare_format<N: Number>(name: &str, scene: &gridel_core::Scene<'_>, amount: Amount) {
        let parts = (0..PARTS).into_par_iter().map(|part| {
            let rays = rays::rays(scene, 7 + part as u64).take(amount.rays / PARTS);
            compare::<N>(name, scene, rays, amount.list_tests / PARTS as u64)
        });
        parts.reduce(Tally::default, Tally::plus).report::<N>(name);
    }
    every_format!(compare_format(name, &scene, amount));
}

fn soups(amount: Amount) {
    compare_scene("soup of 40", &scenes::soup(1, 40, 0.5), 24, amount);
    compare_scene("soup of 400", &scenes::soup(2, 400, 0.15), 16, amount);
    compare_scene("soup of 4000", &scenes::soup(3, 4000, 0.05), 24, amount);
    compare_scene("coarse soup", &scenes::soup(4, 300, 0.3), 10, amount);
}

fn hard_scenes(amount: Amount) {
    for (name, scene) in degenerate_scenes() {
        compare_scene(name, &scene, 24, amount);
    }
}

fn fixtures(amount: Amount) {
    for (name, scene) in scenes::fixtures() {
        compare_scene(&name, &scene, 24, amount);
    }
}

fn real_scenes(amount: Amount) {
    let names = [
        "spd/balls_s2.nff",
        "spd/tetra.nff",
        "spd/mount.nff",
        "spd/gears.nff",
        "spd/teapot.nff",
        "meshes/cow.obj",
        "meshes/fandisk.obj",
        "meshes/cornell_box.obj",
    ];
    for path in names.iter().filter_map(|name| scenes::real(name)) {
        let name = path.file_name().unwrap_or_default().display().to_string();
        compare_scene(&name, &scenes::read(&path), 24, amount);
    }
}

/// Scenes that a builder or a walk could stumble over.
fn degenerate_scenes() -> Vec<(&'static str, Scene)> {
    let sphere = |x: f64, radius: f64| {
        Shape::Sphere(Sphere {
            center: DVec3::new(x, 0.25, -0.5),
            radius,
        })
    };
    let once = scenes::soup(5, 24, 0.6);
    let mut twice = once.clone();
    twice.objects.extend(once.objects.clone());
    // A floor of triangles without height, and discs and boxes in its plane.
    let grid = |x: u32, z: u32| DVec3::new(f64::from(x), 0.0, f64::from(z));
    let mut vertices = Vec::new();
    let mut triangles = Vec::new();
    for (x, z) in (0..8).flat_map(|x| (0..8).map(move |z| (x, z))) {
        let first = vertices.len() as u32;
        vertices.extend([
            grid(x, z),
            grid(x + 1, z),
            grid(x, z + 1),
            grid(x + 1, z + 1),
        ]);
        triangles.extend([[0, 2, 1], [1, 2, 3]].map(|face: [u32; 3]| face.map(|v| first + v)));
    }
    let floor = Shape::Mesh {
        vertices,
        triangles,
    };
    let disc = Shape::Disc(Disc {
        center: grid(4, 4),
        normal: DVec3::Y,
        radius: 3.0,
    });
    let slab = Shape::Box(Cuboid {
        min: grid(1, 1),
        max: grid(6, 2),
    });
    let mut line = scenes::of((0..200).map(|place| sphere(f64::from(place), 0.5)));
    line.objects
        .extend(scenes::of([sphere(0.0, 1e-5), sphere(199.0, 1e-4)]).objects);
    vec![
        ("everything twice", twice),
        ("a flat floor", scenes::of([floor, disc, slab])),
        ("one sphere", scenes::of([sphere(0.0, 1.0)])),
        ("nothing", Scene::default()),
        (
            "300 of the same",
            scenes::of((0..300).map(|_| sphere(1.0, 2.0))),
        ),
        ("spheres in a row", line),
        (
            "a point of a box",
            scenes::of([Shape::Box(Cuboid {
                min: DVec3::ONE,
                max: DVec3::ONE,
            })]),
        ),
    ]
}

#[test]
fn soups_agree() {
    soups(quick());
}

#[test]
fn degenerate_scenes_agree() {
    hard_scenes(quick());
}

#[test]
fn fixtures_agree() {
    fixtures(quick());
}

#[test]
fn tables_of_candidates_agree() {
    for (name, scene) in scenes::fixtures().into_iter().step_by(part_of(3, 1)) {
        compare_blob(&name, &scenes::blob_with_gridels(&scene, 24, 3), tables());
    }
    for (name, scene) in degenerate_scenes().into_iter().step_by(part_of(3, 1)) {
        compare_blob(name, &scenes::blob_with_gridels(&scene, 24, 2), tables());
    }
}

#[test]
fn real_scenes_agree() {
    real_scenes(quick());
}

#[test]
#[ignore = "10^6 rays per scene and format take minutes"]
fn full_synthetic_scenes_agree() {
    soups(FULL);
    hard_scenes(FULL);
    fixtures(FULL);
}

#[test]
#[ignore = "10^6 rays per scene and format take minutes"]
fn full_real_scenes_agree() {
    real_scenes(FULL);
}
