//! The scene as data.

use super::attributes::Attributes;
use super::environment::Environment;
use super::light_form::LightForm;
use super::normals::{Normals, NormalsChoice};
use super::placement::Placement;
use super::places::Places;
use super::source_span::SourceSpan;
use super::texture::{NormalMap, Texture};
use super::track::Track;
use crate::shape::{Shape, unit};
use glam::DVec3;
use gridel_core::Up;

/// A linear RGB color; components at or above 0, 1.0 being display white.
pub type Color = [f64; 3];

/// The brightest channel of a light, a background or an emission that a blob holds; 1 is display white.
pub const BRIGHTEST: f64 = 2047.0;

/// Everything a scene file says.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// The camera of the picture; without one [the compiler frames](fn@crate::compile::framing) the scene's bounds.
    pub camera: Option<Camera>,
    /// The lens of the camera, in place of a pinhole.
    pub lens: Option<Lens>,
    /// The direction up, for that frame.
    pub up: Up,
    /// The color of rays that hit nothing; without one it is black, or light if there is no camera
    /// either.
    pub background: Option<Color>,
    /// True if colors and lights are display values, which are added up and shown as they are. Ray tracers did so
    /// before pictures were encoded. Otherwise they are linear.
    pub display_values: bool,
    /// Light that reaches every surface from everywhere, multiplied with its diffuse color.
    pub ambient: Color,
    /// True if a scene without any light is meant to be dark. Otherwise the compiler supplies a light.
    pub is_dark: bool,
    /// The light around the scene, in place of the background.
    pub environment: Option<Environment>,
    /// Point and directional lights.
    pub lights: Vec<Light>,
    /// Names of the lights, in their order. A name is empty, or missing at the end, where a light has none.
    pub light_names: Vec<String>,
    /// For each light, what makes it more than a point; empty, or missing at the end, where there is nothing.
    pub light_forms: Vec<Option<LightForm>>,
    /// Surfaces; objects refer to them by index.
    pub materials: Vec<Material>,
    /// Objects in scene-file order; that order is the one in which `trace` counts them.
    pub objects: Vec<Object>,
    /// Objects that [`Scene::instances`] place. They are counted after the scene's own, part by part.
    pub parts: Vec<Part>,
    /// Placed parts. Checkerboards lie in the scene's coordinates on them too.
    pub instances: Vec<Instance>,
    /// The joints that move instances.
    pub joints: Vec<Joint>,
    /// The morph targets of meshes.
    pub morph_targets: Vec<MorphTarget>,
    /// A box that the lattice also covers, for instances that programs place.
    pub room: Option<[DVec3; 2]>,
    /// Changes of camera, lights, materials, joints and weights of morph targets over time, at most one track for each
    /// property.
    pub tracks: Vec<Track>,
    /// Defaults for rendering that the scene file states.
    pub render: RenderSettings,
    /// The places at which files state lights and settings.
    pub places: Places,
    /// True if the format has no names. Then all names are made of kinds and numbers, and blobs leave them out.
    pub unnamed: bool,
}

/// A thin lens around the eye. Points that are not in focus are blurred.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Half of the aperture, in scene units: above 0.
    pub radius: f64,
    /// The distance of the plane on which the picture is sharp, along the camera's axis. Default: that of the camera's
    /// target.
    pub focus: Option<f64>,
}

impl Lens {
    /// The lens after the scene around it grew.
    pub(super) fn scaled(self, by: f64) -> Self {
        Self {
            radius: self.radius * by,
            focus: self.focus.map(|focus| focus * by),
        }
    }
}

/// A pinhole camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    pub eye: DVec3,
    /// A point in the middle of the picture; not equal to `eye`.
    pub target: DVec3,
    /// The direction up; not parallel to the view direction.
    pub up: DVec3,
    /// Full vertical field of view in degrees, in (0, 180).
    pub fov_degrees: f64,
}

impl Camera {
    /// Returns the direction of view, of any length.
    pub fn direction(&self) -> DVec3 {
        let direction = self.target - self.eye;
        if direction.is_finite() {
            direction
        } else {
            // The difference of two numbers can be out of range.
            self.target * 0.5 - self.eye * 0.5
        }
    }

    /// Returns whether the camera looks along `up`, within an angle of 2^-15, or one of both has no length.
    pub fn is_along_up(&self) -> bool {
        // Twice the limit of `gridel_core::Camera`, whose integers round both directions.
        const LEAST_SINE: f64 = 1.0 / (1_u32 << 15) as f64;
        let sine = unit(self.direction()).cross(unit(self.up)).length();
        sine.is_nan() || sine < LEAST_SINE
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// Shines from `position`: in all directions and without falloff, unless its [`LightForm`](super::LightForm) states
    /// otherwise.
    Point { position: DVec3, color: Color },
    /// Shines from infinitely far away; `direction` is that in which the light travels.
    Directional { direction: DVec3, color: Color },
}

/// The reflection and transmission of a surface. The parts add up: local light (diffuse and highlight), the light of a
/// mirror ray, the light through glass.
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
    /// Roughness of a mirror or glass: 0 for a smooth one, or [`LEAST_ROUGHNESS`](Self::LEAST_ROUGHNESS) to 1. Its
    /// square is the α of GGX.
    pub roughness: f64,
    /// Weight of the light through glass (Fresnel-split reflection and refraction); black for opaque.
    pub transmit: Color,
    /// Index of refraction relative to the surroundings, 1 to 4; used when `transmit` is not black.
    pub ior: f64,
    /// Priority of glass, 1 to 100: where several overlap, the one with the highest priority fills the place. Glass
    /// without one is independent of others.
    pub priority: Option<u8>,
    /// Absorption inside glass: the coefficient of Beer's law per scene unit of path length.
    pub absorption: Color,
    /// Radiance that leaves the front of the surface; black for none.
    pub emission: Color,
    /// True if objects that send out light are lights, too.
    pub lights: bool,
    /// True if lights represent all objects of this material, as [`Scene::with_emitters`] makes them. Indirect light
    /// does not bring their light again.
    pub is_sampled: bool,
    /// The image that weights the diffuse color of meshes with texture coordinates.
    pub texture: Option<Texture>,
    /// Use of the texture's alpha; glass ignores it.
    pub alpha: Option<Alpha>,
    /// The normals that meshes with texture coordinates are shaded with. It lies as the texture does, if there is one.
    pub normal_map: Option<NormalMap>,
    /// Its place in a scene file or a file of materials, for messages.
    pub place: SourceSpan,
}

/// The mapping of the brightness of pixels to the range of a display.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneMapping {
    /// No mapping: values brighter than white are white.
    #[default]
    None,
    /// Maps by x / (1 + x).
    Reinhard,
    /// Maps by a curve like that of ACES.
    Aces,
}

impl ToneMapping {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::None, Self::Reinhard, Self::Aces];

    /// Returns its name in scene files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Reinhard => "reinhard",
            Self::Aces => "aces",
        }
    }
}

/// The use of a texture's alpha.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Alpha {
    /// Alpha is the part of the surface that is there; times a factor, 0 to 1.
    Blend(f64),
    /// Alpha below this value, above 0, is transparent, and the rest is opaque.
    CutOut(f64),
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Diffuse {
    Plain(Color),
    /// Cubes of edge `size` (scene units, above 0) in two alternating colors, aligned with the axes;
    /// a corner of the pattern lies at `origin`.
    Checker {
        even: Color,
        odd: Color,
        size: f64,
        origin: DVec3,
    },
}

impl Diffuse {
    /// Its colors times another, channel by channel.
    #[must_use]
    pub(super) fn weighted(self, by: Color) -> Self {
        let times = |color: Color| [0, 1, 2].map(|channel: usize| color[channel] * by[channel]);
        match self {
            Self::Plain(color) => Self::Plain(times(color)),
            Self::Checker {
                even,
                odd,
                size,
                origin,
            } => Self::Checker {
                even: times(even),
                odd: times(odd),
                size,
                origin,
            },
        }
    }
}

/// One object: a shape and its material.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// The name that the scene file gives it, or one made of its kind and number.
    pub name: String,
    /// Index into [`Scene::materials`].
    pub material: usize,
    pub shape: Shape,
    /// The normals that a mesh is shaded with. Other shapes have none.
    pub normals: Normals,
    /// Colors of vertices, and texture coordinates. Other shapes have none.
    pub attributes: Attributes,
    /// Its place in the scene file, for messages.
    pub place: SourceSpan,
}

/// A group of objects in coordinates of its own, which instances place.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    pub name: String,
    /// At least one, each with a box; materials are the scene's.
    pub objects: Vec<Object>,
    /// Its place in the scene file, for messages.
    pub place: SourceSpan,
}

/// A placed part.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    pub name: String,
    /// Index into [`Scene::parts`].
    pub part: usize,
    /// Its placement at rest.
    pub placement: Placement,
    /// Index into [`Scene::joints`]; `None` for one that stands still.
    pub joint: Option<usize>,
    /// Its place in the scene file, for messages.
    pub place: SourceSpan,
}

/// Moves the instances and joints that hang on it.
///
/// A joint turns and scales about its pivot, and shifts: its own motion takes a place `p` to `pivot + shift +
/// scale * rotation * (p - pivot)`, in the scene's coordinates at rest. Tracks give the three; without one they are 0,
/// 1 and none. What hangs on a joint follows the joint's own motion, then that of the joint's parent, and so on.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    pub name: String,
    /// Index into [`Scene::joints`], less than that of this joint; `None` for one that hangs on nothing.
    pub parent: Option<usize>,
    /// The place about which it turns, at rest.
    pub pivot: DVec3,
    /// Its place in the scene file, for messages.
    pub place: SourceSpan,
}

/// A shape that meshes take on by a weight: they displace their vertices by
/// [so much](crate::scene::Displacements), times the weight.
#[derive(Clone, Debug, PartialEq)]
pub struct MorphTarget {
    pub name: String,
    /// The weight at rest.
    pub weight: f64,
    /// The weights that programs can give it, from the least to the greatest. Those at rest and of its track come in
    /// addition.
    pub range: [f64; 2],
    /// Its place in the scene file, for messages.
    pub place: SourceSpan,
}

/// Rendering defaults; the command line overrides them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RenderSettings {
    /// Picture size in pixels.
    pub width: u32,
    pub height: u32,
    /// Samples per pixel: 1 to 4,096.
    pub samples: u16,
    /// Maximum number of reflections and refractions of a ray: 0 to 32.
    pub depth: u8,
    /// Maximum number of diffuse reflections of light on its way from a light to the eye, not counting the last one: 0
    /// to 32. 0 for surfaces that do not light each other.
    pub bounces: u8,
    /// A secondary ray that can change no channel by more than this (1.0 being display white) is
    /// not traced.
    pub cutoff: f64,
    /// True if objects cast shadows on each other.
    pub shadows: bool,
    /// All light is multiplied with 2 to this power: -32 to 32.
    pub exposure: f64,
    pub tone_mapping: ToneMapping,
}

impl RenderSettings {
    /// Greatest ratio of a picture's width to its height.
    pub const MAX_ASPECT: u32 = 64;
}

impl Default for RenderSettings {
    fn default() -> Self {
        Self {
            width: 320,
            height: 240,
            samples: 1,
            depth: 5,
            bounces: 0,
            cutoff: 1.0 / 512.0,
            shadows: true,
            exposure: 0.0,
            tone_mapping: ToneMapping::None,
        }
    }
}

impl Material {
    /// The least roughness of rough materials.
    pub const LEAST_ROUGHNESS: f64 = 0.05;

    /// Returns the image that lies on texture coordinates: the texture, or else the normal map, which lies as it does.
    pub fn placing(&self) -> Option<&Texture> {
        let normal_map = self.normal_map.as_ref().map(|it| &it.texture);
        self.texture.as_ref().or(normal_map)
    }

    /// Returns whether rays are mirrored or refracted by facets, as the material is at rest.
    pub fn is_rough(&self) -> bool {
        let sends = self.mirror != [0.0; 3] || self.transmit != [0.0; 3];
        self.roughness > 0.0 && sends
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
            roughness: 0.0,
            transmit: [0.0; 3],
            ior: 1.5,
            priority: None,
            absorption: [0.0; 3],
            emission: [0.0; 3],
            lights: true,
            is_sampled: false,
            texture: None,
            alpha: None,
            normal_map: None,
            place: SourceSpan::default(),
        }
    }
}

impl Object {
    /// Counts the morph targets of an import from another one on.
    pub(super) fn count_targets_from(&mut self, first: usize) {
        for displaced in &mut self.attributes.displacements {
            displaced.target += first;
        }
        for changed in &mut self.normals.changes {
            changed.target += first;
        }
    }

    /// Chooses the normals of a mesh. Computed ones turn with the faces that morph targets move.
    pub fn shade(&mut self, choice: NormalsChoice) {
        match (choice, &self.shape) {
            (NormalsChoice::File, _) => {}
            (
                NormalsChoice::Smooth(degrees),
                Shape::Mesh {
                    vertices,
                    triangles,
                },
            ) => {
                let mesh = (&vertices[..], &triangles[..]);
                let displacements = &self.attributes.displacements;
                self.normals = Normals::computed_for(mesh, degrees, displacements);
                self.normals.turn_with(mesh, displacements);
            }
            _ => self.normals = Normals::default(),
        }
    }
}

impl Scene {
    /// Returns all objects in the order in which they are counted: the scene's own, and those of all parts.
    pub fn all_objects(&self) -> impl Iterator<Item = &Object> {
        let parts = self.parts.iter().flat_map(|part| &part.objects);
        self.objects.iter().chain(parts)
    }

    /// Returns whether the scene states a light of any kind, black ones included.
    pub(crate) fn is_lit(&self) -> bool {
        let glows = |object: &Object| self.materials[object.material].emission != [0.0; 3];
        let lights_itself = self.render.bounces > 0 && self.all_objects().any(glows);
        let from_around = self.ambient != [0.0; 3] || self.environment.is_some();
        !self.lights.is_empty() || from_around || lights_itself
    }

    /// Number of primitives, those of a part once per instance.
    pub fn placed_primitives(&self) -> u64 {
        let count = |objects: &[Object]| -> u64 {
            let primitives = objects.iter().map(|it| it.shape.primitives() as u64);
            primitives.sum()
        };
        let parts: Vec<u64> = self.parts.iter().map(|it| count(&it.objects)).collect();
        let placed = self.instances.iter().filter_map(|it| parts.get(it.part));
        placed.fold(count(&self.objects), |sum, part| sum.saturating_add(*part))
    }

    /// Returns whether there is anything of an instance: whether its part has primitives.
    pub(crate) fn is_placed(&self, instance: &Instance) -> bool {
        let mut objects = self.parts[instance.part].objects.iter();
        objects.any(|object| object.shape.primitives() > 0)
    }
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            camera: None,
            lens: None,
            up: Up::Y,
            background: None,
            display_values: false,
            ambient: [0.0; 3],
            is_dark: false,
            environment: None,
            lights: Vec::new(),
            light_names: Vec::new(),
            light_forms: Vec::new(),
            materials: Vec::new(),
            objects: Vec::new(),
            parts: Vec::new(),
            instances: Vec::new(),
            joints: Vec::new(),
            morph_targets: Vec::new(),
            room: None,
            tracks: Vec::new(),
            render: RenderSettings::default(),
            places: Places::default(),
            unnamed: false,
        }
    }
}
