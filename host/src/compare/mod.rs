//! Acceleration structures side by side: the cost to build, to store and to query each.
//!
//! Every structure is compiled into a blob of its own, and all of them trace the same rays. These are the rays of the
//! scene's own picture, as the ray loop casts them, including those of mirrors, glass and shadows. The answers are
//! compared bit for bit before anything is measured (see `judge.rs`). Times, those of building among them, are medians of
//! repeats on one thread, in which the structures take turns (see `built.rs` for building).
//!
//! Instances are kept as the scene has them: each part is compiled for the contender's structure, too.

mod built;
#[cfg(not(target_family = "wasm"))]
mod charts;
mod comparison;
mod findings;
mod growth;
mod judge;
mod options;

pub use crate::measure::rays::{Work, Works};
#[cfg(not(target_family = "wasm"))]
pub use charts::{CHARTS, charts, is_chart};
pub use comparison::{Comparison, RayCounts, Rejected, Row};
pub use findings::findings;
pub use growth::{Growth, Step, growth, growth_steps};
pub use judge::Mismatch;
pub use options::{CompareError, Options};

use crate::compile::{CompileError, at_rest};
use crate::measure::rays::{self, Amount, Question, Questions};
use crate::measure::{InstanceCount, primitives};
use crate::picture_rays::PictureRays;
use crate::scene;
use built::{build, one_thread, repeat};
use gridel_core::{Effects, Fixed, Format, Number, Settings, Structure};

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
    let (mut built, mut rejected) = (Vec::new(), Vec::new());
    let pool = one_thread()?;
    for contender in options.contenders() {
        progress(&format!("building {}", contender.0.name()));
        match pool.install(|| build(contender)) {
            Err(CompareError::Compile(
                error @ (CompileError::OverBudget { .. } | CompileError::OverMemory { .. }),
            )) => {
                rejected.push(Rejected {
                    structure: contender.0.name(),
                    why: error.to_string(),
                });
            }
            other => built.push(other?),
        }
    }
    pool.install(|| repeat(scene, options, &mut built))?;
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

#[cfg(test)]
mod tests;
