//! Notes of a saved camera about its scene.

use crate::compile::Unstated;

/// Notes on what else the picture of a camera depends on, for comments.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Notes {
    /// Names of the tracks that move the camera, such as `camera.orbit`.
    pub tracks: Vec<&'static str>,
    /// Values that the scene file does not state.
    pub unstated: Unstated,
}
