//! The scene in memory: what every importer produces and the compiler reads.
//!
//! All coordinates are `f64` scene units in one right-handed world space: importers bake the
//! transforms of groups and instances into the geometry, so that nothing downstream knows of
//! them. Colours are linear RGB, 1.0 being full display white, unless [`Scene::display_values`] says
//! otherwise.

mod access;
#[cfg(test)]
mod bad;
#[cfg(test)]
mod damaged;
mod error;
mod gzip;
mod importer;
pub(crate) mod molecule;
mod polygon;
mod size;
#[cfg(test)]
mod test_scenes;
mod text;
mod words;

pub use error::SceneError;
pub use importer::{Importer, extensions};
pub use size::MOST_INPUT;

use access::Access;
use glam::DVec3;
use importer::Input;
use std::path::{Path, PathBuf};
use std::sync::Arc;

importer::formats! {
    pub mod toml;
    mod obj;
    mod gltf;
    mod stl;
    mod ply;
    mod off;
    mod nff;
    mod pdb;
    mod mmcif;
    mod xyz;
}

/// A linear RGB colour; components at or above 0, 1.0 being display white.
pub type Color = [f64; 3];

/// Everything a scene file says.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Where the picture is taken from; without one [the compiler frames](fn@crate::compile::framing) the
    /// scene's bounds.
    pub camera: Option<Camera>,
    /// Which way is up, for that frame.
    pub up: Up,
    /// What a ray that meets nothing sees; without one it is black, or light if there is no camera
    /// either.
    pub background: Option<Color>,
    /// Whether colours and lights are display values, which are added up and shown as they are: what
    /// ray tracers did before pictures were encoded. Linear without.
    pub display_values: bool,
    /// Light that reaches every surface from everywhere, multiplied with its diffuse colour.
    pub ambient: Color,
    /// Point and directional lights.
    pub lights: Vec<Light>,
    /// Surfaces; objects refer to them by index.
    pub materials: Vec<Material>,
    /// Objects in scene-file order; that order is the one in which `trace` counts them.
    pub objects: Vec<Object>,
    /// Defaults for rendering that the scene file states.
    pub render: RenderSettings,
}

/// Which axis points up, where a scene has no camera that says so.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Up {
    Y,
    Z,
}

impl Up {
    /// The axis.
    pub fn vector(self) -> DVec3 {
        match self {
            Self::Y => DVec3::Y,
            Self::Z => DVec3::Z,
        }
    }
}

/// A pinhole camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    pub eye: DVec3,
    /// A point in the middle of the picture; not equal to `eye`.
    pub target: DVec3,
    /// Which way is up; not parallel to the view direction.
    pub up: DVec3,
    /// Full vertical field of view in degrees, in (0, 180).
    pub fov_degrees: f64,
}

impl Camera {
    /// Whether the camera looks along `up`, or one of both has no length.
    pub fn is_along_up(&self) -> bool {
        toml::parallel(self.target - self.eye, self.up)
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// Shines from `position` in all directions, without falloff.
    Point { position: DVec3, color: Color },
    /// Shines from infinitely far away; `direction` is the way the light travels.
    Directional { direction: DVec3, color: Color },
}

/// What a surface does with light. The parts add up: local light (diffuse and highlight), what
/// a mirror ray brings, what glass lets through.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    pub name: String,
    /// Diffuse reflectance.
    pub diffuse: Diffuse,
    /// Reflectance of the specular highlight of lights (Blinn-Phong); black for none.
    pub highlight: Color,
    /// Exponent of the highlight, 1 to 1024.
    pub shininess: u16,
    /// Weight of the mirrored ray; black for none.
    pub mirror: Color,
    /// Weight of what glass brings (Fresnel-split reflection and refraction); black for opaque.
    pub transmit: Color,
    /// Index of refraction relative to the surroundings, 1 to 4; used when `transmit` is not black.
    pub ior: f64,
    /// Absorption inside glass: the coefficient of Beer's law per scene unit of path length.
    pub absorption: Color,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Diffuse {
    Plain(Color),
    /// Cubes of edge `size` (scene units, above 0) in two alternating colours, aligned with the axes;
    /// a corner of the pattern lies at `origin`.
    Checker {
        even: Color,
        odd: Color,
        size: f64,
        origin: DVec3,
    },
}

/// One object: a shape and its material.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// The name that the scene file gives it, or one made of its kind and number.
    pub name: String,
    /// Index into [`Scene::materials`].
    pub material: usize,
    pub shape: Shape,
    /// Where the scene file says so, for messages.
    pub place: Place,
}

/// A shape in world space. Solids are closed; a mesh is whatever its triangles are.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    Sphere {
        center: DVec3,
        radius: f64,
    },
    /// An indexed mesh; every triangle is a primitive. Counter-clockwise is the front.
    Mesh {
        vertices: Vec<DVec3>,
        triangles: Vec<[u32; 3]>,
    },
    /// An axis-aligned box (a box that was turned becomes a mesh).
    Box {
        min: DVec3,
        max: DVec3,
    },
    /// A flat disc; `normal` has any length above 0.
    Disc {
        center: DVec3,
        normal: DVec3,
        radius: f64,
    },
    /// A solid between two flat caps: a cylinder where the radii are equal, a cone where one is
    /// 0, a frustum otherwise. NFF's open cones are closed by caps, because the solid is what
    /// refraction needs.
    Cone {
        base: DVec3,
        base_radius: f64,
        apex: DVec3,
        apex_radius: f64,
    },
}

/// Rendering defaults; the command line overrides them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RenderSettings {
    /// Picture size in pixels.
    pub width: u32,
    pub height: u32,
    /// Samples a pixel: 1 to 256.
    pub samples: u16,
    /// How many times a ray may be reflected or refracted: 0 to 16.
    pub depth: u8,
    /// A secondary ray that can change no channel by more than this (1.0 being display white) is
    /// not traced.
    pub cutoff: f64,
    /// Whether objects stand in each other's light.
    pub shadows: bool,
}

impl Default for RenderSettings {
    fn default() -> Self {
        Self {
            width: 320,
            height: 240,
            samples: 1,
            depth: 5,
            cutoff: 1.0 / 512.0,
            shadows: true,
        }
    }
}

impl Default for Material {
    fn default() -> Self {
        Self {
            name: String::from("default"),
            diffuse: Diffuse::Plain([0.8, 0.8, 0.8]),
            highlight: [0.0; 3],
            shininess: 32,
            mirror: [0.0; 3],
            transmit: [0.0; 3],
            ior: 1.5,
            absorption: [0.0; 3],
        }
    }
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            camera: None,
            up: Up::Y,
            background: None,
            display_values: false,
            ambient: [0.0; 3],
            lights: Vec::new(),
            materials: Vec::new(),
            objects: Vec::new(),
            render: RenderSettings::default(),
        }
    }
}

/// What a molecule file does not say and a person may choose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MoleculeOptions {
    pub style: MoleculeStyle,
    /// Which model of the file, counted from 1.
    pub model: usize,
    /// Which alternate location; without one the first that each residue has.
    pub altloc: Option<char>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MoleculeStyle {
    /// Atoms as spheres of their van der Waals radius.
    SpaceFilling,
    /// Small spheres, and bonds as cylinders in the colours of the atoms at their ends.
    BallAndStick,
}

impl Default for MoleculeOptions {
    fn default() -> Self {
        Self {
            style: MoleculeStyle::SpaceFilling,
            model: 1,
            altloc: None,
        }
    }
}

/// A scene, and what its importer had to pass over to read it.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    pub scene: Scene,
    /// Sentences for the user, each with file and line.
    pub warnings: Vec<String>,
    /// Whether a molecule was read, which [`MoleculeOptions`] are for.
    pub molecules: bool,
}

/// How a scene file is read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ImportOptions {
    /// What a molecule file leaves open.
    pub molecule: MoleculeOptions,
    /// Whether the file may name files outside of its folder: imports, materials, buffers. A scene
    /// from elsewhere could read any file of the user's so.
    pub allow_outside: bool,
}

/// Reads a scene file; its extension says which format it is in, its content if it has none. It may
/// only name files in its own folder and below: see [`load_with`].
///
/// # Errors
/// If the file cannot be read, its format is unknown, or its content is broken.
pub fn load(path: &Path, molecule: &MoleculeOptions) -> Result<Imported, SceneError> {
    load_with(
        path,
        &ImportOptions {
            molecule: *molecule,
            ..ImportOptions::default()
        },
    )
}

/// Reads a scene file; its extension says which format it is in, its content if it has none. The file
/// may be gzipped.
///
/// # Errors
/// If the file cannot be read, its format is unknown, its content is broken, or it names a file
/// outside of its folder and may not.
pub fn load_with(path: &Path, options: &ImportOptions) -> Result<Imported, SceneError> {
    let access = Access::of(path, options.allow_outside);
    let (importer, input) = Input::open(path, &options.molecule, &access)?;
    importer.import(input)
}

/// Reads a scene from bytes as [`load_with`] reads a file of this name, which need not exist. Files
/// that the scene names lie beside it: for a name without a folder in the current folder.
///
/// # Errors
/// As [`load_with`].
pub fn read(name: &Path, bytes: Vec<u8>, options: &ImportOptions) -> Result<Imported, SceneError> {
    let access = Access::of(name, options.allow_outside);
    let (importer, input) = Input::new(name, bytes, &options.molecule, &access)?;
    importer.import(input)
}

/// A place in a scene file, for messages.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// Shared by all objects of the file.
    pub file: Arc<PathBuf>,
    /// Line, counted from 1; 0 where the format has no lines.
    pub line: usize,
}

impl Place {
    /// A whole file.
    fn of(path: &Path) -> Self {
        Self {
            file: Arc::new(path.to_owned()),
            line: 0,
        }
    }
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.line {
            0 => write!(f, "{}", self.file.display()),
            line => write!(f, "{}:{line}", self.file.display()),
        }
    }
}
