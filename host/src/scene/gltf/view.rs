//! The cameras and lights of a glTF file.
//!
//! Points and spots fall off with the square of the distance, and end at their range and their cones, as
//! `KHR_lights_punctual` says. Intensities are in candela and lux, which span many powers of ten. So one factor scales
//! all, as a photographer would expose. The light that is strongest in the middle of the scene is 1 there.

use super::animation::Motion;
use super::middle::middle;
use super::place::parts;
use crate::scene::{
    Camera, CauseAndRemedy, Color, Light, LightForm, RenderSettings, Scene, SourceSpan, Spot, Track,
};
use crate::table::{printable, shortened};
use glam::{DMat4, DVec3, DVec4};
use gltf::Node;
use gltf::camera::Projection;
use gltf::khr_lights_punctual::{Kind, Light as Punctual};

/// Cameras and lights on their way into a scene.
#[derive(Default)]
pub(super) struct View {
    /// The name of the requested camera.
    wanted: Option<String>,
    camera: Option<Camera>,
    /// Width over height of its picture.
    aspect: Option<f64>,
    /// The node of the camera.
    camera_node: usize,
    /// The quality of the match of the camera with the requested name: see [`View::fit`].
    camera_fit: u8,
    cameras: usize,
    /// A camera was left out that is requested, or comes before what is used.
    has_blind: bool,
    /// The names of those with a perspective.
    names: Vec<String>,
    lights: Vec<Lamp>,
    /// The node of each light.
    light_nodes: Vec<usize>,
    has_broken: bool,
    has_moving_spots: bool,
    has_narrow_spots: bool,
    has_flat_picture: bool,
}

/// A light of the file.
struct Lamp {
    light: Light,
    form: Option<LightForm>,
    /// In candela, or lux.
    intensity: f64,
    name: String,
}

impl View {
    /// A view with a camera of some name, or else the first that has a perspective.
    pub(super) fn with_camera(wanted: Option<String>) -> Self {
        Self {
            wanted,
            ..Self::default()
        }
    }

    /// Takes a camera, if it is the requested one, or the first that has a perspective.
    pub(super) fn camera(&mut self, camera: &gltf::Camera<'_>, node: &Node<'_>, world: &DMat4) {
        self.cameras += 1;
        let Projection::Perspective(perspective) = camera.projection() else {
            return;
        };
        let name = node.name().or(camera.name()).unwrap_or_default();
        self.names.push(name.to_owned());
        let fit = self.fit(node.name(), camera.name());
        if fit <= self.camera_fit {
            return;
        }
        let eye = world.transform_point3(DVec3::ZERO);
        // Without its own scale, of which only the signs change a direction.
        let [_, _, scale] = parts(node).unwrap_or([DVec4::ONE; 3]);
        let ahead = world.transform_vector3(-DVec3::Z * 1_f64.copysign(scale.z));
        let (ahead, up) = (
            ahead.try_normalize(),
            world.transform_vector3(DVec3::Y * 1_f64.copysign(scale.y)),
        );
        let fov_degrees = f64::from(perspective.yfov()).to_degrees();
        let ahead = ahead.filter(|ahead| ahead.cross(up).length() > 1e-6 * up.length());
        let target = ahead.map(|ahead| eye + ahead * eye.abs().max_element().max(1.0));
        let target = target.filter(|target| *target != eye);
        let Some(target) = target.filter(|_| fov_degrees > 0.0 && fov_degrees < 180.0) else {
            self.has_blind = true;
            return;
        };
        let aspect = perspective.aspect_ratio().map(f64::from);
        self.aspect = aspect.filter(|aspect| *aspect > 0.0);
        self.has_flat_picture = self.aspect != aspect;
        self.camera_fit = fit;
        self.camera_node = node.index();
        self.camera = Some(Camera {
            eye,
            target,
            up,
            fov_degrees,
        });
    }

    /// 2 for a camera whose node has the requested name, and for all if none is requested; 1 if the camera itself has
    /// the name; else 0.
    fn fit(&self, node: Option<&str>, camera: Option<&str>) -> u8 {
        match self.wanted.as_deref() {
            None => 2,
            wanted if wanted == node => 2,
            wanted if wanted == camera => 1,
            _ => 0,
        }
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
            _ => Light::Point {
                position: world.transform_point3(DVec3::ZERO),
                color,
            },
        };
        let spot = match light.kind() {
            Kind::Spot {
                inner_cone_angle,
                outer_cone_angle,
            } => {
                let degrees = |radians: f32| f64::from(radians).to_degrees();
                // The extension allows no more than 90 degrees.
                let asked = degrees(outer_cone_angle);
                self.has_narrow_spots |= asked < Spot::LEAST_OUTER;
                let outer = asked.clamp(Spot::LEAST_OUTER, 90.0);
                Some(Spot {
                    direction: world.transform_vector3(-DVec3::Z),
                    inner: degrees(inner_cone_angle).clamp(0.0, outer),
                    outer,
                })
            }
            _ => None,
        };
        let form = match made {
            Light::Directional { .. } => None,
            Light::Point { .. } => Some(LightForm {
                range: light.range().map(f64::from).filter(|range| *range > 0.0),
                spot,
                ..LightForm::default()
            }),
        };
        let aims = match made {
            Light::Directional { direction, .. } => direction.try_normalize().is_some(),
            Light::Point { position, .. } => {
                let aims = |spot: Spot| spot.direction.try_normalize().is_some();
                position.is_finite() && spot.is_none_or(aims)
            }
        };
        if aims && intensity.is_finite() && intensity >= 0.0 {
            let name = node.name().or(light.name()).unwrap_or_default();
            self.lights.push(Lamp {
                light: made,
                form,
                intensity,
                name: name.to_owned(),
            });
            self.light_nodes.push(node.index());
        } else {
            self.has_broken = true;
        }
    }

    /// Checks that the requested camera exists.
    ///
    /// # Errors
    /// If it is not: what to do.
    pub(super) fn check_camera(&self) -> Result<(), CauseAndRemedy> {
        let Some(wanted) = self.wanted.as_ref().filter(|_| self.camera.is_none()) else {
            return Ok(());
        };
        let names = self.names.iter().filter(|name| !name.is_empty());
        let names: Vec<_> = names.map(|name| printable(name)).collect();
        let remedy = match names.is_empty() {
            true => String::from("leave `--camera` out"),
            false => format!("choose one of {}", names.join(", ")),
        };
        let cause = match self.has_blind {
            true => format!(
                "the camera {wanted:?} has no direction, or its yfov is not between 0 and 180 degrees",
                wanted = shortened(wanted)
            ),
            false => format!(
                "there is no camera {wanted:?} with a perspective",
                wanted = shortened(wanted)
            ),
        };
        Err(CauseAndRemedy::new(cause, remedy))
    }

    /// The tracks of camera and lights.
    ///
    /// # Errors
    /// If they would take too much memory: cause and remedy.
    pub(super) fn tracks(
        &mut self,
        motion: &mut Motion,
        place: &SourceSpan,
    ) -> Result<Vec<Track>, CauseAndRemedy> {
        let mut tracks = match self.camera {
            Some(_) => motion.camera(self.camera_node, place)?,
            None => Vec::new(),
        };
        // Without any strength lights are black, wherever they are.
        let lit = self.lights.iter().any(|lamp| lamp.intensity > 0.0);
        let lights = self.lights.iter().zip(&self.light_nodes).enumerate();
        for (index, (lamp, &node)) in lights.filter(|_| lit) {
            let directional = matches!(lamp.light, Light::Directional { .. });
            let is_spot = lamp.form.is_some_and(|form| form.spot.is_some());
            self.has_moving_spots |= is_spot && motion.moves(node) && !motion.keeps_direction(node);
            tracks.extend(motion.light(node, index, directional, place)?);
        }
        Ok(tracks)
    }

    /// Puts camera and lights into a scene whose objects are all there.
    pub(super) fn finish(self, scene: &mut Scene, warn: &mut dyn FnMut(&str)) {
        self.warn_of_ignored(warn);
        scene.camera = self.camera;
        self.set_width(&mut scene.render, warn);
        self.add_lights(scene);
    }

    /// Warns of what is left out or changed.
    fn warn_of_ignored(&self, warn: &mut dyn FnMut(&str)) {
        // Those without a perspective cannot be chosen.
        let is_first = self.names.len() > 1 && self.camera.is_some() && self.wanted.is_none();
        let has_names = self.names.iter().any(|name| !name.is_empty());
        for (there, sentence) in [
            (
                self.has_blind,
                "cameras without a direction, or with a yfov that is not between 0 and 180 degrees, are left out",
            ),
            (
                self.cameras > 0 && self.camera.is_none() && !self.has_blind,
                "no camera of the file has a perspective; one is made to see all",
            ),
            (
                self.cameras > self.names.len() && self.camera.is_some() && self.wanted.is_none(),
                "cameras without a perspective are left out",
            ),
            (
                is_first && has_names,
                "the file has several cameras, of which the first is used; choose one with `--camera`",
            ),
            (
                is_first && !has_names,
                "the file has several cameras, of which the first is used; name their nodes to choose one with \
                 `--camera`",
            ),
            (
                self.has_moving_spots,
                "spot lights that turn keep the direction that they have at rest",
            ),
            (
                self.has_narrow_spots,
                "spot lights narrower than 0.3 degrees are widened to 0.3, so that `f32` holds their light",
            ),
            (
                self.has_flat_picture,
                "the aspect ratio of the camera is not above 0, and is ignored",
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
    }

    /// Gives the picture the shape that the camera states.
    fn set_width(&self, render: &mut RenderSettings, warn: &mut dyn FnMut(&str)) {
        let Some(aspect) = self.aspect else {
            return;
        };
        let width = (f64::from(render.height) * aspect).round();
        let widest = f64::from(RenderSettings::MAX_ASPECT * render.height);
        if width > widest {
            let sentence = format!(
                "the camera's picture is {} times as wide as high, which is the limit, not {aspect:.0} times",
                RenderSettings::MAX_ASPECT
            );
            warn(&sentence);
        }
        render.width = width.clamp(1.0, widest) as u32;
    }

    /// Adds the lights, the strongest at full strength.
    fn add_lights(self, scene: &mut Scene) {
        let needs_middle =
            |lamp: &Lamp| matches!(lamp.light, Light::Point { .. }) && lamp.intensity > 0.0;
        let (middle, size) = match self.lights.iter().any(needs_middle) {
            true => middle(scene),
            false => (DVec3::ZERO, 0.0),
        };
        // A light within the scene is measured from a distance that is usual there.
        let nearest = (0.25 * size).max(1e-15);
        let strength = |lamp: &Lamp| match lamp.light {
            Light::Directional { .. } => lamp.intensity,
            Light::Point { position, .. } => {
                lamp.intensity / position.distance(middle).max(nearest).powi(2)
            }
        };
        let strongest = self.lights.iter().map(strength).fold(0.0, f64::max);
        for lamp in self.lights {
            // Lights without any strength are black: the scene is dark, and no other light is supplied.
            let part = match strongest {
                0.0 => 0.0,
                _ => lamp.intensity / strongest,
            };
            let dim = |color: Color| color.map(|channel| channel * part);
            scene.lights.push(match lamp.light {
                Light::Directional { direction, color } => Light::Directional {
                    direction,
                    color: dim(color),
                },
                Light::Point { position, color } => Light::Point {
                    position,
                    color: dim(color),
                },
            });
            scene.light_names.push(lamp.name);
            scene.light_forms.push(lamp.form);
        }
    }
}
