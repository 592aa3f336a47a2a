//! The text of a glTF file as a document that is proved to hold together.

use super::container::{self, Container};
use super::normal_transforms::{self, NormalTransforms};
use super::text::Counts;
use crate::scene::text::Warnings;
use crate::scene::{SceneError, SourceSpan};
use crate::table::{printable, shortened};
use gltf::Document;
use gltf::json::camera::Type;
use gltf::json::image::MimeType;
use gltf::json::validation::{Checked, Error, Validate};
use gltf::json::{Index, Root, Value};
use std::path::Path;

const AGAIN: &str = "export the file again, as glTF 2.0";

/// The extensions that are read.
pub(super) const EXTENSIONS: [&str; 6] = [
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_transmission",
    "KHR_materials_volume",
    "KHR_texture_transform",
];

/// Extensions of how surfaces look. They are ignored, with a warning, even where a file requires them: the shapes are
/// still right.
const DISPENSABLE: [&str; 3] = [
    "KHR_materials_specular",
    "KHR_materials_unlit",
    "KHR_materials_variants",
];

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
    let counts = Counts::of(container.text);
    counts.check(path)?;
    let mut root = parse(path, &container, warnings)?;
    check_version(path, &root.asset.version)?;
    let least = root.asset.min_version.as_ref();
    if let Some(least) = least.filter(|least| *least != "2.0") {
        return Err(SceneError::new(
            path,
            format!(
                "the file needs at least glTF of version {}; version 2.0 is understood",
                shortened(least)
            ),
            AGAIN,
        ));
    }
    warn_of_unlisted(path, &counts, &root, warnings);
    check_required(path, &root)?;
    leave_out_shapeless(path, &mut root, warnings);
    complete_images(path, &mut root, warnings);
    check_indices(path, &root)?;
    validate(path, &root)?;
    let document = Document::from_json_without_validation(root);
    let blob = container.binary.map(<[u8]>::to_vec);
    let transforms = normal_transforms::read(path, container.text)?;
    warn_of_targets(path, container.text, warnings);
    Ok((document, blob, transforms))
}

/// Rejects a file that cannot be shown without an extension that is not read. The crate compares with a list of its own,
/// which has others.
fn check_required(path: &Path, root: &Root) -> Result<(), SceneError> {
    let required = root.extensions_required.iter();
    let is_read = |name: &&str| EXTENSIONS.contains(name) || DISPENSABLE.contains(name);
    let mut unread = required.map(String::as_str).filter(|name| !is_read(name));
    let Some(name) = unread.next() else {
        return Ok(());
    };
    let more = match unread.count() {
        0 => String::new(),
        more => format!(" (and {more} more)"),
    };
    let cause = format!(
        "`extensionsRequired` names an extension that is not read: {}{more}",
        printable(name)
    );
    let remedy = format!(
        "export without it; Gridel reads {}, and no compressed or quantized meshes",
        EXTENSIONS.join(", ")
    );
    Err(SceneError::new(path, cause, remedy))
}

/// Warns of extensions that elements have and the file does not list.
fn warn_of_unlisted(path: &Path, counts: &Counts<'_>, root: &Root, warnings: &mut Warnings) {
    let names = counts.extensions.iter();
    let names = names.filter(|name| {
        !root
            .extensions_used
            .iter()
            .any(|it| it.as_bytes() == **name)
    });
    let names: Vec<_> = names.map(|it| String::from_utf8_lossy(it)).collect();
    if !names.is_empty() {
        let names = names.join(", ");
        let sentence =
            format!("`extensionsUsed` does not list extensions that elements have: {names}");
        warnings.add_times(SourceSpan::of(path), 1, sentence);
    }
}

/// Warns of attributes of morph targets that the crate leaves out, given the JSON text of a file, which is valid.
fn warn_of_targets(path: &Path, text: &[u8], warnings: &mut Warnings) {
    let has = |word: &str| text.windows(word.len()).any(|part| part == word.as_bytes());
    // Few files have both, so that few are read twice.
    if !has("\"targets\"") || !has("COLOR_") && !has("TEXCOORD_") {
        return;
    }
    let Ok(document) = gltf::json::deserialize::from_slice::<Value>(text) else {
        return;
    };
    fn all<'v>(value: &'v Value, key: &str) -> impl Iterator<Item = &'v Value> + use<'v> {
        value[key].as_array().into_iter().flatten()
    }
    let parts = all(&document, "meshes").flat_map(|mesh| all(mesh, "primitives"));
    let targets = parts.flat_map(|part| all(part, "targets"));
    let attributes = targets
        .filter_map(Value::as_object)
        .flat_map(|it| it.keys());
    let ignored = attributes.filter(|it| it.starts_with("COLOR_") || it.starts_with("TEXCOORD_"));
    let count = ignored.count();
    if count > 0 {
        let sentence = "colors and texture coordinates of morph targets are ignored";
        warnings.add_times(SourceSpan::of(path), count, sentence);
    }
}

fn parse(
    path: &Path,
    container: &Container<'_>,
    warnings: &mut Warnings,
) -> Result<Root, SceneError> {
    // Compiled once, in its own crate: the generic function would be compiled again here.
    Root::from_slice(container.text).or_else(|error| {
        let value = gltf::json::deserialize::from_slice::<Value>(container.text).ok();
        if let Some((root, has_untargeted)) = value.clone().and_then(repaired) {
            if has_untargeted {
                let sentence = "channels of animations without a node are ignored";
                warnings.add_times(SourceSpan::of(path), 1, sentence);
            }
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
        // Many files have a single line.
        let (line, column) = (error.line(), error.column());
        let place = match line {
            0 => String::new(),
            _ if container.has_lines => format!(" (column {column})"),
            _ => format!(" (line {line}, column {column} of the JSON chunk)"),
        };
        let wrong = SceneError::new(path, format!("the JSON is broken: {cause}{place}"), AGAIN);
        Err(match line {
            line if line > 0 && container.has_lines => wrong.at_line(line),
            _ => wrong,
        })
    })
}

/// Reads a document with two things that the crate rejects and the format does not: scenes without nodes, and channels
/// of animations without a node. Returns whether there are such channels, which are taken out. `None` if there is
/// neither, or something else is broken.
fn repaired(mut document: Value) -> Option<(Root, bool)> {
    let scenes = add_nodes(&mut document);
    let channels = take_untargeted_channels(&mut document);
    // As text, for the function of `parse`.
    let root = |document: Value| Root::from_slice(document.to_string().as_bytes()).ok();
    (scenes || channels).then(|| root(document).map(|root| (root, channels)))?
}

/// Adds a list of no nodes to scenes without one. Returns whether there are any.
fn add_nodes(document: &mut Value) -> bool {
    let mut found = false;
    let scenes = document.get_mut("scenes").and_then(Value::as_array_mut);
    for scene in scenes
        .into_iter()
        .flatten()
        .filter_map(Value::as_object_mut)
    {
        if !scene.contains_key("nodes") {
            scene.insert(String::from("nodes"), Value::Array(Vec::new()));
            found = true;
        }
    }
    found
}

/// Takes out the channels of animations that name no node: extensions say what these move. Returns whether there are
/// any.
fn take_untargeted_channels(document: &mut Value) -> bool {
    let mut found = false;
    let animations = document.get_mut("animations").and_then(Value::as_array_mut);
    for animation in animations.into_iter().flatten() {
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
    found
}

/// Completes images that lack what the crate reads without having validated it. The decoder
/// recognizes the kind of an image by its bytes. Textures lose images without data.
fn complete_images(path: &Path, root: &mut Root, warnings: &mut Warnings) {
    let mut empty = vec![false; root.images.len()];
    for (number, image) in root.images.iter_mut().enumerate() {
        let name = image.name.as_ref();
        let name = name.map_or_else(String::new, |name| format!(" {:?}", shortened(name)));
        let mut warn = |what: &str| {
            let sentence = format!("image {number}{name} has {what}");
            warnings.add_times(SourceSpan::of(path), 1, sentence);
        };
        if image.buffer_view.is_none() && image.uri.is_none() {
            empty[number] = true;
            warn("neither `uri` nor `bufferView`; it is not drawn");
        } else if image.buffer_view.is_some() && image.mime_type.is_none() {
            image.mime_type = Some(MimeType(String::new()));
            warn("no `mimeType`; its first bytes show whether it is PNG or JPEG");
        }
    }
    for texture in &mut root.textures {
        if empty.get(texture.source.value()) == Some(&true) {
            texture.source = Index::new(u32::MAX);
        }
    }
}

fn check_version(path: &Path, version: &str) -> Result<(), SceneError> {
    if version.split('.').next() == Some("2") {
        return Ok(());
    }
    Err(SceneError::new(
        path,
        format!(
            "the file is glTF of version {}; version 2 is required",
            shortened(version)
        ),
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
        let is_allowed = match error {
            Error::Missing => optional,
            // `check_required` decides.
            Error::Unsupported => true,
            _ => false,
        };
        if !is_allowed && first.is_none() {
            first = Some((place, error));
        }
    });
    first.map_or(Ok(()), |(place, error)| {
        // The crate keeps no name that it does not know.
        let cause = match place.split_once("[\"<invalid semantic name>\"]") {
            Some((attributes, _)) => format!(
                "{attributes}: the name of an attribute is unknown; own names begin with an underscore"
            ),
            None => format!("{place}: {}", error.to_string().to_lowercase()),
        };
        Err(SceneError::new(path, cause, AGAIN))
    })
}
