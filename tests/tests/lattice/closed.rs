//! Closed meshes stay closed where triangles collapse: their neighbors are cut.

use super::meshes::{Mesh, cut_box, stretched, torus};
use glam::DVec3;
use gridel_core::{Kind, Number, Scene, Structure};
use gridel_host::compile::{CompileError, Compiled, Options, compile};
use gridel_host::scene::Shape;
use gridel_tests::effort::part_of;
use gridel_tests::every_format;
use gridel_tests::query::{UnitRay, held, through};
use gridel_tests::random::Random;
use gridel_tests::scenes;
use rayon::prelude::*;
use std::collections::HashMap;

fn compiled((vertices, triangles): Mesh, lattice_bits: u8) -> Result<Compiled, CompileError> {
    let shape = Shape::Mesh {
        vertices,
        triangles,
    };
    let all = Structure::ALL.into_iter();
    let options = Options {
        structures: all.filter(|structure| structure.is_proved()).collect(),
        lattice_bits,
        ..Options::default()
    };
    compile(&scenes::of([shape]), &options)
}

fn corners(scene: &Scene<'_>) -> impl Iterator<Item = [[i32; 3]; 3]> {
    (0..scene.count(Kind::Triangle)).map(|slot| scene.triangle(slot).expect("a triangle"))
}

/// Returns whether an even number of triangles meet at every edge.
fn is_closed(scene: &Scene<'_>) -> bool {
    let mut edges: HashMap<[[i32; 3]; 2], usize> = HashMap::new();
    for [a, b, c] in corners(scene) {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *edges.entry([from.min(to), from.max(to)]).or_default() += 1;
        }
    }
    edges.into_values().all(|count| count % 2 == 0)
}

fn normal([a, b, c]: [[i32; 3]; 3]) -> [i128; 3] {
    let edge = |to: [i32; 3]| [0, 1, 2].map(|k: usize| i128::from(to[k]) - i128::from(a[k]));
    let (p, q) = (edge(b), edge(c));
    [0, 1, 2].map(|k: usize| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        p[i] * q[j] - p[j] * q[i]
    })
}

/// Returns the number of rays from points inside that miss: at vertices, at edges, and anywhere.
fn leaks<N: Number>(
    scene: &Scene<'_>,
    inside: &(dyn Fn(&mut Random) -> DVec3 + Sync),
    rays: usize,
) -> usize {
    let triangles: Vec<_> = corners(scene).collect();
    let structures: Vec<_> = held(scene).chain([Structure::List]).collect();
    let mut random = Random(0x1eaf);
    (0..rays)
        .map(|number| {
            let from = inside(&mut random).to_array();
            let corners = triangles[random.below(triangles.len())];
            let (a, b) = (corners[random.below(3)], corners[random.below(3)]);
            let part = random.unit();
            let along = |k: usize| f64::from(a[k]) + part * f64::from(b[k] - a[k]);
            let direction = match number % 3 {
                0 => random.direction(),
                _ => [0, 1, 2].map(|k| along(k) / 256.0 - from[k]),
            };
            let Some(ray) = UnitRay::new(from, direction).ready::<N>(scene) else {
                return 0;
            };
            let structure = structures[random.below(structures.len())];
            let (hit, any) = through::<N>(structure, scene, &ray);
            usize::from(hit.is_none() || !any)
        })
        .sum()
}

/// The meshes, and a random point inside of each, not near the surface.
type Inside = fn(&mut Random) -> DVec3;

fn meshes() -> [(&'static str, Mesh, Inside); 3] {
    let ball: Inside = |random| DVec3::from_array(random.direction()) * 0.3 * random.unit();
    let cuboid: Inside = |random| DVec3::from_array([0; 3].map(|_| 0.3 * random.signed()));
    let tube: Inside = |random| {
        let (sin, cos) = (random.unit() * std::f64::consts::TAU).sin_cos();
        DVec3::new(cos, sin, 0.1 * random.signed())
    };
    [
        ("ball", scenes::icosphere(3), ball),
        ("box", cut_box(8), cuboid),
        ("torus", torus(24, 16), tube),
    ]
}

const STRETCHES: [[f64; 3]; 8] = [
    [65_536.0, 1.0, 1.0 / 1024.0],
    [65_536.0, 1.0, 1.0],
    [16_384.0, 1.0, 2.0],
    [1.0, 4096.0, 1.0 / 16.0],
    [3.0, 1.0, 1024.0],
    [1.0, 700.0, 300.0],
    [100.0, 1.0, 97.0],
    [64.0, 1.0, 0.7],
];

/// The state of a mesh after it was stretched.
#[derive(PartialEq)]
enum Outcome {
    NoInside,
    HardlyAny,
    Whole,
    WithSlivers,
}

/// Tests that no ray from inside of a stretched mesh is lost, in any structure and format.
fn lose_none(about: &str, mesh: Mesh, inside: Inside, stretch: DVec3, bits: u8) -> Outcome {
    let compiled = match compiled(stretched(mesh, stretch), bits) {
        Ok(compiled) => compiled,
        Err(CompileError::Flattened { .. }) => return Outcome::NoInside,
        Err(error) => panic!("{about}: {error}"),
    };
    let scene = compiled.blob.scene().expect("loads");
    if scene.count(Kind::Triangle) == 0 {
        return Outcome::Whole;
    }
    assert!(is_closed(&scene), "{about}");
    let header = scene.header();
    let unit = f64::powi(2.0, header.unit_exponent.into());
    let origin = DVec3::from_array(header.origin);
    // Where less than two steps are left the given inside may lie outside.
    if stretch.min_element() * 0.4 < 1.5 * compiled.report.step {
        return Outcome::HardlyAny;
    }
    let inside = |random: &mut Random| (inside(random) * stretch - origin) / unit;
    let rays = part_of(1500, 150_000);
    fn none<N: Number>(
        about: &str,
        scene: &Scene<'_>,
        inside: &(dyn Fn(&mut Random) -> DVec3 + Sync),
        rays: usize,
    ) {
        let leaks = leaks::<N>(scene, inside, rays);
        assert_eq!(leaks, 0, "{about}, {}", N::FORMAT.name());
    }
    every_format!(none(about, &scene, &inside, rays));
    if compiled.report.collapsed.count() > 0 {
        Outcome::WithSlivers
    } else {
        Outcome::Whole
    }
}

/// Rays from inside of stretched meshes, on every lattice on which they collapse in part: none is
/// lost, in any structure and format.
#[test]
fn stretched_closed_meshes_do_not_leak() {
    let cases: Vec<_> = meshes()
        .into_iter()
        .flat_map(|mesh| STRETCHES.map(|stretch| (mesh.clone(), stretch)))
        .flat_map(|(mesh, stretch)| [10, 12, 15, 20, 24].map(|bits| (mesh.clone(), stretch, bits)))
        .collect();
    let results: Vec<Outcome> = cases
        .into_par_iter()
        .map(|((name, mesh, inside), stretch, bits)| {
            let stretch = DVec3::from_array(stretch);
            let about = format!("{name} stretched by {stretch} at {bits} bits");
            lose_none(&about, mesh, inside, stretch, bits)
        })
        .collect();
    let count = |which: Outcome| results.iter().filter(|&it| *it == which).count();
    let with_slivers = count(Outcome::WithSlivers);
    eprintln!(
        "{} meshes: {} have no inside left, {} hardly any, {with_slivers} of the others have slivers",
        results.len(),
        count(Outcome::NoInside),
        count(Outcome::HardlyAny),
    );
    assert!(with_slivers >= 5);
}

/// A wall of two layers, such as a mesh with the backs of its faces, has each sliver twice.
#[test]
fn layers_with_the_same_slivers_do_not_leak() {
    let mut with_slivers = 0;
    for (name, (vertices, mut triangles), inside) in meshes() {
        let backs: Vec<_> = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
        triangles.extend(backs);
        for (stretch, bits) in [([65_536.0, 1.0, 1.0], 20), ([100.0, 1.0, 97.0], 10)] {
            let stretch = DVec3::from_array(stretch);
            let mesh = (vertices.clone(), triangles.clone());
            let about = format!("{name} with backs, stretched by {stretch} at {bits} bits");
            let outcome = lose_none(&about, mesh, inside, stretch, bits);
            with_slivers += usize::from(outcome == Outcome::WithSlivers);
        }
    }
    assert!(with_slivers >= 2);
}

/// The pieces of a triangle have its number, lie in its plane, and together have its area.
#[test]
fn pieces_keep_the_number_of_their_triangle() {
    let mut cut = 0;
    for (_, mesh, _) in meshes() {
        let (vertices, triangles) = stretched(mesh, DVec3::new(3000.0, 1.0, 11.0));
        let compiled = compiled((vertices.clone(), triangles.clone()), 14).expect("compiles");
        let scene = compiled.blob.scene().expect("loads");
        let (header, step) = (scene.header(), compiled.report.step);
        let origin = DVec3::from_array(header.origin);
        let snap = |vertex: u32| {
            let steps = ((vertices[vertex as usize] - origin) / step).round();
            // 1/256 units of a step of 14 bits.
            steps.to_array().map(|x| x as i32 * 1024)
        };
        let mut areas: HashMap<u32, ([i128; 3], usize)> = HashMap::new();
        for (slot, corners) in corners(&scene).enumerate() {
            let number = scene.primitive(Kind::Triangle, slot as u32);
            let (sum, pieces) = areas.entry(number).or_default();
            let area = normal(corners);
            *sum = [0, 1, 2].map(|k| sum[k] + area[k]);
            *pieces += 1;
        }
        assert!(scene.count(Kind::Triangle) <= triangles.len());
        for (number, (sum, pieces)) in areas {
            assert_eq!(
                sum,
                normal(triangles[number as usize].map(snap)),
                "{number}"
            );
            cut += usize::from(pieces > 1);
        }
    }
    eprintln!("{cut} triangles were cut");
    assert!(cut > 20);
}

/// A fan of slivers along a line, one triangle along all of it, and one at each of its parts. Every
/// corner of the fan is a vertex on both sides.
#[test]
fn chains_of_slivers_cut_their_neighbours() {
    const PARTS: u32 = 8;
    let hair = |k: u32| [0.0, 1e-9, -1e-9][k as usize % 3];
    let mut vertices: Vec<DVec3> = (0..=PARTS)
        .map(|k| DVec3::new(f64::from(k), hair(k), 0.0))
        .collect();
    let (above, below) = (PARTS + 1, PARTS + 2);
    vertices.extend([DVec3::new(4.0, 3.0, 4.0), DVec3::new(4.0, 3.0, -4.0)]);
    let mut triangles: Vec<[u32; 3]> = (1..PARTS).map(|k| [0, k, k + 1]).collect();
    triangles.push([0, PARTS, above]);
    triangles.extend((0..PARTS).map(|k| [k + 1, k, below]));
    let compiled = compiled((vertices, triangles), 16).expect("compiles");
    let scene = compiled.blob.scene().expect("loads");
    assert_eq!(compiled.report.collapsed.count(), 7);
    let mut pieces = [0; 16];
    let mut edges: HashMap<[[i32; 3]; 2], usize> = HashMap::new();
    for (slot, [a, b, c]) in corners(&scene).enumerate() {
        pieces[scene.primitive(Kind::Triangle, slot as u32) as usize] += 1;
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *edges.entry([from.min(to), from.max(to)]).or_default() += 1;
        }
    }
    assert_eq!(pieces[..7], [0; 7]);
    assert_eq!(pieces[7], 8);
    assert_eq!(pieces[8..], [1; 8]);
    edges.retain(|[a, b], _| a[1..] == b[1..]);
    assert_eq!(edges.len(), 8);
    assert!(edges.into_values().all(|count| count == 2));
}

/// Slivers in a zigzag would need more pieces than there are triangles.
#[test]
fn zigzags_of_slivers_are_rejected() {
    const POINTS: u32 = 60;
    let mut vertices = vec![DVec3::ZERO];
    vertices.extend((0..POINTS).map(|k| {
        let x = if k % 2 == 0 {
            f64::from(k) + 1.0
        } else {
            200.0 - f64::from(k)
        };
        DVec3::new(x, 1e-9 * f64::from(k), 0.0)
    }));
    let mut triangles: Vec<[u32; 3]> = (1..POINTS).map(|k| [0, k, k + 1]).collect();
    // A triangle of its own at each edge of the fan's border.
    for k in 0..POINTS {
        triangles.push([k + 1, k, vertices.len() as u32]);
        vertices.push(DVec3::new(100.0, 50.0, f64::from(k)));
    }
    let error = compiled((vertices, triangles), 16)
        .map(|_| ())
        .expect_err("too many pieces");
    assert!(matches!(error, CompileError::Slivers { .. }), "{error}");
}

/// A closed mesh that lies in one plane has no inside that a ray could be in.
#[test]
fn flattened_closed_meshes_are_rejected() {
    let flat = DVec3::new(65_536.0, 1.0, 1.0 / 1024.0);
    for (name, mesh, _) in meshes() {
        let error = compiled(stretched(mesh.clone(), flat), 24)
            .map(|_| ())
            .expect_err(name);
        assert!(matches!(error, CompileError::Flattened { .. }), "{error}");
        let (vertices, triangles) = stretched(mesh.clone(), flat);
        let shape = Shape::Mesh {
            vertices,
            triangles,
        };
        let allowed = Options {
            flat_meshes: true,
            ..Options::default()
        };
        compile(&scenes::of([shape]), &allowed).expect("an option allows it");
        // An open sheet is a sheet.
        let (vertices, mut triangles) = stretched(mesh, flat);
        triangles.pop();
        compiled((vertices, triangles), 24).expect("an open mesh");
    }
    // Flat in the file.
    let flat = DVec3::new(65_536.0, 1.0, 0.0);
    compiled(stretched(cut_box(4), flat), 24).expect("a flat mesh");
}
