//! The header of a PLY file: its errors, and its parts that are not read.

use super::super::size::{MOST_BYTES, MOST_PRIMITIVES};
use super::super::text::Warnings;
use super::super::{SceneError, SourceSpan};
use super::payload::{Skipped, TOO_LARGE, range};
use crate::scene::error::COPY_AGAIN;
use crate::table::{grouped, printable, shortened};
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{ElementDef, Header, PropertyType};
use std::collections::HashMap;
use std::io::ErrorKind;
use std::path::Path;

/// Reads the header. Warns of announced parts that change the picture and are not drawn.
pub(super) fn read(
    path: &Path,
    bytes: &[u8],
    reader: &mut Reader<&[u8]>,
    warnings: &mut Warnings,
) -> Result<Header, SceneError> {
    let parser = Parser::<Skipped>::new();
    let header = parser.read_header(reader);
    let header = header.map_err(|error| fault(path, bytes, &error))?;
    check_version(path, bytes)?;
    reject_doubled(path, bytes)?;
    ignored(path, bytes, warnings);
    Ok(header)
}

/// Rejects versions other than 1.0. The crate reads every version that is a number.
fn check_version(path: &Path, bytes: &[u8]) -> Result<(), SceneError> {
    for (number, line) in (1..).zip(lines(bytes)) {
        let text = String::from_utf8_lossy(line);
        let mut words = text.split_whitespace();
        match words.next() {
            Some("end_header") => break,
            Some("format") if words.nth(1).and_then(|it| it.parse().ok()) != Some(1.0) => {
                let cause = unknown_version(line);
                return Err(SceneError::new(path, cause, WRITE_VERSION).at_line(number));
            }
            _ => {}
        }
    }
    Ok(())
}

const WRITE_VERSION: &str = "write the version 1.0";

fn unknown_version(line: &[u8]) -> String {
    format!("{} has an unknown version", quoted(line))
}

/// Rejects elements of one name, and properties of one name in an element. The crate keeps the last of them only, and
/// would read all that follows at the wrong places.
fn reject_doubled(path: &Path, bytes: &[u8]) -> Result<(), SceneError> {
    let (mut elements, mut properties) = (HashMap::new(), HashMap::new());
    for (number, line) in (1..).zip(lines(bytes)) {
        let text = String::from_utf8_lossy(line);
        let words: Vec<&str> = text.split_whitespace().collect();
        let (known, name) = match words[..] {
            ["end_header", ..] => break,
            ["element", name, _] => {
                properties.clear();
                (&mut elements, name)
            }
            ["property", .., name] => (&mut properties, name),
            _ => continue,
        };
        let first = *known.entry(name.to_owned()).or_insert(number);
        if first != number {
            let cause = format!(
                "the header announces another {} {:?}; the first is in line {first}",
                words[0],
                shortened(name)
            );
            let remedy = "give each element, and each property of an element, a name of its own";
            return Err(SceneError::new(path, cause, remedy).at_line(number));
        }
    }
    Ok(())
}

/// A property of a vertex that is read.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Component {
    /// A coordinate, by its axis.
    Position(usize),
    /// A component of the normal, by its axis.
    Normal(usize),
    /// Red, green or blue.
    Color(usize),
    Alpha,
}

impl Component {
    /// Returns the component that a name of a property means.
    pub(super) fn named(name: &str) -> Option<Self> {
        Some(match name {
            "x" => Self::Position(0),
            "y" => Self::Position(1),
            "z" => Self::Position(2),
            "nx" => Self::Normal(0),
            "ny" => Self::Normal(1),
            "nz" => Self::Normal(2),
            "red" | "diffuse_red" | "r" => Self::Color(0),
            "green" | "diffuse_green" | "g" => Self::Color(1),
            "blue" | "diffuse_blue" | "b" => Self::Color(2),
            "alpha" | "diffuse_alpha" | "a" => Self::Alpha,
            _ => return None,
        })
    }
}

/// How many of three properties the vertices of a file have.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Announced {
    None,
    Some,
    All,
}

/// Returns how many components of normals, or of colors, the header announces for vertices.
pub(super) fn announced(header: &Header, component: fn(usize) -> Component) -> Announced {
    let vertex = header.elements.get("vertex");
    let has = |number| {
        let wanted = Some(component(number));
        vertex.is_some_and(|it| {
            it.properties
                .keys()
                .any(|it| Component::named(it) == wanted)
        })
    };
    match [0, 1, 2].map(has) {
        [true, true, true] => Announced::All,
        [false, false, false] => Announced::None,
        _ => Announced::Some,
    }
}

fn lines(bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    bytes.split(|&byte| byte == b'\n')
}

/// The error of a header that cannot be read.
fn fault(path: &Path, bytes: &[u8], error: &ParseError) -> SceneError {
    let again = "export the file again; text and both orders of bytes are understood";
    let Some(line) = error.line() else {
        return fault_without_line(path, bytes, error, again);
    };
    if error.kind() == ErrorKind::UnexpectedEof {
        let cause = "the file ends before the end of its header";
        return SceneError::new(path, cause, "end the header with the line `end_header`");
    }
    let found = lines(bytes).nth(line.saturating_sub(1)).unwrap_or_default();
    let quoted = quoted(found);
    let [cause, remedy] = if line == 1 && found.starts_with(b"ply\r") {
        [
            String::from("lines of the header end with a carriage return alone"),
            String::from("export the file again, with a line feed at the end of each line"),
        ]
    } else if line == 1 {
        [
            format!("the file begins with {quoted}; `ply` is required"),
            again.to_owned(),
        ]
    } else {
        let text = String::from_utf8_lossy(found);
        let is_line = Parser::<Skipped>::new().read_header_line(&text).is_ok();
        let first = text.split_whitespace().next().filter(|_| is_line);
        let why = match first {
            Some("ply") => "stands in the middle of the header",
            Some("format") => "differs from the format of a line above",
            Some("element") => "announces more elements than a file can hold",
            Some("property") => "stands above the first element",
            _ => "is not a line of a PLY header",
        };
        let lines = "`format ascii 1.0`, `comment TEXT`, `obj_info TEXT`, `element NAME COUNT`, \
                     `property TYPE NAME` or `property list TYPE TYPE NAME`";
        [format!("{quoted} {why}"), format!("write {lines}")]
    };
    SceneError::new(path, cause, remedy).at_line(line)
}

/// The error of a header as a whole.
fn fault_without_line(path: &Path, bytes: &[u8], error: &ParseError, again: &str) -> SceneError {
    if error.kind() == ErrorKind::InvalidData {
        let broken = |line: &[u8]| std::str::from_utf8(line).is_err();
        let line = 1 + lines(bytes).position(broken).unwrap_or(0);
        let remedy = "write the header, with its comments, in UTF-8";
        return SceneError::new(path, "the header is not UTF-8 text", remedy).at_line(line);
    }
    let is_format = |line: &&[u8]| line.trim_ascii().starts_with(b"format");
    let [cause, remedy] = match lines(bytes).find(is_format) {
        _ if bytes.is_empty() => [String::from("the file is empty"), again.to_owned()],
        Some(line) => [unknown_version(line), String::from(WRITE_VERSION)],
        None => [
            String::from("the header has no format"),
            String::from("write `format ascii 1.0` below `ply`"),
        ],
    };
    SceneError::new(path, cause, remedy)
}

/// The beginning of a line, as errors quote it.
fn quoted(line: &[u8]) -> String {
    format!(
        "`{}`",
        printable(&String::from_utf8_lossy(line.trim_ascii()))
    )
}

/// Bytes that a vertex takes until the scene is made, measured as the growth of the peak memory.
const VERTEX: u64 = 128;

/// The names of the list of a face's vertices.
pub(super) const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// Rejects a number of elements that the file cannot hold at one byte each or more. Also rejects
/// properties whose types do not match their meaning, and faces without vertices.
pub(super) fn check(path: &Path, element: &ElementDef, bytes: usize) -> Result<(), SceneError> {
    if element.count > bytes || (element.properties.is_empty() && element.count > 0) {
        return Err(SceneError::new(
            path,
            format!(
                "the header announces {} elements {:?} of {} properties, and the file has {bytes} bytes",
                element.count,
                shortened(&element.name),
                element.properties.len()
            ),
            COPY_AGAIN,
        ));
    }
    let most = match element.name.as_str() {
        "vertex" => MOST_BYTES / VERTEX,
        "face" | "tristrips" => MOST_PRIMITIVES,
        _ => u64::MAX,
    };
    if element.count as u64 > most {
        return Err(SceneError::new(
            path,
            format!(
                "the header announces {} elements {:?}; at most {} fit into memory",
                grouped(element.count),
                element.name,
                grouped(most)
            ),
            TOO_LARGE,
        ));
    }
    for property in element.properties.values() {
        let expected = match (&*element.name, &*property.name, &property.data_type) {
            ("vertex", name, PropertyType::List(..)) if Component::named(name).is_some() => {
                "a number"
            }
            ("face" | "tristrips", "vertex_index" | "vertex_indices", found) => match found {
                PropertyType::List(_, entry) if range(entry).is_some() => continue,
                _ => "a list of whole numbers",
            },
            _ => continue,
        };
        return Err(SceneError::new(
            path,
            format!(
                "the header announces a property {:?} of {:?} that is not {expected}",
                shortened(&property.name),
                shortened(&element.name)
            ),
            "export the file again, with properties of the usual types",
        ));
    }
    let has_corners = element
        .properties
        .keys()
        .any(|name| CORNERS.contains(&&**name));
    if ["face", "tristrips"].contains(&&*element.name) && element.count > 0 && !has_corners {
        let names = element
            .properties
            .keys()
            .map(|name| format!("{name:?}", name = shortened(name)));
        return Err(SceneError::new(
            path,
            format!(
                "the elements {:?} have no list \"vertex_indices\", but {}",
                shortened(&element.name),
                names.collect::<Vec<_>>().join(", ")
            ),
            "rename the list of their vertices to `vertex_indices`",
        ));
    }
    Ok(())
}

/// Warns of announced parts that change the picture and are not drawn.
fn ignored(path: &Path, bytes: &[u8], warnings: &mut Warnings) {
    let header = bytes
        .split(|&byte| byte == b'\n')
        .map(String::from_utf8_lossy);
    // The element whose properties follow, and its count.
    let (mut element, mut count) = (String::new(), 0);
    let mut is_color_reported = false;
    for (number, line) in (1..).zip(header) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let place = SourceSpan {
            line: number,
            ..SourceSpan::of(path)
        };
        match words[..] {
            ["end_header", ..] => return,
            ["element", name, number] => {
                element = name.to_owned();
                count = number.parse().unwrap_or(0);
                is_color_reported = false;
            }
            ["comment", "TextureFile", ..] => {
                let sentence =
                    "the texture is not drawn; export the mesh as glTF or OBJ to show it";
                warnings.add_times(place, 1, sentence);
            }
            ["property", .., name] if element == "face" && count > 0 => {
                let is_color = matches!(Component::named(name), Some(Component::Color(_)));
                if is_color && !std::mem::replace(&mut is_color_reported, true) {
                    let sentence = "the color of a face is ignored; the surface has one color";
                    warnings.add_times(place, count, sentence);
                }
            }
            _ => {}
        }
    }
}
