//! Reads glTF 2.0, as text (`.gltf`) and binary (`.glb`): the default scene with its nodes, meshes,
//! materials, cameras and lights.
//!
//! Each set of triangles of each node becomes an object, in the order of the nodes; a mesh that
//! several nodes share is copied. Meshes stand as they are at rest: skins, morph targets and
//! animations are passed over, and so are normals, textures and vertex colours, since geometry is
//! exact here and colours come from materials. What of this a file has, a warning tells.

mod buffers;
mod material;
mod view;

use super::text::read_file;
use super::{Imported, Object, Place, Scene, SceneError, Shape};
use buffers::Buffers;
use glam::{DMat4, DQuat, DVec3};
use gltf::json::camera::Type;
use gltf::json::validation::Checked;
use gltf::mesh::Mode;
use gltf::scene::Transform;
use gltf::{Document, Gltf, Node, Primitive, Semantic};
use std::collections::HashMap;
use std::path::Path;
use view::View;

/// Most vertices and triangles of a file, each instance counted: what a blob can hold.
const MOST: usize = 1 << 24;

/// Reads a glTF file, and the buffers it names, which lie beside it. Where it has no camera or no
/// lights, the compiler adds them.
///
/// # Errors
/// If the file or a buffer cannot be read, a required extension is not understood, there are no
/// triangles, or the content is broken; the error names the line of broken JSON, else the element.
pub(super) fn load(path: &Path) -> Result<Imported, SceneError> {
    let Gltf { document, blob } = parse(path, &read_file(path)?)?;
    let mut importer = Importer {
        path,
        place: Place::of(path),
        buffers: Buffers::read(path, &document, blob)?,
        scene: Scene::default(),
        materials: HashMap::new(),
        view: View::default(),
        vertices: 0,
        triangles: 0,
        warnings: Vec::new(),
    };
    importer.passed_over(&document);
    importer.nodes(&document)?;
    if importer.scene.objects.is_empty() {
        return Err(importer.error(
            "the scene of the file has no triangles",
            "export meshes; points and lines cannot be rendered",
        ));
    }
    let Importer {
        mut scene,
        view,
        place,
        mut warnings,
        ..
    } = importer;
    view.finish(&mut scene, &mut warnings);
    let warnings = warnings
        .into_iter()
        .map(|sentence| format!("{place}: {sentence}"))
        .collect();
    Ok(Imported {
        scene,
        warnings,
        molecules: false,
    })
}

fn parse(path: &Path, bytes: &[u8]) -> Result<Gltf, SceneError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let again = "export the file again, as glTF 2.0";
    // The crate takes this length for at least that of the header.
    if let [b'g', b'l', b'T', b'F', _, _, _, _, length @ ..] = bytes
        && let Some(length) = length.first_chunk()
        && u32::from_le_bytes(*length) < 12
    {
        let cause = "the file is no glTF: its header announces less than itself";
        return Err(SceneError::new(path, cause, again));
    }
    let broken = |error: gltf::Error| match error {
        gltf::Error::Deserialize(error) => {
            let wrong = SceneError::new(path, error.to_string(), again);
            // In a binary file the text has lines of its own.
            match error.line() {
                line if line > 0 && !bytes.starts_with(b"glTF") => wrong.at_line(line),
                _ => wrong,
            }
        }
        gltf::Error::Validation(problems) => match problems.into_iter().next() {
            Some((place, gltf::json::validation::Error::Unsupported)) => SceneError::new(
                path,
                format!("an extension that the file requires is not understood: {place}"),
                "export without it; compressed and quantised meshes are not read",
            ),
            Some((place, error)) => {
                let cause = error.to_string().to_lowercase();
                SceneError::new(path, format!("{place}: {cause}"), again)
            }
            None => SceneError::new(path, "the file is no valid glTF", again),
        },
        error => SceneError::new(path, format!("the file is no glTF: {error}"), again),
    };
    let Gltf { document, blob } = Gltf::from_slice_without_validation(bytes).map_err(broken)?;
    let root = document.into_json();
    // The crate looks all this up without having validated it.
    let lacks = |camera: &gltf::json::Camera| match camera.type_ {
        Checked::Valid(Type::Perspective) => camera.perspective.is_none(),
        Checked::Valid(Type::Orthographic) => camera.orthographic.is_none(),
        Checked::Invalid => false,
    };
    if let Some(number) = root.cameras.iter().position(lacks) {
        let cause = format!("camera {number} lacks the numbers of its type");
        return Err(SceneError::new(path, cause, again));
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
                    again,
                ));
            }
        }
    }
    let document = Document::from_json(root).map_err(broken)?;
    Ok(Gltf { document, blob })
}

/// What a file has come to so far.
struct Importer<'a> {
    path: &'a Path,
    place: Place,
    buffers: Buffers<'a>,
    scene: Scene,
    /// Materials in use, by their number in the file; the default has none.
    materials: HashMap<Option<usize>, usize>,
    view: View,
    vertices: usize,
    triangles: usize,
    /// Sentences, each once.
    warnings: Vec<String>,
}

impl Importer<'_> {
    fn error(&self, cause: impl Into<String>, remedy: &str) -> SceneError {
        SceneError::new(self.path, cause, remedy)
    }

    fn warn(&mut self, sentence: impl Into<String>) {
        let sentence = sentence.into();
        if !self.warnings.contains(&sentence) {
            self.warnings.push(sentence);
        }
    }

    /// Tells what nothing is made of.
    fn passed_over(&mut self, document: &Document) {
        if document.scenes().len() > 1 {
            self.warn("the file has several scenes, of which the default one is read");
        }
        if document.textures().len() > 0 {
            self.warn("textures are not drawn; the plain colours are used");
        }
        if document.animations().len() > 0 || document.skins().len() > 0 {
            self.warn("skins and animations are passed over; meshes stand as they are at rest");
        }
        let known = [
            "KHR_lights_punctual",
            "KHR_materials_ior",
            "KHR_materials_transmission",
            "KHR_materials_volume",
        ];
        let used = document.extensions_used();
        let others: Vec<_> = used.filter(|name| !known.contains(name)).collect();
        if !others.is_empty() {
            self.warn(format!("extensions are passed over: {}", others.join(", ")));
        }
    }

    /// Walks the nodes of the default scene, or else of the first, or else all.
    fn nodes(&mut self, document: &Document) -> Result<(), SceneError> {
        let mut inner = vec![false; document.nodes().len()];
        for child in document.nodes().flat_map(|node| node.children()) {
            inner[child.index()] = true;
        }
        let scene = document.default_scene();
        let mut open: Vec<(Node<'_>, DMat4)> = match scene.or_else(|| document.scenes().next()) {
            Some(scene) => scene.nodes().map(|node| (node, DMat4::IDENTITY)).collect(),
            None => document
                .nodes()
                .filter(|node| !inner[node.index()])
                .map(|node| (node, DMat4::IDENTITY))
                .collect(),
        };
        open.reverse();
        let mut seen = vec![false; document.nodes().len()];
        while let Some((node, outer)) = open.pop() {
            if std::mem::replace(&mut seen[node.index()], true) {
                return Err(self.error(
                    format!("node {} is inside of itself or of two nodes", node.index()),
                    "give every node one parent at most",
                ));
            }
            let world = outer * transform(&node);
            if !world.is_finite() {
                return Err(self.error(
                    format!("the transform of node {} is not finite", node.index()),
                    "export the file again, or repair the node",
                ));
            }
            self.node(&node, &world)?;
            let from = open.len();
            open.extend(node.children().map(|child| (child, world)));
            open[from..].reverse();
        }
        Ok(())
    }

    fn node(&mut self, node: &Node<'_>, world: &DMat4) -> Result<(), SceneError> {
        if let Some(camera) = node.camera() {
            self.view.camera(&camera, world, &mut self.scene.render);
        }
        if let Some(light) = node.light() {
            self.view.light(&light, world);
        }
        let Some(mesh) = node.mesh() else {
            return Ok(());
        };
        let name = node.name().or(mesh.name());
        let name = name.map_or_else(|| format!("node {}", node.index()), str::to_owned);
        let parts = mesh.primitives().len();
        for part in mesh.primitives() {
            let place = format!("mesh {}, primitive {}", mesh.index(), part.index());
            let Some(shape) = self.mesh(&place, &part, world)? else {
                continue;
            };
            let name = match parts {
                1 => name.clone(),
                _ => format!("{name} {}", part.index()),
            };
            let material = self.material(&part);
            self.scene.objects.push(Object {
                name,
                material,
                shape,
                place: self.place.clone(),
            });
        }
        Ok(())
    }

    fn material(&mut self, part: &Primitive<'_>) -> usize {
        let material = part.material();
        if let Some(&known) = self.materials.get(&material.index()) {
            return known;
        }
        let (made, warning) = material::read(&material);
        if let Some(warning) = warning {
            self.warn(warning);
        }
        let number = self.scene.materials.len();
        self.scene.materials.push(made);
        self.materials.insert(material.index(), number);
        number
    }

    /// The triangles of a part of a mesh in world space, if it has any.
    fn mesh(
        &mut self,
        place: &str,
        part: &Primitive<'_>,
        world: &DMat4,
    ) -> Result<Option<Shape>, SceneError> {
        if !matches!(
            part.mode(),
            Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan
        ) {
            self.warn("points and lines are passed over");
            return Ok(None);
        }
        if part.morph_targets().len() > 0 {
            self.warn("morph targets are passed over; meshes stand as they are at rest");
        }
        // Without positions the file is not valid.
        let Some(positions) = part.get(&Semantic::Positions) else {
            return Ok(None);
        };
        let vertices = self.buffers.positions(&positions)?;
        let corners = match part.indices() {
            Some(indices) => self.buffers.indices(&indices)?,
            None => (0..vertices.len() as u32).collect(),
        };
        if let Some(&corner) = corners.iter().find(|&&c| c as usize >= vertices.len()) {
            return Err(self.error(
                format!(
                    "{place} uses vertex {corner}, and it has {} vertices",
                    vertices.len()
                ),
                "export the file again; vertices count from 0",
            ));
        }
        // A transform that mirrors would turn the mesh inside out.
        let mirrored = world.determinant() < 0.0;
        let triangles = triangles(part.mode(), &corners, mirrored);
        self.vertices += vertices.len();
        self.triangles += triangles.len();
        if self.vertices > MOST || self.triangles > MOST {
            return Err(self.error(
                format!(
                    "up to {place}, instances counted, the file comes to {} vertices and {} \
                     triangles, and a blob holds {MOST} of each",
                    self.vertices, self.triangles
                ),
                "export a part of the scene, or coarser meshes",
            ));
        }
        if triangles.is_empty() {
            return Ok(None);
        }
        let placed = |position: &[f32; 3]| {
            world.transform_point3(DVec3::from_array(position.map(f64::from)))
        };
        let vertices: Vec<DVec3> = vertices.iter().map(placed).collect();
        if let Some(number) = vertices.iter().position(|vertex| !vertex.is_finite()) {
            return Err(self.error(
                format!("vertex {number} (from 0) of {place} is not finite"),
                "export the file again, or repair the vertex",
            ));
        }
        Ok(Some(Shape::Mesh {
            vertices,
            triangles,
        }))
    }
}

/// Where a node stands in its parent, computed in double precision.
fn transform(node: &Node<'_>) -> DMat4 {
    match node.transform() {
        Transform::Matrix { matrix } => {
            DMat4::from_cols_array_2d(&matrix.map(|column| column.map(f64::from)))
        }
        Transform::Decomposed {
            translation,
            rotation,
            scale,
        } => DMat4::from_scale_rotation_translation(
            DVec3::from_array(scale.map(f64::from)),
            DQuat::from_array(rotation.map(f64::from)).normalize(),
            DVec3::from_array(translation.map(f64::from)),
        ),
    }
}

/// The triangles that corners stand for, counter-clockwise in front.
fn triangles(mode: Mode, corners: &[u32], mirrored: bool) -> Vec<[u32; 3]> {
    let turned = |[a, b, c]: [u32; 3], turn: bool| if turn { [a, c, b] } else { [a, b, c] };
    match (mode, corners) {
        (Mode::TriangleStrip, _) => corners
            .windows(3)
            .enumerate()
            .map(|(number, c)| turned([c[0], c[1], c[2]], mirrored != (number % 2 == 1)))
            .collect(),
        (Mode::TriangleFan, [hub, rim @ ..]) => rim
            .windows(2)
            .map(|c| turned([*hub, c[0], c[1]], mirrored))
            .collect(),
        _ => corners
            .chunks_exact(3)
            .map(|c| turned([c[0], c[1], c[2]], mirrored))
            .collect(),
    }
}

#[cfg(test)]
pub(super) mod tests;
