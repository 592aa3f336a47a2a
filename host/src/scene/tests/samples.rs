//! Helpers of all importers' tests: scenes from bytes and files, and the meshes of a file. Real
//! scene files are not in the repository because of their size or licence.

use crate::scene::{ImportOptions, Imported, Object, SceneError, Shape};
use flate2::Compression;
use flate2::write::GzEncoder;
use glam::DVec3;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Returns a file below the folder in the environment variable `GRIDEL_SCENES`, or else below
/// `../shared/scenes` beside the workspace. If it is missing, the test prints that it is skipped.
pub(in crate::scene) fn find(name: &str) -> Option<PathBuf> {
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

/// Reads a scene from the bytes of a file of this name.
pub(in crate::scene) fn read(
    name: &str,
    bytes: impl Into<Vec<u8>>,
) -> Result<Imported, SceneError> {
    crate::scene::read(Path::new(name), bytes.into(), &ImportOptions::default())
}

/// The bytes, gzipped.
pub(in crate::scene) fn gzipped(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

/// Reads a file that may name files of its own folder alone.
pub(in crate::scene) fn load(path: &Path) -> Result<Imported, SceneError> {
    crate::scene::load_with(path, &ImportOptions::default())
}

/// Reads a file that may name any file.
pub(in crate::scene) fn load_allowing_outside(path: &Path) -> Result<Imported, SceneError> {
    let options = ImportOptions {
        allow_outside: true,
        ..ImportOptions::default()
    };
    crate::scene::load_with(path, &options)
}

/// The vertices and triangles of an object that must be a mesh.
pub(in crate::scene) fn mesh(object: &Object) -> (&[DVec3], &[[u32; 3]]) {
    match &object.shape {
        Shape::Mesh {
            vertices,
            triangles,
        } => (vertices, triangles),
        other => panic!("{other:?} is no mesh"),
    }
}
