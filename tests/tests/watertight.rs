//! No ray slips through a closed mesh: aimed at vertices, at edges, and along the lattice.

use glam::DVec3;
use gridel_core::{Bvh, Flagged, Format, Hit, Kind, NoCount, Number, Ray, Scene, Structure};
use gridel_host::blob::Blob;
use gridel_host::scene::Shape;
use gridel_tests::effort::{part_of, step};
use gridel_tests::every_format;
use gridel_tests::query::{UnitRay, closest, held, t_bound, through};
use gridel_tests::random::Random;
use gridel_tests::scenes;
use rayon::prelude::*;
use std::collections::BTreeSet;

fn mesh(vertices: Vec<DVec3>, triangles: Vec<[u32; 3]>, lattice_bits: u8) -> Blob {
    let shape = Shape::Mesh {
        vertices,
        triangles,
    };
    scenes::blob(&scenes::of([shape]), lattice_bits)
}

/// A closed box of given half sizes, every face cut into `n` by `n` squares of two triangles.
fn cut_box(half: DVec3, n: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let first = vertices.len() as u32;
            for (i, j) in (0..=n).flat_map(|i| (0..=n).map(move |j| (i, j))) {
                let place = |k: u32| 2.0 * f64::from(k) / f64::from(n) - 1.0;
                let mut vertex = DVec3::splat(side);
                vertex[(axis + 1) % 3] = place(i);
                vertex[(axis + 2) % 3] = place(j);
                vertices.push(vertex * half);
            }
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                let corner = first + i * (n + 1) + j;
                let (across, both) = (corner + n + 1, corner + n + 2);
                let faces = [[corner, across, both], [corner, both, corner + 1]];
                let turned = |[a, b, c]: [u32; 3]| if side > 0.0 { [a, b, c] } else { [a, c, b] };
                triangles.extend(faces.map(turned));
            }
        }
    }
    (vertices, triangles)
}

/// All vertices of a blob's triangles, and the points at 1/4, 1/3 and 1/2 of every edge, in units.
fn vertices_and_edges(scene: &Scene<'_>) -> Vec<[f64; 3]> {
    let (mut vertices, mut edges) = (BTreeSet::new(), BTreeSet::new());
    for slot in 0..scene.count(Kind::Triangle) {
        let corners = scene.triangle(slot).expect("a triangle");
        for side in 0..3 {
            let (a, b) = (corners[side], corners[(side + 1) % 3]);
            vertices.insert(a);
            edges.insert((a.min(b), a.max(b)));
        }
    }
    let mut points: Vec<_> = vertices
        .iter()
        .map(|v| v.map(|x| f64::from(x) / 256.0))
        .collect();
    for (a, b) in &edges {
        for part in [0.25, 1.0 / 3.0, 0.5] {
            let along = |k: usize| f64::from(a[k]) + part * (f64::from(b[k]) - f64::from(a[k]));
            points.push([0, 1, 2].map(|k| along(k) / 256.0));
        }
    }
    points
}

/// Returns how many rays from a point inside a convex mesh are sent to points of it. Also returns
/// how many of them hit nothing, or hit the mesh a second time.
fn leaks<N: Number>(
    structure: Structure,
    scene: &Scene<'_>,
    from: [f64; 3],
    targets: impl Iterator<Item = [f64; 3]>,
) -> (usize, usize) {
    targets.fold((0, 0), |(rays, leaks), target| {
        let direction = [0, 1, 2].map(|k| target[k] - from[k]);
        let ray = UnitRay::new(from, direction)
            .ready::<N>(scene)
            .expect("a ray");
        let Some(hit) = through::<N>(structure, scene, &ray).0 else {
            return (rays + 1, leaks + 1);
        };
        // At an edge a ray hits two triangles at one place. Each place is known to within its error
        // bound, which a flat angle makes longer along the ray.
        let blur = |ray: &Ray<N>, hit: &Hit<N>| {
            let cosine: f64 = (0..3)
                .map(|k| hit.normal[k].ratio_to_f64() * ray.slope()[k].ratio_to_f64())
                .sum();
            t_bound(ray, hit) / cosine.abs()
        };
        let t = N::far_to_f64(hit.t);
        let behind = UnitRay {
            tmin: t + blur(&ray, &hit),
            ..UnitRay::new(from, direction)
        };
        let behind = behind.ready::<N>(scene).expect("a ray");
        let again = through::<N>(structure, scene, &behind).0;
        let twice = again.is_some_and(|next| {
            N::far_to_f64(next.t) - t > blur(&ray, &hit) + blur(&behind, &next)
        });
        (rays + 1, leaks + usize::from(twice))
    })
}

/// 10^7 rays per format, shared by all structures, at vertices and at random places of edges.
fn random_targets(scene: &Scene<'_>, seed: u64) -> impl Iterator<Item = [f64; 3]> {
    let triangles: Vec<_> = (0..scene.count(Kind::Triangle))
        .filter_map(|slot| scene.triangle(slot))
        .collect();
    let mut random = Random(seed);
    std::iter::repeat_with(move || {
        let corners = triangles[random.below(triangles.len())];
        let side = random.below(3);
        let (a, b) = (corners[side], corners[(side + 1) % 3]);
        let part = if random.one_in(3) { 0.0 } else { random.unit() };
        [0, 1, 2].map(|k| (f64::from(a[k]) + part * f64::from(b[k] - a[k])) / 256.0)
    })
}

/// Counts leaks and double hits on random places of a closed convex mesh, through every structure.
fn no_leaks_anywhere<N: Number>(name: &str, scene: &Scene<'_>, rays: usize) {
    const BATCH: usize = 5000;
    let structures: Vec<_> = held(scene).collect();
    for &structure in &structures {
        let batches = (rays / structures.len()).div_ceil(BATCH);
        let counts = (0..batches).into_par_iter().map(|batch| {
            let targets = random_targets(scene, batch as u64).take(BATCH);
            leaks::<N>(structure, scene, [0.0; 3], targets)
        });
        let (rays, leaks) = counts.reduce(|| (0, 0), |a, b| (a.0 + b.0, a.1 + b.1));
        let (structure, format) = (structure.name(), N::FORMAT.name());
        eprintln!(
            "{name:24} {format:5} {structure:8}: {rays:8} rays, {leaks} leaks or double hits"
        );
        assert_eq!(leaks, 0, "{name}, {format}, {structure}");
    }
}

/// Rays from inside closed meshes: a ball, and boxes stretched by 65536 : 1 : 1/1024. The full run
/// has 10^7 rays per mesh in every format.
#[test]
fn closed_meshes_have_no_hole_and_no_double_edge() {
    let meshes = [
        ("ball", scenes::icosphere(4)),
        (
            "stretched",
            cut_box(DVec3::new(1.0, 1.0 / 65_536.0, 1.0 / 1024.0), 8),
        ),
        (
            "stretched otherwise",
            cut_box(DVec3::new(1.0 / 1024.0, 1.0, 1.0 / 65_536.0), 8),
        ),
    ];
    for (name, (vertices, triangles)) in meshes {
        let blob = mesh(vertices, triangles, 24);
        let scene = blob.scene().expect("a scene");
        let rays = part_of(4_000, 10_000_000);
        every_format!(no_leaks_anywhere(name, &scene, rays));
    }
}

/// Counts leaks of a closed mesh; brute force traces every `list_step`th ray.
fn no_leaks<N: Number>(name: &str, scene: &Scene<'_>, from: [f64; 3], list_step: usize) {
    let targets = vertices_and_edges(scene);
    let all = || targets.iter().copied().step_by(step());
    let listed = leaks::<N>(Structure::List, scene, from, all().step_by(list_step));
    let results = held(scene)
        .map(|structure| (structure, leaks::<N>(structure, scene, from, all())))
        .chain([(Structure::List, listed)]);
    for (structure, (rays, leaks)) in results {
        let structure = structure.name();
        let format = N::FORMAT.name();
        eprintln!("{name:24} {format:5} {structure:8}: {rays:7} rays, {leaks} leaks");
        assert_eq!(leaks, 0, "{name}, {format}, {structure}");
    }
}

fn icosphere_does_not_leak(list_step: usize) {
    for lattice_bits in [16, 24] {
        let (vertices, triangles) = scenes::icosphere(5);
        assert_eq!(triangles.len(), 20_480);
        let blob = mesh(vertices, triangles, lattice_bits);
        let scene = blob.scene().expect("a scene");
        assert_eq!(scene.count(Kind::Triangle), 20_480, "the lattice took some");
        assert_eq!(vertices_and_edges(&scene).len(), 102_402);
        let name = format!("icosphere, {lattice_bits} bits");
        every_format!(no_leaks(&name, &scene, [0.0; 3], list_step));
        every_format!(no_leaks(
            &name,
            &scene,
            [9000.25, -7000.5, 1234.125],
            list_step * 8
        ));
    }
}

#[test]
fn the_icosphere_is_closed() {
    icosphere_does_not_leak(480);
}

#[test]
#[ignore = "102,402 rays against a list of 20,480 triangles take minutes"]
fn the_icosphere_is_closed_in_the_full_list() {
    icosphere_does_not_leak(1);
}

/// Stretched by 65536 to 1 to 1/1024, where an interpolated t goes wrong.
#[test]
fn stretched_boxes_are_closed() {
    let sizes = [
        [1.0, 1.0 / 65_536.0, 1.0 / 1024.0],
        [1.0 / 1024.0, 1.0, 1.0 / 65_536.0],
        [1.0, 1.0, 1.0 / 65_536.0],
        [0.7, 0.3, 0.9],
    ];
    for size in sizes {
        for lattice_bits in [16, 24] {
            let (vertices, triangles) = cut_box(DVec3::from_array(size), 8);
            let shape = Shape::Mesh {
                vertices,
                triangles,
            };
            let Some(blob) = scenes::blob_with_inside(&scenes::of([shape]), lattice_bits) else {
                assert_eq!(lattice_bits, 16, "the lattice of 24 bits left no inside");
                continue;
            };
            let scene = blob.scene().expect("a scene");
            let name = format!("box {size:?}, {lattice_bits}");
            every_format!(no_leaks(&name, &scene, [0.0; 3], 1));
        }
    }
}

/// Rays exactly along an axis, through vertices: from outside each meets the mesh, with both signs
/// of zero and in both directions.
#[test]
fn axis_parallel_rays_through_vertices_hit() {
    fn through_vertices<N: Number>(name: &str, scene: &Scene<'_>) {
        let (mut rays, mut rim) = (0, 0);
        for target in vertices_and_edges(scene).into_iter().step_by(step()) {
            // On the silhouette a ray may touch or pass.
            for axis in 0..3 {
                for (sign, zero) in [(1.0, 0.0), (-1.0, -0.0), (1.0, -0.0)] {
                    let (mut origin, mut direction) = (target, [zero; 3]);
                    origin[axis] = -sign * 40_000.0;
                    direction[axis] = sign;
                    let ray = UnitRay::new(origin, direction)
                        .ready::<N>(scene)
                        .expect("a ray");
                    let plain = closest::<N, Bvh>(scene, &ray, &mut NoCount);
                    for structure in held(scene) {
                        assert_eq!(plain, through::<N>(structure, scene, &ray).0);
                    }
                    let radius = [1, 2].map(|k| target[(axis + k) % 3]);
                    let inside =
                        radius[0].hypot(radius[1]) < 0.98 * f64::from(scene.bounds().0[0][1]);
                    rays += usize::from(inside);
                    rim += usize::from(!inside);
                    assert!(
                        plain.is_some() || !inside,
                        "{name}, {}: {target:?}",
                        N::FORMAT.name()
                    );
                }
            }
        }
        eprintln!(
            "{name:24} {:5}: {rays} rays along axes hit; {rim} at the rim",
            N::FORMAT.name()
        );
    }
    for lattice_bits in [16, 24] {
        let (vertices, triangles) = scenes::icosphere(4);
        let blob = mesh(vertices, triangles, lattice_bits);
        let scene = blob.scene().expect("a scene");
        let name = format!("icosphere, {lattice_bits} bits");
        every_format!(through_vertices(&name, &scene));
    }
}

/// A ray enters a closed mesh as often as it leaves it, counted by continuing behind every hit.
#[test]
fn rays_enter_as_often_as_they_leave() {
    fn parity<N: Number>(name: &str, scene: &Scene<'_>, rays: usize) {
        let mut random = Random(11);
        let (mut crossings, mut odd) = (0, 0);
        for _ in 0..rays {
            let target = [0; 3].map(|_| random.signed() * 25_000.0);
            let direction = random.direction();
            let mut ray =
                UnitRay::new([0, 1, 2].map(|k| target[k] - 2e5 * direction[k]), direction);
            let mut depth = 0_i32;
            while let Some(hit) = ray
                .ready::<N>(scene)
                .and_then(|ray| closest::<N, Flagged>(scene, &ray, &mut NoCount))
            {
                depth += if hit.front { 1 } else { -1 };
                crossings += 1;
                let t = N::far_to_f64(hit.t);
                // The next t that the format distinguishes from this one, where these rays start.
                ray.tmin = t + f64::powi(2.0, if N::FORMAT == Format::F32 { -5 } else { -12 });
                assert!(crossings < 100 * rays, "a ray that never ends");
            }
            odd += usize::from(depth != 0);
        }
        eprintln!(
            "{name:24} {:5}: {rays} rays, {crossings} crossings, {odd} odd",
            N::FORMAT.name()
        );
        assert_eq!(odd, 0, "{name}, {}", N::FORMAT.name());
    }
    let (vertices, triangles) = scenes::icosphere(3);
    // Not convex: a bumpy ball.
    let bumpy = vertices
        .iter()
        .enumerate()
        .map(|(i, &v)| v * if i % 3 == 0 { 0.7 } else { 1.0 });
    let blob = mesh(bumpy.collect(), triangles, 24);
    let scene = blob.scene().expect("a scene");
    every_format!(parity("bumpy ball", &scene, 40_000));
}
