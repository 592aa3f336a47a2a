//! Grids and octrees over long parallel triangles: tests per ray stay near those of `bvh`.

use super::meshes::{Mesh, cut_box, stretched, torus};
use glam::DVec3;
use gridel_core::accel::DynAccel;
use gridel_core::{Counters, Kind, Structure};
use gridel_host::compile::{CompileError, Options, compile};
use gridel_host::scene::Shape;
use gridel_tests::query::{UnitRay, closest};
use gridel_tests::random::Random;
use gridel_tests::scenes;

/// Long triangles side by side.
fn sticks(along: DVec3, apart: f64) -> Mesh {
    let mut random = Random(4);
    let mut point = |size: f64| DVec3::from_array([0; 3].map(|_| random.signed() * size));
    let vertices: Vec<DVec3> = (0..1024)
        .flat_map(|_| {
            let (middle, width, along) = (point(apart), point(0.02), along + point(0.05));
            [middle - along, middle + along + width, middle - along * 0.9]
        })
        .collect();
    let triangles = (0..1024).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]);
    (vertices, triangles.collect())
}

const RAYS: usize = 400;

/// Three sorts of rays: between points of the scene's box, in all directions from there, and
/// through it from far away.
fn rays(bounds: [[f64; 2]; 3], sort: usize) -> Vec<UnitRay> {
    let mut random = Random(7);
    let inside = |random: &mut Random| bounds.map(|[low, high]| low + (high - low) * random.unit());
    (0..RAYS)
        .map(|_| {
            let (from, to, along) = (inside(&mut random), inside(&mut random), random.direction());
            match sort {
                0 => UnitRay::new(from, [0, 1, 2].map(|k| to[k] - from[k])),
                1 => UnitRay::new(from, along),
                _ => UnitRay::new([0, 1, 2].map(|k| from[k] - 1e5 * along[k]), along),
            }
        })
        .collect()
}

#[test]
fn grid_and_octree_test_at_most_ten_times_as_many_primitives_as_bvh() {
    let thin = DVec3::new(65_536.0, 1.0, 1.0 / 256.0);
    let needle = DVec3::new(65_536.0, 1.0, 1.0);
    let blade = DVec3::new(1024.0, 1.0, 64.0);
    let meshes = [
        ("ball", scenes::icosphere(4)),
        ("box", cut_box(16)),
        ("thin box", stretched(cut_box(16), thin)),
        ("needle of a box", stretched(cut_box(16), needle)),
        ("blade of a box", stretched(cut_box(16), blade)),
        ("torus", torus(48, 32)),
        ("thin torus", stretched(torus(48, 32), thin)),
        ("needle of a torus", stretched(torus(48, 32), needle)),
        ("blade of a torus", stretched(torus(48, 32), blade)),
        ("needle of a ball", stretched(scenes::icosphere(4), needle)),
        ("bundle", sticks(DVec3::ONE, 0.05)),
        ("sheaf", sticks(DVec3::new(1.0, 0.3, 0.1), 0.5)),
    ];
    let mut exceeded = Vec::new();
    for (name, (vertices, triangles)) in meshes {
        let scene = scenes::of([Shape::Mesh {
            vertices,
            triangles,
        }]);
        let options = Options {
            structures: vec![Structure::Bvh, Structure::Grid, Structure::Octree],
            ..Options::default()
        };
        let compiled = match compile(&scene, &options) {
            Err(CompileError::Flattened { .. }) => continue,
            compiled => compiled.expect("compiles"),
        };
        let scene = compiled.blob.scene().expect("loads");
        // Finer than units.
        let corners = (0..scene.count(Kind::Triangle)).filter_map(|slot| scene.triangle(slot));
        let corners: Vec<[i32; 3]> = corners.flatten().collect();
        let bounds = [0, 1, 2].map(|k: usize| {
            let side = |sign: i32| corners.iter().map(|it| sign * it[k]).max().unwrap_or(0) * sign;
            [-1, 1].map(|sign| f64::from(side(sign)) / 256.0)
        });
        for sort in 0..3 {
            let tests = [Structure::Bvh, Structure::Grid, Structure::Octree].map(|structure| {
                let chosen = scene.choose(structure).expect("held");
                let mut count = Counters::default();
                for ray in rays(bounds, sort) {
                    let ray = ray.ready::<f64>(&scene).expect("a ray");
                    closest::<f64, DynAccel>(&chosen, &ray, &mut count);
                }
                count.primitives as f64 / RAYS as f64
            });
            let [bvh, grid, octree] = tests;
            eprintln!("{name:18} {sort}: {bvh:7.1} {grid:7.1} {octree:7.1}");
            if grid.max(octree) > 10.0 * bvh {
                exceeded.push(format!("{name}, {sort}: {tests:?}"));
            }
        }
    }
    assert!(exceeded.is_empty(), "{exceeded:#?}");
}
