//! Reads Wavefront OBJ with its MTL materials.
//!
//! The parser is our own. The crate `tobj` was tried first. It divides positions by `w`, makes triangles of polylines
//! (`l`), and lets NaN through. It rejects comments and continuations on face lines, panics on a color of two numbers,
//! and never names a line. So a file would have to be parsed completely before it was passed on.
//!
//! Every `o`, `g` and change of `usemtl` starts a new mesh, in file order, which holds only the vertices that it uses.
//! Faces are cut into triangles in file order. A face whose corners all have normals is smooth. Smoothing groups are
//! ignored, with a warning. Colors of vertices are in sRGB. Zero-area triangles are kept for the compiler to report. A
//! backslash at the end of a line continues it on the next one, also within names and in MTL files.

mod lines;
mod mtl;
mod parser;

use super::access::Access;
use super::importer::{Importer, Input};
use super::polygon;
use super::text::{Source, Warnings};
use super::texture::Images;
use super::{
    Attributes, CauseAndRemedy, Color, Imported, Material, Normals, Object, Scene, SceneError,
    Shape,
};
use crate::table::{grouped, shortened};
use glam::{DVec2, DVec3};
use gridel_core::Up;
use parser::{NO_INDEX, Parsed, Part};
use std::collections::{HashMap, HashSet};

pub(super) const IMPORTER: Importer = Importer {
    name: "OBJ",
    about: "Wavefront's meshes, with MTL materials",
    extensions: &["obj"],
    // The format does not state it; modelling programs export y up by default.
    up: Up::Y,
    binary: false,
    example: "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 3 1 0\nf 1 2 3 4\n",
    recognizes: |bytes| {
        let mut vertices = bytes.split(|&byte| byte == b'\n').filter_map(|line| {
            let numbers = line.trim_ascii().strip_prefix(b"v ")?;
            Some(str::from_utf8(numbers).ok()?.split_ascii_whitespace())
        });
        // NFF has lines of a `v` as well, but without numbers.
        vertices.next().is_some_and(|mut numbers| {
            let is_number = |word: Option<&str>| word.is_some_and(|it| it.parse::<f64>().is_ok());
            (0..3).all(|_| is_number(numbers.next()))
        })
    },
    read,
};

/// Reads an OBJ file and the material files it names, which lie in the same folder. It has no camera and no lights; the
/// compiler adds them.
///
/// # Errors
/// If the file has no faces, or its content is broken; the error names the line.
fn read(input: Input<'_>) -> Result<Imported, SceneError> {
    let access = input.access;
    import(&input.into_source()?, access)
}

fn import(source: &Source, access: &Access) -> Result<Imported, SceneError> {
    let mut warnings = Warnings::default();
    let continued = lines::continued(source);
    let parsed = parser::parse(source, &continued, &mut warnings)?;
    if parsed.parts.is_empty() {
        return Err(without_faces(source, &parsed));
    }
    let library = read_libraries(source, &parsed, access, &mut warnings)?;
    let mut materials = Materials {
        library,
        used: Vec::new(),
        index: HashMap::new(),
    };
    let mut mesher = Mesher {
        vertices: &parsed.vertices,
        normals: &parsed.normals,
        colors: &parsed.colors,
        coordinates: &parsed.coordinates,
        seen: vec![(usize::MAX, 0); parsed.vertices.len()],
    };
    let mut scene = Scene::default();
    for (number, part) in parsed.parts.iter().enumerate() {
        let name = if part.name.is_empty() {
            format!("mesh {}", number + 1)
        } else {
            part.name.to_owned()
        };
        let material = materials.resolve(part, source, &mut warnings);
        let (shape, normals, attributes) = mesher.mesh(number, part, source, &mut warnings)?;
        scene.objects.push(Object {
            name,
            material,
            shape,
            place: source.place(part.line),
            normals,
            attributes,
        });
    }
    scene.materials = materials.used;
    Ok(Imported::of(scene, warnings.into_sentences()))
}

/// The error of a file in which no face is left, with what was passed over.
fn without_faces(source: &Source, parsed: &Parsed<'_>) -> SceneError {
    let mut cause = String::from("the file has no faces");
    for (number, skipped) in parsed.skipped.iter().enumerate() {
        cause += &match number {
            0 => format!(": {}", skipped.sentence),
            _ => format!("; line {}: {}", skipped.line, skipped.sentence),
        };
        cause += &match skipped.more {
            0 => String::new(),
            1 => String::from(" (and once more)"),
            more => format!(" (and {more} times more)"),
        };
    }
    let remedy = "export the surfaces as polygons (f lines) of at least three vertices";
    let error = source.error(cause, remedy);
    match parsed.skipped.first() {
        Some(first) => error.at_line(first.line),
        None => error,
    }
}

/// The most bytes of text of all material files: a material takes up to 300 times the bytes of its name.
const MOST_LIBRARY_TEXT: usize = 10_000_000;

/// The most names of material files.
const MOST_LIBRARIES: usize = 1000;

/// Reads the files that `mtllib` names. A missing one only causes a warning: it is often not delivered, and the
/// geometry is complete.
fn read_libraries(
    source: &Source,
    parsed: &Parsed<'_>,
    access: &Access,
    warnings: &mut Warnings,
) -> Result<HashMap<String, Material>, SceneError> {
    let mut library = HashMap::new();
    let mut images = Images::new(access);
    let mut seen = HashSet::new();
    // Few names are resolved: that takes calls of the system.
    let mut named = HashSet::new();
    let mut left = MOST_LIBRARY_TEXT;
    for &(line, names) in &parsed.libraries {
        if !named.insert(names) {
            continue;
        }
        let allowed = |name: &str| {
            let path = access.resolve(&source.path, &name.replace('\\', "/"));
            path.map_err(|CauseAndRemedy { cause, remedy }| {
                let cause = format!("the material file {cause}");
                source.error(cause, remedy).at_line(line)
            })
        };
        // A name may contain spaces, and a line may contain several names.
        let names: Vec<&str> = if allowed(names).is_ok_and(|whole| access.is_file(&whole)) {
            vec![names]
        } else {
            let names = names.split_whitespace();
            names.take_while(|word| !word.starts_with('#')).collect()
        };
        for name in names {
            named.insert(name);
            if named.len() > MOST_LIBRARIES {
                let cause = format!("the file names more than {MOST_LIBRARIES} material files");
                let remedy = "put the materials together in one file";
                return Err(source.error(cause, remedy).at_line(line));
            }
            let path = allowed(name)?;
            if !seen.insert(path.clone()) {
                continue;
            }
            match Source::read(&path, access) {
                Ok(file) => {
                    left = left.checked_sub(file.text.len()).ok_or_else(|| {
                        let most = grouped(MOST_LIBRARY_TEXT);
                        let cause =
                            format!("the material files have more than {most} bytes of text");
                        source
                            .error(cause, "leave materials out that no face uses")
                            .at_line(line)
                    })?;
                    let file = lines::joined(file);
                    library.extend(mtl::read(&file, &mut images, warnings)?);
                }
                Err(error) => {
                    let cause = format!(
                        "the material file {name:?} {}; its materials are replaced",
                        error.cause,
                        name = shortened(name)
                    );
                    warnings.add(source, line, cause);
                }
            }
        }
    }
    Ok(library)
}

/// The materials in use, in the order of their first use.
struct Materials<'a> {
    library: HashMap<String, Material>,
    used: Vec<Material>,
    index: HashMap<Option<&'a str>, usize>,
}

impl<'a> Materials<'a> {
    /// The name of a material without a comment behind it, if there is such a material and none of the whole name:
    /// names may have number signs.
    fn without_comment(&self, name: &'a str) -> &'a str {
        let mut signs = name.match_indices('#').map(|(at, _)| &name[..at]);
        let before = signs.find(|it| it.ends_with(char::is_whitespace));
        let before = before.map(str::trim_end);
        let is_known = |name: &&str| self.library.contains_key(*name);
        let before = before.filter(|it| is_known(it) && !is_known(&name));
        before.unwrap_or(name)
    }

    fn resolve(&mut self, part: &Part<'a>, source: &Source, warnings: &mut Warnings) -> usize {
        let material = part.material.map(|name| self.without_comment(name));
        if let Some(&index) = self.index.get(&material) {
            return index;
        }
        let known = material.and_then(|name| self.library.get(name)).cloned();
        if let (Some(name), None) = (material, &known) {
            let sentence = format!(
                "the material {name:?} is defined nowhere; the default is used",
                name = shortened(name)
            );
            warnings.add(source, part.line, sentence);
        }
        let index = self.used.len();
        self.used.push(known.unwrap_or_default());
        self.index.insert(material, index);
        index
    }
}

/// Makes meshes of parts of one file.
struct Mesher<'a> {
    vertices: &'a [DVec3],
    normals: &'a [DVec3],
    colors: &'a [Color],
    coordinates: &'a [DVec2],
    /// For each vertex of the file, the last part that used it and its index there.
    seen: Vec<(usize, u32)>,
}

impl Mesher<'_> {
    fn mesh(
        &mut self,
        number: usize,
        part: &Part<'_>,
        source: &Source,
        warnings: &mut Warnings,
    ) -> Result<(Shape, Normals, Attributes), SceneError> {
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        let mut corners = part.corners.as_slice();
        let mut of_corners = part.normals.as_slice();
        let mut normals = PartNormals::default();
        let mut of_texture = part.coordinates.as_slice();
        let mut attributes = Attributes::default();
        let (mut local, mut points) = (Vec::new(), Vec::new());
        for face in &part.faces {
            let (outline, rest) = corners.split_at(face.corners);
            corners = rest;
            local.clear();
            points.clear();
            for &corner in outline {
                let seen = &mut self.seen[corner as usize];
                if seen.0 != number {
                    *seen = (number, vertices.len() as u32);
                    vertices.push(self.vertices[corner as usize]);
                    attributes.colors.extend(self.colors.get(corner as usize));
                }
                local.push(seen.1);
                points.push(self.vertices[corner as usize]);
            }
            let (cut, crosses) =
                polygon::cut("face", &points).map_err(|CauseAndRemedy { cause, remedy }| {
                    source.error(cause, remedy).at_line(face.line)
                })?;
            if let Some(sentence) = crosses {
                warnings.add(source, face.line, sentence);
            }
            if !of_corners.is_empty() {
                let (outline, rest) = of_corners.split_at(face.corners);
                of_corners = rest;
                if !normals.add(self.normals, outline, &cut) {
                    let sentence = "a face has a normal that the file lacks, and is shaded flat";
                    warnings.add(source, face.line, sentence);
                }
            }
            if !of_texture.is_empty() {
                let (outline, rest) = of_texture.split_at(face.corners);
                of_texture = rest;
                if !self.add_coordinates(&mut attributes, outline, &cut) {
                    let sentence =
                        "a face has texture coordinates that the file lacks, and no texture";
                    warnings.add(source, face.line, sentence);
                }
            }
            triangles.extend(cut.iter().map(|t| t.map(|corner| local[corner as usize])));
        }
        let normals = Normals::given(normals.vectors, normals.triangles, (&vertices, &triangles));
        let shape = Shape::Mesh {
            vertices,
            triangles,
        };
        Ok((shape, normals, attributes))
    }

    /// Adds the texture coordinates of a face's corners, which has these triangles, v downwards. Returns false if one of
    /// them is missing.
    fn add_coordinates(
        &self,
        attributes: &mut Attributes,
        outline: &[u32],
        triangles: &[[u32; 3]],
    ) -> bool {
        let found = outline.iter().map(|it| self.coordinates.get(*it as usize));
        let Some(found) = found.collect::<Option<Vec<_>>>() else {
            let none = triangles.iter().map(|_| Attributes::NONE);
            attributes.triangles.extend(none);
            return outline.contains(&NO_INDEX);
        };
        let first = attributes.coordinates.len() as u32;
        let down = found.into_iter().map(|it| DVec2::new(it.x, 1.0 - it.y));
        attributes.coordinates.extend(down);
        let named = triangles.iter().map(|it| it.map(|corner| first + corner));
        attributes.triangles.extend(named);
        true
    }
}

/// The normals that a part uses.
#[derive(Default)]
struct PartNormals {
    vectors: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    /// The numbers here of normals of the file.
    numbers: HashMap<u32, u32>,
}

impl PartNormals {
    /// Adds those of a face's corners, which has these triangles. Returns false if one of them is missing.
    fn add(&mut self, all: &[DVec3], outline: &[u32], triangles: &[[u32; 3]]) -> bool {
        let is_flat = outline.contains(&NO_INDEX);
        let is_missing = outline.iter().any(|it| *it as usize >= all.len());
        let is_complete = is_flat || !is_missing;
        if is_flat || is_missing {
            self.triangles
                .extend(triangles.iter().map(|_| Normals::FLAT));
            return is_complete;
        }
        let number = |corner: &u32| {
            *self.numbers.entry(*corner).or_insert_with(|| {
                self.vectors.push(all[*corner as usize]);
                self.vectors.len() as u32 - 1
            })
        };
        let local: Vec<u32> = outline.iter().map(number).collect();
        let named = |triangle: &[u32; 3]| triangle.map(|corner| local[corner as usize]);
        self.triangles.extend(triangles.iter().map(named));
        true
    }
}

#[cfg(test)]
mod tests;
