//! Contenders as they are built: blobs, with time and memory.
//!
//! Times are taken on one thread, and the structures take turns.

use super::comparison::Row;
use super::judge::Mismatch;
use super::options::{CompareError, Contender, Options};
use crate::compile::{self, Builder, Compiled, compile};
use crate::measure::rays::Works;
use crate::measure::{board_memory, median};
use crate::scene;
use gridel_core::{Scene, Structure};
use rayon::{ThreadPool, ThreadPoolBuilder};

/// Seconds after which a structure is not built again. Noise hardly changes such times, and some structures take many
/// seconds.
const SECONDS: f64 = 1.0;

/// A structure in a blob of its own.
pub(super) struct Built {
    pub structure: Structure,
    builder: Option<Builder>,
    pub compiled: Compiled,
    /// Seconds of each set-up.
    setups: Vec<f64>,
    peak_bytes: Option<usize>,
}

/// The options with which a contender is compiled.
fn compiling(options: &Options<'_>, (structure, builder): Contender) -> compile::Options {
    compile::Options {
        structures: vec![structure],
        builder: builder.unwrap_or_default(),
        ..options.compiling.clone()
    }
}

/// Compiles a contender, and measures time and memory.
pub(super) fn build(
    scene: &scene::Scene,
    options: &Options<'_>,
    contender: Contender,
) -> Result<Built, CompareError> {
    let before = options.memory.map(|memory| {
        memory.reset_peak_usage();
        memory.current_usage()
    });
    let compiled = compile(scene, &compiling(options, contender))?;
    let peak_bytes = before.zip(options.memory).map(|(before, memory)| {
        // Other threads may have freed what was counted.
        memory.peak_usage().saturating_sub(before)
    });
    let (structure, builder) = contender;
    Ok(Built {
        structure,
        builder,
        setups: vec![compiled.report.setup.as_secs_f64()],
        compiled,
        peak_bytes,
    })
}

impl Built {
    /// The row of a contender, with its work or what is wrong with it.
    pub fn row(
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
            setup_seconds: median(&self.setups).unwrap_or(0.0),
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

/// Returns one thread, so that times do not depend on the number of processors.
pub(super) fn one_thread() -> Result<ThreadPool, CompareError> {
    let pool = ThreadPoolBuilder::new().num_threads(1).build();
    pool.map_err(|error| CompareError::Thread(error.to_string()))
}

/// Builds the structures again, in turns: as often as times are repeated, or until one has taken a second.
pub(super) fn repeat(
    scene: &scene::Scene,
    options: &Options<'_>,
    built: &mut [Built],
) -> Result<(), CompareError> {
    for _ in 1..options.repeats {
        for it in &mut *built {
            if is_due(&it.setups) {
                let contender = (it.structure, it.builder);
                let compiled = compile(scene, &compiling(options, contender))?;
                it.setups.push(compiled.report.setup.as_secs_f64());
            }
        }
    }
    Ok(())
}

/// Returns whether a structure is built in another round.
fn is_due(setups: &[f64]) -> bool {
    setups.iter().sum::<f64>() < SECONDS
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn structures_are_built_again_until_they_have_taken_a_second() {
        assert!(is_due(&[0.3; 3]) && !is_due(&[0.3; 4]) && !is_due(&[60.0]));
    }

    /// Times are those of one thread, as often as they are repeated, and their median counts.
    #[test]
    fn set_ups_are_repeated_on_one_thread() {
        let scene = crate::sample::diamond(8.0);
        let options = Options {
            repeats: 5,
            ..Options::default()
        };
        let pool = one_thread().expect("a thread");
        assert_eq!(pool.current_num_threads(), 1);
        let contenders = [(Structure::Bvh, None), (Structure::List, None)];
        let built = contenders.map(|it| build(&scene, &options, it).expect("a blob"));
        let mut built: Vec<Built> = built.into();
        repeat(&scene, &options, &mut built).expect("blobs");
        for it in &mut built {
            assert_eq!(it.setups.len(), 5);
            it.setups = vec![5.0, 1.0, 2.0, 4.0, 9.0];
        }
        let scene = built[0].compiled.blob.scene().expect("a scene");
        let row = built[0].row(&scene, &built[1], None, None, &options);
        assert_eq!(row.setup_seconds, 4.0);
    }
}
