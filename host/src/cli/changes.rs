//! Values of options that replace a blob's own values.

use super::arguments::{LightChange, SceneOptions};
use super::failure::Failure;
use glam::DVec3;
use gridel_core::Scene;
use gridel_core::format::light_form::LightForm;
use gridel_core::format::record::{self, View};
use gridel_host::compile::{self, CompileError};
use gridel_host::scene::{Light, ToneMapping};
use gridel_host::state::State;
use std::f64::consts::PI;

/// The changes to a blob.
pub struct Changes {
    pub state: State,
    /// In ticks.
    pub time: Option<i32>,
}

impl Changes {
    /// Returns the scene with these changes.
    pub fn apply<'a>(&'a self, scene: &Scene<'a>) -> Result<Scene<'a>, Failure> {
        // The values are proved to be in their range.
        self.state.apply(scene).map_err(Failure::fault)
    }

    /// Returns the changes that options make.
    pub fn of(scene: &Scene<'_>, options: &SceneOptions) -> Result<Self, Failure> {
        let mut view = options.view.in_blob(scene)?;
        if let Some(cutoff) = options.cutoff {
            [view.cutoff, ..] = compile::radiance([cutoff; 3]);
        }
        if let Some(tone_mapping) = options.tone_mapping {
            if view.encoding == View::DISPLAY_VALUES && tone_mapping != ToneMapping::None {
                let error = CompileError::ToneMapping;
                return Err(Failure::Usage(miette::Report::new(error)));
            }
            view.encoding = match tone_mapping {
                ToneMapping::None if view.encoding == View::DISPLAY_VALUES => view.encoding,
                ToneMapping::None => 0,
                ToneMapping::Reinhard => View::REINHARD,
                ToneMapping::Aces => View::ACES,
            };
        }
        if options.exposure.is_some() {
            return Err(Failure::usage(
                "a blob's exposure is part of its lights, and cannot be changed",
                "give the scene file in place of the blob, or change the lights with `--light`",
            ));
        }
        let own = scene.lights();
        let mut lights: Vec<Light> = own.iter().map(|it| Light::of_blob(scene, it)).collect();
        let before = lights.clone();
        // The last are those of the environment, which no scene file has among its lights.
        let stated = own.iter().take_while(|it| !it.is_environment()).count();
        for change in &options.lights {
            change.apply(&mut lights[..stated], |number| is_spot(scene, &own[number]))?;
        }
        let mut numbers = options.lights.iter().map(LightChange::number);
        let is_shown =
            |&number: &usize| before[number] != lights[number] && is_face(scene, &own[number]);
        if let Some(number) = numbers.find(is_shown) {
            return Err(Failure::usage(
                format!(
                    "light {number} is visible, and the object that shows it cannot change in a blob"
                ),
                "give the scene file in place of the blob",
            ));
        }
        let records = lights.iter().enumerate().map(|(number, light)| {
            // Those that stay keep their bits.
            if before[number] == *light {
                Ok(own[number])
            } else {
                light.in_blob(scene, number)
            }
        });
        let lights = records.collect::<Result<_, _>>();
        let state = State {
            view,
            lights: lights.map_err(|error| Failure::Usage(miette::Report::new(error)))?,
            materials: scene.materials().to_vec(),
            poses: None,
            morphed: None,
        };
        Ok(Self { state, time: None })
    }
}

/// Returns whether a light is a face of an object that glows. A blob states it where materials are rough. Elsewhere the
/// light of an area is taken for one if a material that has lights emits the same radiance.
fn is_face(scene: &Scene<'_>, light: &record::Light) -> bool {
    if scene.lights().iter().any(|it| scene.is_shown(it)) {
        return scene.is_shown(light);
    }
    let Some(form) = scene.light_form(light).filter(|_| light.is_area()) else {
        return false;
    };
    let edges = form
        .edges
        .map(|edge| DVec3::from_array(edge.map(f64::from)));
    let across = edges[0].cross(edges[1]).length();
    // Over π, as the square of the reference.
    let area = match form.shape {
        LightForm::SPHERE => edges[0].x * edges[0].x,
        LightForm::RECTANGLE => across / PI,
        LightForm::TRIANGLE => across / (2.0 * PI),
        _ => across,
    };
    let reference = f64::from(form.reference);
    let color = light.color;
    let radiance = color.map(|it| f64::from(it) * (reference * reference / area));
    // Lengths are rounded, and a sphere's surface is lifted.
    let spare = 0.02 * radiance.into_iter().fold(0.0, f64::max);
    let is_same = |(it, own): (f64, i32)| (it - f64::from(own)).abs() <= spare;
    let mut emissions = scene.emissions().iter().filter(|it| it.lights == 1);
    emissions.any(|it| radiance.into_iter().zip(it.radiance).all(is_same))
}

/// Returns whether a light shines within a cone.
fn is_spot(scene: &Scene<'_>, light: &record::Light) -> bool {
    let form = scene.light_form(light);
    form.is_some_and(|form| !light.is_area() && form.cone_cosine != -(1 << 30))
}
