//! Reads glTF 2.0, as text (`.gltf`) and binary (`.glb`): the default scene with its nodes, meshes, materials, cameras
//! and lights.
//!
//! Each set of triangles of each node becomes an object, in the order of the nodes. A mesh that several nodes share is
//! a [part](super::Part), or is copied where that costs little. Animations of cameras, of lights and of nodes with
//! meshes become tracks. Morph targets whose weights an animation moves are kept; others give a mesh its shape at rest.
//! Skins are ignored. The textures of the base color and the normal map are drawn. Of those of emission and transmission
//! the mean is taken. A warning names all textures that are not drawn. Images that nothing uses are not read.

mod ancestry;
mod animation;
mod attributes;
mod buffers;
mod check;
mod chosen;
mod container;
mod curve;
mod document;
mod instances;
mod joints;
mod material;
mod means;
mod middle;
mod morph;
mod normal_transforms;
mod normals;
mod place;
mod shared;
mod text;
mod view;

use super::access::Access;
use super::importer::{FileOptions, Importer as Entry, Input};
use super::text::Warnings;
use super::texture::ImageMeans;
use super::{
    Attributes, CauseAndRemedy, FileKinds, Image, Imported, Normals, Object, ScaleRange, Scene,
    SceneError, Shape, SourceSpan,
};
use crate::table::shortened;
use animation::Motion;
use buffers::{Buffers, MOST};
use glam::DMat4;
use gltf::mesh::{Mode, MorphTarget};
use gltf::scene::Transform;
use gltf::{Document, Node, Semantic};
use gridel_core::Up;
use normal_transforms::NormalTransforms;
use place::{Weighted, place_of, transform, weights};
use shared::{Shared, triangles};
use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;
use view::View;

pub(super) const IMPORTER: Entry = Entry {
    name: "glTF",
    about: "scenes of meshes, with materials, cameras and lights",
    extensions: &["gltf", "glb"],
    // GlTF 2.0, chapter 3.4.
    up: Up::Y,
    binary: true,
    example: r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
"nodes": [{"name": "tip", "mesh": 0}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
"min": [0, 0, 0], "max": [1, 1, 0]}],
"bufferViews": [{"buffer": 0, "byteLength": 36}],
"buffers": [{"byteLength": 36, "uri":
"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}
"#,
    recognizes: |bytes| bytes.starts_with(b"glTF") || bytes.trim_ascii_start().starts_with(b"{"),
    read,
};

/// Reads a glTF file, and the buffers it names, which lie in the same folder. Where it has no camera or no lights, the
/// compiler adds them.
///
/// # Errors
/// If a buffer cannot be read, a required extension is not supported, or the content is broken. The error names the
/// line of broken JSON, else the element.
fn read(input: Input<'_>) -> Result<Imported, SceneError> {
    let Input {
        path,
        bytes,
        options: FileOptions { gltf: options, .. },
        access,
        ..
    } = input;
    let mut warnings = Warnings::default();
    let (document, blob, normal_transforms) = document::read(path, &bytes, &mut warnings)?;
    drop(bytes);
    let mut importer = Importer {
        path,
        place: SourceSpan::of(path),
        buffers: Buffers::read(path, &document, blob, access)?,
        access,
        images: HashMap::new(),
        turned: HashMap::new(),
        image_means: ImageMeans::default(),
        scene: Scene::default(),
        materials: HashMap::new(),
        normal_transforms,
        view: View::with_camera(options.camera.clone()),
        motion: Motion::default(),
        vertices: 0,
        triangles: 0,
        displaced: 0,
        shared: Shared::default(),
        joint_of: HashMap::new(),
        scales: Vec::new(),
        warnings,
    };
    importer.check(&document)?;
    importer.ignored(&document);
    importer.animation(&document, options)?;
    importer.nodes(&document)?;
    let missing = |CauseAndRemedy { cause, remedy }| SceneError::new(path, cause, remedy);
    importer.view.check_camera().map_err(missing)?;
    if importer.scene.objects.is_empty() && importer.scene.instances.is_empty() {
        importer.warn("the scene of the file has no triangles; nothing is drawn");
    }
    let Importer {
        mut scene,
        mut view,
        mut motion,
        place,
        mut warnings,
        ..
    } = importer;
    let tracks = view.tracks(&mut motion, &place);
    scene.tracks.extend(tracks.map_err(missing)?);
    if let Some(rate) = motion.least_rate {
        let sentence = format!(
            "a camera or light that other nodes carry, or a directional light that turns, is sampled {} times per second",
            (10.0 * rate).round() / 10.0
        );
        warnings.add_times(place.clone(), 1, sentence);
    }
    view.finish(&mut scene, &mut |sentence| {
        warnings.add_times(place.clone(), 1, sentence);
    });
    scene.places.lights = vec![place; scene.lights.len()];
    Ok(Imported {
        kinds: FileKinds {
            gltf: true,
            ..FileKinds::default()
        },
        ..Imported::of(scene, warnings.into_sentences())
    })
}

/// A mesh, the weights of its morph targets at rest, which of the scene's morph targets is its first if they move, and
/// the name of its objects.
struct Named<'m> {
    mesh: &'m gltf::Mesh<'m>,
    weights: &'m [f32],
    moving: Option<usize>,
    name: &'m str,
}

/// The scene so far.
struct Importer<'a> {
    path: &'a Path,
    place: SourceSpan,
    buffers: Buffers<'a>,
    access: &'a Access,
    /// Images by their path or URI; for those that are not there, the cause.
    images: HashMap<String, Result<Arc<Image>, String>>,
    /// Images of normal maps that are turned, by their number.
    turned: HashMap<usize, Arc<Image>>,
    image_means: ImageMeans,
    scene: Scene,
    /// Materials in use, by their number in the file; the default has none.
    materials: HashMap<Option<usize>, usize>,
    normal_transforms: NormalTransforms,
    view: View,
    motion: Motion,
    vertices: usize,
    triangles: usize,
    /// Displacements of vertices by morph targets.
    displaced: usize,
    shared: Shared,
    /// The joint that moves a node.
    joint_of: HashMap<usize, usize>,
    /// For each joint, the scales that it and those above it lead to.
    scales: Vec<ScaleRange>,
    warnings: Warnings,
}

impl Importer<'_> {
    fn error(&self, cause: impl Into<String>, remedy: &str) -> SceneError {
        SceneError::new(self.path, cause, remedy)
    }

    fn warn(&mut self, sentence: impl Into<String>) {
        self.warn_of(1, sentence);
    }

    /// Warns of `count` things at once, if there are any.
    fn warn_of(&mut self, count: usize, sentence: impl Into<String>) {
        if count > 0 {
            self.warnings.add_times(self.place.clone(), count, sentence);
        }
    }

    /// Warns of parts that change the picture and are not drawn.
    fn ignored(&mut self, document: &Document) {
        if document.scenes().len() > 1 {
            self.warn("the file has several scenes, of which the default one is read");
        }
        let parts = || document.meshes().flat_map(|mesh| mesh.primitives());
        let with =
            |semantic: Semantic| parts().filter(|part| part.get(&semantic).is_some()).count();
        self.warn_of(
            with(Semantic::Colors(1)),
            "COLOR_1 of a primitive is ignored; COLOR_0 is read",
        );
        self.warn_of(
            document.skins().len(),
            "skins are ignored; their meshes stand unbent at their nodes",
        );
        for material in document.materials() {
            for sentence in material::ignored(&material) {
                self.warn(sentence);
            }
        }
        let used = document.extensions_used();
        let others: Vec<_> = used
            .filter(|name| !document::EXTENSIONS.contains(name))
            .collect();
        if !others.is_empty() {
            self.warn(format!("extensions are ignored: {}", others.join(", ")));
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
        let mut placed = Vec::new();
        while let Some((node, outer)) = open.pop() {
            if std::mem::replace(&mut seen[node.index()], true) {
                return Err(self.error(
                    format!("node {} stands twice in the scene", node.index()),
                    "give every node one parent, or list it once among the scene's nodes",
                ));
            }
            self.check_affine(&node)?;
            let world = outer * transform(&node);
            if !world.is_finite() {
                return Err(self.error(
                    format!("the transform of node {} is not finite", node.index()),
                    "export the file again, or repair the node",
                ));
            }
            let from = open.len();
            open.extend(node.children().map(|child| (child, world)));
            open[from..].reverse();
            placed.push((node, world));
        }
        self.joints(&placed);
        self.shared = Shared::of(&placed, |node| self.joint_of.contains_key(&node.index()));
        self.weigh(&placed)?;
        placed
            .iter()
            .try_for_each(|(node, world)| self.node(node, world))
    }

    /// A matrix must keep the points at infinity there.
    fn check_affine(&self, node: &Node<'_>) -> Result<(), SceneError> {
        let Transform::Matrix { matrix } = node.transform() else {
            return Ok(());
        };
        let last = matrix.map(|column| column[3]);
        if last == [0.0, 0.0, 0.0, 1.0] {
            return Ok(());
        }
        let name = node.name().map_or_else(String::new, |name| {
            format!(" {name:?}", name = shortened(name))
        });
        let [x, y, z, w] = last;
        Err(self.error(
            format!(
                "node {}{name}: the matrix is projective (its last row is {x} {y} {z} {w}, not 0 0 0 1)",
                node.index()
            ),
            "export the node with an affine transform",
        ))
    }

    fn node(&mut self, node: &Node<'_>, world: &DMat4) -> Result<(), SceneError> {
        if let Some(camera) = node.camera() {
            self.view.camera(&camera, node, world);
        }
        if let Some(light) = node.light() {
            self.view.light(&light, node, world);
        }
        let Some(mesh) = node.mesh() else {
            return Ok(());
        };
        if self.instance(node, world)? {
            return Ok(());
        }
        let name = node.name().or(mesh.name());
        let name = name.map_or_else(|| format!("node {}", node.index()), str::to_owned);
        let named = Named {
            mesh: &mesh,
            weights: weights(node, &mesh),
            moving: self.moving_targets(node, &mesh),
            name: &name,
        };
        let objects = self.objects(&named, world)?;
        self.scene.objects.extend(objects);
        Ok(())
    }

    /// The objects of a mesh, in this place.
    fn objects(&mut self, named: &Named<'_>, world: &DMat4) -> Result<Vec<Object>, SceneError> {
        let Named {
            mesh,
            weights,
            moving,
            name,
        } = *named;
        let parts = mesh.primitives().len();
        let mut objects = Vec::with_capacity(parts);
        for part in mesh.primitives() {
            if material::is_cut_out(&part.material()) {
                let name = material::name(&part.material());
                self.warn(format!(
                    "the alpha of material {name:?} is below its cutoff; what has it is left out",
                    name = shortened(&name)
                ));
                continue;
            }
            let place = place_of(mesh, &part);
            let Some((shape, normals, attributes)) = self.mesh(
                &place,
                Weighted {
                    part: &part,
                    weights,
                    moving,
                },
                world,
            )?
            else {
                continue;
            };
            let name = match parts {
                1 => name.to_owned(),
                _ => format!("{name} {}", part.index()),
            };
            let material = self.material(&part)?;
            self.warn_of_colors(&attributes, material);
            objects.push(Object {
                name,
                material,
                shape,
                place: self.place.clone(),
                normals,
                attributes,
            });
        }
        Ok(objects)
    }

    /// The triangles of a part of a mesh in world space, if it has any.
    fn mesh(
        &mut self,
        place: &str,
        weighted: Weighted<'_>,
        world: &DMat4,
    ) -> Result<Option<(Shape, Normals, Attributes)>, SceneError> {
        let part = weighted.part;
        if !matches!(
            part.mode(),
            Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan
        ) {
            self.warn("points and lines are not drawn");
            return Ok(None);
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
        if let Some(&corner) = corners.iter().max() {
            self.check_corner(place, corner, vertices.len())?;
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
        let mut vertices = self.morph(place, weighted, &vertices, MorphTarget::positions)?;
        for vertex in &mut vertices {
            *vertex = world.transform_point3(*vertex);
        }
        if let Some(number) = vertices.iter().position(|vertex| !vertex.is_finite()) {
            return Err(self.error(
                format!("vertex {number} (from 0) of {place} is not finite"),
                "export the file again, or repair the vertex",
            ));
        }
        let mut normals = self.normals(place, weighted, world, (&vertices, &triangles))?;
        let mut attributes = self.attributes(place, part, (vertices.len(), &triangles))?;
        attributes.displacements = self.displacements(place, weighted, world, vertices.len())?;
        self.change_normals(place, weighted, world, &triangles, &mut normals)?;
        normals.turn_with((&vertices, &triangles), &attributes.displacements);
        let shape = Shape::Mesh {
            vertices,
            triangles,
        };
        Ok(Some((shape, normals, attributes)))
    }
}

#[cfg(test)]
pub(super) mod tests;
