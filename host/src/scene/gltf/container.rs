//! The container of glTF: text as it is, or the chunks of a binary file (glTF 2.0, chapter 4).

use crate::scene::SceneError;
use crate::scene::SourceSpan;
use crate::scene::error::COPY_AGAIN;
use crate::scene::importer::extension;
use crate::scene::text::{Warnings, check_encoding};
use std::path::Path;

const HEADER: usize = 12;
const CHUNK_HEADER: usize = 8;
const JSON: [u8; 4] = *b"JSON";
const BIN: [u8; 4] = *b"BIN\0";

/// The text of a file, and the buffer in the file itself.
pub(super) struct Container<'b> {
    pub(super) text: &'b [u8],
    pub(super) binary: Option<&'b [u8]>,
    /// Lines of the text are lines of the file.
    pub(super) has_lines: bool,
}

/// Splits a file.
///
/// # Errors
/// If the header or a chunk of a binary file has the wrong length, kind or version, or if the text
/// is in UTF-16.
pub(super) fn split<'b>(
    path: &Path,
    bytes: &'b [u8],
    warnings: &mut Warnings,
) -> Result<Container<'b>, SceneError> {
    if bytes.starts_with(b"glTF") {
        return chunks(path, bytes);
    }
    check_encoding(path, bytes)?;
    let text = bytes.strip_prefix(b"\xef\xbb\xbf");
    if text.is_some() {
        let sentence = "the text begins with a byte order mark, which glTF forbids; it is ignored";
        warnings.add_times(SourceSpan::of(path), 1, sentence);
    }
    let text = text.unwrap_or(bytes);
    if text.trim_ascii().is_empty() {
        return Err(SceneError::new(path, "the file is empty", COPY_AGAIN));
    }
    let named_binary = extension(path).is_some_and(|it| it == "glb");
    if named_binary && !text.trim_ascii_start().starts_with(b"{") {
        let magic: Vec<String> = bytes.iter().take(4).map(|b| format!("{b:02x}")).collect();
        return Err(SceneError::new(
            path,
            format!(
                "the file is no binary glTF: it begins with the bytes {}, not with `glTF` (67 6c 54 46)",
                magic.join(" ")
            ),
            "check that the file is what its name says; export it again, as .glb",
        ));
    }
    Ok(Container {
        text,
        binary: None,
        has_lines: true,
    })
}

fn chunks<'b>(path: &Path, bytes: &'b [u8]) -> Result<Container<'b>, SceneError> {
    let cut = |cause: String| SceneError::new(path, cause, COPY_AGAIN);
    let word = |at: usize| {
        let bytes = bytes.get(at..)?.first_chunk()?;
        Some(u32::from_le_bytes(*bytes))
    };
    let (Some(version), Some(length)) = (word(4), word(8)) else {
        return Err(cut(format!(
            "the file ends inside its header: it has {} of {HEADER} bytes",
            bytes.len()
        )));
    };
    if version != 2 {
        return Err(SceneError::new(
            path,
            format!("the file is binary glTF of version {version}; version 2 is required"),
            "export the file again, as glTF 2.0",
        ));
    }
    if u64::from(length) != bytes.len() as u64 {
        return Err(cut(format!(
            "the header announces {length} bytes, and the file has {}",
            bytes.len()
        )));
    }
    let mut at = HEADER;
    let mut found: [Option<&[u8]>; 2] = [None; 2];
    let mut number = 0;
    while at < bytes.len() {
        let (Some(length), Some(kind)) = (word(at), word(at + 4)) else {
            return Err(cut(format!(
                "the file ends inside the header of chunk {number}"
            )));
        };
        let rest = &bytes[at + CHUNK_HEADER..];
        let Some(content) = rest.get(..length as usize) else {
            return Err(cut(format!(
                "chunk {number} (from 0) announces {length} bytes, and {} follow it",
                rest.len()
            )));
        };
        let kind = kind.to_le_bytes();
        if number == 0 && kind != JSON {
            return Err(SceneError::new(
                path,
                format!(
                    "the first chunk is of the type {:?}; it must be JSON",
                    String::from_utf8_lossy(&kind)
                ),
                "export the file again",
            ));
        }
        // Chunks of other types are for extensions.
        if let Some(place) = [JSON, BIN].iter().position(|known| *known == kind)
            && found[place].replace(content).is_some()
        {
            return Err(SceneError::new(
                path,
                format!(
                    "chunk {number} (from 0) is a second one of the type {}",
                    String::from_utf8_lossy(&kind).trim_end_matches('\0')
                ),
                "export the file again",
            ));
        }
        at += CHUNK_HEADER + content.len();
        number += 1;
    }
    let [Some(text), binary] = found else {
        return Err(cut(String::from("the file has no chunk")));
    };
    Ok(Container {
        text,
        binary,
        has_lines: false,
    })
}
