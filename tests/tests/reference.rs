//! Meshes and rays with answers by brute force in double precision, which Embree shares.

use glam::DVec3;
use gridel_core::{Format, Structure};
use gridel_host::scene::{Scene, Shape};
use gridel_host::trace::{Query, SceneHit, SceneRay, trace};
use gridel_tests::scenes;
use std::path::Path;

/// A ray and its answer.
struct Answer {
    ray: SceneRay,
    triangle: Option<u32>,
    t: f64,
}

fn answers(path: &Path) -> Vec<Answer> {
    let text = std::fs::read_to_string(path).expect("a file of rays");
    let json: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let vector = |value: &serde_json::Value| {
        DVec3::from_array([0, 1, 2].map(|k| value[k].as_f64().expect("a number")))
    };
    let rays = json["rays"].as_array().expect("rays");
    rays.iter()
        .map(|ray| Answer {
            ray: SceneRay {
                origin: vector(&ray["o"]),
                tmin: 0.0,
                direction: vector(&ray["d"]),
                tmax: f64::INFINITY,
            },
            triangle: ray["tri"]
                .as_i64()
                .and_then(|number| u32::try_from(number).ok()),
            t: ray["t"].as_f64().unwrap_or(f64::INFINITY),
        })
        .collect()
}

/// A binary STL file as one mesh: 50 bytes per triangle after 84.
fn read_stl(path: &Path) -> Scene {
    let bytes = std::fs::read(path).expect("an STL file");
    let facets = bytes[84..].chunks_exact(50);
    let number =
        |bytes: &[u8]| f64::from(f32::from_le_bytes(bytes.try_into().expect("four bytes")));
    let corner = |bytes: &[u8]| {
        DVec3::new(
            number(&bytes[..4]),
            number(&bytes[4..8]),
            number(&bytes[8..12]),
        )
    };
    let vertices: Vec<DVec3> = facets
        .flat_map(|facet| {
            facet[12..48]
                .chunks_exact(12)
                .map(corner)
                .collect::<Vec<_>>()
        })
        .collect();
    let triangles = (0..vertices.len() as u32 / 3)
        .map(|t| [3 * t, 3 * t + 1, 3 * t + 2])
        .collect();
    scenes::of([Shape::Mesh {
        vertices,
        triangles,
    }])
}

/// An OFF file of triangles as one mesh.
fn read_off(path: &Path) -> Scene {
    let text = std::fs::read_to_string(path).expect("an OFF file");
    let mut numbers = text
        .split_ascii_whitespace()
        .skip(1)
        .map(|word| word.parse::<f64>().expect("a number"));
    let mut next = || numbers.next().expect("another number");
    let (vertices, faces, _) = (next() as usize, next() as usize, next());
    let vertices = (0..vertices)
        .map(|_| DVec3::new(next(), next(), next()))
        .collect();
    let triangles = (0..faces)
        .map(|_| {
            assert_eq!(next(), 3.0, "a face that is no triangle");
            [next() as u32, next() as u32, next() as u32]
        })
        .collect();
    scenes::of([Shape::Mesh {
        vertices,
        triangles,
    }])
}

#[test]
fn answers_agree_with_brute_force() {
    let meshes = [
        "capsule.obj",
        "angle_block.STL",
        "featuretype.STL",
        "cylinder.stl",
        "soup.stl",
        "ballA.off",
    ];
    for mesh in meshes {
        let Some(rays) = scenes::real(&format!("reference/rays_{mesh}.json")) else {
            continue;
        };
        let Some(path) = scenes::real(&format!("meshes/{mesh}")) else {
            continue;
        };
        let scene = match path.extension().and_then(|e| e.to_str()) {
            Some("obj") => scenes::read(&path),
            Some("off") => read_off(&path),
            _ => read_stl(&path),
        };
        let blob = scenes::blob(&scene, 24);
        let scene = blob.scene().expect("a scene");
        let answers = answers(&rays);
        let rays: Vec<SceneRay> = answers.iter().map(|answer| answer.ray).collect();
        let step = f64::powi(2.0, i32::from(scene.header().unit_exponent) - 8);
        for format in Format::ALL {
            let query = Query {
                format,
                structure: Structure::Flagged,
                any: false,
            };
            let mut hits = vec![SceneHit::MISS; rays.len()];
            trace(&scene, &rays, query, &mut hits).expect("a structure");
            compare(mesh, format, step, &answers, &hits);
        }
    }
}

/// Flags must agree. t must agree within the distance that snapping moves a surface, seen at a
/// slant. The triangle must nearly always agree; at an edge or where two coincide either one is
/// right.
fn compare(mesh: &str, format: Format, step: f64, answers: &[Answer], hits: &[SceneHit]) {
    let (mut flags, mut others, mut worst) = (0, 0, 0.0_f64);
    for (answer, hit) in answers.iter().zip(hits) {
        let found = *hit != SceneHit::MISS;
        flags += usize::from(found != answer.triangle.is_some());
        if found && answer.triangle.is_some() {
            others += usize::from(Some(hit.primitive) != answer.triangle);
            worst = worst.max((hit.t - answer.t).abs() * answer.ray.direction.length() / step);
        }
    }
    let format = format.name();
    eprintln!(
        "{mesh:16} {format:5}: {} rays, {flags} wrong flags, {others} other triangles, t off by at \
         most {worst:.2} steps of the lattice",
        answers.len()
    );
    assert!(flags <= 2, "{mesh} {format}");
    assert!(others <= answers.len() / 100, "{mesh} {format}");
    assert!(worst < 1000.0, "{mesh} {format}");
}
