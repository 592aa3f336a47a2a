//! Draws pixels for the web page.
//!
//! A crate of its own, because generic code is optimized as the crate that calls it. The page is optimized for size.

use gridel_core::Scene;
use gridel_core::render::Block;
use gridel_host::view::{Drawn, Shot, ViewError};

/// Draws the pixels of blocks, and passes each to `put`.
///
/// # Errors
/// If settings or structure do not fit the scene.
pub fn draw(
    scene: &Scene<'_>,
    shot: &Shot,
    blocks: &mut dyn Iterator<Item = Block>,
    put: &mut dyn FnMut(Block, Drawn),
) -> Result<(), ViewError> {
    gridel_host::view::draw(scene, shot, blocks, put)
}
