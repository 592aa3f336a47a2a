//! The text of a glTF file as a document that is proved to hold together.

use super::container::{self, Container};
use crate::scene::text::Warnings;
use crate::scene::{Place, SceneError};
use gltf::Document;
use gltf::json::camera::Type;
use gltf::json::validation::{Checked, Error};
use gltf::json::{Root, Value};
use std::path::Path;

const AGAIN: &str = "export the file again, as glTF 2.0";

/// Reads the document and the buffer that the file itself holds.
///
/// # Errors
/// If the container or the JSON is broken, the version is not 2, an extension that is required is
/// not understood, or an index leads nowhere.
pub(super) fn read(
    path: &Path,
    bytes: &[u8],
    warnings: &mut Warnings,
) -> Result<(Document, Option<Vec<u8>>), SceneError> {
    let container = container::split(path, bytes, warnings)?;
    let mut root = parse(path, &container)?;
    check_version(path, &root.asset.version)?;
    if let Some(least) = &root.asset.min_version {
        check_version(path, least)?;
    }
    leave_out_shapeless(path, &mut root, warnings);
    check_indices(path, &root)?;
    let document = Document::from_json(root).map_err(|error| broken(path, error))?;
    Ok((document, container.binary.map(<[u8]>::to_vec)))
}

/// Reads the JSON. Textures may name no image; the crate's do, and no image is read.
fn parse(path: &Path, container: &Container<'_>) -> Result<Root, SceneError> {
    let error = match gltf::json::deserialize::from_slice(container.text) {
        Ok(root) => return Ok(root),
        Err(error) => error,
    };
    let value: Option<Value> = gltf::json::deserialize::from_slice(container.text).ok();
    if let Some(version) = value
        .as_ref()
        .and_then(|value| value["asset"]["version"].as_str())
    {
        check_version(path, version)?;
    }
    if let Some(value) = value.and_then(with_images)
        && let Ok(root) = gltf::json::deserialize::from_value(value)
    {
        return Ok(root);
    }
    let cause = error.to_string();
    // The line is told before the cause.
    let cause = cause
        .rsplit_once(" at line ")
        .map_or(cause.as_str(), |(cause, _)| cause);
    let wrong = SceneError::new(path, format!("the JSON is broken: {cause}"), AGAIN);
    Err(match error.line() {
        line if line > 0 && container.has_lines => wrong.at_line(line),
        _ => wrong,
    })
}

/// The document with an image for every texture that names none; `None` if there is no such one.
fn with_images(mut value: Value) -> Option<Value> {
    let images = value
        .get("images")
        .and_then(Value::as_array)
        .map_or(0, Vec::len);
    let textures = value.get_mut("textures")?.as_array_mut()?;
    let mut changed = false;
    for texture in textures.iter_mut().filter_map(Value::as_object_mut) {
        if !texture.contains_key("source") {
            texture.insert(String::from("source"), images.into());
            changed = true;
        }
    }
    if !changed {
        return None;
    }
    let empty = || {
        Value::Object(
            [(String::from("uri"), Value::from(""))]
                .into_iter()
                .collect(),
        )
    };
    let root = value.as_object_mut()?;
    let images = root
        .entry("images")
        .or_insert_with(|| Value::Array(Vec::new()));
    images.as_array_mut()?.push(empty());
    Some(value)
}

fn check_version(path: &Path, version: &str) -> Result<(), SceneError> {
    if version.split('.').next() == Some("2") {
        return Ok(());
    }
    Err(SceneError::new(
        path,
        format!("the file is glTF of version {version}; version 2 is required"),
        AGAIN,
    ))
}

/// Takes out the parts of meshes that have no positions. They are valid, and have no surface.
fn leave_out_shapeless(path: &Path, root: &mut Root, warnings: &mut Warnings) {
    use gltf::Semantic::Positions;
    let mut first = None;
    let mut count = 0;
    for (number, mesh) in root.meshes.iter_mut().enumerate() {
        let mut part = 0;
        mesh.primitives.retain(|primitive| {
            let has = primitive
                .attributes
                .contains_key(&Checked::Valid(Positions));
            if !has {
                first = first.or(Some((number, part)));
                count += 1;
            }
            part += 1;
            has
        });
    }
    if let Some((mesh, part)) = first {
        let sentence = format!("mesh {mesh}, primitive {part} has no positions; it is left out");
        warnings.add_times(Place::of(path), count, sentence);
    }
}

/// What the crate looks up without having validated it.
fn check_indices(path: &Path, root: &Root) -> Result<(), SceneError> {
    let lacks = |camera: &gltf::json::Camera| match camera.type_ {
        Checked::Valid(Type::Perspective) => camera.perspective.is_none(),
        Checked::Valid(Type::Orthographic) => camera.orthographic.is_none(),
        Checked::Invalid => false,
    };
    if let Some(number) = root.cameras.iter().position(lacks) {
        let cause = format!("camera {number} lacks the numbers of its type");
        return Err(SceneError::new(path, cause, AGAIN));
    }
    for (number, mesh) in root.meshes.iter().enumerate() {
        let attributes = mesh.primitives.iter().flat_map(|part| &part.attributes);
        for (_, accessor) in attributes {
            if accessor.value() >= root.accessors.len() {
                return Err(SceneError::new(
                    path,
                    format!(
                        "mesh {number} uses accessor {}, and there are {}",
                        accessor.value(),
                        root.accessors.len()
                    ),
                    AGAIN,
                ));
            }
        }
    }
    Ok(())
}

fn broken(path: &Path, error: gltf::Error) -> SceneError {
    match error {
        gltf::Error::Validation(problems) => match problems.into_iter().next() {
            Some((place, Error::Unsupported)) => SceneError::new(
                path,
                format!("an extension that the file requires is not understood: {place}"),
                "export without it; compressed and quantised meshes are not read",
            ),
            Some((place, error)) => {
                let cause = error.to_string().to_lowercase();
                SceneError::new(path, format!("{place}: {cause}"), AGAIN)
            }
            None => SceneError::new(path, "the file is no valid glTF", AGAIN),
        },
        error => SceneError::new(path, format!("the file is no glTF: {error}"), AGAIN),
    }
}
