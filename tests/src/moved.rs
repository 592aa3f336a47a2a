//! The same scene elsewhere: scaled, shifted, mirrored, turned.

use glam::DVec3;
use gridel_host::scene::{Scene, Shape};

/// A scene with every vector put through a linear function, every length multiplied, and every
/// point shifted.
pub fn with(scene: &Scene, turn: impl Fn(DVec3) -> DVec3, scale: f64, shift: DVec3) -> Scene {
    let mut moved = scene.clone();
    let (point, length) = (|p| turn(p) + shift, |x: f64| x * scale);
    for object in &mut moved.objects {
        object.shape = match &object.shape {
            Shape::Sphere { center, radius } => Shape::Sphere {
                center: point(*center),
                radius: length(*radius),
            },
            Shape::Box { min, max } => {
                let (a, b) = (point(*min), point(*max));
                Shape::Box {
                    min: a.min(b),
                    max: a.max(b),
                }
            }
            Shape::Disc {
                center,
                normal,
                radius,
            } => Shape::Disc {
                center: point(*center),
                normal: turn(*normal),
                radius: length(*radius),
            },
            Shape::Torus {
                center,
                axis,
                major_radius,
                minor_radius,
            } => Shape::Torus {
                center: point(*center),
                axis: turn(*axis),
                major_radius: length(*major_radius),
                minor_radius: length(*minor_radius),
            },
            Shape::Cone {
                base,
                base_radius,
                apex,
                apex_radius,
            } => Shape::Cone {
                base: point(*base),
                base_radius: length(*base_radius),
                apex: point(*apex),
                apex_radius: length(*apex_radius),
            },
            Shape::Mesh {
                vertices,
                triangles,
            } => Shape::Mesh {
                vertices: vertices.iter().map(|&vertex| point(vertex)).collect(),
                triangles: triangles.clone(),
            },
        };
    }
    moved
}
