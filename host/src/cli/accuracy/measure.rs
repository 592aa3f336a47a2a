//! Measures every setting, step by step.

use super::arguments::Arguments;
use super::folder::{RESULTS, write_picture};
use crate::cli::failure::Failure;
use crate::cli::output::write_file;
use crate::cli::progress::Progress;
use crate::cli::saving::Saving;
use crate::cli::threads;
use gridel_host::accuracy::{Bench, MeasureError, Point, Results, Setting, effect_costs, given_up};
use gridel_host::measure::difference_picture;
use gridel_host::picture::srgb_of;
use std::io;
use std::path::Path;

/// The means of a run, and where it writes.
struct Run<'r, 's> {
    arguments: &'r Arguments,
    bench: &'r mut Bench<'s>,
    folder: &'r Path,
    saving: Saving,
}

/// Measures the rest, and writes it down now and then: the settings, then effects that are left out one after the other.
pub fn measure(
    arguments: &Arguments,
    bench: &mut Bench<'_>,
    folder: &Path,
    (key, kept): (String, Option<Results>),
    (settings, reference): (&[Setting], &Setting),
) -> Result<Results, Failure> {
    let mut run = Run {
        arguments,
        bench,
        folder,
        saving: Saving::start(),
    };
    let instances = run.bench.instances().map_err(|it| run.failed(it))?;
    let mut results = match kept {
        Some(results) => Results {
            instances,
            ..results
        },
        None => {
            let progress = Progress::unknown("rendering the reference");
            let reference = run.bench.reference(reference);
            drop(progress);
            Results {
                key,
                base: run.bench.base(),
                instances,
                reference: reference.map_err(|it| run.failed(it))?,
                points: Vec::new(),
                effects: Vec::new(),
            }
        }
    };
    run.write(&results)?;
    run.all(settings, &mut results)?;
    run.write(&results)?;
    results.effects = effect_costs(run.bench, &results).map_err(|it| run.failed(it))?;
    let more = given_up(&results.base, &results.effects);
    run.all(&more, &mut results)?;
    run.write(&results)?;
    Ok(results)
}

impl Run<'_, '_> {
    fn failed(&self, error: MeasureError) -> Failure {
        Failure::in_file(&self.arguments.scene, error)
    }

    fn write(&self, results: &Results) -> Result<(), Failure> {
        let text = serde_json::to_vec(results).map_err(io::Error::other);
        let file = self.folder.join(RESULTS);
        write_file(&file, |out| text.and_then(|text| out.write_all(&text)))
    }

    /// Writes them now and then.
    fn save(&mut self, results: &Results) -> Result<(), Failure> {
        match self.saving.is_due() {
            true => self.write(results),
            false => Ok(()),
        }
    }

    /// Measures all of some settings that are not measured yet.
    fn all(&mut self, settings: &[Setting], results: &mut Results) -> Result<(), Failure> {
        let repeats = usize::from(self.arguments.repeat);
        let is_missing = |it: &&Setting| results.points.iter().all(|point| point.setting != **it);
        let missing = settings.iter().filter(is_missing);
        self.bench.plan(missing.copied().collect());
        let progress = Progress::steps("measuring", (settings.len() * (repeats + 1)) as u64);
        for setting in settings {
            if results.point(setting).is_none() {
                let measured = self.bench.measure(setting, &results.reference);
                let (point, pixels) = measured.map_err(|it| self.failed(it))?;
                let difference = difference_picture(&results.reference.pixels, &pixels);
                let (name, size) = (setting.name(), self.bench.size());
                write_picture(self.folder, size, &name, &srgb_of(&pixels))?;
                write_picture(
                    self.folder,
                    size,
                    &format!("{name}-difference"),
                    &difference,
                )?;
                results.points.push(point);
                self.save(results)?;
            }
            progress.step();
        }
        // One thread, so that times do not depend on the machine's other work.
        let pool = threads::start(1)?;
        for repeat in 0..repeats {
            for setting in settings {
                let missing = |point: &&mut Point| point.cost.seconds.len() <= repeat;
                if results.point(setting).filter(missing).is_some() {
                    let seconds = pool.install(|| self.bench.time(setting));
                    let seconds = seconds.map_err(|it| self.failed(it))?;
                    if let Some(point) = results.point(setting) {
                        point.cost.seconds.push(seconds);
                    }
                    self.save(results)?;
                }
                progress.step();
            }
        }
        Ok(())
    }
}
