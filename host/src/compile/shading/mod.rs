//! Camera, lights and materials as records, and the effects that they require.

mod checkerboard;
mod environment;
mod exposure;
mod lens;
mod light_forms;
mod lights;
mod materials;
mod media;
mod radiance;
mod setting;
mod textures;

pub use environment::EnvironmentFigures;
pub use exposure::exposure_factor;
pub use lights::{light_label, light_record};
pub use materials::with_coordinates;
pub use radiance::radiance;
pub use textures::{TextureFigures, root};

use super::CompileError;
use super::geometry::extent::Shapes;
use super::motion::joints;
use super::motion::tracks;
use super::requirements::{Requirements, RequiringPart};
use super::section::{Section, section};
use super::view::camera::place;
use super::view::coordinates::Coordinates;
use crate::scene::{Camera, Scene, ToneMapping};
use crate::shape::Lattice;
use bytemuck::Zeroable;
use environment::EnvironmentData;
use exposure::Exposure;
use glam::DVec3;
use gridel_core::Effects;
use gridel_core::format::SectionKind;
use gridel_core::format::lens::Lens;
use gridel_core::format::record::{self, View};
use lights::{CAMERA, LightData, Space, on_lattice};
use materials::MaterialData;
use setting::Setting;
pub use setting::{Shoulder, Supplied, Unstated};

/// Everything of a blob that is not geometry.
#[derive(Debug)]
pub struct ShadingData {
    pub view: View,
    pub coordinates: Coordinates,
    pub requirements: Requirements,
    /// Parts that the scene lacks and the compiler supplied.
    pub supplied: Vec<Supplied>,
    pub unstated: Unstated,
    materials: MaterialData,
    lights: LightData,
    /// The light around the scene.
    environment: Option<EnvironmentData>,
    /// The lens of the camera, in place of a pinhole: one, or none.
    lens: Vec<Lens>,
    /// Maximum number of diffuse reflections of light: one number, or none.
    bounces: Vec<u32>,
    /// Tracks and joints.
    motion: Vec<Section>,
}

impl ShadingData {
    /// Compiles the shading data of a scene in a space, whose meshes require these effects. Its textures may take
    /// `texture_bytes`.
    pub fn of(
        shapes: &Shapes<'_>,
        lattice: &Lattice,
        extent: (DVec3, DVec3),
        mut requirements: Requirements,
        texture_bytes: Option<u64>,
    ) -> Result<Self, CompileError> {
        let scene = shapes.scene();
        let setting = Setting::of(shapes);
        let camera = setting.camera;
        let space = Space { lattice, extent };
        let exposure = Exposure::of(scene);
        let materials =
            MaterialData::of(scene, lattice, &exposure, texture_bytes, &mut requirements)?;
        let are_rough = materials.are_rough();
        let mut lights = LightData::of(scene, &setting.lights, space, &exposure, are_rough)?;
        let places = &scene.places;
        let environment = scene.environment.as_ref();
        let environment = environment.map(|it| EnvironmentData::of(it, scene.up, &exposure));
        let environment = environment.transpose()?;
        if let Some(environment) = &environment {
            lights.records.extend(&environment.lights);
            let part = RequiringPart::ENVIRONMENT;
            requirements.add(Effects::ENVIRONMENT, part, &places.environment);
        }
        let light = |color, what: &str| exposure.of_color(color, || what.into()).map(radiance);
        let view = View {
            background: light(setting.background, "background")?,
            ambient: light(setting.ambient, "ambient light")?,
            ..view_record(scene)?
        };
        let lens = lens::record(scene.lens.as_ref(), &camera, lattice)?;
        let bounces = Some(scene.render.bounces).filter(|&bounces| bounces > 0);
        for (effect, is_required, part, place) in [
            (
                view.effects(),
                true,
                RequiringPart::TONE_MAPPING,
                &places.tone_mapping,
            ),
            (
                Effects::DEPTH_OF_FIELD,
                lens.is_some(),
                RequiringPart::APERTURE,
                &places.aperture,
            ),
            (
                Effects::INDIRECT,
                bounces.is_some(),
                RequiringPart::BOUNCES,
                &places.bounces,
            ),
        ] {
            requirements.add(effect.only_if(is_required), part, place);
        }
        if scene.all_objects().next().is_some() {
            let stated = setting.lights.len();
            require_lights(&lights.records, stated, scene, &mut requirements);
        }

        on_lattice(lattice, space.size(), String::from(CAMERA), camera.eye)?;
        let coordinates = coordinates(scene, &camera, lattice, [extent.0, extent.1]);
        let placed = place(&camera, &coordinates.header)?;
        let mut tracks = joints::kept_tracks(scene);
        exposure.change_tracks(&mut tracks)?;
        let mut motion = tracks::sections(
            scene,
            tracks,
            &camera,
            &materials.numbers,
            &coordinates.header,
        )?;
        motion.extend(joints::sections(scene, &coordinates.header)?);
        Ok(Self {
            view: placed.replace_in(&view, &coordinates.header),
            coordinates,
            requirements,
            unstated: setting.unstated(scene),
            supplied: setting.supplied,
            materials,
            lights,
            environment,
            lens: lens.into_iter().collect(),
            bounces: bounces.into_iter().map(u32::from).collect(),
            motion,
        })
    }

    /// Returns the lights, those of the environment included.
    pub fn lights(&self) -> &[record::Light] {
        &self.lights.records
    }

    /// Returns the storage of each texture.
    pub fn texture_figures(&self) -> &[TextureFigures] {
        &self.materials.texture_figures
    }

    /// Returns the storage of the environment.
    pub fn environment_figures(&self) -> Option<EnvironmentFigures> {
        self.environment.as_ref().map(|it| it.figures)
    }

    /// Returns the sections of a blob that distinguishes this number of objects.
    pub fn sections(&self, objects: u32) -> Vec<Section> {
        let mut sections = vec![
            section(SectionKind::View, &[self.view]),
            section(SectionKind::Lens, &self.lens),
            section(SectionKind::Indirect, &self.bounces),
        ];
        sections.extend(self.lights.sections());
        sections.extend(self.environment.iter().flat_map(EnvironmentData::sections));
        sections.extend(self.materials.sections(objects));
        sections.extend(self.motion.iter().cloned());
        sections
    }
}

/// Returns the length of a coordinate step of a scene with this lattice and extent.
pub fn coordinate_step(shapes: &Shapes<'_>, lattice: &Lattice, corners: [DVec3; 2]) -> f64 {
    let camera = Setting::of(shapes).camera;
    coordinates(shapes.scene(), &camera, lattice, corners).step()
}

/// Chooses the integer coordinates of a scene with a camera.
fn coordinates(
    scene: &Scene,
    camera: &Camera,
    lattice: &Lattice,
    corners: [DVec3; 2],
) -> Coordinates {
    let mut places = tracks::places(&scene.tracks, camera);
    places.extend(joints::places(scene));
    Coordinates::choose(lattice, corners, camera.eye, &scene.lights, &places)
}

/// Adds what lights require where there are objects. Those behind the `stated` ones are of the environment.
fn require_lights(
    lights: &[record::Light],
    stated: usize,
    scene: &Scene,
    requirements: &mut Requirements,
) {
    // The environment stands for itself. A scene file may turn shadows off.
    let mut known = Effects::ENVIRONMENT;
    if !scene.render.shadows {
        known = known.with(Effects::SHADOW);
    }
    for (number, light) in lights.iter().enumerate() {
        let place = match number < stated {
            true => scene.places.light(number),
            false => scene.places.environment.clone(),
        };
        let effects = light.effects().without(known);
        requirements.add(effects, format!("light {number}"), &place);
    }
}

/// The defaults of a picture; the camera is placed afterwards.
fn view_record(scene: &Scene) -> Result<View, CompileError> {
    let render = &scene.render;
    let encoding = match (render.tone_mapping, scene.display_values) {
        (ToneMapping::None, false) => 0,
        (ToneMapping::None, true) => View::DISPLAY_VALUES,
        (_, true) => return Err(CompileError::ToneMapping),
        (ToneMapping::Reinhard, false) => View::REINHARD,
        (ToneMapping::Aces, false) => View::ACES,
    };
    Ok(View {
        cutoff: radiance([render.cutoff; 3])[0],
        width: render.width.clamp(1, u16::MAX.into()) as u16,
        height: render.height.clamp(1, u16::MAX.into()) as u16,
        samples: render.samples,
        depth: render.depth.max(render.bounces),
        encoding,
        ..View::zeroed()
    })
}
