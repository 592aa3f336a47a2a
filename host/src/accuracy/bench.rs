//! Builds and renders settings, and measures the errors of the pictures and their cost.

use super::plan::{HitsKey, Plan, hits_key, in_f64, with_all};
use super::setting::{Key, Setting};
use super::truth::{Truth, exact_pixels};
use crate::blob::Blob;
use crate::compile::{self, CompileError, Compiled, LATTICE_BITS, Quality};
use crate::measure::board::instructions;
use crate::measure::{
    Errors, FirstHit, InstanceCount, Rendered, board_memory, median, rmse_and_largest, time,
};
use crate::render::{Job, first_hits};
use crate::scene::Scene;
use gridel_core::format::checksum;
use gridel_core::render::RenderError;
use gridel_core::{Effects, Format, Settings, Structure};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// The error of a setting, and its cost.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Point {
    pub name: String,
    pub setting: Setting,
    /// Errors against the reference.
    pub errors: Errors,
    pub parts: ErrorParts,
    /// If effects are left out: the errors against the picture with these effects and otherwise the same setting.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lost: Option<Errors>,
    pub cost: Cost,
}

/// The two parts of an error, each a root of the mean square difference of display values. They do not add up:
/// one may cancel the other.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ErrorParts {
    /// The true picture of this setting, of `f64` or exact, against the reference: what samples, depth, cut-off,
    /// lattice and left-out effects do.
    pub sampling: f64,
    /// The picture of the setting's number format against the true picture of this setting.
    pub arithmetic: f64,
    /// The largest difference between these two.
    pub arithmetic_largest: f64,
    /// Pixels of an exact picture that are open.
    #[serde(default)]
    pub open: usize,
}

/// The cost of a picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cost {
    /// Seconds of each repeat, rendering alone.
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
    /// Returns the median of the repeats.
    pub fn time(&self) -> f64 {
        median(&self.seconds).unwrap_or(0.0)
    }

    /// Returns the rays and the tests in one count.
    pub fn work(&self) -> f64 {
        (self.rays + self.tests) as f64
    }

    /// Returns the least and the largest of the repeats: see [`time::interval`].
    pub fn interval(&self) -> Option<[f64; 2]> {
        time::interval(&self.seconds)
    }

    /// Returns whether every repeat took less than every repeat of another.
    pub fn is_below(&self, other: &Self) -> bool {
        time::is_below(&self.seconds, &other.seconds)
    }

    /// Returns the largest less the least, as a part of the median.
    pub fn spread(&self) -> Option<f64> {
        time::spread(&self.seconds)
    }

    /// Returns the spread as tables show it.
    pub fn spread_text(&self) -> String {
        let spread = self.spread();
        spread.map_or(String::from("-"), |spread| {
            format!("{:.0} %", 100.0 * spread)
        })
    }
}

impl Point {
    /// Rays per pixel.
    pub fn rays_per_pixel(&self) -> f64 {
        self.cost.rays as f64 / self.cost.pixels.max(1) as f64
    }

    /// Rays and tests per pixel.
    pub fn work_per_pixel(&self) -> f64 {
        self.cost.work() / self.cost.pixels.max(1) as f64
    }

    /// Instructions per pixel on a board: see [`instructions`].
    pub fn instructions(&self, board: &str) -> Option<[f64; 2]> {
        instructions(board, self.setting.format, self.rays_per_pixel())
    }
}

/// The picture that others are measured against.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reference {
    /// Samples per pixel.
    pub samples: u16,
    /// A secondary ray that can change no channel by more than this is not traced.
    #[serde(default)]
    pub cutoff: f64,
    #[serde(default)]
    pub truth: Truth,
    /// Pixels of an exact picture that are open.
    #[serde(default)]
    pub open: usize,
    /// Linear, 65535 being white.
    pub pixels: Vec<[u16; 3]>,
    /// One value per pixel; `None` on a miss.
    pub(super) hits: Vec<Option<FirstHit>>,
}

/// An error of a measurement.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum MeasureError {
    #[error(transparent)]
    #[diagnostic(transparent)]
    Compile(#[from] CompileError),
    #[error("the scene cannot be rendered: {0}")]
    #[diagnostic(help("change `[render]` in the scene file"))]
    Render(#[from] RenderError),
    #[error(transparent)]
    #[diagnostic(help("leave it out of the scene, or measure against `--reference f64`"))]
    Unknown(#[from] crate::certify::Unknown),
    #[error("a compiled scene is rejected: {0}")]
    #[diagnostic(help("this is a fault of gridel: report it with the scene file"))]
    Blob(#[from] gridel_core::BlobError),
}

/// A scene that is measured, with the blobs that were built of it.
///
/// ```
/// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
/// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// use gridel_core::Structure;
/// use gridel_host::accuracy::{Bench, reference_setting};
///
/// let mut bench = Bench::new(&imported.scene, Structure::Flagged, [16, 12]);
/// let base = bench.base();
/// let reference = bench.reference(&reference_setting(16, &[base]))?;
/// let (point, pixels) = bench.measure(&base, &reference)?;
/// assert_eq!(pixels.len(), 16 * 12);
/// assert!(point.errors.rmse < 0.2 && point.cost.rays >= 16 * 12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Bench<'s> {
    scene: &'s Scene,
    structure: Structure,
    quality: Quality,
    size: [u16; 2],
    copied: usize,
    truth: Truth,
    /// Scenes as they were compiled, the last one that was used at the end.
    compiled: Vec<(BlobKey, Compiled)>,
    /// Most bytes of their blobs.
    most_blob_bytes: usize,
    plan: Plan,
    hits: HashMap<HitsKey, Vec<Option<FirstHit>>>,
    /// Pictures that others are measured against.
    pictures: HashMap<Key, Vec<[u16; 3]>>,
    /// Exact pictures of `f64`, and how many of their pixels are open.
    exact: HashMap<Key, (Vec<[u16; 3]>, usize)>,
}

/// The settings that a blob depends on: lattice bits, cutoff, effects left out.
type BlobKey = (u8, u64, Effects);

/// Most bytes of blobs that are kept. Others are compiled again when they are needed.
const MOST_BLOB_BYTES: usize = 256 << 20;

impl<'s> Bench<'s> {
    pub fn new(scene: &'s Scene, structure: Structure, size: [u16; 2]) -> Self {
        Self {
            scene,
            structure,
            quality: Quality::default(),
            size,
            copied: 0,
            truth: Truth::F64,
            compiled: Vec::new(),
            most_blob_bytes: MOST_BLOB_BYTES,
            plan: Plan::default(),
            hits: HashMap::new(),
            pictures: HashMap::new(),
            exact: HashMap::new(),
        }
    }

    /// Returns it with a build quality of the structure `wide`.
    #[must_use]
    pub fn with_quality(self, quality: Quality) -> Self {
        Self { quality, ..self }
    }

    /// Returns it with the number of instances of the scene file that were [copied](crate::scene::Imported::copied), for
    /// the report.
    #[must_use]
    pub fn with_copied(self, copied: usize) -> Self {
        Self { copied, ..self }
    }

    /// Returns it with other pictures that errors are measured against; usually those of `f64`.
    #[must_use]
    pub fn with_truth(self, truth: Truth) -> Self {
        Self { truth, ..self }
    }

    /// States the settings that are going to be measured. From then on only the pictures that one of them needs are kept,
    /// until it was measured; without a plan all are.
    pub fn plan(&mut self, settings: Vec<Setting>) {
        self.plan = Plan::of(settings);
        self.forget();
    }

    /// Drops the pictures that the plan does not need any more.
    fn forget(&mut self) {
        let plan = &self.plan;
        self.hits.retain(|key, _| plan.needs_hits(key));
        self.pictures.retain(|key, _| plan.needs_picture(key));
        self.exact.retain(|key, _| plan.needs_picture(key));
    }

    /// Width and height of the pictures.
    pub fn size(&self) -> [u16; 2] {
        self.size
    }

    /// Returns the setting that the scene file states.
    pub fn base(&self) -> Setting {
        let stated = self.scene.render;
        Setting {
            format: Format::F32,
            lattice_bits: *LATTICE_BITS.end(),
            samples: stated.samples,
            depth: stated.depth,
            cutoff: stated.cutoff,
            without: Effects::NONE,
        }
    }

    /// Returns a number that distinguishes scenes.
    ///
    /// # Errors
    /// If the scene cannot be compiled.
    pub fn checksum(&mut self) -> Result<u32, MeasureError> {
        let base = self.base();
        Ok(checksum(self.blob(&base)?.bytes()))
    }

    /// Returns the treatment of the scene's instances; `None` without any.
    ///
    /// # Errors
    /// If the scene cannot be compiled.
    pub fn instances(&mut self) -> Result<Option<InstanceCount>, MeasureError> {
        let (base, copied) = (self.base(), self.copied);
        Ok(InstanceCount::of(&self.blob(&base)?.scene()?, copied))
    }

    /// Returns the effects that the scene calls for.
    ///
    /// # Errors
    /// If the scene cannot be compiled.
    pub fn effects(&mut self) -> Result<Effects, MeasureError> {
        let base = self.base();
        Ok(self.blob(&base)?.scene()?.effects_with_parts())
    }

    /// Returns the compiler's warnings of the scene as it is stated.
    ///
    /// # Errors
    /// If the scene cannot be compiled.
    pub fn warnings(&mut self) -> Result<Vec<String>, MeasureError> {
        let base = self.base();
        Ok(self.compiled(&base)?.report.warnings(base.lattice_bits))
    }

    /// The blob of a setting.
    pub(super) fn blob(&mut self, setting: &Setting) -> Result<&Blob, MeasureError> {
        Ok(&self.compiled(setting)?.blob)
    }

    fn compiled(&mut self, setting: &Setting) -> Result<&Compiled, MeasureError> {
        let cutoff = setting.cutoff.to_bits();
        let key = (setting.lattice_bits, cutoff, setting.without);
        let found = self.compiled.iter().position(|(it, _)| *it == key);
        let last = match found {
            Some(place) => self.compiled.remove(place),
            None => (key, self.compile(setting)?),
        };
        self.compiled.push(last);
        let bytes = |(_, compiled): &(BlobKey, Compiled)| compiled.blob.bytes().len();
        let mut all: usize = self.compiled.iter().map(bytes).sum();
        while all > self.most_blob_bytes && self.compiled.len() > 1 {
            all -= bytes(&self.compiled.remove(0));
        }
        Ok(&self.compiled[self.compiled.len() - 1].1)
    }

    fn compile(&self, setting: &Setting) -> Result<Compiled, CompileError> {
        let mut scene = self.scene.clone();
        scene.render.cutoff = setting.cutoff;
        scene.remove_effects(setting.without);
        [scene.render.width, scene.render.height] = self.size.map(u32::from);
        let options = compile::Options {
            structures: vec![self.structure],
            lattice_bits: setting.lattice_bits,
            quality: self.quality,
            ..compile::Options::default()
        };
        compile::compile(&scene, &options)
    }

    fn rendered(&mut self, setting: &Setting, count: bool) -> Result<Rendered, MeasureError> {
        let settings = settings(self.size, setting);
        let with = (self.structure, setting.format);
        let scene = self.blob(setting)?.scene()?;
        Ok(Rendered::new(&scene, with, settings, count)?)
    }

    /// Renders the reference, on all threads of the pool that this is called in. Its setting is that of
    /// [`reference_setting`](super::reference_setting).
    ///
    /// # Errors
    /// If the scene cannot be compiled or rendered with this setting, or its exact picture is required and not known.
    pub fn reference(&mut self, setting: &Setting) -> Result<Reference, MeasureError> {
        let (pixels, open) = self.true_picture(setting)?;
        let hits = self.first_hits(setting)?;
        self.forget();
        Ok(Reference {
            samples: setting.samples,
            cutoff: setting.cutoff,
            truth: self.truth,
            open,
            pixels,
            hits,
        })
    }

    /// Seconds of one more repeat.
    ///
    /// # Errors
    /// If the scene cannot be compiled or rendered with this setting.
    pub fn time(&mut self, setting: &Setting) -> Result<f64, MeasureError> {
        Ok(self.rendered(setting, false)?.seconds)
    }

    /// Renders a picture that others are measured against, once.
    fn picture(&mut self, setting: &Setting) -> Result<Vec<[u16; 3]>, MeasureError> {
        let key = setting.key();
        if let Some(pixels) = self.pictures.get(&key) {
            return Ok(pixels.clone());
        }
        let pixels = self.rendered(setting, false)?.picture.pixels;
        self.pictures.insert(key, pixels.clone());
        Ok(pixels)
    }

    /// The true picture of a setting in any format, and how many of its pixels are open.
    fn true_picture(&mut self, setting: &Setting) -> Result<(Vec<[u16; 3]>, usize), MeasureError> {
        let setting = in_f64(setting);
        if self.truth == Truth::F64 {
            return Ok((self.picture(&setting)?, 0));
        }
        let key = setting.key();
        if let Some(exact) = self.exact.get(&key) {
            return Ok(exact.clone());
        }
        let settings = settings(self.size, &setting);
        let exact = exact_pixels(&self.blob(&setting)?.scene()?, &settings)?;
        self.exact.insert(key, exact.clone());
        Ok(exact)
    }

    /// Measures a setting without its time; returns its pixels, too.
    ///
    /// # Errors
    /// If the scene cannot be compiled or rendered with this setting, or its exact picture is required and not known.
    pub fn measure(
        &mut self,
        setting: &Setting,
        reference: &Reference,
    ) -> Result<(Point, Vec<[u16; 3]>), MeasureError> {
        let rendered = self.rendered(setting, true)?;
        let hits = self.first_hits(setting)?;
        let (exact, open) = self.true_picture(setting)?;
        let full = match setting.without {
            Effects::NONE => None,
            _ => {
                let with_all = with_all(setting);
                let hits = self.first_hits(&with_all)?;
                Some((self.picture(&with_all)?, hits))
            }
        };
        let blob = self.blob(setting)?;
        let blob_bytes = blob.bytes().len();
        let working = board_memory(&blob.scene()?, setting.format, setting.depth);
        let pixels = &rendered.picture.pixels;
        let found = (&pixels[..], &hits[..]);
        let [sampling, _] = rmse_and_largest(&reference.pixels, &exact);
        let [arithmetic, arithmetic_largest] = rmse_and_largest(&exact, pixels);
        let point = Point {
            name: setting.name(),
            setting: *setting,
            errors: Errors::of(self.size[0], (&reference.pixels, &reference.hits), found),
            parts: ErrorParts {
                sampling,
                arithmetic,
                arithmetic_largest,
                open,
            },
            lost: full.map(|(pixels, hits)| Errors::of(self.size[0], (&pixels, &hits), found)),
            cost: Cost {
                seconds: Vec::new(),
                pixels: pixels.len(),
                rays: rendered.rays(),
                tests: rendered.tests(),
                blob_bytes,
                working_bytes: working.workspace,
            },
        };
        self.plan.measured(setting);
        self.forget();
        Ok((point, rendered.picture.pixels))
    }

    /// Returns the first hits of the rays through the middles of pixels.
    fn first_hits(&mut self, setting: &Setting) -> Result<Vec<Option<FirstHit>>, MeasureError> {
        let key = hits_key(setting);
        if let Some(hits) = self.hits.get(&key) {
            return Ok(hits.clone());
        }
        let job = Job::whole(setting.format, self.structure, settings(self.size, setting));
        let hits = first_hits(&self.blob(setting)?.scene()?, &job)?.into_iter();
        let hits: Vec<_> = hits.map(|it| it.map(FirstHit::from)).collect();
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

#[cfg(test)]
mod tests;
