//! The rays of the range finder: a fan from above a scene.

use gridel_core::{Position, Scene};

/// Rays of the fan.
pub const RAYS: i32 = 16;

/// The direction of a ray, of any length.
pub fn direction(number: i32) -> [i32; 3] {
    [
        number.wrapping_mul(3).wrapping_sub(22),
        -40,
        number.wrapping_sub(9),
    ]
}

/// Returns the origin of the fan: above the middle of the scene's box, by half of its height.
pub fn place(scene: &Scene<'_>) -> Position {
    let [x, y, z] = scene.bounds().0.map(|side| side.map(i64::from));
    // Units with 13 fraction bits.
    let middle = |[low, high]: [i64; 2]| low.wrapping_add(high) << 12;
    let above = (y[1] << 13).wrapping_add(y[1].wrapping_sub(y[0]) << 12);
    scene.position([middle(x), above, middle(z)])
}

/// The distances that the sensor measures, in steps: up to 1.4 times the height of the scene's box.
pub fn reach(scene: &Scene<'_>) -> [u64; 2] {
    let [_, [low, high], _] = scene.bounds().0;
    let bottom = scene.position([0, i64::from(low) << 13, 0]).0[1];
    let top = scene.position([0, i64::from(high) << 13, 0]).0[1];
    [
        0,
        u64::from(top.wrapping_sub(bottom).unsigned_abs()).wrapping_mul(7) / 5,
    ]
}
