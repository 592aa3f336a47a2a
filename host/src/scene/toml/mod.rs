#![doc = include_str!("../../../docs/SCENE.md")]

mod census;
mod document;
mod environment;
mod hinge;
mod import;
mod imported_track;
mod item;
mod joint;
mod light;
mod material;
mod morph;
mod object;
mod part;
mod place;
mod shape;
pub(crate) mod source;
mod track;
mod transform;
pub(crate) mod value;
mod view;

#[cfg(test)]
mod tests;

use super::importer::{Importer, Input};
use super::{Imported, SceneError};
use gridel_core::Up;
use import::Imports;

pub(super) const IMPORTER: Importer = Importer {
    name: "TOML",
    about: "Gridel's own format, which a person writes",
    extensions: &["toml"],
    // The camera's `up` is y as well where it is not given.
    up: Up::Y,
    binary: false,
    example: "[[light]]\nkind = \"point\"\nposition = [2, 3, 4]\n\n[[object]]\nkind = \"sphere\"\n\
              center = [0, 0, 0]\nradius = 1\n",
    recognizes: |bytes| {
        let lines = bytes.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii);
        let mut lines = lines.filter(|line| !line.is_empty() && !line.starts_with(b"#"));
        // A heading, or a key and its value.
        lines.next().is_some_and(|line| {
            let key = line.split(|&byte| byte == b'=').next();
            let is_key = |key: &[u8]| {
                let key = key.trim_ascii();
                let plain = |byte: &u8| byte.is_ascii_alphanumeric() || b"_-.\"".contains(byte);
                !key.is_empty() && key.iter().all(plain)
            };
            line.starts_with(b"[") || line.contains(&b'=') && key.is_some_and(is_key)
        })
    },
    read,
};

/// Reads a scene file in this format, and the files it imports. Molecules among these follow the input's options where
/// the file does not say otherwise.
///
/// # Errors
/// If a file that is imported cannot be read or a file's content is broken; the error shows file, line
/// and remedy.
fn read(input: Input<'_>) -> Result<Imported, SceneError> {
    let mut imports = Imports::new((IMPORTER.name, document::read), &input);
    let scene = imports.root(input)?;
    Ok(Imported {
        kinds: imports.kinds,
        ..Imported::of(scene, imports.warnings)
    })
}
