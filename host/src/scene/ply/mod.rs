//! Reads PLY, binary and text: the vertices and faces of a mesh.
//!
//! Faces are cut into triangles, and triangle strips (the element `tristrips`, where -1 ends a
//! strip) into theirs. Vertices have normals and colors: whole numbers up to 255 (`ushort`: 65,535) or others
//! up to 1. A color with a number that is not finite is white, and such a normal makes its faces flat, with a warning.
//! Colors of faces, textures and elements of other names are ignored, with a warning each.

mod header;
mod payload;

use super::importer::{Importer, Input, stem};
use super::polygon;
use super::size::Size;
use super::text::{Warnings, check_encoding};
use super::{
    Attributes, CauseAndRemedy, Imported, Material, Normals, Object, Scene, SceneError, Shape,
    SourceSpan,
};
use crate::srgb::linear_of_srgb;
use crate::table::{grouped, shortened};
use glam::DVec3;
use gridel_core::Up;
use header::{Announced, Component};
use payload::{Payload, Skipped};
use ply_rs_bw::parser::Reader;
use ply_rs_bw::ply::{Header, Property, PropertyAccess, PropertyAccessResult};
use std::path::Path;

pub(super) const IMPORTER: Importer = Importer {
    name: "PLY",
    about: "the Stanford scans' meshes",
    extensions: &["ply"],
    // The format does not state it; the Stanford scans stand along y.
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
/// If the file has no faces, or its content is broken. The error names the line of a text file, else the vertex or the
/// face.
fn read(input: Input<'_>) -> Result<Imported, SceneError> {
    let Input { path, bytes, .. } = input;
    check_encoding(path, &bytes)?;
    // The mark that some editors put before text.
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes);
    let mut warnings = Warnings::default();
    let mut reader = Reader::new(bytes);
    let header = header::read(path, bytes, &mut reader, &mut warnings)?;
    let mut payload = Payload::new(path, header.encoding, reader);
    let (mut vertices, mut faces, mut strips) = (Vec::new(), Vec::new(), Vec::new());
    let mut ignored = Vec::new();
    for element in header.elements.values() {
        header::check(path, element, bytes.len())?;
        match element.name.as_str() {
            "vertex" => vertices = payload.read(element, &header, |_: &Vertex| 0)?,
            "face" => {
                let triangles = |face: &Face| face.len().saturating_sub(2);
                faces = payload.read(element, &header, triangles)?;
            }
            // A strip of one triangle takes four numbers, and longer ones take fewer for each.
            "tristrips" => strips = payload.read(element, &header, |it: &Face| it.len() / 4)?,
            name => {
                payload.read(element, &header, |_: &Skipped| 0)?;
                let sentence = format!("elements {name:?} are ignored", name = shortened(name));
                warnings.add_times(SourceSpan::of(path), element.count.max(1), sentence);
                if element.count > 0 {
                    ignored.push(format!("{name:?}", name = shortened(name)));
                }
            }
        }
    }
    payload.warn(&mut warnings);
    if faces.is_empty() && strips.is_empty() {
        return Err(without_surface(path, &ignored));
    }
    warn_of_normals(path, &header, &vertices, &mut warnings);
    let attributes = attributes(path, &header, &vertices, &mut warnings);
    let (shape, normals) = mesh(path, &vertices, &faces, &strips, &mut warnings)?;
    let scene = Scene {
        materials: vec![Material::default()],
        objects: vec![Object {
            name: stem(path),
            material: 0,
            shape,
            place: SourceSpan::of(path),
            normals,
            attributes,
        }],
        ..Scene::default()
    };
    Ok(Imported::of(scene, warnings.into_sentences()))
}

/// The error of a file without faces, whose elements of these names are not read.
fn without_surface(path: &Path, ignored: &[String]) -> SceneError {
    let cause = "the file has no faces and no triangle strips";
    match ignored {
        [] => SceneError::new(
            path,
            cause,
            "export a mesh; points alone cannot be rendered",
        ),
        names => SceneError::new(
            path,
            format!(
                "{cause}, and its elements {} are not read",
                names.join(", ")
            ),
            "export the surface as elements `face` with a list `vertex_indices`",
        ),
    }
}

/// The numbers that end a strip: -1, which is the largest number where a list has no sign.
const STRIP_ENDS: [i64; 2] = [-1, u32::MAX as i64];

/// Warns of normals that are not used.
fn warn_of_normals(path: &Path, header: &Header, vertices: &[Vertex], warnings: &mut Warnings) {
    if vertices.is_empty() {
        return;
    }
    match header::announced(header, Component::Normal) {
        Announced::None => {}
        Announced::Some => {
            let sentence = "normals of vertices without nx, ny or nz are ignored";
            warnings.add_times(SourceSpan::of(path), 1, sentence);
        }
        Announced::All => {
            let are =
                "normals with numbers that are not finite; faces that have them are shaded flat";
            warn_of_vertices(path, vertices, |it| is_finite(it.normal), are, warnings);
        }
    }
}

/// Warns of the vertices that something does not hold for: which the first is, and how many there are.
fn warn_of_vertices(
    path: &Path,
    vertices: &[Vertex],
    holds: impl Fn(&Vertex) -> bool,
    are: &str,
    warnings: &mut Warnings,
) {
    let others = || vertices.iter().enumerate().filter(|(_, it)| !holds(it));
    if let Some((first, _)) = others().next() {
        let sentence = match others().count() {
            1 => format!("vertex {first} (from 0) has {are}"),
            count => format!(
                "{} vertices, of which vertex {first} (from 0) is the first, have {are}",
                grouped(count)
            ),
        };
        warnings.add_times(SourceSpan::of(path), 1, sentence);
    }
}

fn is_finite(numbers: [f64; 3]) -> bool {
    numbers.iter().all(|it| it.is_finite())
}

/// The colors of vertices, if the header announces all channels.
fn attributes(
    path: &Path,
    header: &Header,
    vertices: &[Vertex],
    warnings: &mut Warnings,
) -> Attributes {
    match header::announced(header, Component::Color) {
        Announced::All => {}
        Announced::Some if !vertices.is_empty() => {
            let sentence = "colors of vertices without red, green or blue are ignored";
            warnings.add_times(SourceSpan::of(path), 1, sentence);
            return Attributes::default();
        }
        _ => return Attributes::default(),
    }
    let are = "colors with numbers that are not finite; white is used";
    warn_of_vertices(path, vertices, |it| is_finite(it.color), are, warnings);
    for (sentence, is_so) in [
        (
            "colors of vertices are limited to 0 to 1 (of whole numbers: 0 to 255, or 65,535), their range",
            (|vertex| {
                is_finite(vertex.color) && vertex.color.iter().any(|it| !(0.0..=1.0).contains(it))
            }) as fn(&Vertex) -> bool,
        ),
        ("the alpha of colors of vertices is ignored", |vertex| {
            vertex.alpha < 1.0
        }),
    ] {
        let count = vertices.iter().filter(|vertex| is_so(vertex)).count();
        if count > 0 {
            warnings.add_times(SourceSpan::of(path), count, sentence);
        }
    }
    let linear = |channel: f64| linear_of_srgb(channel.clamp(0.0, 1.0));
    let colors = vertices.iter().map(|vertex| match is_finite(vertex.color) {
        true => vertex.color.map(linear),
        false => [1.0; 3],
    });
    Attributes {
        colors: colors.collect(),
        ..Attributes::default()
    }
}

fn mesh(
    path: &Path,
    read: &[Vertex],
    faces: &[Face],
    strips: &[Face],
    warnings: &mut Warnings,
) -> Result<(Shape, Normals), SceneError> {
    let wrong = |cause: String, remedy: &str| SceneError::new(path, cause, remedy);
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
    let (mut corners, mut points) = (Vec::new(), Vec::new());
    for (number, face) in faces.iter().enumerate() {
        face.corners_into(&mut corners);
        points.clear();
        for &corner in &corners {
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
        let (cut, crosses) =
            polygon::cut("face", &points).map_err(|CauseAndRemedy { cause, remedy }| {
                wrong(format!("face {number} (from 0): {cause}"), &remedy)
            })?;
        crossing += usize::from(crosses.is_some());
        let named = |triangle: [u32; 3]| triangle.map(|corner| corners[corner as usize] as u32);
        triangles.extend(cut.into_iter().map(named));
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
    add_strips(path, strips, vertices.len(), &mut triangles)?;
    if triangles.is_empty() {
        return Err(wrong(
            String::from("no face and no triangle strip of the file has three vertices"),
            "export a mesh; points and lines cannot be rendered",
        ));
    }
    // Where the file lacks some, nothing is smooth.
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

/// Adds the triangles of strips; `known` is the number of vertices.
fn add_strips(
    path: &Path,
    strips: &[Face],
    known: usize,
    triangles: &mut Vec<[u32; 3]>,
) -> Result<(), SceneError> {
    let mut numbers = Vec::new();
    for (number, strip) in strips.iter().enumerate() {
        strip.corners_into(&mut numbers);
        for strip in numbers.split(|corner| STRIP_ENDS.contains(corner)) {
            let mut corners = Vec::with_capacity(strip.len());
            for &corner in strip {
                let index = u32::try_from(corner).ok();
                let index = index.filter(|&index| (index as usize) < known);
                corners.push(index.ok_or_else(|| {
                    SceneError::new(
                        path,
                        format!(
                            "triangle strips {number} (from 0) use vertex {corner}, and there are \
                             {known} vertices"
                        ),
                        "export the file again; vertices count from 0, and -1 ends a strip",
                    )
                })?);
            }
            triangles.extend(strip_triangles(&corners));
            let size = Size {
                objects: 1,
                triangles: triangles.len() as u64,
                ..Size::default()
            };
            if let Some(excess) = size.excess() {
                let cause =
                    format!("up to triangle strips {number} (from 0) the file takes {excess}");
                return Err(SceneError::new(path, cause, payload::TOO_LARGE));
            }
        }
    }
    Ok(())
}

/// Returns the triangles of a strip, of which every second one is turned. Vertices that come twice join strips, and
/// make degenerate triangles.
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

/// A vertex; NaN for missing numbers.
struct Vertex {
    position: [f64; 3],
    normal: [f64; 3],
    /// In sRGB, 0 to 1.
    color: [f64; 3],
    /// 0 to 1.
    alpha: f64,
}

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self {
            position: [f64::NAN; 3],
            normal: [f64::NAN; 3],
            color: [f64::NAN; 3],
            alpha: 1.0,
        }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let (component, is_color) = match Component::named(name) {
            Some(Component::Position(axis)) => (&mut self.position[axis], false),
            Some(Component::Normal(axis)) => (&mut self.normal[axis], false),
            Some(Component::Color(channel)) => (&mut self.color[channel], true),
            Some(Component::Alpha) => (&mut self.alpha, true),
            None => return PropertyAccessResult::Ignored,
        };
        // What white is: no program writes more than a byte's numbers in longer signed types.
        let most = match property {
            Property::Float(_) | Property::Double(_) => 1.0,
            Property::UShort(_) => 65_535.0,
            _ => 255.0,
        };
        let value = match property {
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
        *component = if is_color { value / most } else { value };
        PropertyAccessResult::Set
    }
}

/// The corners of a face: the list of numbers of vertices as it is written, which takes no more memory than in the file.
#[derive(Debug)]
struct Face(Option<Property>);

impl Face {
    /// The number of corners.
    fn len(&self) -> usize {
        match &self.0 {
            Some(Property::ListChar(list)) => list.len(),
            Some(Property::ListUChar(list)) => list.len(),
            Some(Property::ListShort(list)) => list.len(),
            Some(Property::ListUShort(list)) => list.len(),
            Some(Property::ListInt(list)) => list.len(),
            Some(Property::ListUInt(list)) => list.len(),
            _ => 0,
        }
    }

    /// Replaces a list by the corners.
    fn corners_into(&self, corners: &mut Vec<i64>) {
        fn wide<T: Copy + Into<i64>>(list: &[T], corners: &mut Vec<i64>) {
            corners.extend(list.iter().map(|&it| it.into()));
        }
        corners.clear();
        match &self.0 {
            Some(Property::ListChar(list)) => wide(list, corners),
            Some(Property::ListUChar(list)) => wide(list, corners),
            Some(Property::ListShort(list)) => wide(list, corners),
            Some(Property::ListUShort(list)) => wide(list, corners),
            Some(Property::ListInt(list)) => wide(list, corners),
            Some(Property::ListUInt(list)) => wide(list, corners),
            _ => {}
        }
    }
}

impl PropertyAccess for Face {
    fn new() -> Self {
        Self(None)
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if !header::CORNERS.contains(&name) {
            return PropertyAccessResult::Ignored;
        }
        // The header's check rejects other types.
        self.0 = Some(property);
        PropertyAccessResult::Set
    }
}

#[cfg(test)]
pub(super) mod tests;
