//! Reads PLY, binary and text: the vertices and faces of a mesh.
//!
//! Faces are cut into triangles, and triangle strips (the element `tristrips`, where -1 ends a
//! strip) into theirs. Colors, normals, textures and elements of other names are ignored, with a
//! warning each.

use super::importer::{Importer, Input, stem};
use super::polygon::{self, MAX_CONCAVE};
use super::text::{Warnings, check_encoding};
use super::{Imported, Material, Normals, Object, Scene, SceneError, Shape, SourceSpan};
use glam::DVec3;
use gridel_core::Up;
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{ElementDef, Property, PropertyAccess, PropertyAccessResult};
use std::path::Path;

pub(super) const IMPORTER: Importer = Importer {
    name: "PLY",
    about: "the Stanford scans' meshes",
    extensions: &["ply"],
    // The format says nothing; the Stanford scans stand along y.
    up: Up::Y,
    binary: true,
    example: "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
              property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
              0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
    recognizes: |bytes| bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r"),
    read,
};

/// Reads a PLY file. It has no camera and no lights; the compiler adds them.
///
/// # Errors
/// If the file has no faces, or its content is broken; the error names the line where there are lines,
/// else the vertex or the face.
fn read(input: Input<'_>) -> Result<Imported, SceneError> {
    let Input { path, bytes, .. } = input;
    check_encoding(path, &bytes)?;
    let broken = |error: ParseError| {
        let cause = error.to_string();
        let cause = cause.split_once(": ").filter(|_| error.line().is_some());
        let cause = cause.map_or_else(|| error.to_string(), |(_, cause)| cause.to_owned());
        let sentence: Vec<_> = cause.split_whitespace().collect();
        let error_at = SceneError::new(
            path,
            sentence.join(" "),
            "export the file again; text and both orders of bytes are understood",
        );
        match error.line() {
            Some(line) => error_at.at_line(line),
            None => error_at,
        }
    };
    let mut rest = &bytes[..];
    let mut reader = Reader::new(&mut rest);
    let header = Parser::<Skipped>::new()
        .read_header(&mut reader)
        .map_err(broken)?;
    let (mut vertices, mut faces, mut strips) = (Vec::new(), Vec::new(), Vec::new());
    let mut warnings = Warnings::default();
    ignored(path, &bytes, &mut warnings);
    for element in header.elements.values() {
        announced(path, element, bytes.len())?;
        match element.name.as_str() {
            "vertex" => {
                let parser = Parser::<Vertex>::new();
                let read = parser.read_payload_for_element(&mut reader, element, &header);
                vertices = read.map_err(broken)?;
            }
            "face" => {
                let parser = Parser::<Face>::new();
                let read = parser.read_payload_for_element(&mut reader, element, &header);
                faces = read.map_err(broken)?;
            }
            "tristrips" => {
                let parser = Parser::<Face>::new();
                let read = parser.read_payload_for_element(&mut reader, element, &header);
                strips = read.map_err(broken)?;
            }
            name => {
                let parser = Parser::<Skipped>::new();
                let read = parser.read_payload_for_element(&mut reader, element, &header);
                read.map_err(broken)?;
                let sentence = format!("elements {name:?} are ignored");
                warnings.add_times(SourceSpan::of(path), element.count.max(1), sentence);
            }
        }
    }
    if !rest.trim_ascii().is_empty() {
        let sentence = "data behind what the header announces is ignored";
        warnings.add_times(SourceSpan::of(path), 1, sentence.to_owned());
    }
    let (shape, normals) = mesh(path, &vertices, &faces, &strips, &mut warnings)?;
    let scene = Scene {
        materials: vec![Material::default()],
        objects: vec![Object {
            name: stem(path),
            material: 0,
            shape,
            place: SourceSpan::of(path),
            normals,
        }],
        ..Scene::default()
    };
    Ok(Imported {
        scene,
        warnings: warnings.into_sentences(),
        molecules: false,
        choices: false,
        assemblies: false,
        posed: false,
        copied: 0,
    })
}

/// Properties that change a picture: what they are, and what the picture lacks.
const IGNORED: [(&[&str], &str, &str); 1] = [(
    &[
        "red",
        "green",
        "blue",
        "diffuse_red",
        "diffuse_green",
        "diffuse_blue",
    ],
    "color",
    "the surface has one color",
)];

/// Warns of what the header announces that changes the picture and is not drawn.
fn ignored(path: &Path, bytes: &[u8], warnings: &mut Warnings) {
    let header = bytes
        .split(|&byte| byte == b'\n')
        .map(String::from_utf8_lossy);
    // The element whose properties follow, how many of it there are, and what it was warned of.
    let (mut element, mut count, mut is_reported) = (String::new(), 0, [false; IGNORED.len()]);
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
                is_reported = [false; IGNORED.len()];
            }
            ["comment", "TextureFile", ..] => {
                let sentence = "textures are not drawn; the plain colors are used";
                warnings.add_times(place, 1, sentence);
            }
            ["property", .., name] if ["vertex", "face"].contains(&&*element) && count > 0 => {
                let is_it = |(names, ..): &(&[&str], _, _)| names.contains(&name);
                let Some(kind) = IGNORED.iter().position(is_it) else {
                    continue;
                };
                if !std::mem::replace(&mut is_reported[kind], true) {
                    let (_, what, lacking) = IGNORED[kind];
                    let sentence = format!("the {what} of a {element} is ignored; {lacking}");
                    warnings.add_times(place, count, sentence);
                }
            }
            _ => {}
        }
    }
}

/// Rejects a number of elements that the file cannot hold: each takes a byte at least.
fn announced(path: &Path, element: &ElementDef, bytes: usize) -> Result<(), SceneError> {
    if element.count <= bytes && (!element.properties.is_empty() || element.count == 0) {
        return Ok(());
    }
    Err(SceneError::new(
        path,
        format!(
            "the header announces {} elements {:?} of {} properties, and the file has {bytes} bytes",
            element.count,
            element.name,
            element.properties.len()
        ),
        "copy the file again, as binary, or export it again",
    ))
}

fn mesh(
    path: &Path,
    read: &[Vertex],
    faces: &[Face],
    strips: &[Face],
    warnings: &mut Warnings,
) -> Result<(Shape, Normals), SceneError> {
    let wrong = |cause: String, remedy: &str| SceneError::new(path, cause, remedy);
    if faces.is_empty() && strips.is_empty() {
        return Err(wrong(
            String::from("the file has no faces and no triangle strips"),
            "export a mesh; points alone cannot be rendered",
        ));
    }
    let vertices: Vec<DVec3> = read
        .iter()
        .map(|vertex| DVec3::from_array(vertex.position))
        .collect();
    if let Some(number) = vertices.iter().position(|vertex| !vertex.is_finite()) {
        return Err(wrong(
            format!("vertex {number} (from 0) has no x, y and z that are finite numbers"),
            "export the file again, or repair the vertex",
        ));
    }
    let mut triangles = Vec::new();
    let (mut short, mut crossing) = (0_usize, 0_usize);
    let mut points = Vec::new();
    for (number, face) in faces.iter().enumerate() {
        points.clear();
        for &corner in &face.0 {
            let vertex = usize::try_from(corner)
                .ok()
                .and_then(|corner| vertices.get(corner));
            points.push(*vertex.ok_or_else(|| {
                wrong(
                    format!(
                        "face {number} (from 0) uses vertex {corner}, and there are {} vertices",
                        vertices.len()
                    ),
                    "export the file again; vertices count from 0",
                )
            })?);
        }
        if points.len() < 3 {
            short += 1;
            continue;
        }
        let cut = polygon::triangulate(&points).ok_or_else(|| {
            wrong(
                format!(
                    "face {number} (from 0) is concave and has {} vertices",
                    points.len()
                ),
                &format!("split it into faces of at most {MAX_CONCAVE} vertices"),
            )
        })?;
        crossing += usize::from(!cut.exact);
        let named = |triangle: [u32; 3]| triangle.map(|corner| face.0[corner as usize] as u32);
        triangles.extend(cut.triangles.into_iter().map(named));
    }
    for (count, sentence) in [
        (
            short,
            "a face has fewer than three vertices and is left out",
        ),
        (
            crossing,
            "a face crosses itself; its triangles cover more than it encloses",
        ),
    ] {
        if count > 0 {
            warnings.add_times(SourceSpan::of(path), count, sentence);
        }
    }
    for (number, strip) in strips.iter().enumerate() {
        for strip in strip.0.split(|&corner| corner == -1) {
            let mut corners = Vec::with_capacity(strip.len());
            for &corner in strip {
                let index = u32::try_from(corner).ok();
                let index = index.filter(|&index| (index as usize) < vertices.len());
                corners.push(index.ok_or_else(|| {
                    wrong(
                        format!(
                            "triangle strips {number} (from 0) use vertex {corner}, and there are \
                             {} vertices",
                            vertices.len()
                        ),
                        "export the file again; vertices count from 0, and -1 ends a strip",
                    )
                })?);
            }
            triangles.extend(strip_triangles(&corners));
        }
    }
    if triangles.is_empty() {
        return Err(wrong(
            String::from("no face and no triangle strip of the file has three vertices"),
            "export a mesh; points and lines cannot be rendered",
        ));
    }
    // Of those that the file lacks nothing is smooth.
    let normals = read.iter().map(|vertex| DVec3::from_array(vertex.normal));
    let normals = Normals::given(
        normals.collect(),
        triangles.clone(),
        (&vertices, &triangles),
    );
    let shape = Shape::Mesh {
        vertices,
        triangles,
    };
    Ok((shape, normals))
}

/// The triangles of a strip, of which every second one is turned. Vertices that come twice join
/// strips, and make triangles that are none.
fn strip_triangles(corners: &[u32]) -> impl Iterator<Item = [u32; 3]> {
    let triangles = corners.windows(3).enumerate().map(|(number, c)| {
        let turned = number % 2 == 1;
        if turned {
            [c[1], c[0], c[2]]
        } else {
            [c[0], c[1], c[2]]
        }
    });
    triangles.filter(|[a, b, c]| a != b && b != c && c != a)
}

/// A vertex; NaN where it says nothing.
struct Vertex {
    position: [f64; 3],
    normal: [f64; 3],
}

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self {
            position: [f64::NAN; 3],
            normal: [f64::NAN; 3],
        }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let component = match name {
            "x" => &mut self.position[0],
            "y" => &mut self.position[1],
            "z" => &mut self.position[2],
            "nx" => &mut self.normal[0],
            "ny" => &mut self.normal[1],
            "nz" => &mut self.normal[2],
            _ => return PropertyAccessResult::Ignored,
        };
        *component = match property {
            Property::Float(value) => value.into(),
            Property::Double(value) => value,
            Property::Char(value) => value.into(),
            Property::UChar(value) => value.into(),
            Property::Short(value) => value.into(),
            Property::UShort(value) => value.into(),
            Property::Int(value) => value.into(),
            Property::UInt(value) => value.into(),
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

/// The corners of a face: numbers of vertices, as they are written.
struct Face(Vec<i64>);

impl PropertyAccess for Face {
    fn new() -> Self {
        Self(Vec::new())
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if !["vertex_indices", "vertex_index"].contains(&name) {
            return PropertyAccessResult::Ignored;
        }
        fn wide<T: Into<i64>>(list: Vec<T>) -> Vec<i64> {
            list.into_iter().map(Into::into).collect()
        }
        self.0 = match property {
            Property::ListChar(list) => wide(list),
            Property::ListUChar(list) => wide(list),
            Property::ListShort(list) => wide(list),
            Property::ListUShort(list) => wide(list),
            Property::ListInt(list) => wide(list),
            Property::ListUInt(list) => wide(list),
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

/// An element that nothing is taken from.
struct Skipped;

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Self
    }
}

#[cfg(test)]
pub(super) mod tests;
