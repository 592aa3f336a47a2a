//! Gridel's hierarchies against obvhs, on identical rays, interleaved in one run.
//!
//! `cargo bench -p gridel-host --bench peers`. Meshes come from `GRIDEL_SCENES` or
//! `../shared/scenes`; what is absent is left out, loudly. A rate counts everything from a ray's
//! origin and direction in scene units to what all of them answer, t and primitive: Gridel's set-up
//! on the lattice is in its time. Only the ratios within one run mean anything.

use glam::{DVec3, Vec3, Vec3A};
use gridel_core::accel::MAX_STACK_DEPTH;
use gridel_core::{
    Accel, Bvh, Flagged, NoCount, Ray, Scene, Stack, Structure, any_hit, closest_primitive,
};
use gridel_host::compile::{Options, compile};
use gridel_host::scene::{self, Shape};
use obvhs::BvhBuildParams;
use obvhs::bvh2::{Bvh2, builder::build_bvh2_from_tris};
use obvhs::ray::{Ray as PeerRay, RayHit};
use obvhs::triangle::Triangle;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// A ray in scene units.
#[derive(Clone, Copy)]
struct Query {
    origin: Vec3,
    direction: Vec3,
    tmax: f32,
}

/// One way to trace rays: returns how many hit.
type Contender<'c> = (&'static str, Box<dyn Fn(&[Query], bool) -> usize + 'c>);

/// Repeats of each measurement; contenders take turns.
const REPEATS: usize = 9;

fn main() {
    let root = std::env::var_os("GRIDEL_SCENES").map_or_else(
        || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/scenes")),
        PathBuf::from,
    );
    println!(
        "median Mrays/s of {REPEATS} interleaved repeats, one thread; (x) is the ratio to obvhs Bvh2"
    );
    for name in ["suzanne", "stanford-bunny"] {
        let path = root.join(format!("meshes/{name}.obj"));
        if !path.exists() {
            println!("SKIPPED: {} is absent", path.display());
            continue;
        }
        for bits in [16, 24] {
            compare(name, &path, bits);
        }
    }
}

fn compare(name: &str, path: &std::path::Path, lattice_bits: u8) {
    let scene = scene::load(path, &scene::MoleculeOptions::default())
        .expect("a mesh")
        .scene;
    let options = Options {
        lattice_bits,
        structures: vec![Structure::Bvh, Structure::Flagged],
        ..Options::default()
    };
    let compiled = compile(&scene, &options).expect("a blob");
    let flagged_only = compile(
        &scene,
        &Options {
            lattice_bits,
            ..Options::default()
        },
    )
    .expect("a blob");
    let blob = compiled.blob.scene().expect("a sound blob");
    let started = Instant::now();
    flagged_only.blob.scene().expect("a sound blob");
    let load = started.elapsed();

    let triangles: Vec<Triangle> = scene
        .objects
        .iter()
        .filter_map(|object| match &object.shape {
            Shape::Mesh {
                vertices,
                triangles,
            } => Some((vertices, triangles)),
            _ => None,
        })
        .flat_map(|(vertices, triangles)| {
            let vertex = |v: u32| Vec3A::from(vertices[v as usize].as_vec3());
            triangles.iter().map(move |t| Triangle {
                v0: vertex(t[0]),
                v1: vertex(t[1]),
                v2: vertex(t[2]),
            })
        })
        .collect();
    let peer = build_bvh2_from_tris(
        &triangles,
        BvhBuildParams::medium_build(),
        &mut Duration::default(),
    );
    let ordered: Vec<Triangle> = peer
        .primitive_indices
        .iter()
        .map(|&index| triangles[index as usize])
        .collect();
    println!(
        "\n{name}: {} triangles, {lattice_bits} bits; flagged blob {:.1} bytes a triangle, from_bytes {load:?}",
        triangles.len(),
        flagged_only.blob.bytes().len() as f64 / triangles.len() as f64,
    );

    let contenders: [Contender<'_>; 3] = [
        (
            "obvhs Bvh2",
            Box::new(|rays, any| trace_peer(&peer, &ordered, rays, any)),
        ),
        (
            "gridel bvh f32",
            Box::new(|rays, any| trace::<Bvh>(&blob, rays, any)),
        ),
        (
            "gridel flagged f32",
            Box::new(|rays, any| trace::<Flagged>(&blob, rays, any)),
        ),
    ];
    let primary = primary_rays(&scene);
    let bounce = bounce_rays(&peer, &ordered, &primary);
    let shadow: Vec<Query> = bounce
        .iter()
        .map(|ray| Query {
            tmax: f32::INFINITY,
            ..*ray
        })
        .collect();
    for (kind, rays, any) in [
        ("primary", &primary, false),
        ("bounce", &bounce, false),
        ("shadow", &shadow, true),
    ] {
        let mut times = [const { Vec::new() }; 3];
        let mut hits = [0; 3];
        for _ in 0..REPEATS {
            for (number, (_, run)) in contenders.iter().enumerate() {
                let started = Instant::now();
                hits[number] = run(rays, any);
                times[number].push(started.elapsed().as_secs_f64());
            }
        }
        let rates = times.map(|mut times| {
            times.sort_by(f64::total_cmp);
            rays.len() as f64 / times[REPEATS / 2] / 1e6
        });
        print!("  {kind:8}");
        for (number, (contender, _)) in contenders.iter().enumerate() {
            print!(
                " | {contender} {:6.2} ({:.2}) {}",
                rates[number],
                rates[number] / rates[0],
                hits[number]
            );
        }
        println!();
    }
}

/// Rays through the pixels of a square picture of the whole mesh.
fn primary_rays(scene: &scene::Scene) -> Vec<Query> {
    const SIDE: usize = 512;
    let mut bounds = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for object in &scene.objects {
        if let Shape::Mesh { vertices, .. } = &object.shape {
            for &vertex in vertices {
                bounds = (bounds.0.min(vertex), bounds.1.max(vertex));
            }
        }
    }
    let middle = ((bounds.0 + bounds.1) * 0.5).as_vec3();
    let size = (bounds.1 - bounds.0).max_element() as f32;
    let eye = middle + Vec3::new(0.3, 0.2, 1.6) * size;
    let forward = (middle - eye).normalize();
    let right = forward.cross(Vec3::Y).normalize();
    let up = right.cross(forward);
    let pixels = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y)));
    pixels
        .map(|(x, y)| {
            let place = |pixel: usize| (pixel as f32 + 0.5) / SIDE as f32 * 0.7 - 0.35;
            let direction = (forward + right * place(x) - up * place(y)).normalize();
            Query {
                origin: eye,
                direction,
                tmax: f32::INFINITY,
            }
        })
        .collect()
}

/// Rays from what the primary rays hit, in all directions of the half space outside.
fn bounce_rays(peer: &Bvh2, triangles: &[Triangle], primary: &[Query]) -> Vec<Query> {
    let mut state = 0x9e37_79b9_u32;
    let mut random = move || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        state as f32 / u32::MAX as f32 * 2.0 - 1.0
    };
    primary
        .iter()
        .filter_map(|query| {
            let mut hit = RayHit::none();
            let ray = PeerRay::new_inf(query.origin.into(), query.direction.into());
            if !peer.ray_traverse(ray, &mut hit, |ray, id| triangles[id].intersect(ray)) {
                return None;
            }
            let triangle = &triangles[hit.primitive_id as usize];
            let normal = Vec3::from((triangle.v1 - triangle.v0).cross(triangle.v2 - triangle.v0));
            let normal = normal.normalize_or_zero();
            let normal = if normal.dot(query.direction) > 0.0 {
                -normal
            } else {
                normal
            };
            let point = query.origin + query.direction * hit.t;
            let random = Vec3::new(random(), random(), random());
            let direction = (normal * 1.001 + random.normalize_or_zero()).normalize_or(normal);
            Some(Query {
                origin: point + normal * 1e-4,
                direction,
                tmax: f32::INFINITY,
            })
        })
        .collect()
}

fn trace_peer(peer: &Bvh2, triangles: &[Triangle], rays: &[Query], any: bool) -> usize {
    let mut hits = 0;
    for query in rays {
        let ray = PeerRay::new(query.origin.into(), query.direction.into(), 0.0, query.tmax);
        let hit = if any {
            !peer.ray_traverse_miss(ray, |ray, id| triangles[id].intersect(ray))
        } else {
            let mut hit = RayHit::none();
            peer.ray_traverse(ray, &mut hit, |ray, id| triangles[id].intersect(ray))
        };
        hits += usize::from(hit);
    }
    hits
}

fn trace<A: Accel>(scene: &Scene<'_>, rays: &[Query], any: bool) -> usize {
    let header = scene.header();
    let origin = DVec3::from_array(header.origin).as_vec3();
    let scale = f32::powi(2.0, -i32::from(header.unit_exponent));
    let mut stack = Stack::<MAX_STACK_DEPTH>::new();
    let mut hits = 0;
    for query in rays {
        let start = (query.origin - origin) * scale;
        let ray = Ray::<f32>::new(
            scene.bounds(),
            start.to_array(),
            query.direction.to_array(),
            0.0,
            query.tmax,
        );
        let Ok(ray) = ray else { continue };
        let hit = if any {
            any_hit::<f32, A, _>(scene, &ray, stack.as_view(), &mut NoCount)
        } else {
            closest_primitive::<f32, A, _>(scene, &ray, stack.as_view(), &mut NoCount).is_some()
        };
        hits += usize::from(hit);
    }
    hits
}
