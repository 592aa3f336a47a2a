//! Builds and renders settings, and measures what is wrong with the pictures and what they cost.

use super::flip::{self, flip};
use super::setting::Setting;
use super::ssim::ssim;
use crate::blob::Blob;
use crate::compile::{self, CompileError, Quality};
use crate::render::{Job, Picture, chosen, render};
use crate::report::working_memory_at;
use crate::scene::Scene;
use gridel_core::accel::DynAccel;
use gridel_core::format::checksum;
use gridel_core::format::limits::{MAX_RAY_DEPTH, MAX_STACK_DEPTH};
use gridel_core::render::{Pixel, RenderError};
use gridel_core::{
    Effects, Fixed, Format, NoCount, Number, Renderer, Rgb888, Settings, Stack, Structure,
    closest_hit,
};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::time::Instant;

/// What a setting is worth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Point {
    pub name: String,
    pub setting: Setting,
    pub errors: Errors,
    pub cost: Cost,
}

/// What is wrong with a picture, against the reference. Display values are sRGB, 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// Root of the mean square difference of display values, over all pixels and channels.
    pub rmse: f64,
    /// Largest difference of a display value.
    pub largest: f64,
    /// Pixels of which a display value is off by more than 1/255.
    pub pixels_off: usize,
    /// Mean structural similarity of the grey pictures, in windows of 8 by 8 (Wang and others 2004);
    /// 1 is the same.
    pub ssim: f64,
    /// Mean of FLIP: 0 is the same, 1 as different as can be.
    pub flip: f64,
    /// Rays through the middles of pixels that meet another object than in the reference.
    pub other_objects: usize,
    /// Of the rays that meet the same object: the median and the largest error of the distance, in
    /// units of its last place in single precision.
    pub t_ulps: [f64; 2],
}

/// What a picture costs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cost {
    /// Of each repeat, rendering alone.
    pub seconds: Vec<f64>,
    pub pixels: usize,
    pub rays: u64,
    /// Boxes and primitives that were tested.
    pub tests: u64,
    pub blob_bytes: usize,
    /// Workspace on a 32-bit board.
    pub working_bytes: usize,
}

impl Cost {
    /// The median of the repeats.
    pub fn time(&self) -> f64 {
        let mut sorted = self.seconds.clone();
        sorted.sort_by(f64::total_cmp);
        match sorted.len() {
            0 => 0.0,
            count if count % 2 == 1 => sorted[count / 2],
            count => 0.5 * (sorted[count / 2 - 1] + sorted[count / 2]),
        }
    }

    /// The least and the largest of the repeats; `None` of a single one, which tells nothing of others.
    pub fn interval(&self) -> Option<[f64; 2]> {
        let largest = self.seconds.iter().copied().fold(0.0, f64::max);
        let least = self.seconds.iter().copied().fold(f64::INFINITY, f64::min);
        (self.seconds.len() > 1).then_some([least, largest])
    }

    /// Whether every repeat took less than every repeat of another.
    pub fn is_below(&self, other: &Self) -> bool {
        let both = self.interval().zip(other.interval());
        both.is_some_and(|([_, largest], [least, _])| largest < least)
    }

    /// The largest less the smallest, as a part of the median.
    pub fn spread(&self) -> Option<f64> {
        let [least, largest] = self.interval()?;
        Some((largest - least) / self.time().max(f64::MIN_POSITIVE))
    }

    /// The spread as tables show it.
    pub fn spread_text(&self) -> String {
        let spread = self.spread();
        spread.map_or(String::from("-"), |spread| {
            format!("{:.0} %", 100.0 * spread)
        })
    }
}

/// What the ray through the middle of a pixel meets: an object, and how far away.
type FirstHit = Option<(u32, f64)>;

/// The picture that others are measured against.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reference {
    /// Samples a pixel.
    pub samples: u16,
    /// Linear, 65535 being white.
    pub pixels: Vec<[u16; 3]>,
    /// Of each pixel.
    hits: Vec<FirstHit>,
}

/// Why something cannot be measured.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum MeasureError {
    #[error(transparent)]
    #[diagnostic(transparent)]
    Compile(#[from] CompileError),
    #[error("the scene cannot be rendered: {0}")]
    #[diagnostic(help("change `[render]` in the scene file"))]
    Render(#[from] RenderError),
    #[error("a compiled scene is refused: {0}")]
    #[diagnostic(help("this is a fault of gridel: report it with the scene file"))]
    Blob(#[from] gridel_core::BlobError),
}

/// A scene that is measured, with the blobs that were built of it.
pub struct Bench<'s> {
    scene: &'s Scene,
    structure: Structure,
    /// Of the structure wide.
    pub quality: Quality,
    pub size: [u16; 2],
    blobs: HashMap<(u8, u64), Blob>,
    hits: HashMap<(u8, u64, &'static str), Vec<FirstHit>>,
}

/// How the reference is made: double precision, the finest lattice, all reflections that a picture
/// could show.
pub fn reference_setting(samples: u16) -> Setting {
    Setting {
        format: Format::F64,
        lattice_bits: 24,
        samples,
        depth: MAX_RAY_DEPTH as u8,
        cutoff: f64::powi(2.0, -14),
    }
}

impl<'s> Bench<'s> {
    pub fn new(scene: &'s Scene, structure: Structure, size: [u16; 2]) -> Self {
        Self {
            scene,
            structure,
            quality: Quality::default(),
            size,
            blobs: HashMap::new(),
            hits: HashMap::new(),
        }
    }

    /// What the scene file states.
    pub fn base(&self) -> Setting {
        let stated = self.scene.render;
        Setting {
            format: Format::F32,
            lattice_bits: 24,
            samples: stated.samples,
            depth: stated.depth,
            cutoff: stated.cutoff,
        }
    }

    /// Tells scenes apart.
    pub fn checksum(&mut self) -> Result<u32, MeasureError> {
        let base = self.base();
        Ok(checksum(self.blob(&base)?.bytes()))
    }

    /// Whether anything in the scene reflects or refracts.
    pub fn is_secondary(&mut self) -> Result<bool, MeasureError> {
        let base = self.base();
        let effects = self.blob(&base)?.scene()?.effects();
        Ok(effects.work_depth(1) > 0)
    }

    fn blob(&mut self, setting: &Setting) -> Result<&Blob, MeasureError> {
        let key = (setting.lattice_bits, setting.cutoff.to_bits());
        if !self.blobs.contains_key(&key) {
            let mut scene = self.scene.clone();
            scene.render.cutoff = setting.cutoff;
            let options = compile::Options {
                structures: vec![self.structure],
                lattice_bits: setting.lattice_bits,
                quality: self.quality,
                ..compile::Options::default()
            };
            let blob = compile::compile(&scene, &options)?.blob;
            self.blobs.insert(key, blob);
        }
        Ok(&self.blobs[&key])
    }

    /// A picture, and the seconds that it took.
    fn picture(&mut self, setting: &Setting, count: bool) -> Result<(Picture, f64), MeasureError> {
        let settings = settings(self.size, setting);
        let job = Job {
            count,
            ..Job::whole(setting.format, self.structure, settings)
        };
        let scene = self.blob(setting)?.scene()?;
        let begun = Instant::now();
        let picture = render(&scene, &job, &|| ())?;
        Ok((picture, begun.elapsed().as_secs_f64()))
    }

    /// Renders the reference, on all threads of the pool that this is called in.
    pub fn reference(&mut self, samples: u16) -> Result<Reference, MeasureError> {
        let setting = reference_setting(samples);
        Ok(Reference {
            samples,
            pixels: self.picture(&setting, false)?.0.pixels,
            hits: self.first_hits(&setting)?,
        })
    }

    /// Seconds of one more repeat.
    pub fn time(&mut self, setting: &Setting) -> Result<f64, MeasureError> {
        Ok(self.picture(setting, false)?.1)
    }

    /// Measures a setting but for its time; its pixels, too.
    pub fn measure(
        &mut self,
        setting: &Setting,
        reference: &Reference,
    ) -> Result<(Point, Vec<[u16; 3]>), MeasureError> {
        let (picture, _) = self.picture(setting, true)?;
        let hits = self.first_hits(setting)?;
        let blob = self.blob(setting)?;
        let blob_bytes = blob.bytes().len();
        let working = working_memory_at(&blob.scene()?, setting.depth);
        let name = setting.format.name();
        let counters = picture.counters.unwrap_or_default();
        let point = Point {
            name: setting.name(),
            setting: *setting,
            errors: errors(self.size[0], reference, &picture.pixels, &hits),
            cost: Cost {
                seconds: Vec::new(),
                pixels: picture.pixels.len(),
                rays: counters.rays(),
                tests: counters.boxes + counters.objects,
                blob_bytes,
                working_bytes: working
                    .iter()
                    .find(|memory| memory.format == name && memory.word_bits == 32)
                    .map_or(0, |memory| memory.workspace),
            },
        };
        Ok((point, picture.pixels))
    }

    /// What the rays through the middles of pixels meet.
    fn first_hits(&mut self, setting: &Setting) -> Result<Vec<FirstHit>, MeasureError> {
        let name = setting.format.name();
        let key = (setting.lattice_bits, setting.cutoff.to_bits(), name);
        if let Some(hits) = self.hits.get(&key) {
            return Ok(hits.clone());
        }
        let (structure, settings) = (self.structure, settings(self.size, setting));
        let scene = self.blob(setting)?.scene()?;
        let scene = &chosen(&scene, structure)?;
        let hits = match setting.format {
            Format::Fixed => first_hits::<Fixed>(scene, settings),
            Format::F32 => first_hits::<f32>(scene, settings),
            Format::F64 => first_hits::<f64>(scene, settings),
        }?;
        self.hits.insert(key, hits.clone());
        Ok(hits)
    }
}

fn settings([width, height]: [u16; 2], setting: &Setting) -> Settings {
    Settings {
        width,
        height,
        samples: setting.samples,
        depth: setting.depth,
        dither: false,
    }
}

fn first_hits<N: Number>(
    scene: &gridel_core::Scene<'_>,
    settings: Settings,
) -> Result<Vec<FirstHit>, RenderError> {
    let renderer = Renderer::<N, DynAccel, { Effects::ALL.0 }>::new(scene, settings)?;
    let unit = f64::powi(2.0, scene.header().unit_exponent.into());
    let mut stack = Stack::<MAX_STACK_DEPTH>::new();
    let mut first = |x: u16, y: u16| {
        let ray = renderer.primary_ray(x, y).ok()?;
        let hit = closest_hit::<N, DynAccel, _>(scene, &ray, stack.as_view(), &mut NoCount)?;
        let slope = ray.slope().map(N::ratio_to_f64);
        let norm = slope.iter().map(|x| x * x).sum::<f64>().sqrt();
        Some((hit.object, N::far_to_f64(hit.t) * norm * unit))
    };
    let places = (0..settings.height).flat_map(|y| (0..settings.width).map(move |x| (x, y)));
    Ok(places.map(|(x, y)| first(x, y)).collect())
}

/// A linear value as a display shows it, 0 to 1.
fn display(linear: u16) -> f64 {
    let linear = f64::from(linear) / 65535.0;
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    }
}

fn errors(width: u16, reference: &Reference, pixels: &[[u16; 3]], hits: &[FirstHit]) -> Errors {
    let [expected, found] = [&reference.pixels[..], pixels]
        .map(|p| -> Vec<[f64; 3]> { p.iter().map(|pixel| pixel.map(display)).collect() });
    let (mut squares, mut largest, mut pixels_off) = (0.0, 0.0_f64, 0);
    for (a, b) in expected.iter().zip(&found) {
        let apart = [0, 1, 2].map(|k| (a[k] - b[k]).abs());
        let most = apart.into_iter().fold(0.0, f64::max);
        squares += apart.iter().map(|x| x * x).sum::<f64>();
        largest = largest.max(most);
        pixels_off += usize::from(most > 1.0 / 255.0);
    }
    let picture = |pixels| flip::Picture {
        width: width.into(),
        pixels,
    };
    let differences = flip(picture(&expected), picture(&found));
    let grey = |pixels: &[[u16; 3]]| -> Vec<u8> {
        let luma = |linear: &[u16; 3]| {
            let [r, g, b] = Rgb888::encode(*linear, None).0.map(f64::from);
            (0.2126 * r + 0.7152 * g + 0.0722 * b).round() as u8
        };
        pixels.iter().map(luma).collect()
    };

    let mut other_objects = 0;
    let mut ulps = Vec::new();
    for (expected, found) in reference.hits.iter().zip(hits) {
        match (expected, found) {
            (Some((a, at)), Some((b, found))) if a == b => {
                let ulp = f64::powi(2.0, at.abs().log2().floor() as i32 - 23);
                ulps.push((at - found).abs() / ulp);
            }
            (None, None) => {}
            _ => other_objects += 1,
        }
    }
    ulps.sort_by(f64::total_cmp);
    let last = ulps.last().copied().unwrap_or(0.0);
    Errors {
        rmse: (squares / (3 * pixels.len()).max(1) as f64).sqrt(),
        largest,
        pixels_off,
        ssim: ssim(width.into(), &grey(&reference.pixels), &grey(pixels)),
        flip: differences.iter().sum::<f64>() / differences.len().max(1) as f64,
        other_objects,
        t_ulps: [ulps.get(ulps.len() / 2).copied().unwrap_or(0.0), last],
    }
}

/// How display values differ, eight times enlarged, as sRGB pixels: black is the same.
pub fn difference_picture(reference: &Reference, pixels: &[[u16; 3]]) -> Vec<u8> {
    let pairs = reference
        .pixels
        .iter()
        .flatten()
        .zip(pixels.iter().flatten());
    pairs
        .map(|(&a, &b)| (8.0 * 255.0 * (display(a) - display(b)).abs()).round() as u8)
        .collect()
}
