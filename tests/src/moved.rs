//! A scene elsewhere: scaled, shifted, mirrored, turned.

use glam::DVec3;
use gridel_host::scene::Scene;
use gridel_host::shape::Map;

/// Returns a scene with a linear function applied to every vector. Every length is multiplied, and
/// every point shifted.
pub fn with(scene: &Scene, turn: impl Fn(DVec3) -> DVec3, scale: f64, shift: DVec3) -> Scene {
    let mut moved = scene.clone();
    for object in &mut moved.objects {
        object.shape = object.shape.map(&Map {
            point: &|point| turn(point) + shift,
            direction: &turn,
            length: &|length| length * scale,
        });
    }
    moved
}
