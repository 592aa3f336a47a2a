//! Writes the needs of a blob as Rust constants for the program that it is built into.
//!
//! A crate beside the build script: the script would be compiled with the features of the core that a program
//! chooses, and the core for it anew.

use gridel_core::scene::part_blobs;
use gridel_core::{BlobError, Requirements, Scene, Tracks};

/// The constants of a blob, which is checked as the board will check it.
///
/// # Errors
/// If the blob is invalid.
pub fn constants(bytes: &[u8]) -> Result<String, BlobError> {
    let mut aligned = vec![0_u128; bytes.len().div_ceil(size_of::<u128>())];
    let aligned: &mut [u8] = bytemuck::cast_slice_mut(&mut aligned);
    aligned[..bytes.len()].copy_from_slice(bytes);
    of(&aligned[..bytes.len()])
}

fn of(blob: &[u8]) -> Result<String, BlobError> {
    let parts: Vec<_> = part_blobs(blob)?
        .map(Scene::from_bytes)
        .collect::<Result<_, _>>()?;
    let scene = Scene::with_parts(blob, &parts)?;
    let tracks = Tracks::from_bytes(blob)?;
    let requirements = Requirements::of(blob)?;
    Ok(format!(
        "/// Entries of the traversal stack.\n\
         pub const STACK_DEPTH: usize = {};\n\
         /// Places for rays that wait.\n\
         pub const WORK_DEPTH: usize = {};\n\
         /// The effects that the scene requires.\n\
         pub const EFFECTS: u32 = {};\n\
         /// Pixels of a row.\n\
         pub const WIDTH: usize = {};\n\
         /// Vertices of all meshes.\n\
         pub const VERTICES: usize = {};\n\
         /// Pairs of the hierarchy of boxes.\n\
         pub const PAIRS: usize = {};\n\
         /// Normals that morph targets change.\n\
         pub const MOVING_NORMALS: usize = {};\n\
         /// Morph targets of the scene.\n\
         pub const MORPH_TARGETS: usize = {};\n\
         /// Parts of the scene.\n\
         pub const PARTS: usize = {};\n\
         /// Instances of the scene.\n\
         pub const INSTANCES: usize = {};\n\
         /// Joints on which instances hang.\n\
         pub const JOINTS: usize = {};\n\
",
        scene.stack_depth(),
        scene.effects().work_depth(scene.view().depth),
        scene.effects().0,
        scene.view().width,
        requirements.vertices,
        requirements.pairs,
        requirements.moving_normals,
        requirements.morph_targets,
        parts.len(),
        scene.instances().len(),
        tracks.joints().len(),
    ))
}
