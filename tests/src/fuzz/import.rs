//! Scene files and arrays of rays, of any bytes.

use super::agree;
use crate::query::UnitRay;
use crate::scenes;
use gridel_core::Structure;
use gridel_host::blob::Blob;
use gridel_host::compile::{Options, compile};
use gridel_host::npy::read_rays;
use gridel_host::scene::{IMPORTERS, Importer, MoleculeOptions, Scene, Shape, load};
use std::sync::OnceLock;
use tempfile::TempDir;

/// Primitives of a scene that is compiled; larger ones take long and test nothing else.
const MOST_PRIMITIVES: usize = 2000;

/// Reads a scene file, compiles it and loads the blob. The first line is the file's extension, the rest
/// its bytes.
pub fn import(data: &[u8]) {
    let Some(end) = data.iter().position(|&byte| byte == b'\n') else {
        return;
    };
    let mut extensions = IMPORTERS.iter().flat_map(|it| it.extensions);
    if let Some(extension) = extensions.find(|it| it.as_bytes() == &data[..end]) {
        read(extension, &data[end + 1..]);
    }
}

/// Returns seeds of an importer's fuzzing: the format's example, and the corpus of the format.
pub fn seeds(importer: &Importer, corpus: &[Vec<u8>]) -> Vec<Vec<u8>> {
    let is_in_format = |input: &&Vec<u8>| {
        let mut extensions = importer.extensions.iter();
        extensions.any(|it| input.starts_with(format!("{it}\n").as_bytes()))
    };
    let example = format!("{}\n{}", importer.extensions[0], importer.example);
    let committed = corpus.iter().filter(is_in_format).cloned();
    [example.into_bytes()]
        .into_iter()
        .chain(committed)
        .collect()
}

/// Reads a scene file in TOML, compiles it and loads the blob.
pub fn toml(data: &[u8]) {
    read("toml", data);
}

/// Reads an array of rays, and traces some of them in a small scene.
pub fn npy(data: &[u8]) {
    let Ok(rays) = read_rays(data) else {
        return;
    };
    static BLOB: OnceLock<Blob> = OnceLock::new();
    let blob = BLOB.get_or_init(|| scenes::blob(&scenes::soup(5, 8, 0.5), 24));
    let rays: Vec<UnitRay> = rays
        .iter()
        .take(8)
        .map(|ray| UnitRay {
            origin: ray.origin.to_array(),
            direction: ray.direction.to_array(),
            tmin: ray.tmin,
            tmax: ray.tmax,
        })
        .collect();
    agree(&blob.scene().expect("a scene"), &rays);
}

/// Reads a file of these bytes. An error says what is wrong and what to do. A scene compiles, or the compiler says why
/// it does not. A compiled scene loads.
fn read(extension: &str, bytes: &[u8]) {
    let folder = folder();
    let path = folder.path().join("scene").with_extension(extension);
    std::fs::write(&path, bytes).expect("the file is written");
    match load(&path, &MoleculeOptions::default()) {
        Err(error) => assert!(!error.cause.is_empty() && !error.remedy.is_empty()),
        Ok(imported) if primitives(&imported.scene) <= MOST_PRIMITIVES => {
            let options = Options {
                structures: vec![Structure::DualSplit],
                ..Options::default()
            };
            if let Ok(compiled) = compile(&imported.scene, &options) {
                compiled.blob.scene().expect("what was compiled loads");
            }
        }
        Ok(_) => {}
    }
}

fn primitives(scene: &Scene) -> usize {
    let of = |shape: &Shape| match shape {
        Shape::Mesh { triangles, .. } => triangles.len(),
        _ => 1,
    };
    scene.objects.iter().map(|object| of(&object.shape)).sum()
}

/// An empty folder of this thread's own, so that no file leads to another one by chance.
fn folder() -> TempDir {
    tempfile::tempdir().expect("a folder")
}
