//! The cameras and lights of a glTF file.
//!
//! Lights do not fall off with distance here. So each has the strength that it has in the middle of
//! the scene, and all are scaled alike so that the strongest is 1, as a photographer would expose.

use super::animation::Motion;
use crate::scene::{Camera, Color, Light, Object, RenderSettings, Scene, Shape, SourceSpan, Track};
use crate::table::printable;
use glam::{DMat4, DVec3};
use gltf::Node;
use gltf::camera::Projection;
use gltf::khr_lights_punctual::{Kind, Light as Punctual};

/// Cameras and lights on their way into a scene.
#[derive(Default)]
pub(super) struct View {
    /// The name of the camera that is asked for.
    wanted: Option<String>,
    camera: Option<Camera>,
    /// The node of the camera.
    camera_node: usize,
    cameras: usize,
    /// The names of those with a perspective.
    names: Vec<String>,
    /// Each with its intensity and its name.
    lights: Vec<(Light, f64, String)>,
    /// The node of each light.
    light_nodes: Vec<usize>,
    has_spots: bool,
    has_broken: bool,
}

impl View {
    /// A view with a camera of some name, or else the first that has a perspective.
    pub(super) fn with_camera(wanted: Option<String>) -> Self {
        Self {
            wanted,
            ..Self::default()
        }
    }

    /// Takes a camera, if it is the one that is asked for, or the first that has a perspective.
    pub(super) fn camera(
        &mut self,
        camera: &gltf::Camera<'_>,
        node: &Node<'_>,
        world: &DMat4,
        render: &mut RenderSettings,
    ) {
        self.cameras += 1;
        let Projection::Perspective(perspective) = camera.projection() else {
            return;
        };
        let name = node.name().or(camera.name()).unwrap_or_default();
        self.names.push(name.to_owned());
        let is_wanted = |wanted: &String| {
            let names = [node.name(), camera.name()];
            names.contains(&Some(wanted.as_str()))
        };
        if !self.wanted.as_ref().is_none_or(is_wanted) {
            return;
        }
        let eye = world.transform_point3(DVec3::ZERO);
        let ahead = world.transform_vector3(-DVec3::Z).try_normalize();
        let up = world.transform_vector3(DVec3::Y);
        let fov_degrees = f64::from(perspective.yfov()).to_degrees();
        let Some(ahead) = ahead.filter(|ahead| ahead.cross(up).length() > 1e-6 * up.length())
        else {
            return;
        };
        let target = eye + ahead * eye.abs().max_element().max(1.0);
        if self.camera.is_some() || !(fov_degrees > 0.0 && fov_degrees < 180.0) || eye == target {
            return;
        }
        if let Some(aspect) = perspective.aspect_ratio().filter(|a| *a > 0.0) {
            let width = f64::from(render.height) * f64::from(aspect);
            render.width = width.round().clamp(1.0, 65_535.0) as u32;
        }
        self.camera_node = node.index();
        self.camera = Some(Camera {
            eye,
            target,
            up,
            fov_degrees,
        });
    }

    /// Takes the light of a node, which is named as the node is, or else as the light.
    pub(super) fn light(&mut self, light: &Punctual<'_>, node: &Node<'_>, world: &DMat4) {
        let color = light.color().map(|c| f64::from(c).clamp(0.0, 1.0));
        let intensity = f64::from(light.intensity());
        let made = match light.kind() {
            Kind::Directional => Light::Directional {
                direction: world.transform_vector3(-DVec3::Z),
                color,
            },
            kind => {
                self.has_spots |= matches!(kind, Kind::Spot { .. });
                Light::Point {
                    position: world.transform_point3(DVec3::ZERO),
                    color,
                }
            }
        };
        let aims = match made {
            Light::Directional { direction, .. } => direction.try_normalize().is_some(),
            Light::Point { position, .. } => position.is_finite(),
        };
        if aims && intensity.is_finite() && intensity >= 0.0 {
            let name = node.name().or(light.name()).unwrap_or_default();
            self.lights.push((made, intensity, name.to_owned()));
            self.light_nodes.push(node.index());
        } else {
            self.has_broken = true;
        }
    }

    /// Proves that the camera that is asked for is there.
    ///
    /// # Errors
    /// If it is not: what to do.
    pub(super) fn check_camera(&self) -> Result<(), [String; 2]> {
        let Some(wanted) = self.wanted.as_ref().filter(|_| self.camera.is_none()) else {
            return Ok(());
        };
        let names = self.names.iter().filter(|name| !name.is_empty());
        let names: Vec<_> = names.map(|name| printable(name)).collect();
        let remedy = match names.is_empty() {
            true => String::from("leave `--camera` out"),
            false => format!("choose one of {}", names.join(", ")),
        };
        let cause = format!("there is no camera {wanted:?} with a perspective");
        Err([cause, remedy])
    }

    /// The tracks of camera and lights.
    pub(super) fn tracks(&self, motion: &mut Motion, place: &SourceSpan) -> Vec<Track> {
        let mut tracks = match self.camera {
            Some(_) => motion.camera(self.camera_node, place),
            None => Vec::new(),
        };
        // Without any strength there are no lights.
        let lit = self.lights.iter().any(|(_, intensity, _)| *intensity > 0.0);
        let lights = self.lights.iter().zip(&self.light_nodes).enumerate();
        for (index, ((light, ..), &node)) in lights.filter(|_| lit) {
            let directional = matches!(light, Light::Directional { .. });
            tracks.extend(motion.light(node, index, directional, place));
        }
        tracks
    }

    /// Puts camera and lights into a scene whose objects are all there.
    pub(super) fn finish(self, scene: &mut Scene, warn: &mut dyn FnMut(&str)) {
        for (there, sentence) in [
            (
                self.cameras > 0 && self.camera.is_none(),
                "no camera of the file has a perspective; one is made to see all",
            ),
            (
                self.cameras > 1 && self.camera.is_some() && self.wanted.is_none(),
                "the file has several cameras, of which the first is used; choose one with `--camera`",
            ),
            (
                self.has_spots,
                "spot lights shine in all directions, as point lights do",
            ),
            (
                self.has_broken,
                "lights without a direction or a strength are left out",
            ),
        ] {
            if there {
                warn(sentence);
            }
        }
        scene.camera = self.camera;
        let middle = middle(scene);
        let strength = |(light, intensity, _): &(Light, f64, String)| match light {
            Light::Directional { .. } => *intensity,
            Light::Point { position, .. } => {
                intensity / position.distance_squared(middle).max(1e-30)
            }
        };
        let strongest = self.lights.iter().map(strength).fold(0.0, f64::max);
        if strongest == 0.0 {
            return;
        }
        let exposed = |light: &(Light, f64, String)| {
            let dim = |color: Color| color.map(|channel| channel * strength(light) / strongest);
            match light.0 {
                Light::Directional { direction, color } => Light::Directional {
                    direction,
                    color: dim(color),
                },
                Light::Point { position, color } => Light::Point {
                    position,
                    color: dim(color),
                },
            }
        };
        scene.lights = self.lights.iter().map(exposed).collect();
        scene.light_names = self.lights.into_iter().map(|(.., name)| name).collect();
    }
}

/// The middle of the box around all meshes.
fn middle(scene: &Scene) -> DVec3 {
    fn vertices(object: &Object) -> &[DVec3] {
        match &object.shape {
            Shape::Mesh { vertices, .. } => vertices,
            _ => &[],
        }
    }
    let own = scene.objects.iter().flat_map(vertices).copied();
    let placed = scene.instances.iter().flat_map(|instance| {
        let affine = instance.placement.affine();
        let objects = scene.parts[instance.part].objects.iter();
        let vertices = objects.flat_map(vertices);
        vertices.map(move |vertex| affine.transform_point3(*vertex))
    });
    let nowhere = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = own.chain(placed).fold(nowhere, |(low, high), vertex| {
        (low.min(vertex), high.max(vertex))
    });
    (low + high) * 0.5
}
