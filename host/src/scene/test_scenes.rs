//! What the tests of all importers ask for: real scene files, which are not in the repository because
//! of their size or licence, and the meshes that came of a file.

use super::{Object, Shape};
use glam::DVec3;
use std::path::{Path, PathBuf};

/// A file below the folder that the environment variable `GRIDEL_SCENES` names, or else below
/// `../shared/scenes` beside the workspace; where it is missing, the test says that it is skipped.
pub(super) fn find(name: &str) -> Option<PathBuf> {
    let folder = match std::env::var_os("GRIDEL_SCENES") {
        Some(folder) => PathBuf::from(folder),
        None => Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/scenes"),
    };
    let path = folder.join(name);
    if !path.exists() {
        println!(
            "skipped: {} is missing; set GRIDEL_SCENES to the folder of scene files",
            path.display()
        );
        return None;
    }
    Some(path)
}

/// The vertices and triangles of an object that must be a mesh.
pub(super) fn mesh(object: &Object) -> (&[DVec3], &[[u32; 3]]) {
    match &object.shape {
        Shape::Mesh {
            vertices,
            triangles,
        } => (vertices, triangles),
        other => panic!("{other:?} is no mesh"),
    }
}
