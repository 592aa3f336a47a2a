//! Acceleration structures side by side: what each takes to make, to hold and to ask.
//!
//! Every contender is compiled into a blob of its own, and all of them trace the same rays: those of
//! the scene's own picture, as the ray loop casts them, with all that mirrors, glass and shadows
//! cause. Their answers are compared to the last bit before anything is measured (see `judge.rs`).
//! Times are medians of repeats in which the contenders take turns, on one thread.

mod charts;
mod findings;
mod growth;
mod judge;
mod measure;
mod picture;

pub use charts::charts;
pub use findings::findings;
pub use growth::{Growth, Step, growth, growth_steps};
pub use judge::Wrong;
pub use measure::Work;
pub use picture::{MOST_RAYS, PictureRays};

use crate::compile::{self, Builder, CompileError, Compiled, compile, takes_hierarchy};
use crate::report::working_memory;
use crate::scene;
use gridel_core::render::RenderError;
use gridel_core::{BlobError, Effects, Fixed, Format, Number, Scene, Settings, Structure};
use measure::{Question, Questions};
use peak_alloc::PeakAlloc;
use serde::Serialize;
use std::time::Duration;

/// What to compare, and how.
#[derive(Clone, Debug)]
pub struct Options<'o> {
    pub structures: Vec<Structure>,
    /// How hierarchies are built; a structure that takes one is a contender with each.
    pub builders: Vec<Builder>,
    /// How everything else is compiled.
    pub compiling: compile::Options,
    pub format: Format,
    /// Width and height of the picture whose rays are traced; one sample a pixel.
    pub size: [u16; 2],
    /// How often everything is timed; 0 for counts alone.
    pub repeats: usize,
    /// Tests of primitives that a row may spend on one pass over the rays. A row that would take
    /// more traces every second ray, or every third, and so on; the list decides about so many.
    pub tests: u64,
    /// The program's allocator, to measure the memory of builders with.
    pub memory: Option<&'o PeakAlloc>,
}

impl Default for Options<'_> {
    fn default() -> Self {
        Self {
            structures: Structure::ALL.to_vec(),
            builders: vec![Builder::default()],
            compiling: compile::Options::default(),
            format: Format::F32,
            size: [256, 256],
            repeats: 5,
            tests: 400_000_000,
            memory: None,
        }
    }
}

impl Options<'_> {
    /// How often [`compare`] tells what happens next, if all contenders can be built and are right.
    pub fn steps(&self) -> u64 {
        let contenders = contenders(self).len();
        (2 + contenders * (2 + self.repeats)) as u64
    }
}

/// Why nothing can be compared.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum CompareError {
    #[error(transparent)]
    #[diagnostic(transparent)]
    Compile(#[from] CompileError),
    #[error("the picture of {pixels} pixels casts more than {most} rays")]
    #[diagnostic(help("ask for a smaller one with `--size`"))]
    TooManyRays { pixels: usize, most: usize },
    #[error("{0}")]
    #[diagnostic(help("ask for another `--size`"))]
    Picture(#[from] RenderError),
    #[error("the compiler's own blob is refused: {0}")]
    #[diagnostic(help("this is a fault of gridel: report it with the scene file"))]
    Blob(#[from] BlobError),
}

/// How the contenders compare on one scene.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    pub format: &'static str,
    /// Width and height of the picture.
    pub size: [u16; 2],
    /// How often everything was timed.
    pub repeats: usize,
    pub primitives: usize,
    pub rays: RayCounts,
    /// Rays about which the plain list was asked; on the others the contenders were compared with
    /// each other, and the list was asked where they differed.
    pub listed: usize,
    pub rows: Vec<Row>,
    /// Structures whose tables do not fit their budget.
    pub refused: Vec<Refused>,
}

/// A structure that was not built.
#[derive(Clone, Debug, Serialize)]
pub struct Refused {
    pub structure: &'static str,
    /// With the bytes that it would take.
    pub why: String,
}

/// The rays of the picture.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct RayCounts {
    pub primary: usize,
    pub shadow: usize,
    pub bounced: usize,
}

/// One contender.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The structure, and the builder where there are several.
    pub name: String,
    pub structure: &'static str,
    /// `None` where there is no hierarchy.
    pub builder: Option<&'static str>,
    /// Of the hierarchy's boxes, by the surface area heuristic.
    pub sah_cost: Option<f64>,
    /// Of building the structure, from primitives on the lattice to records.
    pub setup_seconds: f64,
    /// The most memory at any time while the scene was compiled, beyond the scene itself.
    pub peak_bytes: Option<usize>,
    /// By how much the blob is larger than one of the list alone.
    pub own_bytes: usize,
    pub blob_bytes: usize,
    /// Primitives of the longest list that a ray can be led to.
    pub longest_list: usize,
    /// The traversal stack on a 32-bit board.
    pub stack_bytes: usize,
    /// What the answers are worth: `None` where all are the list's.
    pub wrong: Option<Wrong>,
    /// `None` where the answers are wrong.
    pub work: Option<Works>,
}

/// What tracing took, by what the rays were cast for.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Works {
    pub primary: Work,
    /// To lights; `None` where there are none.
    pub shadow: Option<Work>,
    /// Mirrored and refracted; `None` where there are none.
    pub bounced: Option<Work>,
    pub all: Work,
}

/// Compares structures on a scene. `progress` is told what happens next.
///
/// # Errors
/// If the scene cannot be compiled, or its picture casts too many rays.
pub fn compare(
    scene: &scene::Scene,
    options: &Options<'_>,
    progress: &dyn Fn(&str),
) -> Result<Comparison, CompareError> {
    match options.format {
        Format::Fixed => compare_in::<Fixed>(scene, options, progress),
        Format::F32 => compare_in::<f32>(scene, options, progress),
        Format::F64 => compare_in::<f64>(scene, options, progress),
    }
}

fn compare_in<N: Number>(
    scene: &scene::Scene,
    options: &Options<'_>,
    progress: &dyn Fn(&str),
) -> Result<Comparison, CompareError> {
    let build = |contender| build(scene, options, contender);
    let list = build((Structure::List, None))?;
    let flagged = build((Structure::Flagged, None))?;
    let [width, height] = options.size;
    let settings = Settings {
        width,
        height,
        samples: 1,
        ..Settings::of(&flagged.compiled.blob.scene()?)
    };
    progress("casting the picture's rays");
    let rays = PictureRays::<N>::of(&flagged.compiled.blob.scene()?, settings)?;
    let mut built = Vec::new();
    let mut refused = Vec::new();
    for contender in contenders(options) {
        progress(&format!("building {}", contender.0.name()));
        match build(contender) {
            Err(CompareError::Compile(error @ CompileError::OverBudget { .. })) => {
                refused.push(Refused {
                    structure: contender.0.name(),
                    why: error.to_string(),
                });
            }
            other => built.push(other?),
        }
    }
    let structures: Vec<_> = built.iter().map(|built| built.structure).collect();
    let scenes = built
        .iter()
        .map(|built| built.compiled.blob.scene())
        .collect::<Result<Vec<_>, _>>()?;
    let list_scene = list.compiled.blob.scene()?;
    let primitives = gridel_core::Kind::ALL
        .iter()
        .map(|&kind| list_scene.count(kind))
        .sum();
    let glass = list_scene.effects().contains(Effects::GLASS);
    let questions = Questions {
        rays: &rays,
        // Through glass a shadow ray asks for what it meets first.
        shadow: if glass {
            Question::Closest
        } else {
            Question::Any
        },
    };

    let contenders: Vec<_> = scenes.iter().zip(&structures).collect();
    progress("comparing answers");
    let verdict = judge::judge(&questions, &list_scene, &contenders, options.tests);
    let sound: Vec<_> = contenders
        .iter()
        .zip(&verdict.wrong)
        .filter_map(|(&contender, wrong)| wrong.is_none().then_some(contender))
        .collect();
    let mut works = measure::measure(&questions, &sound, options, primitives, progress).into_iter();
    let rows = built
        .iter()
        .zip(&scenes)
        .zip(verdict.wrong)
        .map(|((built, scene), wrong)| {
            let works = if wrong.is_none() { works.next() } else { None };
            built.row(scene, &list, wrong, works, options)
        })
        .collect();
    Ok(Comparison {
        format: options.format.name(),
        size: options.size,
        repeats: options.repeats,
        primitives,
        rays: RayCounts {
            primary: rays.primary.len(),
            shadow: rays.shadow.len(),
            bounced: rays.bounced.len(),
        },
        listed: verdict.listed,
        rows,
        refused,
    })
}

/// A structure and the builder of its hierarchy, if it takes one.
type Contender = (Structure, Option<Builder>);

fn contenders(options: &Options<'_>) -> Vec<Contender> {
    let with_builders = |&structure| {
        let builders: Vec<Option<Builder>> = if takes_hierarchy(structure) {
            options.builders.iter().copied().map(Some).collect()
        } else {
            vec![None]
        };
        builders
            .into_iter()
            .map(move |builder| (structure, builder))
    };
    options.structures.iter().flat_map(with_builders).collect()
}

/// A structure in a blob of its own.
struct Built {
    structure: Structure,
    builder: Option<Builder>,
    compiled: Compiled,
    setup: Duration,
    peak_bytes: Option<usize>,
}

fn build(
    scene: &scene::Scene,
    options: &Options<'_>,
    (structure, builder): Contender,
) -> Result<Built, CompareError> {
    let compiling = compile::Options {
        structures: vec![structure],
        builder: builder.unwrap_or_default(),
        ..options.compiling.clone()
    };
    let before = options.memory.map(|memory| {
        memory.reset_peak_usage();
        memory.current_usage()
    });
    let compiled = compile(scene, &compiling)?;
    let peak_bytes = before.zip(options.memory).map(|(before, memory)| {
        // Other threads may have freed what was counted.
        memory.peak_usage().saturating_sub(before)
    });
    let mut setup = compiled.report.setup;
    // What takes no time is repeated, so that the first run's page faults do not count.
    let repeats = if options.repeats == 0 { 0 } else { 4 };
    for _ in 0..repeats {
        if setup > Duration::from_millis(100) {
            break;
        }
        setup = setup.min(compile(scene, &compiling)?.report.setup);
    }
    Ok(Built {
        structure,
        builder,
        compiled,
        setup,
        peak_bytes,
    })
}

impl Built {
    fn row(
        &self,
        scene: &Scene<'_>,
        list: &Self,
        wrong: Option<Wrong>,
        work: Option<Works>,
        options: &Options<'_>,
    ) -> Row {
        let blob_bytes = self.compiled.blob.bytes().len();
        let stack = working_memory(scene)
            .into_iter()
            .find(|memory| memory.format == options.format.name() && memory.word_bits == 32);
        let builder = self.builder.map(Builder::name);
        Row {
            name: match builder {
                Some(builder) if options.builders.len() > 1 => {
                    format!("{} {builder}", self.structure.name())
                }
                _ => self.structure.name().to_owned(),
            },
            structure: self.structure.name(),
            builder,
            sah_cost: self.compiled.report.sah_cost,
            setup_seconds: self.setup.as_secs_f64(),
            peak_bytes: self.peak_bytes,
            own_bytes: blob_bytes.saturating_sub(list.compiled.blob.bytes().len()),
            blob_bytes,
            longest_list: self.compiled.report.longest_list,
            stack_bytes: stack.map_or(0, |memory| memory.stack),
            wrong,
            work,
        }
    }
}
