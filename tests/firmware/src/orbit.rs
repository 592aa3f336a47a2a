//! A camera that goes once around a scene; for programs of boards and, to the bit, for the host.

use gridel_core::{Angle, Camera, Scene, Up};

/// Frames of a turn.
pub const FRAMES: u32 = 64;

/// Frames that are moments of one picture while a shutter is open, and the samples per pixel that they share.
pub const MOMENTS: usize = 4;
pub const SAMPLES: u16 = 8;

/// The camera of a frame: as far from the middle of the scene's box as the blob's own on the axis where that is
/// farthest. `None` if it is at the middle.
pub fn camera(scene: &Scene<'_>, frame: u32) -> Option<Camera> {
    let middle = |[low, high]: [i16; 2]| (i64::from(low) + i64::from(high)) << 12;
    let middle = scene.position(scene.bounds().0.map(middle));
    let eye = scene.position(scene.view().eye);
    let away = middle.0.into_iter().zip(eye.0);
    let distance = away.map(|(middle, eye)| middle.abs_diff(eye)).max()?;
    let turn = Angle::of_turn(frame as i32, FRAMES);
    let (elevation, field) = (Angle::degrees(20), Angle::degrees(45));
    Camera::orbit(Up::Y, middle, distance, turn, elevation, field).ok()
}
