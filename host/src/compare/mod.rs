//! Acceleration structures side by side: the cost to build, to store and to query each.
//!
//! Every structure is compiled into a blob of its own, and all of them trace the same rays. These are the rays of the
//! scene's own picture, as the ray loop casts them, including those of mirrors, glass and shadows. The answers are
//! compared bit for bit before anything is measured (see `judge.rs`). Times are medians of repeats on one thread, in
//! which the structures take turns.
//!
//! Instances are kept as the scene has them: each part is compiled for the contender's structure, too.

#[cfg(not(target_family = "wasm"))]
mod charts;
mod comparison;
mod findings;
mod growth;
mod judge;
mod options;

pub use crate::measure::rays::{Work, Works};
#[cfg(not(target_family = "wasm"))]
pub use charts::charts;
pub use comparison::{Comparison, RayCounts, Rejected, Row};
pub use findings::findings;
pub use growth::{Growth, Step, growth, growth_steps};
pub use judge::Mismatch;
pub use options::{CompareError, Options};

use crate::compile::{self, Builder, CompileError, Compiled, at_rest, compile};
use crate::measure::rays::{self, Amount, Question, Questions};
use crate::measure::{InstanceCount, board_memory, primitives};
use crate::picture_rays::PictureRays;
use crate::scene;
use gridel_core::{Effects, Fixed, Format, Number, Scene, Settings, Structure};
use options::Contender;
use std::time::Duration;

/// Compares structures on a scene. Calls `progress` with a description of each step.
///
/// # Errors
/// If the scene cannot be compiled, or its picture casts too many rays.
///
/// ```
/// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
/// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// use gridel_core::Structure;
/// use gridel_host::compare::{Options, compare};
///
/// let options = Options {
///     structures: vec![Structure::List, Structure::DualSplit],
///     size: [16, 12],
///     repeats: 0,
///     ..Options::default()
/// };
/// let comparison = compare(&imported.scene, &options, &|step| eprintln!("{step}"))?;
/// assert_eq!(comparison.rays.primary, 16 * 12);
/// assert!(comparison.rows.iter().all(|row| row.wrong.is_none()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn compare(
    scene: &scene::Scene,
    options: &Options<'_>,
    progress: &dyn Fn(&str),
) -> Result<Comparison, CompareError> {
    // Few structures can follow morph targets.
    let mut scene = at_rest(scene);
    if scene.camera.is_none() {
        // A supplied camera shows the scene in a picture of this shape.
        let render = &mut scene.to_mut().render;
        [render.width, render.height] = options.size.map(u32::from);
    }
    let scene = &*scene;
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
    let picture_rays = PictureRays::<N>::of(&flagged.compiled.blob.scene()?, settings)?;
    let mut built = Vec::new();
    let mut rejected = Vec::new();
    for contender in options.contenders() {
        progress(&format!("building {}", contender.0.name()));
        match build(contender) {
            Err(CompareError::Compile(error @ CompileError::OverBudget { .. })) => {
                rejected.push(Rejected {
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
    let [stored, placed] = primitives(&list_scene);
    let instances = InstanceCount::of(&list_scene, options.copied);
    let is_opaque = list_scene.effects().without(Effects::FILTERING) == list_scene.effects();
    let questions = Questions {
        rays: &picture_rays,
        // Through glass a shadow ray searches for the first hit.
        shadow: if is_opaque {
            Question::Any
        } else {
            Question::Closest
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
    let amount = Amount {
        repeats: options.repeats,
        primitives: placed,
        tests: options.tests,
    };
    let mut works = rays::measure(&questions, &sound, &amount, progress).into_iter();
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
        primitives: stored,
        instances,
        rays: RayCounts {
            primary: picture_rays.primary.len(),
            shadow: picture_rays.shadow.len(),
            bounced: picture_rays.bounced.len(),
        },
        listed: verdict.listed,
        rows,
        rejected,
        warnings: list
            .compiled
            .report
            .warnings(options.compiling.lattice_bits),
    })
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
    // Fast runs are repeated, so that the first run's page faults do not count.
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
        wrong: Option<Mismatch>,
        work: Option<Works>,
        options: &Options<'_>,
    ) -> Row {
        let blob_bytes = self.compiled.blob.bytes().len();
        let memory = board_memory(scene, options.format, scene.view().depth);
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
            // The compiler reports that of the scene's own objects.
            sah_cost: self
                .compiled
                .report
                .sah_cost
                .filter(|_| scene.instances().is_empty()),
            setup_seconds: self.setup.as_secs_f64(),
            peak_bytes: self.peak_bytes,
            own_bytes: blob_bytes.saturating_sub(list.compiled.blob.bytes().len()),
            blob_bytes,
            longest_list: self.compiled.report.longest_list,
            stack_bytes: memory.stack,
            wrong,
            work,
        }
    }
}

#[cfg(test)]
mod tests;
