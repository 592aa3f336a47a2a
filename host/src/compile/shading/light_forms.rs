//! The forms of lights as records.

use crate::compile::CompileError;
use crate::scene::{BRIGHTEST, Color, LightForm, LightShape};
use crate::shape::{Lattice, unit};
use glam::DVec3;
use gridel_core::format::light_form::LightForm as Record;
use std::f64::consts::PI;

/// The longest distance of a form, in units.
const LONGEST: f64 = (1 << 17) as f64;
/// The longest component of an edge, in units: that of the lattice.
const LONGEST_EDGE: f64 = (1 << 16) as f64;
/// Largest variation of light across the scene by a range that is too long for a record.
const UNEVEN: f64 = 0.05;
/// The longest range of a form, in units.
const LONGEST_RANGE: f64 = LONGEST * (1 << Record::FAR_RANGE_BITS) as f64;

/// Steps of the lattice by which light starts above a surface of the scene. More than the lattice moves the surface,
/// and than the error of arithmetic.
const LIFT: f64 = 4.0;

fn lift_length(form: &LightForm, lattice: &Lattice) -> f64 {
    if form.is_surface {
        LIFT * lattice.step()
    } else {
        0.0
    }
}

/// Returns the offset from the position of a light to the point from which it shines. That point lies above the light's
/// surface in the scene, which must not block the light.
pub fn lift(form: &LightForm, lattice: &Lattice) -> DVec3 {
    let normal = match form.shape {
        LightShape::Point | LightShape::Facet { .. } | LightShape::Sphere { .. } => {
            return DVec3::ZERO;
        }
        LightShape::Rectangle { edges } | LightShape::Triangle { edges } => {
            edges[0].cross(edges[1])
        }
        LightShape::Disc { normal, .. } => normal,
    };
    unit(normal) * lift_length(form, lattice)
}

/// The part of a light with a range that is left at a distance.
fn left_within(range: f64, distance: f64) -> f64 {
    let part = (distance / range).min(1.0);
    1.0 - part * part * part * part
}

/// A light that has a form.
pub struct FormedLight<'a> {
    pub form: &'a LightForm,
    pub color: Color,
    /// The light for messages.
    pub label: &'a str,
    /// The distances to the nearest and the farthest point of the scene's box.
    pub distances: [f64; 2],
    pub scene_size: f64,
    pub has_color_track: bool,
}

/// Returns the record of a form, and the light's color in it: brought to the range where it is most precise, unless a
/// track gives the light other colors.
pub fn form_record(
    light: &FormedLight<'_>,
    lattice: &Lattice,
) -> Result<(Record, Color), CompileError> {
    let outline = Outline::of(light.form, lattice);
    for edge in outline.edges {
        let length = edge.abs().max_element();
        light.reject_beyond(lattice, "edge or radius", length, LONGEST_EDGE)?;
    }
    let (reference, color) = light.at_reference(outline.reference, lattice)?;
    let (range, color) = light.in_range(color, lattice)?;
    light.reject_too_bright(color)?;
    let q13 = |length: f64| q13(length / lattice.unit());
    let cosine = |degrees: f64| libm::cos(degrees.to_radians());
    let cone = light.form.spot;
    let cone = cone.map(|spot| [spot.outer, spot.inner].map(cosine));
    let record = Record {
        shape: outline.shape,
        // A light that is there is never without a distance.
        reference: q13(reference).max(i32::from(reference > 0.0)),
        range: range.map_or(0, |range| range_record(range / lattice.unit())),
        cone_cosine: cone.map_or(-(1 << 30), |[outer, _]| q30(outer)),
        width: match (outline.shape, cone) {
            (_, Some([outer, inner])) => q30(inner) - q30(outer),
            (0 | Record::SPHERE, _) => 0,
            // Within its own size of all of it.
            _ => {
                let sizes = outline.edges.map(|edge| 2.0 * edge.abs().element_sum());
                q13(sizes.iter().sum()).min(1 << 30)
            }
        },
        normal: outline.normal.to_array().map(q30),
        edges: outline.edges.map(|edge| edge.to_array().map(q13)),
    };
    Ok((record, color))
}

/// A length in units as records have it.
fn q13(units: f64) -> i32 {
    (units * 8192.0).round() as i32
}

/// A ratio as records have it.
fn q30(ratio: f64) -> i32 {
    (ratio * f64::from(1 << 30)).round() as i32
}

/// A range in units as records have it: negative where it is far.
fn range_record(units: f64) -> i32 {
    let far = f64::from(1 << Record::FAR_RANGE_BITS);
    match units > LONGEST {
        true => -q13(units / far),
        false => q13(units).max(1),
    }
}

/// The shape of a form as its record holds it, in scene units.
struct Outline {
    shape: u32,
    normal: DVec3,
    edges: [DVec3; 2],
    /// The distance at which the light has its color; 0 without a falloff.
    reference: f64,
}

impl Outline {
    fn of(form: &LightForm, lattice: &Lattice) -> Self {
        let at_1 = if form.falls_off { 1.0 } else { 0.0 };
        let (shape, normal, edges, reference) = match form.shape {
            LightShape::Point => {
                let direction = form.spot.map_or(DVec3::ZERO, |spot| unit(spot.direction));
                (0, direction, [DVec3::ZERO; 2], at_1)
            }
            LightShape::Facet { normal } => {
                (Record::RECTANGLE, unit(normal), [DVec3::ZERO; 2], at_1)
            }
            LightShape::Sphere { radius } => {
                let lifted = radius + lift_length(form, lattice);
                let edges = [DVec3::X * lifted, DVec3::ZERO];
                (Record::SPHERE, DVec3::ZERO, edges, radius)
            }
            LightShape::Rectangle { edges } => {
                let across = edges[0].cross(edges[1]);
                let reference = (across.length() / PI).sqrt();
                (Record::RECTANGLE, unit(across), edges, reference)
            }
            LightShape::Triangle { edges } => {
                let across = edges[0].cross(edges[1]);
                let reference = (0.5 * across.length() / PI).sqrt();
                (Record::TRIANGLE, unit(across), edges, reference)
            }
            LightShape::Disc { normal, radius } => {
                let normal = unit(normal);
                let first = normal.any_orthonormal_vector();
                let edges = [first * radius, normal.cross(first) * radius];
                (Record::DISC, normal, edges, radius)
            }
        };
        Self {
            shape,
            normal,
            edges,
            reference,
        }
    }
}

impl FormedLight<'_> {
    /// Rejects a length of more than `most` units.
    fn reject_beyond(
        &self,
        lattice: &Lattice,
        what: &'static str,
        length: f64,
        most: f64,
    ) -> Result<(), CompileError> {
        if length / lattice.unit() <= most {
            return Ok(());
        }
        Err(CompileError::LightForm {
            light: self.label.to_owned(),
            what,
            length,
            most: most * lattice.unit(),
        })
    }

    /// Returns the color in the record, as precise as possible, and the distance at which the light has it.
    fn at_reference(
        &self,
        reference: f64,
        lattice: &Lattice,
    ) -> Result<(f64, Color), CompileError> {
        let peak = self.color.into_iter().fold(0.0, f64::max);
        if reference <= 0.0 || peak <= 0.0 {
            return Ok((reference, self.color));
        }
        let what = "distance at which it has its color";
        if self.has_color_track {
            self.reject_beyond(lattice, what, reference, LONGEST)?;
            return Ok((reference, self.color));
        }
        let full = reference * peak.sqrt();
        let reference = full.min(LONGEST * lattice.unit());
        let brightness = (full / reference) * (full / reference);
        let nearest = self.distances[0];
        if brightness > BRIGHTEST && nearest / lattice.unit() > LONGEST {
            return Err(CompileError::FarAway {
                what: self.label.to_owned(),
                distance: nearest,
                size: self.scene_size,
                remedy: "move it nearer and make it less bright, or use a directional light",
            });
        }
        if brightness > BRIGHTEST {
            return Err(CompileError::LightTooBright {
                light: self.label.to_owned(),
                times: brightness / BRIGHTEST,
            });
        }
        let color = self.color.map(|channel| channel / peak * brightness);
        Ok((reference, color))
    }

    /// Returns the range in the record, if it has one, and the color with what a longer one leaves of it.
    fn in_range(
        &self,
        color: Color,
        lattice: &Lattice,
    ) -> Result<(Option<f64>, Color), CompileError> {
        let range = self.form.range;
        let Some(range) = range.filter(|range| range / lattice.unit() > LONGEST_RANGE) else {
            return Ok((range, color));
        };
        // It is nearly the same everywhere in the scene.
        let [nearest, farthest] = self.distances.map(|it| left_within(range, it));
        let mean = (nearest + farthest) / 2.0;
        if nearest - farthest > UNEVEN * mean || self.has_color_track && mean < 1.0 - UNEVEN {
            self.reject_beyond(lattice, "range", range, LONGEST_RANGE)?;
        }
        let color = match self.has_color_track {
            true => color,
            false => color.map(|channel| channel * mean),
        };
        Ok((None, color))
    }

    fn reject_too_bright(&self, color: Color) -> Result<(), CompileError> {
        let value = color.into_iter().fold(0.0, f64::max);
        // Rounding may bring a color that is as bright as possible beyond.
        if value <= BRIGHTEST * (1.0 + 1e-9) {
            return Ok(());
        }
        Err(CompileError::TooBright {
            what: match self.has_color_track {
                true => format!("{}, whose color has a track,", self.label),
                false => self.label.to_owned(),
            },
            value,
            most: BRIGHTEST,
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::compile::{Options, compile};
    use crate::scene::read;

    /// The record of the light of a scene in millimeters, in scene units, and its error.
    fn color_at_reference(light: &str) -> Result<f64, String> {
        let file = format!(
            "{light}\n[[object]]\nkind = 'box'\nmin = [-2000, -200, -2000]\nmax = [2000, 0, 2000]\n"
        );
        let imported = read("mm.toml".as_ref(), file.into(), &Default::default());
        let imported = imported.map_err(|error| error.to_string())?;
        let blob = compile(&imported.scene, &Options::default());
        let blob = blob.map_err(|error| error.to_string())?.blob;
        let scene = blob.scene().unwrap();
        let unit = f64::powi(2.0, scene.header().unit_exponent.into());
        let light = &scene.lights()[0];
        let form = scene.light_form(light).unwrap();
        let reference = f64::from(form.reference) / 8192.0 * unit;
        Ok(f64::from(light.color[0]) / f64::from(1 << 20) * reference * reference)
    }

    #[test]
    fn lights_with_a_falloff_or_an_area_may_be_as_bright_as_their_scene_is_large() {
        let point =
            "[[light]]\nkind = 'point'\nposition = [0, 500, 0]\nfalloff = 'square'\ncolor = 250000";
        let sphere =
            "[[light]]\nkind = 'sphere'\ncenter = [0, 500, 0]\nradius = 2\nradiance = 62500";
        for light in [point, sphere] {
            let found = color_at_reference(light).unwrap();
            assert!((found / 250_000.0 - 1.0).abs() < 1e-4, "{light}: {found}");
        }
    }

    /// A range is kept, or so long that it leaves all of the light.
    #[test]
    fn ranges_of_every_length_fit() {
        for exponent in -20..80 {
            let range = 10.0 * f64::powf(2.0, f64::from(exponent) / 2.0);
            let file = format!(
                "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n\
                 [[light]]\nkind = 'point'\nposition = [0, 3, 3]\nrange = {range}\n"
            );
            let imported = read("range.toml".as_ref(), file.into(), &Default::default()).unwrap();
            let blob = compile(&imported.scene, &Options::default()).unwrap().blob;
            let scene = blob.scene().unwrap();
            let form = scene.light_form(&scene.lights()[0]).unwrap();
            let unit = f64::powi(2.0, scene.header().unit_exponent.into());
            let found = match form.range {
                far @ ..0 => f64::from(-far) / 256.0 * unit,
                near => f64::from(near) / 8192.0 * unit,
            };
            let is_kept = (found / range - 1.0).abs() < 1e-4;
            let is_longer = range > super::LONGEST_RANGE * unit;
            assert!(is_kept != is_longer, "{range}: {found}");
            assert_eq!(is_longer, form.range == 0, "{range}");
        }
    }

    #[test]
    fn what_is_too_far_away_is_named_with_its_remedy() {
        const LIGHT: &str = "[[light]]\nkind = 'point'\n";
        for (rest, cause, remedy) in [
            (
                String::from("[camera]\neye = [0, 0, 1e9]\ntarget = [0, 0, 0]"),
                "the camera lies 1.000e9 scene units from",
                "move the camera nearer",
            ),
            (
                format!("{LIGHT}position = [0, 1e300, 0]"),
                "light 0 lies 1.000e300 scene units from",
                "use a directional light",
            ),
            (
                format!("{LIGHT}position = [3e6, 4e6, 0]\nfalloff = 'square'\ncolor = 25e12"),
                "light 0 lies 5.000e6 scene units from a scene of",
                "use a directional light",
            ),
        ] {
            let file =
                format!("{rest}\n[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 10\n");
            let imported = read("far.toml".as_ref(), file.into(), &Default::default()).unwrap();
            let error = compile(&imported.scene, &Options::default()).unwrap_err();
            let said = crate::explained(&error);
            assert!(said.contains(cause) && said.contains(remedy), "{said}");
        }
    }

    #[test]
    fn lights_that_their_records_cannot_hold_are_rejected() {
        let bright = "color = 250000\n[[light]]\nkind = 'point'\nposition = [0, 1, 0]";
        let track = "\n[[track]]\ntarget = 'light.0.color'\ntimes = [0, 1]\nvalues = [[1, 1, 1], [2, 2, 2]]";
        for (rest, told) in [
            (format!("falloff = 'square'\n{bright}{track}"), "250000"),
            (format!("range = 9\n{bright}"), "at most 2047"),
            (
                String::from("range = 9\ncolor = 2000\n[render]\nexposure = 1"),
                "4000",
            ),
        ] {
            let light = format!("[[light]]\nkind = 'point'\nposition = [0, 500, 0]\n{rest}");
            let error = color_at_reference(&light).unwrap_err();
            assert!(
                error.contains(told) || error.contains("2.5000e5") || error.contains("4.0000e3"),
                "{error}"
            );
        }
    }
}
