//! Renderings by programs on boards.

use gridel_core::{Format, Scene, Structure};

/// The settings with which a program on a board renders a scene.
#[derive(Clone, Copy, Debug)]
pub struct Rendering {
    /// One of the board's number formats.
    pub format: Format,
    /// A structure of the blob.
    pub structure: Structure,
    /// Pixels in a row.
    pub width: u16,
}

impl Rendering {
    /// Returns the rendering through the best structure of the blob, as wide as the scene file says.
    pub fn of(scene: &Scene<'_>, format: Format) -> Self {
        Self {
            format,
            structure: scene.best_structure(),
            width: scene.view().width,
        }
    }
}
