//! How normal maps lie on texture coordinates: their `KHR_texture_transform`, which the reader of glTF leaves out.

use crate::scene::texture::texture_transform;
use glam::{DAffine2, DVec2};
use gltf::json::Value;
use std::collections::HashMap;

/// A transform of texture coordinates, and their set, if it names another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct NormalTransform {
    pub set: Option<u32>,
    pub transform: DAffine2,
}

/// The transforms of normal maps, by the numbers of their materials.
pub(super) type NormalTransforms = HashMap<usize, NormalTransform>;

const EXTENSION: &str = "KHR_texture_transform";

/// Reads the transforms of the JSON text of a file, which is valid.
pub(super) fn read(text: &[u8]) -> NormalTransforms {
    let has = |word: &str| {
        text.windows(word.len())
            .any(|part| part == word.as_bytes())
    };
    // Seldom, so what follows is seldom read twice.
    if !has(EXTENSION) || !has("normalTexture") {
        return NormalTransforms::default();
    }
    let document: Value = gltf::json::deserialize::from_slice(text).unwrap_or_default();
    let materials = document["materials"].as_array().into_iter().flatten();
    let found = materials.enumerate().filter_map(|(number, material)| {
        let extension = &material["normalTexture"]["extensions"][EXTENSION];
        extension.is_object().then(|| (number, of(extension)))
    });
    found.collect()
}

fn of(extension: &Value) -> NormalTransform {
    // In single precision, as the numbers of other textures are read.
    let number = |value: &Value| value.as_f64().map(|it| f64::from(it as f32));
    let pair = |key: &str, default: DVec2| {
        let pair = &extension[key];
        match (number(&pair[0]), number(&pair[1])) {
            (Some(x), Some(y)) => DVec2::new(x, y),
            _ => default,
        }
    };
    let rotation = number(&extension["rotation"]).unwrap_or(0.0);
    let scale = pair("scale", DVec2::ONE);
    NormalTransform {
        set: extension["texCoord"].as_u64().map(|it| it as u32),
        transform: texture_transform(scale, rotation, pair("offset", DVec2::ZERO)),
    }
}
