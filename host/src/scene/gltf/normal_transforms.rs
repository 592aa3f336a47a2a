//! Reads the transforms of normal maps: their `KHR_texture_transform`, which the reader of glTF leaves out.

use crate::scene::SceneError;
use gltf::json::Value;
use gltf::json::deserialize::{from_slice, from_value};
use gltf::json::extensions::texture::TextureTransform;
use std::collections::HashMap;
use std::path::Path;

/// The transforms of normal maps, by the numbers of their materials.
pub(super) type NormalTransforms = HashMap<usize, TextureTransform>;

const EXTENSION: &str = "KHR_texture_transform";

/// Reads the transforms of the JSON text of a file, which is valid.
///
/// # Errors
/// If a transform is not one of the extension.
pub(super) fn read(path: &Path, text: &[u8]) -> Result<NormalTransforms, SceneError> {
    let has = |word: &str| text.windows(word.len()).any(|part| part == word.as_bytes());
    // Few files have both, so that few are read twice.
    if !has(EXTENSION) || !has("normalTexture") {
        return Ok(NormalTransforms::default());
    }
    let wrong = |what: String, error| {
        let cause = format!("{what} is broken: {error}");
        SceneError::new(path, cause, "export the file again")
    };
    let document: Value =
        from_slice(text).map_err(|error| wrong(String::from("the JSON"), error))?;
    let mut transforms = NormalTransforms::default();
    let materials = document["materials"].as_array();
    for (number, material) in materials.into_iter().flatten().enumerate() {
        // `Null` where a step of the path is missing, or is no object.
        let extension = &material["normalTexture"]["extensions"][EXTENSION];
        if !extension.is_null() {
            let what = || format!("the transform of the normal map of material {number}");
            let transform = from_value(extension.clone()).map_err(|error| wrong(what(), error))?;
            transforms.insert(number, transform);
        }
    }
    Ok(transforms)
}
