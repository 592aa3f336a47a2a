//! The text of a glTF file as a document that is proved to hold together.

use super::container::{self, Container};
use super::normal_transforms::{self, NormalTransforms};
use crate::scene::text::Warnings;
use crate::scene::{SceneError, SourceSpan};
use gltf::Document;
use gltf::json::camera::Type;
use gltf::json::validation::{Checked, Error, Validate};
use gltf::json::{Root, Value};
use std::path::Path;

const AGAIN: &str = "export the file again, as glTF 2.0";

/// Reads the document, the buffer that the file itself holds, and how its normal maps lie.
///
/// # Errors
/// If the container or the JSON is broken, or the version is not 2. Also if a required extension is
/// not supported, or an index is out of range.
pub(super) fn read(
    path: &Path,
    bytes: &[u8],
    warnings: &mut Warnings,
) -> Result<(Document, Option<Vec<u8>>, NormalTransforms), SceneError> {
    let container = container::split(path, bytes, warnings)?;
    let mut root = parse(path, &container, warnings)?;
    check_version(path, &root.asset.version)?;
    let least = root.asset.min_version.as_ref();
    if let Some(least) = least.filter(|least| *least != "2.0") {
        return Err(SceneError::new(
            path,
            format!("the file needs at least glTF of version {least}; version 2.0 is understood"),
            AGAIN,
        ));
    }
    leave_out_shapeless(path, &mut root, warnings);
    check_indices(path, &root)?;
    validate(path, &root)?;
    let document = Document::from_json_without_validation(root);
    let blob = container.binary.map(<[u8]>::to_vec);
    let transforms = normal_transforms::read(path, container.text)?;
    Ok((document, blob, transforms))
}

fn parse(
    path: &Path,
    container: &Container<'_>,
    warnings: &mut Warnings,
) -> Result<Root, SceneError> {
    // Compiled once, in its own crate: the generic function would be compiled again here.
    Root::from_slice(container.text).or_else(|error| {
        let value = gltf::json::deserialize::from_slice::<Value>(container.text).ok();
        let repaired = value.clone().and_then(without_untargeted_channels);
        if let Some(root) = repaired {
            let sentence = "channels of animations without a node are ignored";
            warnings.add_times(SourceSpan::of(path), 1, sentence);
            return Ok(root);
        }
        // Other versions have other types where this one has its own.
        let version = value
            .as_ref()
            .and_then(|value| value["asset"]["version"].as_str());
        if let Some(Err(wrong)) = version.map(|version| check_version(path, version)) {
            return Err(wrong);
        }
        let cause = error.to_string();
        // The error names the line before the cause.
        let cause = cause
            .rsplit_once(" at line ")
            .map_or(cause.as_str(), |(cause, _)| cause);
        let wrong = SceneError::new(path, format!("the JSON is broken: {cause}"), AGAIN);
        Err(match error.line() {
            line if line > 0 && container.has_lines => wrong.at_line(line),
            _ => wrong,
        })
    })
}

/// Takes out the channels of animations that name no node, which are valid: extensions say what these move. Returns
/// `None` if there are none, or something else is broken.
fn without_untargeted_channels(mut document: Value) -> Option<Root> {
    let mut found = false;
    for animation in document.get_mut("animations")?.as_array_mut()? {
        let Some(channels) = animation.get_mut("channels").and_then(Value::as_array_mut) else {
            continue;
        };
        channels.retain(|channel| {
            let is_untargeted =
                channel["target"].is_object() && channel["target"]["node"].is_null();
            found |= is_untargeted;
            !is_untargeted
        });
    }
    // As text, for the function of `parse`.
    found.then(|| Root::from_slice(document.to_string().as_bytes()).ok())?
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
        warnings.add_times(SourceSpan::of(path), count, sentence);
    }
}

/// Checks the indices that the crate looks up without having validated them.
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
    for (number, animation) in root.animations.iter().enumerate() {
        let channels = animation.channels.iter().map(|channel| &channel.target);
        let leads = |target: &gltf::json::animation::Target| {
            let node = target.node.value() < root.nodes.len();
            node && matches!(target.path, Checked::Valid(_))
        };
        if !channels.clone().all(leads) {
            let cause = format!("animation {number} moves a node or a property that there is not");
            return Err(SceneError::new(path, cause, AGAIN));
        }
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

/// Validates the rest. Allows two things that the crate rejects and the format does not. They are a
/// texture without an image, and an accessor without a view, which holds zeros.
fn validate(path: &Path, root: &Root) -> Result<(), SceneError> {
    let mut first = None;
    root.validate(root, gltf::json::Path::new, &mut |place, error| {
        let place = place().to_string();
        let optional = place.starts_with("textures[") && place.ends_with("].source")
            || place.starts_with("accessors[") && place.ends_with("].bufferView");
        if !(optional && matches!(error, Error::Missing)) && first.is_none() {
            first = Some((place, error));
        }
    });
    match first {
        None => Ok(()),
        Some((place, Error::Unsupported)) => Err(SceneError::new(
            path,
            format!("an extension that the file requires is not understood: {place}"),
            "export without it; compressed and quantized meshes are not read",
        )),
        Some((place, error)) => {
            let cause = error.to_string().to_lowercase();
            Err(SceneError::new(path, format!("{place}: {cause}"), AGAIN))
        }
    }
}
