//! What a picture costs on boards, as far as recorded figures tell.
//!
//! Two pictures are recorded in `fixtures/recorded/board.json`, instruction by instruction: the quick
//! scene, of simple solids, and the glass chessboard, of cones and cylinders in glass. Divided by
//! their rays they give the least and the most that a ray, with its shading, is known to take. A
//! picture's estimate is its rays times either; where a scene lies in between, its primitives
//! decide: on boards a test of a cone takes several times as long as one of a box. Meshes are nearer to
//! the least: a ray at suzanne takes 1,110 instructions in `f32` and 1,385 to 1,524 in `fixed`, not
//! shaded. `tests/tests/accuracy.rs` holds these numbers to the recorded ones.

use super::measure::Point;
use gridel_core::Format;
use serde::Serialize;

/// A board in one number format.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Board {
    /// The name of its core.
    pub name: &'static str,
    /// What it is called elsewhere: see [`BOARDS`](crate::board::BOARDS).
    pub machine: &'static str,
    #[serde(skip)]
    pub format: Format,
    /// Instructions a ray, the least and the most that was recorded.
    pub a_ray: [f64; 2],
}

/// All that were measured, through dual-split nodes.
pub const BOARDS: [Board; 3] = [
    Board {
        name: "cortex-m4f",
        machine: "mps2-an386",
        format: Format::F32,
        a_ray: [1843.0, 2896.0],
    },
    Board {
        name: "cortex-m4f",
        machine: "mps2-an386",
        format: Format::Fixed,
        a_ray: [2903.0, 5579.0],
    },
    Board {
        name: "cortex-m3",
        machine: "mps2-an385",
        format: Format::Fixed,
        a_ray: [2997.0, 5800.0],
    },
];

/// Instructions a pixel of a point on a board, by its own name or its core's, the least and the most;
/// `None` where the board was not measured in the point's format.
pub fn instructions(board: &str, point: &Point) -> Option<[f64; 2]> {
    let is_it = |candidate: &&Board| {
        [candidate.name, candidate.machine].contains(&board)
            && candidate.format == point.setting.format
    };
    let board = BOARDS.iter().find(is_it)?;
    let rays = point.cost.rays as f64 / point.cost.pixels.max(1) as f64;
    Some(board.a_ray.map(|a_ray| a_ray * rays))
}

/// The boards there are, by the names of their cores.
pub fn names() -> Vec<&'static str> {
    let mut names: Vec<_> = BOARDS.iter().map(|board| board.name).collect();
    names.dedup();
    names
}

/// All names of the boards there are, their own ones first.
pub fn all_names() -> Vec<&'static str> {
    let mut names: Vec<_> = BOARDS.iter().map(|board| board.machine).collect();
    names.dedup();
    names.extend(self::names());
    names
}
