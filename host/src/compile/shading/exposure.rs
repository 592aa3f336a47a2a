//! Exposure. The compiler multiplies all light of a scene, so that pictures cost no more.

use crate::compile::CompileError;
use crate::scene::{Color, Light, Scene, Track};
use gridel_core::format::track::TrackTarget;

/// The largest radiance of a record.
const MOST: f64 = 2047.0;

/// The factor of all light.
pub struct Exposure {
    pub factor: f64,
}

impl Exposure {
    pub fn of(scene: &Scene) -> Self {
        Self {
            factor: libm::exp2(scene.render.exposure),
        }
    }

    /// A color, as records have it.
    pub fn of_color(
        &self,
        color: Color,
        what: impl FnOnce() -> String,
    ) -> Result<Color, CompileError> {
        let exposed = color.map(|channel| channel * self.factor);
        let largest = exposed.into_iter().fold(0.0, f64::max);
        if self.factor != 1.0 && largest > MOST {
            return Err(CompileError::TooBright {
                what: what(),
                value: largest,
                most: MOST,
            });
        }
        Ok(exposed)
    }

    /// A light whose color is all that says how bright it is.
    pub fn of_light(&self, light: &Light, number: usize) -> Result<Light, CompileError> {
        let mut light = *light;
        let (Light::Point { color, .. } | Light::Directional { color, .. }) = &mut light;
        *color = self.of_color(*color, || format!("light {number}"))?;
        Ok(light)
    }

    /// Changes the colors that tracks give to lights.
    pub fn change_tracks(&self, tracks: &mut [Track]) {
        let of_lights = tracks.iter_mut();
        for track in of_lights.filter(|it| it.target == TrackTarget::LightColor) {
            for key in &mut track.keys {
                for values in [&mut key.value, &mut key.entering, &mut key.leaving] {
                    *values = values.map(|value| value * self.factor);
                }
            }
        }
    }
}
