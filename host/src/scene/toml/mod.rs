#![doc = include_str!("../../../docs/SCENE.md")]

mod census;
mod document;
mod import;
mod material;
mod object;
mod place;
mod shape;
pub(crate) mod source;
mod transform;
pub(crate) mod value;
mod view;

#[cfg(test)]
mod tests;

use super::access::Access;
use super::{Imported, MoleculeOptions, SceneError};
use import::Imports;
use std::path::Path;

/// Reads a scene file in this format, and the files it imports; molecules among these follow
/// `molecule` where the file does not say otherwise.
///
/// # Errors
/// If a file cannot be read or a file's content is broken; the error shows file, line and remedy.
pub(super) fn load(
    path: &Path,
    molecule: &MoleculeOptions,
    access: &Access,
) -> Result<Imported, SceneError> {
    let mut imports = Imports::new(access);
    let scene = imports.root(path, molecule)?;
    Ok(Imported {
        scene,
        warnings: imports.warnings,
        molecules: imports.molecules,
    })
}
