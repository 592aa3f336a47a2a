//! The bytes of a scene's blob, and what makes them fewer.

use super::{Source, compile_shown};
use crate::cli::failure::Failure;
use gridel_core::Scene;
use gridel_host::compile::{CompileError, MOST_COPIED, Options};
use gridel_host::measure::InstanceCount;
use gridel_host::measure::board::{Fit, MemoryReport};
use gridel_host::scene::{self, ImportOptions, Instances};

impl Source {
    /// Rejects a scene that does not fit a board's memory, with what would help.
    pub fn check_fits(&self, scene: &Scene<'_>, report: &MemoryReport) -> Result<(), Failure> {
        match report.fit() {
            Fit::Fits => Ok(()),
            Fit::Short(why) => {
                let advice = report.advice(scene, || self.smaller());
                Err(Failure::rejected(why, advice))
            }
            Fit::Undecided(why) => {
                let advice = report.advice(scene, || self.smaller());
                let otherwise = match advice.is_empty() {
                    true => "name another board with `--target`",
                    false => &advice,
                };
                Err(Failure::rejected(
                    why,
                    format!("build the program and measure it; if it does not fit, {otherwise}"),
                ))
            }
        }
    }

    /// Returns the bytes of the blob if instances were copied in place of kept, or the other way round; `None` for a
    /// blob, and for more copies than are worth the time.
    pub fn bytes_otherwise(&self, instances: &InstanceCount) -> Option<usize> {
        let (importing, compiling) = self.made_by.as_ref()?;
        if instances.placed_primitives as u64 > MOST_COPIED {
            return None;
        }
        let importing = ImportOptions {
            instances: match instances.choice {
                Instances::Keep => Instances::Flatten,
                Instances::Flatten => Instances::Keep,
            },
            ..importing.clone()
        };
        let unlimited = Options {
            max_bytes: None,
            ..compiling.clone()
        };
        let other = compile_shown(&self.read_again(&importing)?, &unlimited).ok()?;
        Some(other.report.bytes)
    }

    /// Returns advice that makes the blob of a scene file smaller, from a build that allows no byte.
    fn smaller(&self) -> Option<String> {
        let (importing, compiling) = self.made_by.as_ref()?;
        let nothing = Options {
            max_bytes: Some(0),
            ..compiling.clone()
        };
        match compile_shown(&self.read_again(importing)?, &nothing) {
            Err(CompileError::TooLarge { advice, .. }) => Some(advice),
            _ => None,
        }
    }

    /// The scene of the file, without the effects that were left out.
    fn read_again(&self, importing: &ImportOptions) -> Option<scene::Scene> {
        let mut scene = self.input.scene(importing).ok()?.scene;
        scene.remove_effects(self.without);
        Some(scene)
    }
}
