//! Reads STL, binary and text: triangles, and nothing else.
//!
//! The parser is our own. The crate `stl_io` was tried first. It reads one solid of a text file and silently ignores
//! the others, and its errors name no lines.
//!
//! Every solid of a text file is an object. Vertices are shared by their coordinates, so that triangles meet without a
//! gap. Normals are ignored, since the order of the corners gives them. Colors, which some programs put into binary
//! files, are ignored with a warning.

use super::importer::{Importer, Input, stem};
use super::size::Size;
use super::text::{Source, Warnings, check_encoding};
use super::{Imported, Material, Object, Scene, SceneError, Shape, SourceSpan};
use crate::scene::error::COPY_AGAIN;
use crate::table::shortened;
use glam::DVec3;
use gridel_core::Up;
use std::collections::HashMap;
use std::path::Path;

/// Bytes in front of the triangles of a binary file: a text that means nothing, and their number.
const HEAD: usize = 84;
/// Bytes of a triangle: normal, three corners, attributes.
const TRIANGLE: usize = 50;

pub(super) const IMPORTER: Importer = Importer {
    name: "STL",
    about: "triangles, as printers and CAD programs use them",
    extensions: &["stl"],
    // The format does not state it; CAD programs and printers have the plate in x and y.
    up: Up::Z,
    binary: true,
    example: "solid tip\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n\
              endloop\nendfacet\nendsolid tip\n",
    recognizes: |bytes| {
        begins_with_solid(bytes)
            || announced(bytes).is_some_and(|it| length(it) == bytes.len() as u64)
    },
    read,
};

/// The number of triangles that a binary file states.
fn announced(bytes: &[u8]) -> Option<u32> {
    let count = bytes.get(HEAD - 4..HEAD)?.first_chunk()?;
    Some(u32::from_le_bytes(*count))
}

/// Returns the bytes of a binary file of this many triangles.
fn length(triangles: u32) -> u64 {
    HEAD as u64 + TRIANGLE as u64 * u64::from(triangles)
}

/// Returns whether a file is one of text. Binary files may begin with "solid" as well, but their head and their
/// triangles have bytes that no text has.
fn is_text(bytes: &[u8]) -> bool {
    begins_with_solid(bytes) && !bytes[..bytes.len().min(HEAD + TRIANGLE)].contains(&0)
}

fn begins_with_solid(bytes: &[u8]) -> bool {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let head = bytes.trim_ascii_start().get(..5);
    head.is_some_and(|it| it.eq_ignore_ascii_case(b"solid"))
}

/// Reads an STL file. It has no camera and no lights; the compiler adds them.
///
/// # Errors
/// If the file is cut off, has no triangles, or its content is broken; the error names the line or the
/// triangle.
fn read(input: Input<'_>) -> Result<Imported, SceneError> {
    let Input { path, bytes, .. } = input;
    // Binary files may begin with "solid" as well; their length distinguishes them.
    let announced = announced(&bytes);
    let found = bytes.len() as u64;
    if announced.is_none_or(|count| length(count) != found) {
        check_encoding(path, &bytes)?;
    }
    match announced {
        Some(count) if length(count) == found => binary(path, &bytes, Warnings::default()),
        _ if is_text(&bytes) => text(&Source::from_bytes(path, bytes)),
        _ if let Some(line) = late_solid(&bytes) => Err(SceneError::new(
            path,
            format!(
                "the text begins with other lines; `solid`, with which STL begins, is in line {line}"
            ),
            "remove the lines before it",
        )),
        Some(count) if length(count) < found => {
            let more = found - length(count);
            let mut warnings = Warnings::default();
            let sentence = format!("{more} bytes behind the last triangle are ignored");
            warnings.add_times(SourceSpan::of(path), 1, sentence);
            binary(path, &bytes, warnings)
        }
        Some(count) => Err(SceneError::new(
            path,
            format!(
                "the file announces {count} triangles, which take {} bytes, and has {found}",
                length(count)
            ),
            COPY_AGAIN,
        )),
        None => Err(SceneError::new(
            path,
            "this is neither a binary STL file nor one of text",
            "export it again; a text begins with `solid`, and a binary file has at least 84 bytes",
        )),
    }
}

/// Returns the line of the first `solid` of a text that begins with something else.
fn late_solid(bytes: &[u8]) -> Option<usize> {
    let text = str::from_utf8(bytes).ok()?;
    let line = text.lines().position(|line| is_text(line.as_bytes()))?;
    Some(line + 1)
}

/// Rejects what fits into no memory.
fn check_size(path: &Path, size: Size) -> Result<(), SceneError> {
    let Some(excess) = size.excess() else {
        return Ok(());
    };
    Err(SceneError::new(
        path,
        format!("the file takes {excess}"),
        "export a part of the mesh, or one with fewer triangles",
    ))
}

fn binary(path: &Path, bytes: &[u8], mut warnings: Warnings) -> Result<Imported, SceneError> {
    let count = announced(bytes).unwrap_or_default() as usize;
    let size = Size {
        objects: 1,
        names: 0,
        triangles: count as u64,
    };
    check_size(path, size)?;
    let mut soup = Soup::default();
    let mut colored = 0;
    for (number, triangle) in bytes[HEAD..].chunks_exact(TRIANGLE).take(count).enumerate() {
        let mut corners = [DVec3::ZERO; 3];
        // The normal comes first.
        for (corner, bytes) in corners.iter_mut().zip(triangle[12..48].chunks_exact(12)) {
            let coordinate = |axis: usize| {
                let bytes = bytes[4 * axis..4 * axis + 4].try_into().unwrap_or_default();
                f64::from(f32::from_le_bytes(bytes))
            };
            *corner = DVec3::new(coordinate(0), coordinate(1), coordinate(2));
            if !corner.is_finite() {
                return Err(SceneError::new(
                    path,
                    format!("triangle {number} (from 0) has a corner that is not finite"),
                    "export the file again, or repair the triangle",
                ));
            }
        }
        soup.push(corners);
        colored += usize::from(triangle[48..] != [0; 2]);
    }
    if bytes[..HEAD].windows(6).any(|it| it == b"COLOR=") {
        let sentence = "the color of the header (`COLOR=`) is ignored; the surface has one color";
        warnings.add_times(SourceSpan::of(path), 1, sentence);
    }
    if colored > 0 {
        let sentence = "the attributes of a triangle, which some programs use for its color, are \
                        ignored; the surface has one color";
        warnings.add_times(SourceSpan::of(path), colored, sentence);
    }
    let objects = soup
        .object(stem(path), SourceSpan::of(path))
        .into_iter()
        .collect();
    scene(path, objects, warnings.into_sentences())
}

fn text(source: &Source) -> Result<Imported, SceneError> {
    let mut warnings = Warnings::default();
    let mut objects = Vec::new();
    let mut solid = (String::new(), source.place(1));
    let mut soup = Soup::default();
    let mut size = Size::default();
    // The corners of the facet that is open.
    let mut facet: Option<Vec<DVec3>> = None;
    // The line of the last `endfacet` behind which no solid ends.
    let mut unended = None;
    let lines = source.lines();
    let statements = lines.flat_map(|(number, line)| Statements(line).map(move |it| (number, it)));
    for (number, line) in statements {
        let mut words = line.split_whitespace();
        let Some(word) = words.next() else { continue };
        let misplaced = |cause: &str| {
            source.error_at(
                word,
                cause,
                "write `facet`, `outer loop`, three times `vertex`, `endloop`, `endfacet`",
            )
        };
        match word.to_ascii_lowercase().as_str() {
            "solid" | "endsolid" | "facet" if facet.is_some() => {
                return Err(misplaced("the facet before this line has no `endfacet`"));
            }
            "solid" => {
                let (name, place) = std::mem::replace(
                    &mut solid,
                    (
                        line.trim()[word.len()..].trim().to_owned(),
                        source.place(number),
                    ),
                );
                objects.extend(std::mem::take(&mut soup).object(name, place));
            }
            "facet" => facet = Some(Vec::with_capacity(3)),
            "vertex" => {
                let Some(corners) = facet.as_mut().filter(|corners| corners.len() < 3) else {
                    return Err(misplaced("this vertex is none of the three of a facet"));
                };
                let mut coordinate = || match words.next() {
                    Some(word) => source.number(word, "a coordinate"),
                    None => Err(misplaced("this vertex has fewer than three coordinates")),
                };
                corners.push(DVec3::new(coordinate()?, coordinate()?, coordinate()?));
                if words.next().is_some() {
                    let sentence = "what follows the three coordinates of a vertex is ignored";
                    warnings.add(source, number, sentence);
                }
            }
            "endfacet" => match facet.take().as_deref() {
                Some(&[a, b, c]) => {
                    if soup.triangles.is_empty() {
                        size.objects += 1;
                        size.names += solid.0.len() as u64;
                    }
                    size.triangles += 1;
                    check_size(&source.path, size).map_err(|error| error.at_line(number))?;
                    soup.push([a, b, c]);
                    unended = Some(number);
                }
                _ => return Err(misplaced("this facet has not three vertices")),
            },
            "endsolid" => unended = None,
            "outer" | "endloop" => {}
            _ => {
                let sentence = format!(
                    "lines that begin with {word:?} are ignored",
                    word = shortened(word)
                );
                warnings.add(source, number, sentence);
            }
        }
    }
    if facet.is_some() {
        return Err(source.error(
            "the file ends inside a facet",
            "copy the file again, or export it again",
        ));
    }
    if let Some(line) = unended {
        let sentence = "the text ends behind this facet without `endsolid`; it may be cut off";
        warnings.add(source, line, sentence);
    }
    let (name, place) = solid;
    objects.extend(soup.object(name, place));
    for (number, object) in objects.iter_mut().enumerate() {
        if object.name.is_empty() {
            object.name = format!("solid {}", number + 1);
        }
    }
    scene(&source.path, objects, warnings.into_sentences())
}

/// The statements of a line: one, or several in files without line breaks.
#[derive(Clone)]
struct Statements<'a>(&'a str);

impl<'a> Iterator for Statements<'a> {
    type Item = &'a str;

    fn next(&mut self) -> Option<&'a str> {
        const KEYWORDS: [&str; 7] = [
            "solid", "facet", "outer", "vertex", "endloop", "endfacet", "endsolid",
        ];
        let line = self.0.trim_start();
        let mut words = line.split_whitespace();
        let first = words.next()?;
        let is = |word: &str, keyword: &str| word.eq_ignore_ascii_case(keyword);
        let is_keyword = |word: &str| KEYWORDS.iter().any(|it| is(word, it));
        let ends = is(first, "endsolid");
        let behind = words.clone().skip(1).chain([""]);
        // Names can have words that are keywords. In comments and the like words mean nothing.
        let next = words.zip(behind).find(|&(word, behind)| match first {
            _ if ends => is(word, "solid"),
            _ if is(first, "solid") => {
                is(word, "facet") && is(behind, "normal") || is(word, "endsolid")
            }
            _ => is_keyword(first) && is_keyword(word),
        });
        let end = next.map_or(line.len(), |(word, _)| {
            word.as_ptr() as usize - line.as_ptr() as usize
        });
        let (statement, rest) = line.split_at(end);
        self.0 = rest;
        Some(statement)
    }
}

fn scene(path: &Path, objects: Vec<Object>, warnings: Vec<String>) -> Result<Imported, SceneError> {
    if objects.is_empty() {
        return Err(SceneError::new(
            path,
            "the file has no triangles",
            "export a surface or a solid",
        ));
    }
    let scene = Scene {
        materials: vec![Material::default()],
        objects,
        ..Scene::default()
    };
    Ok(Imported::of(scene, warnings))
}

/// Triangles whose vertices find each other by their coordinates.
#[derive(Default)]
struct Soup {
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    numbers: HashMap<[u64; 3], u32>,
}

impl Soup {
    fn push(&mut self, corners: [DVec3; 3]) {
        let triangle = corners.map(|corner| {
            // Adding 0 makes -0 the same as 0.
            let key = (corner + 0.0).to_array().map(f64::to_bits);
            *self.numbers.entry(key).or_insert_with(|| {
                self.vertices.push(corner);
                self.vertices.len() as u32 - 1
            })
        });
        self.triangles.push(triangle);
    }

    /// The mesh of the triangles, if there are any.
    fn object(self, name: String, place: SourceSpan) -> Option<Object> {
        let shape = Shape::Mesh {
            vertices: self.vertices,
            triangles: self.triangles,
        };
        let any = !self.numbers.is_empty();
        any.then_some(Object {
            name,
            material: 0,
            shape,
            place,
            normals: Default::default(),
            attributes: Default::default(),
        })
    }
}

#[cfg(test)]
pub(super) mod tests;
