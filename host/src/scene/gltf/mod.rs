//! Reads glTF 2.0, as JSON (`.gltf`) and binary (`.glb`): meshes, materials, cameras and lights of
//! the file's scene.
//!
//! The crate `gltf` reads and validates the description; geometry is read here, because that
//! crate's own readers panic on accessors that overlap their strides or hold nothing.
//!
//! | glTF | here |
//! |---|---|
//! | node with a mesh | an object for each of its primitives, transforms baked in |
//! | metallic-roughness material | what a smooth metal mirrors, less with its roughness; the rest diffuse; a highlight for what is not rough |
//! | transmission, index of refraction, volume | glass, with absorption by the attenuation distance |
//! | perspective camera, the first | the camera |
//! | point, spot and directional light | a light without falloff, as bright as it is relative to the brightest of its kind; a spot shines all around |
//!
//! Textures, vertex colours, normals, skins, animations and morph targets are passed over.

mod buffer;
mod material;

#[cfg(test)]
pub(super) mod tests;

use super::text::read_file;
use super::{Camera, Imported, Light, Material, Object, Place, Scene, SceneError, Shape};
use ::gltf::camera::Projection;
use ::gltf::json::extensions::scene::khr_lights_punctual::Type;
use ::gltf::json::validation::Checked;
use ::gltf::mesh::Mode;
use ::gltf::{Document, Gltf, Node, Primitive, Semantic};
use buffer::Buffers;
use glam::{DAffine3, DMat4, DVec3};
use std::collections::BTreeSet;
use std::path::Path;

/// Deepest nesting of nodes.
const MAX_DEPTH: usize = 1024;

/// Reads a glTF file and the buffers it names, which lie beside it.
///
/// # Errors
/// If a file cannot be read, the description is no valid glTF, or it refers to data that is not
/// there; the error names the node, mesh, accessor or buffer.
pub(super) fn load(path: &Path) -> Result<Imported, SceneError> {
    let bytes = read_file(path)?;
    let Gltf { document, blob } = Gltf::from_slice(&bytes).map_err(|error| {
        SceneError::new(
            path,
            format!("this is no valid glTF 2.0: {error}"),
            "export it again; glTF 1.0 is not understood",
        )
    })?;
    let buffers = Buffers::read(path, &document, blob.as_deref())?;
    let mut importer = Importer {
        path,
        document: &document,
        buffers,
        scene: Scene::default(),
        lights: Vec::new(),
        materials: vec![None; document.materials().len() + 1],
        warnings: BTreeSet::new(),
    };
    importer.nodes()?;
    importer.finish()
}

struct Importer<'d> {
    path: &'d Path,
    document: &'d Document,
    buffers: Buffers<'d>,
    scene: Scene,
    /// Lights and their intensities.
    lights: Vec<(Light, f64)>,
    /// Where the file's materials are in the scene, the default one last.
    materials: Vec<Option<usize>>,
    /// Each sentence once.
    warnings: BTreeSet<String>,
}

impl<'d> Importer<'d> {
    fn error(&self, cause: impl Into<String>, remedy: &str) -> SceneError {
        SceneError::new(self.path, cause, remedy)
    }

    fn warn(&mut self, sentence: impl std::fmt::Display) {
        let place = Place::of(self.path);
        self.warnings.insert(format!("{place}: {sentence}"));
    }

    /// Walks the nodes of the scene, parents before their children.
    fn nodes(&mut self) -> Result<(), SceneError> {
        let document = self.document;
        let scene = document
            .default_scene()
            .or_else(|| document.scenes().next());
        let Some(scene) = scene else {
            return Err(self.error("the file has no scene", "export a scene, not a library"));
        };
        let mut met = vec![false; document.nodes().len()];
        let world = |node: Node<'d>| (node, DAffine3::IDENTITY, 0);
        let mut open: Vec<_> = scene.nodes().map(world).collect();
        open.reverse();
        while let Some((node, parent, depth)) = open.pop() {
            let index = node.index();
            if std::mem::replace(&mut met[index], true) || depth > MAX_DEPTH {
                return Err(self.error(
                    format!(
                        "node {index} is met twice, or nodes are nested deeper than {MAX_DEPTH}"
                    ),
                    "export the file again; each node has one parent at most",
                ));
            }
            let matrix = node
                .transform()
                .matrix()
                .map(|column| column.map(f64::from));
            let transform = parent * DAffine3::from_mat4(DMat4::from_cols_array_2d(&matrix));
            if !transform.is_finite() {
                return Err(self.error(
                    format!("the transform of node {index} is not finite"),
                    "repair it, or export the file again",
                ));
            }
            self.node(&node, &transform)?;
            let first = open.len();
            open.extend(node.children().map(|child| (child, transform, depth + 1)));
            open[first..].reverse();
        }
        Ok(())
    }

    fn node(&mut self, node: &Node<'d>, transform: &DAffine3) -> Result<(), SceneError> {
        let named = |what: &str, name: Option<&str>, index: usize| match name {
            Some(name) if !name.is_empty() => name.to_owned(),
            _ => format!("{what} {index}"),
        };
        if let Some(mesh) = node.mesh() {
            let name = named("node", node.name().or(mesh.name()), node.index());
            let several = mesh.primitives().len() > 1;
            for primitive in mesh.primitives() {
                let number = primitive.index();
                let what = format!("primitive {number} of mesh {}", mesh.index());
                let Some(shape) = self.shape(&primitive, &what, transform)? else {
                    continue;
                };
                let name = if several {
                    format!("{name}/{number}")
                } else {
                    name.clone()
                };
                let material = self.material(&primitive);
                self.scene.objects.push(Object {
                    name,
                    material,
                    shape,
                    place: Place::of(self.path),
                });
            }
        }
        if node.skin().is_some() {
            self.warn("skins are passed over: meshes stay as they were modelled");
        }
        if let Some(camera) = node.camera() {
            self.camera(&camera.projection(), transform);
        }
        if let Some(light) = node.light() {
            self.light(light.index(), transform);
        }
        Ok(())
    }

    /// The triangles of a primitive; `None` for points and lines.
    fn shape(
        &mut self,
        primitive: &Primitive<'d>,
        what: &str,
        transform: &DAffine3,
    ) -> Result<Option<Shape>, SceneError> {
        let mode = primitive.mode();
        if !matches!(
            mode,
            Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan
        ) {
            self.warn("points and lines are passed over");
            return Ok(None);
        }
        let Some(positions) = primitive.get(&Semantic::Positions) else {
            self.warn(format!("{what} has no positions and is left out"));
            return Ok(None);
        };
        if primitive.morph_targets().len() > 0 {
            self.warn("morph targets are passed over");
        }
        let vertices = self.buffers.positions(&positions)?;
        let moved = vertices
            .iter()
            .map(|&vertex| transform.transform_point3(vertex));
        let vertices: Vec<DVec3> = moved.collect();
        if !vertices.iter().all(|vertex| vertex.is_finite()) {
            return Err(self.error(
                format!("{what} has a vertex that is not finite"),
                "repair it, or export the file again",
            ));
        }
        let indices = match primitive.indices() {
            Some(indices) => self.buffers.indices(&indices)?,
            None => (0..vertices.len() as u32).collect(),
        };
        if let Some(index) = indices
            .iter()
            .find(|&&index| index as usize >= vertices.len())
        {
            return Err(self.error(
                format!("{what} uses vertex {index}, and has {}", vertices.len()),
                "export the file again; vertices count from 0",
            ));
        }
        let mut triangles: Vec<[u32; 3]> = match mode {
            Mode::TriangleStrip => indices
                .windows(3)
                .enumerate()
                // Every other triangle turns the other way.
                .map(|(number, it)| match number % 2 {
                    0 => [it[0], it[1], it[2]],
                    _ => [it[1], it[0], it[2]],
                })
                .collect(),
            Mode::TriangleFan => {
                let pairs = indices.get(1..).unwrap_or_default().windows(2);
                pairs.map(|pair| [indices[0], pair[0], pair[1]]).collect()
            }
            _ => indices
                .chunks_exact(3)
                .map(|it| [it[0], it[1], it[2]])
                .collect(),
        };
        if triangles.is_empty() {
            self.warn(format!("{what} has no triangles and is left out"));
            return Ok(None);
        }
        if transform.matrix3.determinant() < 0.0 {
            // A mirror turns triangles round; fronts stay fronts.
            triangles
                .iter_mut()
                .for_each(|triangle| triangle.swap(1, 2));
        }
        Ok(Some(Shape::Mesh {
            vertices,
            triangles,
        }))
    }

    fn material(&mut self, primitive: &Primitive<'d>) -> usize {
        let material = primitive.material();
        let slot = material.index().unwrap_or(self.materials.len() - 1);
        if let Some(index) = self.materials[slot] {
            return index;
        }
        let (read, warnings) = material::read(&material);
        warnings.iter().for_each(|warning| self.warn(warning));
        self.scene.materials.push(Material {
            name: match material.index() {
                Some(index) => format!("material {index}"),
                None => String::from("default"),
            },
            ..read
        });
        let index = self.scene.materials.len() - 1;
        if let Some(name) = material.name().filter(|name| !name.is_empty()) {
            self.scene.materials[index].name = name.to_owned();
        }
        self.materials[slot] = Some(index);
        index
    }

    fn camera(&mut self, projection: &Projection<'_>, transform: &DAffine3) {
        let Projection::Perspective(perspective) = projection else {
            return self.warn("cameras without perspective are passed over");
        };
        let eye = transform.translation;
        let camera = Camera {
            eye,
            target: eye
                + transform
                    .transform_vector3(DVec3::NEG_Z)
                    .normalize_or_zero(),
            up: transform.transform_vector3(DVec3::Y).normalize_or_zero(),
            fov_degrees: f64::from(perspective.yfov()).to_degrees(),
        };
        let across = (camera.target - eye).cross(camera.up).length();
        let sound = across > 1e-6 && camera.fov_degrees > 0.0 && camera.fov_degrees < 180.0;
        if !sound {
            return self.warn("a camera that looks nowhere is passed over");
        }
        if self.scene.camera.is_none() {
            self.scene.camera = Some(camera);
        }
    }

    fn light(&mut self, index: usize, transform: &DAffine3) {
        let extensions = self.document.as_json().extensions.as_ref();
        let lights = extensions.and_then(|extensions| extensions.khr_lights_punctual.as_ref());
        let Some(json) = lights.and_then(|lights| lights.lights.get(index)) else {
            return;
        };
        let color = json.color.map(|channel| f64::from(channel).max(0.0));
        let light = match json.type_ {
            Checked::Valid(Type::Directional) => Light::Directional {
                direction: transform
                    .transform_vector3(DVec3::NEG_Z)
                    .normalize_or_zero(),
                color,
            },
            Checked::Valid(kind) => {
                if kind == Type::Spot {
                    self.warn("spot lights shine all around");
                }
                let position = transform.translation;
                Light::Point { position, color }
            }
            Checked::Invalid => return,
        };
        let intensity = f64::from(json.intensity);
        let nowhere = matches!(
            light,
            Light::Directional {
                direction: DVec3::ZERO,
                ..
            }
        );
        if intensity > 0.0
            && intensity.is_finite()
            && color.iter().all(|it| it.is_finite())
            && !nowhere
        {
            self.lights.push((light, intensity));
        }
    }

    fn finish(mut self) -> Result<Imported, SceneError> {
        if self.scene.objects.is_empty() {
            return Err(self.error(
                "the scene of the file has no triangles",
                "export meshes, and a scene that shows them",
            ));
        }
        let is_point = |light: &Light| matches!(light, Light::Point { .. });
        let brightest = |points: bool| {
            let of_kind = self
                .lights
                .iter()
                .filter(|(light, _)| is_point(light) == points);
            of_kind.map(|(_, intensity)| *intensity).fold(0.0, f64::max)
        };
        let brightest = [brightest(false), brightest(true)];
        for (mut light, intensity) in std::mem::take(&mut self.lights) {
            let relative = intensity / brightest[usize::from(is_point(&light))];
            let (Light::Point { color, .. } | Light::Directional { color, .. }) = &mut light;
            *color = color.map(|channel| channel * relative);
            self.scene.lights.push(light);
        }
        Ok(Imported {
            scene: self.scene,
            warnings: self.warnings.into_iter().collect(),
        })
    }
}
