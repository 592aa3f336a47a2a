//! Lights of which rough mirrors and rough glass show too little in `fixed`, because single samples are brighter than
//! it holds.
//!
//! A sample is the light that arrives times π D G / (4 cos) of the facets: `reflect` of `gridel-core`. That is
//! 1 / (4 α²) at most where a surface is seen from above, and below 1 / (2 α² s) at every angle. There s, the root of
//! α² + (1 - α²) cos², is that of the angle at which it is seen.
//!
//! Only pictures in linear radiance lose light. In others a sample counts up to 16 times white in every format.

mod arriving;

use super::requirements::RequiringPart;
use super::shading::light_label;
use crate::scene::{Color, Light, LightForm, LightShape, Material, Scene, Track};
use crate::table::printable;
use arriving::{Surfaces, arriving};
use gridel_core::format::track::TrackTarget;
use std::collections::HashMap;

/// The largest radiance of a sample in `fixed`.
const MOST: f64 = 2048.0;

/// The roughness from which on lights that rays could hit are reflected by their random points, too.
const FOR_ALL: f64 = 0.3;

/// The cosine of the most grazing angle that counts: below 2 degrees a surface takes few pixels.
const GRAZING: f64 = 0.03;

/// The color of the light that the compiler supplies, or brighter.
const SUPPLIED: Color = [1.0; 3];

/// The most boxes of surfaces that are compared with a light.
const MOST_BOXES: usize = 4096;

/// The most comparisons of lights with boxes, for all materials.
const MOST_COMPARISONS: usize = 1 << 26;

/// The tracks of a scene by what they change; of each property there is one.
type Tracks<'s> = HashMap<(TrackTarget, usize), &'s Track>;

/// Returns a sentence for each rough material that in `fixed` may show too little of a light, in pictures of linear
/// radiance. They are no warnings of the [report](super::Report), because they concern no other format.
///
/// ```
/// let file = "[[light]]\nkind = 'directional'\ndirection = [0, -1, 0]\n\
///     [material.m]\nmirror = 1\nroughness = 0.05\n\
///     [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'm'\n";
/// let imported = gridel_host::scene::read("s.toml".as_ref(), file.into(), &Default::default())?;
/// let sentences = gridel_host::compile::dim_reflections(&imported.scene);
/// assert!(sentences[0].contains("material m (s.toml:4) shows too little of light 0"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn dim_reflections(scene: &Scene) -> Vec<String> {
    let scene = &*scene.with_emitters();
    let rough = scene.materials.iter().zip(scene.sends());
    let rough = rough.map(|(material, sends)| material.roughness > 0.0 && sends.any());
    let is_rough: Vec<bool> = rough.collect();
    let materials = is_rough.iter().filter(|it| **it).count();
    if materials == 0 {
        return Vec::new();
    }
    let tracks = scene.tracks.iter();
    let tracks: Tracks<'_> = tracks.map(|it| ((it.target, it.index), it)).collect();
    let lamps = lamps(scene, &tracks);
    let most = MOST_COMPARISONS / (materials * lamps.len()).max(1);
    let surfaces = Surfaces::of_all(scene, &is_rough, most.clamp(1, MOST_BOXES));
    let sentences = surfaces.iter().filter_map(|(&number, surfaces)| {
        let reflector = Reflector::of(scene, &tracks, number);
        let lamps = lamps.iter().map(|lamp| lamp.arriving_at(scene, surfaces));
        reflector.sentence(scene, &lamps.collect::<Vec<_>>())
    });
    sentences.collect()
}

/// A source of light.
#[derive(Clone, Copy)]
enum Source {
    /// A light of the scene, by its number.
    Light(usize),
    Sun,
    /// The light that the compiler supplies.
    Supplied,
}

impl Source {
    fn label(self, scene: &Scene) -> String {
        match self {
            Self::Light(number) => light_label(scene, number),
            Self::Sun => String::from("the sun"),
            Self::Supplied => String::from("the supplied light"),
        }
    }
}

/// A light, and what arrives of it where it is brightest.
#[derive(Clone, Copy)]
struct Lamp {
    source: Source,
    color: Color,
    /// The brightest sample that arrives, over the color.
    arriving: f64,
    /// True if its place changes with time.
    moves: bool,
    /// True if rays bring it below a roughness of 0.3, and facets do not mirror it.
    is_met: bool,
    /// True if as much arrives everywhere.
    is_even: bool,
}

impl Lamp {
    fn distant(source: Source, color: Color) -> Self {
        Self {
            source,
            color,
            arriving: 1.0,
            moves: false,
            is_met: false,
            is_even: true,
        }
    }

    /// The lamp with what arrives of it at surfaces.
    fn arriving_at(&self, scene: &Scene, surfaces: &Surfaces) -> Self {
        let Source::Light(number) = self.source else {
            return *self;
        };
        let form = scene.light_forms.get(number).and_then(Option::as_ref);
        let (Some(form), Light::Point { position, .. }) = (form, scene.lights[number]) else {
            return *self;
        };
        let position = (!self.moves).then_some(position);
        Self {
            arriving: arriving(form, position, surfaces),
            ..*self
        }
    }
}

/// Returns the lights of a scene that light surfaces.
fn lamps(scene: &Scene, tracks: &Tracks<'_>) -> Vec<Lamp> {
    let factor = libm::exp2(scene.render.exposure);
    let exposed = |color: Color| color.map(|channel| channel * factor);
    let mut lamps = Vec::new();
    for (number, light) in scene.lights.iter().enumerate() {
        let (Light::Point { color, .. } | Light::Directional { color, .. }) = *light;
        let form = scene.light_forms.get(number).copied().flatten();
        let color = most_by_tracks(tracks, TrackTarget::LightColor, number, color);
        let is_even = |form: LightForm| form.shape == LightShape::Point && !form.falls_off;
        lamps.push(Lamp {
            moves: tracks.contains_key(&(TrackTarget::LightPosition, number)),
            is_met: form.is_some_and(|it| it.is_surface),
            is_even: form.is_none_or(is_even),
            ..Lamp::distant(Source::Light(number), exposed(color))
        });
    }
    if let Some(sun) = scene.environment.as_ref().and_then(|it| it.sun) {
        let lamp = Lamp::distant(Source::Sun, exposed(sun.light()));
        // Facets mirror a sun that is brighter than rays bring.
        let is_met = largest(lamp.color) / sun.solid_angle_over_pi() < MOST;
        lamps.push(Lamp { is_met, ..lamp });
    }
    if !scene.is_lit() && !scene.is_dark {
        lamps.push(Lamp::distant(Source::Supplied, exposed(SUPPLIED)));
    }
    lamps
}

/// Returns the largest channels of a color at rest and by its track.
fn most_by_tracks(tracks: &Tracks<'_>, target: TrackTarget, index: usize, at_rest: Color) -> Color {
    let points = tracks.get(&(target, index)).into_iter();
    let points = points.flat_map(|track| track.control_points());
    points.fold(at_rest, |[red, green, blue], it| {
        [red.max(it.x), green.max(it.y), blue.max(it.z)]
    })
}

fn largest([red, green, blue]: Color) -> f64 {
    red.max(green).max(blue)
}

/// A rough material.
struct Reflector<'s> {
    material: &'s Material,
    mirror: Color,
    transmit: f64,
}

impl<'s> Reflector<'s> {
    fn of(scene: &'s Scene, tracks: &Tracks<'_>, number: usize) -> Self {
        use TrackTarget::{MaterialMirror, MaterialTransmit};
        let material = &scene.materials[number];
        let most = |target, color| most_by_tracks(tracks, target, number, color);
        Self {
            material,
            mirror: most(MaterialMirror, material.mirror),
            transmit: largest(most(MaterialTransmit, material.transmit)),
        }
    }

    /// Returns the brightest sample of a light that facets mirror, where the surface is seen from above, or else at any
    /// angle.
    fn brightest(&self, lamp: &Lamp, roughness: f64, is_above: bool) -> f64 {
        if lamp.is_met && roughness < FOR_ALL {
            return 0.0;
        }
        let square = roughness.powi(4);
        let slant = (square + (1.0 - square) * GRAZING * GRAZING).sqrt();
        let (cos, part) = match is_above {
            true => (1.0, 0.25),
            false => (GRAZING, 0.5 / slant),
        };
        let glass = self.transmit * fresnel(self.material.ior, cos);
        let channels = self.mirror.iter().zip(lamp.color);
        let reflected = channels.map(|(mirror, light)| (mirror + glass).min(1.0) * light);
        let reflected = reflected.fold(0.0, f64::max);
        match reflected > 0.0 {
            true => part * reflected * lamp.arriving / square,
            false => 0.0,
        }
    }

    fn sentence(&self, scene: &Scene, lamps: &[Lamp]) -> Option<String> {
        let roughness = self.material.roughness.max(Material::LEAST_ROUGHNESS);
        let beyond = |is_above: bool| {
            let bright = lamps.iter();
            let bright = bright.filter(move |it| self.brightest(it, roughness, is_above) > MOST);
            bright.collect::<Vec<_>>()
        };
        let grazing = beyond(false);
        let first = grazing.first()?;
        let above = beyond(true);
        let (verb, shown, angles) = match above.iter().find(|it| it.is_even) {
            Some(even) => ("shows", even, ""),
            None => match above.first() {
                Some(first) => ("may show", first, ""),
                None => ("may show", first, " at grazing angles"),
            },
        };
        let named = if above.is_empty() { &grazing } else { &above };
        let others = match named.len() - 1 {
            0 => String::new(),
            1 => String::from(" and another light"),
            more => format!(" and {more} other lights"),
        };
        // Of those that are met and of the others the brightest is the same at every roughness.
        let brightest = [false, true].map(|is_met| {
            let such = lamps.iter().filter(|it| it.is_met == is_met);
            let at_one = |lamp: &&Lamp| self.brightest(lamp, 1.0, false);
            such.max_by(|a, b| at_one(a).total_cmp(&at_one(b)))
        });
        let hundredths = (1..=100).map(|it| f64::from(it) / 100.0);
        let mut rougher = hundredths.filter(|it| *it > roughness);
        let enough = rougher.find(|it| {
            let mut brightest = brightest.iter().flatten();
            brightest.all(|lamp| self.brightest(lamp, *it, false) <= MOST)
        });
        let remedy = match enough {
            Some(enough) => format!("a roughness of {enough:.2} or more, "),
            None => String::new(),
        };
        let label = format!("material {}", printable(&self.material.name));
        let label = RequiringPart::new(label, &self.material.place);
        let light = shown.source.label(scene);
        Some(format!(
            "in `fixed` and linear radiance, {label} {verb} too little of {light}{others}{angles}: its facets mirror single samples that \
             are brighter than {MOST}, the largest radiance; use `f32` or `f64`, {remedy}a darker light or less \
             `exposure`"
        ))
    }
}

/// Returns the part of light that smooth glass reflects, seen from outside.
fn fresnel(ior: f64, cos: f64) -> f64 {
    if ior <= 1.0 {
        return 0.0;
    }
    let inner = (1.0 - (1.0 - cos * cos) / (ior * ior)).sqrt();
    let across = (cos - ior * inner) / (cos + ior * inner);
    let along = (ior * cos - inner) / (ior * cos + inner);
    (across * across + along * along) / 2.0
}

#[cfg(test)]
mod tests;
