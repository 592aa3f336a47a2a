//! Lights as records, and the forms of those that are more than points.

use super::exposure::Exposure;
use super::light_forms::{FormedLight, form_record, lift};
use super::radiance::radiance;
use crate::compile::CompileError;
use crate::compile::section::{Section, section};
use crate::scene::{Color, Light, LightForm, Scene, Track};
use crate::shape::{Lattice, unit};
use crate::table::printable;
use glam::DVec3;
use gridel_core::format::SectionKind;
use gridel_core::format::limits::FARTHEST;
use gridel_core::format::record;
use gridel_core::format::track::TrackTarget;

/// The lights of a scene.
#[derive(Debug)]
pub struct LightData {
    pub records: Vec<record::Light>,
    /// Properties of lights other than plain points.
    forms: Vec<gridel_core::format::light_form::LightForm>,
    /// For each form, whether an object shows it; empty where no material is rough.
    shown_forms: Vec<u8>,
}

/// The space in which a scene lies.
#[derive(Clone, Copy)]
pub struct Space<'a> {
    pub lattice: &'a Lattice,
    /// The lowest and the highest corner of the scene's box.
    pub extent: (DVec3, DVec3),
}

impl Space<'_> {
    /// Returns the longest side of the scene's box.
    pub fn size(&self) -> f64 {
        (self.extent.1 - self.extent.0).max_element()
    }
}

impl LightData {
    /// Compiles these lights, to which the forms of a scene belong. Rough materials need to know which lights an
    /// object shows.
    pub fn of(
        scene: &Scene,
        lights: &[Light],
        space: Space<'_>,
        exposure: &Exposure,
        are_rough: bool,
    ) -> Result<Self, CompileError> {
        let mut data = Self {
            records: Vec::with_capacity(lights.len()),
            forms: Vec::new(),
            shown_forms: Vec::new(),
        };
        for (number, light) in lights.iter().enumerate() {
            let form = scene.light_forms.get(number).and_then(Option::as_ref);
            let record = match (form, *light) {
                (Some(form), Light::Point { position, color }) => {
                    if are_rough {
                        data.shown_forms.push(form.is_surface.into());
                    }
                    let color = color.map(|channel| channel * exposure.factor);
                    data.formed(scene, number, (form, position, color), space)?
                }
                _ => {
                    let light = exposure.of_light(light, number)?;
                    light_record(&light, space.lattice, space.size(), number)?
                }
            };
            data.records.push(record);
        }
        Ok(data)
    }

    /// Adds the form of a light, and returns the light's record.
    fn formed(
        &mut self,
        scene: &Scene,
        number: usize,
        (form, position, color): (&LightForm, DVec3, Color),
        space: Space<'_>,
    ) -> Result<record::Light, CompileError> {
        let Space { lattice, extent } = space;
        let position = position + lift(form, lattice);
        let nearest = position.clamp(extent.0, extent.1) - position;
        let farthest = (extent.1 - position).abs().max((extent.0 - position).abs());
        let mut tracks = scene.tracks.iter();
        let has_color_track =
            tracks.any(|track| (track.target, track.index) == (TrackTarget::LightColor, number));
        if form.is_surface {
            check_stays(scene, number)?;
        }
        let formed = FormedLight {
            form,
            color,
            label: &light_label(scene, number),
            distances: [nearest.length(), farthest.length()],
            scene_size: space.size(),
            has_color_track,
        };
        let (form, color) = form_record(&formed, lattice)?;
        let light = Light::Point { position, color };
        let record = light_record(&light, lattice, space.size(), number)?;
        let is_area = form.shape != 0 && form.edges != [[0; 3]; 2];
        let kind = record::Light::with_form(self.forms.len() as u32, is_area);
        self.forms.push(form);
        Ok(record::Light { kind, ..record })
    }

    pub fn sections(&self) -> [Section; 3] {
        [
            section(SectionKind::Lights, &self.records),
            section(SectionKind::LightForms, &self.forms),
            section(SectionKind::ShownForms, &self.shown_forms),
        ]
    }
}

/// Checks that no track moves or changes a light that an object shows.
fn check_stays(scene: &Scene, number: usize) -> Result<(), CompileError> {
    use TrackTarget::{LightColor, LightPosition};
    let mut tracks = scene.tracks.iter();
    let changes = |track: &&Track| {
        track.index == number && matches!(track.target, LightColor | LightPosition)
    };
    match tracks.find(changes) {
        None => Ok(()),
        Some(track) => Err(CompileError::Track {
            place: track.place.clone(),
            target: scene.target_of(track),
            cause: format!(
                "{} is visible, and the object that shows it cannot change with time",
                light_label(scene, number)
            ),
            remedy: String::from("set the light's `visible = false`, or leave the track out"),
        }),
    }
}

/// The camera for messages.
pub const CAMERA: &str = "camera";

/// Returns a place that may lie beyond the scene, in units with 13 fraction bits.
pub fn on_lattice(
    lattice: &Lattice,
    size: f64,
    what: String,
    point: DVec3,
) -> Result<[i64; 3], CompileError> {
    let q13 = lattice.in_units(point) * 8192.0;
    let largest = q13.abs().max_element();
    if largest.is_nan() || largest > FARTHEST as f64 {
        let way = point - lattice.origin;
        let longest = way.abs().max_element();
        return Err(CompileError::FarAway {
            remedy: match what.as_str() {
                CAMERA => "move the camera nearer, or make the scene larger",
                _ => "move it nearer, make the scene larger, or use a directional light",
            },
            what,
            // Squares of the longest ways are no numbers.
            distance: (way / longest).length() * longest,
            size,
        });
    }
    Ok(q13.round().to_array().map(|x| x as i64))
}

/// A light for messages: its number, and its name if it has one.
pub fn light_label(scene: &Scene, number: usize) -> String {
    match scene.light_names.get(number) {
        Some(name) if !name.is_empty() => format!("light {number} ({})", printable(name)),
        _ => format!("light {number}"),
    }
}

/// Returns a light of a scene of some size.
pub fn light_record(
    light: &Light,
    lattice: &Lattice,
    size: f64,
    number: usize,
) -> Result<record::Light, CompileError> {
    Ok(match *light {
        Light::Point { position, color } => record::Light {
            vector: on_lattice(lattice, size, format!("light {number}"), position)?,
            color: radiance(color),
            kind: 0,
        },
        Light::Directional { direction, color } => {
            let towards = -unit(direction);
            let vector = (towards * f64::from(1 << 30))
                .round()
                .to_array()
                .map(|x| x as i64);
            record::Light {
                vector,
                color: radiance(color),
                kind: record::Light::DIRECTIONAL,
            }
        }
    })
}

#[cfg(test)]
mod tests {
    use crate::compile::{CompileError, Options, compile};
    use crate::scene::read;

    fn compiled(is_visible: bool, track: &str) -> Result<(), CompileError> {
        let file = format!(
            "[[light]]\nkind = 'sphere'\ncenter = [0, 4, 0]\nradius = 1\nradiance = 1\nname = 'bulb'\n\
             visible = {is_visible}\n\
             [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n\
             [[track]]\ntarget = 'light.0.{track}'\ntimes = [0, 1]\nvalues = [[0, 4, 0], [0, 5, 0]]"
        );
        let imported = read("lamp.toml".as_ref(), file.into(), &Default::default()).unwrap();
        compile(&imported.scene, &Options::default()).map(|_| ())
    }

    #[test]
    fn tracks_of_visible_lights_are_rejected() {
        for track in ["position", "color"] {
            compiled(false, track).unwrap();
            let error = compiled(true, track).unwrap_err().to_string();
            let told = [track, "light 0 (bulb) is visible", "lamp.toml:1"];
            assert!(told.iter().all(|it| error.contains(it)), "{error}");
        }
    }
}
