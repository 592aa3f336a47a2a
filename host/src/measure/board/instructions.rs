//! The cost of a picture on boards, estimated from recorded figures.
//!
//! Two pictures are recorded in `fixtures/recorded/board.json`, instruction by instruction. They are the quick scene,
//! of simple solids, and the glass chessboard, of cones and cylinders in glass. Their instructions divided by their
//! rays are the least and the most that a ray, with its shading, is known to take. The estimate of a picture is its
//! rays times each of these. Its primitives decide where it lies in between: on boards a test of a cone takes several
//! times as long as one of a box. Meshes are nearer to the least: a ray at suzanne takes 1,110 instructions in `f32`
//! and 1,385 to 1,524 in `fixed`, not shaded. `tests/tests/accuracy.rs` compares these numbers with the recorded ones.

use gridel_core::Format;

/// Recorded costs of pictures on a board in one number format.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureCost {
    /// The name of its core.
    pub core: &'static str,
    /// The name of the board: see [`BOARDS`](super::BOARDS).
    pub machine: &'static str,
    pub format: Format,
    /// Instructions per ray, the least and the most that was recorded.
    pub per_ray: [f64; 2],
}

/// All that were measured, through dual-split nodes.
pub const PICTURE_COSTS: [PictureCost; 3] = [
    PictureCost {
        core: "cortex-m4f",
        machine: "mps2-an386",
        format: Format::F32,
        per_ray: [1843.0, 2896.0],
    },
    PictureCost {
        core: "cortex-m4f",
        machine: "mps2-an386",
        format: Format::Fixed,
        per_ray: [2903.0, 5579.0],
    },
    PictureCost {
        core: "cortex-m3",
        machine: "mps2-an385",
        format: Format::Fixed,
        per_ray: [2997.0, 5800.0],
    },
];

/// Returns the least and the most instructions per pixel of a picture with so many rays per pixel on a board. `board`
/// is its own name or its core's. `None` where the board was not measured in the format.
pub fn instructions(board: &str, format: Format, rays_per_pixel: f64) -> Option<[f64; 2]> {
    let is_it =
        |cost: &&PictureCost| [cost.core, cost.machine].contains(&board) && cost.format == format;
    let cost = PICTURE_COSTS.iter().find(is_it)?;
    Some(cost.per_ray.map(|per_ray| per_ray * rays_per_pixel))
}

/// Returns the cores that were measured.
pub fn core_names() -> Vec<&'static str> {
    let mut names: Vec<_> = PICTURE_COSTS.iter().map(|cost| cost.core).collect();
    names.dedup();
    names
}

/// Returns the boards that were measured, and their cores.
pub fn names() -> Vec<&'static str> {
    let mut names: Vec<_> = PICTURE_COSTS.iter().map(|cost| cost.machine).collect();
    names.dedup();
    names.extend(core_names());
    names
}
