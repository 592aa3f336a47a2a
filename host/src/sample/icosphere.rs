//! A sphere of triangles.

use super::lit;
use crate::scene::{Material, Object, Scene, Shape, SourceSpan};
use glam::DVec3;
use std::collections::HashMap;

/// The most levels whose vertices a 32-bit index counts, with room to spare for memory.
const MOST_LEVELS: u32 = 9;

/// Returns a closed sphere of radius 1 around the origin. It is an icosahedron whose triangles are
/// cut in four `levels` times (at most 9). That makes 20 * 4^levels triangles, 20,480 at level 5.
///
/// ```
/// use gridel_host::scene::Shape;
///
/// let scene = gridel_host::sample::icosphere(2);
/// assert!(matches!(&scene.objects[0].shape, Shape::Mesh { .. }));
/// ```
pub fn icosphere(levels: u32) -> Scene {
    let (mut vertices, mut triangles) = icosahedron();
    for _ in 0..levels.min(MOST_LEVELS) {
        let mut middles: HashMap<[u32; 2], u32> = HashMap::new();
        let mut finer = Vec::with_capacity(4 * triangles.len());
        for [a, b, c] in triangles {
            let mut middle = |a: u32, b: u32| {
                *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                    vertices.push((vertices[a as usize] + vertices[b as usize]).normalize());
                    vertices.len() as u32 - 1
                })
            };
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            finer.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
        }
        triangles = finer;
    }
    let points = vertices.clone();
    let sphere = Object {
        name: "icosphere".to_owned(),
        material: 0,
        shape: Shape::Mesh {
            vertices,
            triangles,
        },
        place: SourceSpan::default(),
        normals: Default::default(),
        attributes: Default::default(),
    };
    lit(
        Scene {
            materials: vec![Material::default()],
            objects: vec![sphere],
            ..Scene::default()
        },
        &points,
        0.0,
    )
}

/// Two poles and between them two rings of five vertices.
fn icosahedron() -> (Vec<DVec3>, Vec<[u32; 3]>) {
    // The rings lie at the latitude whose tangent is a half.
    let (height, radius) = (1.0 / 5.0_f64.sqrt(), 2.0 / 5.0_f64.sqrt());
    let ring = |height: f64, turn: f64| {
        (0..5).map(move |i| {
            let (sin, cos) = libm::sincos((f64::from(i) + turn) * std::f64::consts::TAU / 5.0);
            DVec3::new(radius * cos, radius * sin, height)
        })
    };
    let mut vertices = vec![DVec3::Z];
    vertices.extend(ring(height, 0.0));
    vertices.extend(ring(-height, 0.5));
    vertices.push(-DVec3::Z);
    let mut triangles = Vec::new();
    for i in 0..5 {
        let next = (i + 1) % 5;
        let (upper, upper_next, lower, lower_next) = (1 + i, 1 + next, 6 + i, 6 + next);
        triangles.extend([
            [0, upper, upper_next],
            [upper, lower, upper_next],
            [lower, lower_next, upper_next],
            [11, lower_next, lower],
        ]);
    }
    (vertices, triangles)
}
