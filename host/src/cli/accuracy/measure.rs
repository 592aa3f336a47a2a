//! Measures every setting, step by step.

use super::arguments::Arguments;
use super::folder::{RESULTS, encoded, write_picture};
use crate::cli::failure::Failure;
use crate::cli::output::write_file;
use crate::cli::progress::Progress;
use gridel_host::accuracy::{Bench, MeasureError, Point, Results, Setting};
use gridel_host::measure::difference_picture;
use std::io;
use std::path::Path;

/// Measures what is not measured yet, and writes down every step.
pub fn measure(
    arguments: &Arguments,
    bench: &mut Bench<'_>,
    folder: &Path,
    (key, kept): (String, Option<Results>),
    settings: &[Setting],
) -> Result<Results, Failure> {
    let failed = |error: MeasureError| Failure::in_file(&arguments.scene, error);
    let file = folder.join(RESULTS);
    let repeats = usize::from(arguments.repeat);
    let progress = Progress::steps("measuring", (settings.len() * (repeats + 1)) as u64 + 1);
    let instances = bench.instances().map_err(failed)?;
    let mut results = match kept {
        Some(results) => Results {
            instances,
            ..results
        },
        None => Results {
            key,
            base: bench.base(),
            instances,
            reference: bench
                .reference(arguments.reference_samples)
                .map_err(failed)?,
            points: Vec::new(),
        },
    };
    progress.step();
    let write = |results: &Results| {
        let text = serde_json::to_vec(results).map_err(io::Error::other);
        write_file(&file, |out| text.and_then(|text| out.write_all(&text)))
    };
    write(&results)?;
    // One thread, so that times do not depend on the machine's other work.
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .map_err(|error| Failure::failed(error.to_string(), "end other programs"))?;
    for setting in settings {
        if results.point(setting).is_none() {
            let (point, pixels) = bench.measure(setting, &results.reference).map_err(failed)?;
            let difference = difference_picture(&results.reference.pixels, &pixels);
            let name = setting.name();
            write_picture(folder, bench.size, &name, &encoded(&pixels))?;
            write_picture(
                folder,
                bench.size,
                &format!("{name}-difference"),
                &difference,
            )?;
            results.points.push(point);
            write(&results)?;
        }
        progress.step();
    }
    for repeat in 0..repeats {
        for setting in settings {
            let missing = |point: &&mut Point| point.cost.seconds.len() <= repeat;
            if results.point(setting).filter(missing).is_some() {
                let seconds = pool.install(|| bench.time(setting)).map_err(failed)?;
                if let Some(point) = results.point(setting) {
                    point.cost.seconds.push(seconds);
                }
                write(&results)?;
            }
            progress.step();
        }
    }
    Ok(results)
}
