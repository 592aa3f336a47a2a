//! `gridel accuracy`: what accuracy costs in time.

mod arguments;
mod choice;
mod folder;
mod measure;
mod report;

pub use arguments::Arguments;

use super::arguments::{GeometryOptions, SceneOptions, check_quality};
use super::failure::Failure;
use super::input::stem;
use super::output::{
    check_folder, check_writable, print, print_json_warned, results_folder, write_texts,
};
use super::source::{import, warn_of_file};
use choice::{Choice, choice};
use folder::{CSV, PAGE, PICTURES, PLOT, kept, pictures};
use gridel_core::format::checksum;
use gridel_host::accuracy::{
    Bench, EffectCost, MOST_MEASURED_SAMPLES, MeasureError, Point, Setting, Truth, answers,
    frontier, least_reference_samples, page, plot, reference_setting, sentences, sweep,
};
use gridel_host::measure::InstanceCount;
use gridel_host::render::too_many_pixels;
use gridel_host::scene::{Imported, RenderSettings};
use gridel_host::table::{counted, grouped, significant};
use measure::measure;
use report::{csv, text};
use serde::Serialize;

/// Samples per pixel of a reference, where no more are needed.
const REFERENCE_SAMPLES: u16 = 256;

/// Most pixels that are measured, each of which takes up to 1 KB of memory.
const MOST_PIXELS: usize = 1 << 20;

/// The JSON output.
#[derive(Serialize)]
struct Printed<'t> {
    folder: String,
    size: [u16; 2],
    #[serde(skip_serializing_if = "Option::is_none")]
    instances: Option<InstanceCount>,
    reference: &'static str,
    reference_samples: u16,
    reference_cutoff: f64,
    /// Pixels of an exact reference that are open.
    reference_open: usize,
    points: &'t [Point],
    /// For each point, true if none beats it in cost and RMSE.
    frontier: Vec<bool>,
    /// Sentences about the setting for a given error, the effect of the number format, and what to leave out first.
    answers: Vec<String>,
    /// The cost of each effect, in the order in which to leave them out.
    effects: &'t [EffectCost],
    sentences: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    chosen: Option<&'t Choice>,
}

/// Returns a number of this build of the program, whose times are not those of another; 0 if its file cannot be read.
fn build() -> u32 {
    let program = std::env::current_exe().and_then(std::fs::read);
    program.map_or(0, |bytes| checksum(&bytes))
}

/// Sweeps, measures and reports.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let path = &arguments.scene;
    check_quality(arguments.quality, &[arguments.accel])?;
    arguments.output.as_deref().map_or(Ok(()), check_folder)?;
    let (imported, mut warnings) = read(arguments)?;
    let stem = stem(path);
    let folder = results_folder(arguments.output.as_deref(), "accuracy", &stem);
    let size = measured_size(arguments, &imported.scene.render)?;
    let failed = |error: MeasureError| Failure::in_file(path, error);
    let mut bench = Bench::new(&imported.scene, arguments.accel, size)
        .with_quality(arguments.quality.unwrap_or_default())
        .with_copied(imported.copied)
        .with_truth(arguments.reference);
    let settings = sweep(bench.base(), bench.effects().map_err(failed)?);
    let reference = reference_setting(reference_samples(arguments, &settings)?, &settings);
    warn_of_file(path, bench.warnings().map_err(failed)?, &mut warnings);
    let key = format!(
        "gridel {} build {:08x} scene {:08x} size {size:?} structure {} reference {}{} cutoff {}",
        env!("CARGO_PKG_VERSION"),
        build(),
        bench.checksum().map_err(failed)?,
        arguments.accel.name(),
        match arguments.reference {
            Truth::F64 => "",
            Truth::Exact => "exact ",
        },
        reference.samples,
        reference.cutoff
    );
    let kept = kept(&folder, &key)?;
    std::fs::create_dir_all(folder.join(PICTURES))
        .map_err(|error| Failure::writing(&folder, &error))?;
    for name in [PAGE, CSV, PLOT] {
        check_writable(&folder.join(name))?;
    }
    let results = measure(
        arguments,
        &mut bench,
        &folder,
        (key, kept),
        (&settings, &reference),
    )?;
    let pictures = pictures(&folder, size, &results)?;
    let page = page(&stem, size, &results, &pictures).map_err(Failure::fault)?;
    let plot = plot(&results).map_err(Failure::fault)?;
    let csv = csv(&results.points);
    write_texts(&folder, &[(PAGE, page), (CSV, csv), (PLOT, plot)])?;

    let choice = choice(arguments, &stem, &results);
    if arguments.json {
        let printed = Printed {
            folder: folder.display().to_string(),
            size,
            instances: results.instances,
            reference: results.reference.truth.name(),
            reference_samples: results.reference.samples,
            reference_cutoff: results.reference.cutoff,
            reference_open: results.reference.open,
            points: &results.points,
            frontier: frontier(&results.points),
            answers: answers(&results),
            effects: &results.effects,
            sentences: sentences(&results),
            chosen: choice.as_ref(),
        };
        print_json_warned(&printed, &warnings)?;
    } else {
        print(text(&folder, size, &results, choice.as_ref()))?;
    }
    let limited = arguments.max_error.is_some() || arguments.max_rays.is_some();
    match limited && choice.is_none() {
        true => Err(nothing_within(arguments, &results.points)),
        false => Ok(()),
    }
}

/// Reads the scene, with at most as many samples as are measured. Returns its warnings, too.
fn read(arguments: &Arguments) -> Result<(Imported, Vec<String>), Failure> {
    let path = &arguments.scene;
    let options = SceneOptions {
        cutoff: arguments.cutoff,
        geometry: GeometryOptions {
            lattice_bits: None,
            room: None,
            texture_bytes: None,
            import: arguments.import.clone(),
        },
        ..SceneOptions::default()
    };
    let mut imported = import(path, &options)?;
    let mut warnings = std::mem::take(&mut imported.warnings);
    let samples = &mut imported.scene.render.samples;
    if *samples > MOST_MEASURED_SAMPLES {
        let note = format!(
            "its {} samples per pixel are measured as {MOST_MEASURED_SAMPLES}, because the reference has twice as many",
            grouped(usize::from(*samples))
        );
        warn_of_file(path, vec![note], &mut warnings);
        *samples = MOST_MEASURED_SAMPLES;
    }
    Ok((imported, warnings))
}

/// The width and height of the pictures that are measured.
fn measured_size(arguments: &Arguments, stated: &RenderSettings) -> Result<[u16; 2], Failure> {
    let size = arguments
        .size
        .unwrap_or_else(|| smaller([stated.width, stated.height]));
    match too_many_pixels(size, MOST_PIXELS) {
        Some(clause) => Err(Failure::usage(
            format!("{clause}, which takes about 1 GB of memory"),
            "ask for a smaller `--size`: errors, and times per ray, hardly depend on it",
        )),
        None => Ok(size),
    }
}

/// The samples per pixel of the reference.
fn reference_samples(arguments: &Arguments, settings: &[Setting]) -> Result<u16, Failure> {
    let least = least_reference_samples(settings);
    let samples = arguments
        .reference_samples
        .unwrap_or(least.max(REFERENCE_SAMPLES));
    if samples >= least {
        return Ok(samples);
    }
    Err(Failure::usage(
        format!(
            "a reference of {} per pixel is no better than the measured settings",
            counted(samples.into(), "sample")
        ),
        format!("ask for at least {least} with `--reference-samples`, or leave it out"),
    ))
}

/// No setting keeps within the bound.
fn nothing_within(arguments: &Arguments, points: &[Point]) -> Failure {
    let on = arguments.board.as_deref();
    let measured = points
        .iter()
        .filter(|point| on.is_none_or(|board| point.instructions(board).is_some()));
    let measured: Vec<&Point> = measured.collect();
    let least = |figure: fn(&Point) -> f64| {
        let figures = measured.iter().map(|point| figure(point));
        significant(figures.fold(f64::INFINITY, f64::min))
    };
    let (cause, remedy) = match (arguments.max_error, arguments.max_rays) {
        (Some(most), None) => (
            format!(
                "no setting keeps within an RMSE of {most}; the least is {}",
                least(|it| it.errors.rmse)
            ),
            "allow a larger error, or give the scene file more samples and depth",
        ),
        (None, rays) => (
            format!(
                "no setting casts at most {} rays per pixel; the fewest are {}",
                rays.unwrap_or_default(),
                least(Point::rays_per_pixel)
            ),
            "allow more rays",
        ),
        (Some(most), Some(rays)) => (
            format!("no setting keeps within an RMSE of {most} with at most {rays} rays per pixel"),
            "allow a larger error or more rays",
        ),
    };
    Failure::failed(cause, remedy)
}

/// A picture's size, made smaller.
fn smaller(sides: [u32; 2]) -> [u16; 2] {
    const MOST: u32 = 128;
    let longest = sides[0].max(sides[1]).max(1);
    sides.map(|side| {
        let side = if longest > MOST {
            (side * MOST).div_ceil(longest)
        } else {
            side
        };
        side.clamp(1, MOST) as u16
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_made_smaller_and_never_larger() {
        assert_eq!(smaller([400, 300]), [128, 96]);
        assert_eq!(smaller([64, 20]), [64, 20]);
        assert_eq!(smaller([60_000, 1]), [128, 1]);
    }
}
