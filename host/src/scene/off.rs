//! Reads OFF, the Object File Format of Geomview: the vertices and polygons of a mesh, as text.
//!
//! The keyword may be missing. It may have the prefixes `ST`, `C` and `N`, each once, for vertices with texture
//! coordinates, colors and normals on their lines. Geomview names them in this order, and MeshLab in the order `N`, `C`,
//! `ST`; any is read, also in lower case. On the line, coordinates come first. Geomview has the normal, the color and the
//! texture coordinates behind them; MeshLab writes the color before the normal. All three are ignored, with a warning
//! each, so their order does not matter, and so are the colors of faces. Many programs write colors behind vertices
//! without announcing them; these are ignored in the same way, where every vertex and every face has a line of its own.
//! Vertices of other than three coordinates (`4OFF`, `nOFF`) and binary files are rejected. Comments begin with `#`.

use super::error::CauseAndRemedy;
use super::importer::{Importer, Input, stem};
use super::polygon;
use super::size::Size;
use super::text::{Source, Warnings};
use super::words::Words;
use super::{Imported, Material, Object, Scene, SceneError, Shape, SourceSpan};
use crate::table::shortened;
use glam::DVec3;
use gridel_core::Up;

pub(super) const IMPORTER: Importer = Importer {
    name: "OFF",
    about: "Geomview's meshes of polygons",
    extensions: &["off"],
    // The format does not state it; Geomview's own camera has y up and looks along -z.
    up: Up::Y,
    binary: false,
    example: "OFF\n# an arrowhead\n4 1 4\n1 0 0\n0 2 0\n-1 0 0\n0 .5 0\n4 0 1 2 3\n",
    recognizes: |bytes| {
        let lines = bytes.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii);
        let mut lines = lines.filter(|line| !line.is_empty() && !line.starts_with(b"#"));
        let words = |line: Option<&[u8]>| -> Vec<String> {
            let line = line.unwrap_or_default();
            let text = String::from_utf8_lossy(&line[..line.len().min(256)]).into_owned();
            text.split_whitespace().map(String::from).collect()
        };
        let (first, second) = (words(lines.next()), words(lines.next()));
        let are_numbers = |words: &[String]| words.iter().all(|it| it.parse::<f64>().is_ok());
        let counts = first.len() == 3 && first.iter().all(|it| it.parse::<u32>().is_ok());
        first
            .first()
            .is_some_and(|word| Keyword::of(word).is_some())
            || counts && second.len() >= 3 && are_numbers(&second[..3])
    },
    read,
};

/// The properties of vertices that the first word of a file states.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Keyword<'a> {
    textured: bool,
    colored: bool,
    normals: bool,
    /// `4` or `n`, for vertices that have not three coordinates.
    dimension: &'a str,
    /// Numbers that follow without a space between, as in the files of ModelNet.
    rest: &'a str,
}

impl<'a> Keyword<'a> {
    fn of(word: &'a str) -> Option<Self> {
        let written = ["OFF", "off"].map(|it| word.split_once(it));
        let is_lower = written[0].is_none();
        let (mut prefix, rest) = written.into_iter().flatten().next()?;
        let mut keyword = Self {
            rest,
            ..Self::default()
        };
        loop {
            let properties = [
                ("ST", &mut keyword.textured),
                ("C", &mut keyword.colored),
                ("N", &mut keyword.normals),
            ];
            // A small `n` before capitals stands for dimensions.
            let begins = |letters: &str| {
                let head = prefix.get(..letters.len());
                head.is_some_and(|it| it == letters || is_lower && it.eq_ignore_ascii_case(letters))
            };
            let mut properties = properties.into_iter();
            let Some((letters, has)) = properties.find(|(it, has)| !**has && begins(it)) else {
                break;
            };
            *has = true;
            prefix = &prefix[letters.len()..];
        }
        keyword.dimension = prefix;
        let is_whole = ["", "4", "n", "4n"].contains(&prefix)
            && rest.bytes().all(|byte| byte.is_ascii_digit());
        is_whole.then_some(keyword)
    }

    /// Returns whether a word was meant as a keyword.
    fn is_like(word: &str) -> bool {
        let letters = word.trim_end_matches(|c: char| c.is_ascii_digit());
        let end = letters.len().saturating_sub(3);
        letters
            .get(end..)
            .is_some_and(|it| it.eq_ignore_ascii_case("OFF"))
    }

    /// The fewest numbers that a vertex has; a color may lack its opacity.
    fn fewest_numbers(self) -> usize {
        3 + 3 * usize::from(self.normals)
            + 3 * usize::from(self.colored)
            + 2 * usize::from(self.textured)
    }
}

/// Reads an OFF file. It has no camera and no lights; the compiler adds them.
///
/// # Errors
/// If the file is binary, has no faces, or its content is broken; the error names the line.
fn read(input: Input<'_>) -> Result<Imported, SceneError> {
    let name = stem(input.path);
    let source = &input.into_source()?;
    let mut warnings = Warnings::default();
    let mut words = Words::new(source);
    let (keyword, [vertices, faces]) = header(source, &mut words)?;
    let vertices = read_vertices(
        source,
        &mut words,
        keyword,
        [vertices, faces],
        &mut warnings,
    )?;
    let triangles = read_faces(source, &mut words, &vertices, faces, &mut warnings)?;
    if words.next().is_some() {
        let sentence = "lines behind the last face are ignored";
        warnings.add(source, words.line, sentence);
    }
    let scene = Scene {
        materials: vec![Material::default()],
        objects: vec![Object {
            name,
            material: 0,
            shape: Shape::Mesh {
                vertices,
                triangles,
            },
            place: SourceSpan::of(&source.path),
            normals: Default::default(),
            attributes: Default::default(),
        }],
        ..Scene::default()
    };
    Ok(Imported::of(scene, warnings.into_sentences()))
}

/// Reads the keyword, and the numbers of vertices and faces.
fn header<'a>(
    source: &'a Source,
    words: &mut Words<'a>,
) -> Result<(Keyword<'a>, [usize; 2]), SceneError> {
    let first = words.expect("the keyword `OFF`")?;
    let keyword = Keyword::of(first);
    if let Some(keyword) = keyword {
        if !keyword.dimension.is_empty() {
            return Err(source.error_at(
                first,
                format!("the vertices of {first} have not three coordinates"),
                "export the file again, as OFF with three coordinates for each vertex",
            ));
        }
        let after = words.rest_of_line();
        if after.starts_with("BINARY") {
            return Err(source.error_at(
                after,
                "the file is binary OFF, which is not read",
                "export it again as text, or as binary PLY or STL",
            ));
        }
    }
    if keyword.is_none() && Keyword::is_like(first) {
        return Err(source.error_at(
            first,
            format!("the keyword {:?} is unknown", shortened(first)),
            "write OFF, NOFF (with normals), COFF (colors), STOFF (texture coordinates), or several such as NCOFF",
        ));
    }
    // The first word is a count where the keyword is missing or ends with one.
    let glued = keyword.map_or(first, |it| it.rest);
    if !glued.is_empty() {
        words.put_back(glued);
    }
    let vertices = words.count("the number of vertices")?;
    let line = words.line;
    let faces = words.count("the number of faces")?;
    // No reader uses the number of edges, and some files leave it out.
    let left_out =
        words.rest_of_line().is_empty() && line == words.line && words.count_of_next_line() != 1;
    if !left_out {
        words.count("the number of edges")?;
    }
    if faces == 0 {
        return Err(source.error(
            "the file has no faces",
            "export a mesh; points alone cannot be rendered",
        ));
    }
    Ok((keyword.unwrap_or_default(), [vertices, faces]))
}

/// Vertices that weigh as a triangle does.
const CORNERS: usize = 3;

/// Rejects the vertex or the face at which the file no longer fits into memory.
fn check_size(source: &Source, size: Size, part: &str, line: usize) -> Result<(), SceneError> {
    let Some(excess) = size.excess() else {
        return Ok(());
    };
    let cause = format!("up to this {part} the file takes {excess}");
    let remedy = "export a part of the mesh, or one with fewer faces";
    Err(source.error(cause, remedy).at_line(line))
}

fn read_vertices(
    source: &Source,
    words: &mut Words<'_>,
    keyword: Keyword<'_>,
    [count, faces]: [usize; 2],
    warnings: &mut Warnings,
) -> Result<Vec<DVec3>, SceneError> {
    let unannounced = keyword.fewest_numbers() == 3 && has_unannounced_numbers(words, count, faces);
    let fewest = keyword.fewest_numbers() + usize::from(unannounced);
    let mut vertices = Vec::new();
    let mut size = Size {
        objects: 1,
        ..Size::default()
    };
    let mut first_line = 0;
    for number in 0..count {
        let mut position = [0.0; 3];
        for (value, axis) in position.iter_mut().zip(["x", "y", "z"]) {
            *value = words.number(format_args!(
                "the {axis} coordinate of vertex {number} (from 0)"
            ))?;
        }
        vertices.push(DVec3::from_array(position));
        size.triangles = (vertices.len() / CORNERS) as u64;
        check_size(source, size, "vertex", words.line)?;
        if number == 0 {
            first_line = words.line;
        }
        if fewest > 3 {
            let found = 3 + words.skip_line();
            if found < fewest {
                return Err(source
                    .error(
                        format!("vertex {number} (from 0) has {found} numbers, and {fewest} are announced"),
                        "write every vertex on a line of its own, with all that the keyword announces",
                    )
                    .at_line(words.line));
            }
        }
    }
    for (has, sentence) in [
        (
            unannounced,
            "the numbers behind the coordinates of a vertex are ignored; the keyword does not announce them",
        ),
        (
            keyword.colored,
            "the color of a vertex is ignored; the surface has one color",
        ),
        (
            keyword.normals,
            "the normal of a vertex is ignored; for smooth normals use `--normals smooth=40`",
        ),
        (
            keyword.textured,
            "the texture coordinates of a vertex are ignored, as no image can be named; export glTF or OBJ to show one",
        ),
    ] {
        if has && count > 0 {
            warnings.add_times(source.place(first_line), count, sentence);
        }
    }
    Ok(vertices)
}

/// Returns whether every vertex has more numbers than its coordinates, on a line of its own. Where lines end says so only
/// in files that have a line for each vertex and each face.
fn has_unannounced_numbers(words: &Words<'_>, vertices: usize, faces: usize) -> bool {
    let is_wide = |line: &str| {
        let mut words = line.split_whitespace();
        words.clone().nth(3).is_some() && words.all(|word| word.parse::<f64>().is_ok())
    };
    let is_face = |line: &str| {
        let mut words = line.split_whitespace();
        let corners = words.next().and_then(|word| word.parse().ok());
        corners.is_some_and(|corners: usize| corners > 0 && words.nth(corners - 1).is_some())
    };
    let mut lines = words.lines_ahead();
    words.rest_of_line().is_empty()
        && vertices > 0
        && lines
            .by_ref()
            .take(vertices)
            .filter(|it| is_wide(it))
            .count()
            == vertices
        && lines.take(faces).filter(|it| is_face(it)).count() == faces
}

fn read_faces(
    source: &Source,
    words: &mut Words<'_>,
    vertices: &[DVec3],
    count: usize,
    warnings: &mut Warnings,
) -> Result<Vec<[u32; 3]>, SceneError> {
    let wrong = |line, cause: String, remedy: &str| source.error(cause, remedy).at_line(line);
    let mut size = Size {
        objects: 1,
        triangles: (vertices.len() / CORNERS) as u64,
        ..Size::default()
    };
    let mut triangles = Vec::new();
    let (mut corners, mut points) = (Vec::new(), Vec::new());
    for face in 0..count {
        let corner_count = words.count(format_args!(
            "the number of vertices of face {face} (from 0)"
        ))?;
        let line = words.line;
        corners.clear();
        points.clear();
        for _ in 0..corner_count {
            let corner = words.count(format_args!("a vertex of face {face} (from 0)"))?;
            let known = vertices.len();
            points.push(*vertices.get(corner).ok_or_else(|| {
                let cause = format!(
                    "face {face} (from 0) uses vertex {corner}, and there are {known} vertices"
                );
                wrong(
                    words.line,
                    cause,
                    "export the file again; vertices count from 0",
                )
            })?);
            corners.push(corner as u32);
            let within = (triangles.len() + corners.len().saturating_sub(2)) as u64;
            size.triangles = size.triangles.max(within);
            check_size(source, size, "face", words.line)?;
        }
        if words.skip_line() > 0 {
            let sentence = "the color of a face is ignored; the surface has one color";
            warnings.add(source, words.line, sentence);
        }
        if corner_count < 3 {
            let sentence = "a face has fewer than three vertices and is left out";
            warnings.add(source, line, sentence);
            continue;
        }
        let (cut, crosses) = polygon::cut("face", &points)
            .map_err(|CauseAndRemedy { cause, remedy }| wrong(line, cause, &remedy))?;
        if let Some(sentence) = crosses {
            warnings.add(source, line, sentence);
        }
        let named = |triangle: [u32; 3]| triangle.map(|corner| corners[corner as usize]);
        triangles.extend(cut.into_iter().map(named));
    }
    if triangles.is_empty() {
        return Err(source.error(
            "no face of the file has three vertices",
            "export a mesh; points and lines cannot be rendered",
        ));
    }
    Ok(triangles)
}

#[cfg(test)]
mod tests;
