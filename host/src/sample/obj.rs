//! Meshes as Wavefront OBJ.

use crate::scene::{Scene, Shape};
use std::fmt::Write;

/// Writes the meshes of a scene, each as one object; other shapes are left out, as OBJ has none.
/// Coordinates are written so that they read back to the same bits.
pub fn obj(scene: &Scene) -> String {
    let mut text = String::new();
    let mut first = 1;
    for object in &scene.objects {
        let Shape::Mesh {
            vertices,
            triangles,
        } = &object.shape
        else {
            continue;
        };
        // Writing to a string cannot fail.
        let _ = writeln!(text, "o {}", object.name);
        for vertex in vertices {
            let _ = writeln!(text, "v {} {} {}", vertex.x, vertex.y, vertex.z);
        }
        for triangle in triangles {
            let [a, b, c] = triangle.map(|index| index as usize + first);
            let _ = writeln!(text, "f {a} {b} {c}");
        }
        first += vertices.len();
    }
    text
}
