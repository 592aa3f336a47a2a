mod animation;
mod appearance;
mod cameras;
mod costs;
mod factors;
mod files;
mod geometry;
mod instances;
mod invalid;
mod joints;
mod means;
mod morph;
mod scales;

use super::*;
use crate::scene::tests::samples::{self, load, load_allowing_outside, mesh};
use crate::scene::{
    Alpha, Camera, Diffuse, GltfOptions, ImportOptions, Light, LightForm, Material, Wrap,
};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use glam::DVec3;
use serde_json::{Value, json};

/// Bytes of a unit square in the plane z = 0 and of two triangles of it.
fn square() -> Vec<u8> {
    let positions: [f32; 12] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];
    let corners: [u16; 6] = [0, 1, 2, 0, 2, 3];
    let mut bytes: Vec<u8> = positions.iter().flat_map(|x| x.to_le_bytes()).collect();
    bytes.extend(corners.iter().flat_map(|x| x.to_le_bytes()));
    bytes
}

/// A document of one mesh, the square, in one node.
fn document() -> Value {
    let data = STANDARD.encode(square());
    json!({
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_materials_ior",
            "KHR_materials_transmission", "KHR_materials_volume", "KHR_texture_transform"],
        "scene": 0,
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [
            {"name": "tile", "mesh": 0},
            {"camera": 0, "translation": [0.5, 0.5, 4],
             "extensions": {"KHR_lights_punctual": {"light": 0}}},
        ],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 1}}],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point"}]}},
        "materials": [{"name": "plain", "pbrMetallicRoughness": {"metallicFactor": 0}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
             "min": [0, 0, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 12},
        ],
        "buffers": [{"byteLength": 60, "uri": format!("data:application/octet-stream;base64,{data}")}],
    })
}

fn push(document: &mut Value, list: &str, value: Value) {
    document[list].as_array_mut().unwrap().push(value);
}

pub(in crate::scene) fn text() -> String {
    document().to_string()
}

/// The document as a binary file.
pub(in crate::scene) fn binary() -> Vec<u8> {
    let mut document = document();
    document["buffers"] = json!([{"byteLength": 60}]);
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let chunks = [(text, *b"JSON"), (square(), *b"BIN\0")];
    let length: usize = 12
        + chunks
            .iter()
            .map(|(bytes, _)| 8 + bytes.len())
            .sum::<usize>();
    let mut file = b"glTF".to_vec();
    file.extend([2, length as u32].map(u32::to_le_bytes).concat());
    for (bytes, kind) in chunks {
        file.extend((bytes.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(bytes);
    }
    file
}

fn read(bytes: &[u8]) -> Result<Imported, SceneError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("thing.gltf");
    std::fs::write(&path, bytes).unwrap();
    load(&path)
}

fn scene(document: &Value) -> Scene {
    read(document.to_string().as_bytes()).unwrap().scene
}

fn cause(document: &Value) -> String {
    let error = read(document.to_string().as_bytes()).unwrap_err();
    assert!(!error.remedy.is_empty());
    error.cause
}

fn warnings(document: &Value) -> Vec<String> {
    let warnings = read(document.to_string().as_bytes()).unwrap().warnings;
    let sentence = |warning: &String| warning.split_once(": ").unwrap().1.to_owned();
    warnings.iter().map(sentence).collect()
}

fn chosen(document: &Value, options: GltfOptions) -> Result<Imported, SceneError> {
    let options = ImportOptions {
        gltf: options,
        ..ImportOptions::default()
    };
    crate::scene::read(
        "a.gltf".as_ref(),
        document.to_string().into_bytes(),
        &options,
    )
}
