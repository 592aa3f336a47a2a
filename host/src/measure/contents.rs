//! The structures of a blob, and its longest leaf.

use gridel_core::{Scene, Structure};

/// Returns the names of the structures that a scene holds, in the order of [`Structure::ALL`].
pub fn structure_names(scene: &Scene<'_>) -> Vec<&'static str> {
    let all = Structure::ALL.into_iter();
    let held = all.filter(|&structure| scene.holds(structure));
    held.map(Structure::name).collect()
}

/// Returns the most primitives in a leaf, of the scene and of its parts.
pub fn longest_leaf(scene: &Scene<'_>) -> u16 {
    let parts = scene.parts().iter().map(|part| part.header().longest_leaf);
    parts.fold(scene.header().longest_leaf, u16::max)
}
