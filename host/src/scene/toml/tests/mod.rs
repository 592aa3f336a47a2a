//! Tests of the format, and what they share.

mod errors;
mod fixtures;
mod hostile;
mod imported_tracks;
mod imports;
mod joints;
mod keys;
mod morph;
mod nested_imports;
mod objects;
mod parts;
mod textures;
mod tracks;
mod transforms;

use crate::scene::{Imported, MoleculeOptions, Object, Scene, SceneError, Shape};
use glam::DVec3;
use std::path::Path;

/// Loads a scene from text; the file is called `scene.toml`.
fn load(text: &str) -> Result<Imported, SceneError> {
    let folder = tempfile::tempdir().unwrap();
    load_in(folder.path(), text)
}

/// Loads a scene from text that stands as `scene.toml` in a folder.
fn load_in(folder: &Path, text: &str) -> Result<Imported, SceneError> {
    let path = folder.join("scene.toml");
    std::fs::write(&path, text).unwrap();
    crate::scene::load(&path, &MoleculeOptions::default())
}

fn scene(text: &str) -> Scene {
    load(text)
        .unwrap_or_else(|error| panic!("{error}; {}", error.remedy))
        .scene
}

/// The error of a text that must be rejected.
fn rejection(text: &str) -> SceneError {
    match load(text) {
        Ok(_) => panic!("accepted:\n{text}"),
        Err(error) => error,
    }
}

/// The example at the end of the format's document.
fn example() -> &'static str {
    let document = include_str!("../../../../docs/SCENE.md");
    let (_, example) = document.rsplit_once("```toml\n").unwrap();
    example.split_once("```").unwrap().0
}

fn named<'s>(scene: &'s Scene, name: &str) -> &'s Object {
    let found = scene.objects.iter().find(|object| object.name == name);
    found.unwrap_or_else(|| {
        let names: Vec<_> = scene.objects.iter().map(|object| &object.name).collect();
        panic!("no {name:?} in {names:?}")
    })
}

fn material_of<'s>(scene: &'s Scene, name: &str) -> &'s str {
    &scene.materials[named(scene, name).material].name
}

/// Six times the volume that a mesh encloses; positive if its fronts are outside.
fn volume(shape: &Shape) -> f64 {
    let Shape::Mesh {
        vertices,
        triangles,
    } = shape
    else {
        panic!("no mesh: {shape:?}")
    };
    let corner = |index: u32| vertices[index as usize];
    let parts = triangles
        .iter()
        .map(|&[a, b, c]| corner(a).dot(corner(b).cross(corner(c))));
    parts.sum()
}

fn assert_near(found: DVec3, expected: DVec3) {
    assert!(
        (found - expected).length() <= 1e-12 * (1.0 + expected.length()),
        "{found} is not {expected}"
    );
}
