//! `gridel certify`: encloses the exact picture, and measures how far each number format is from it.

mod state;

use super::arguments::{
    self, GeometryOptions, PictureOptions, SceneOptions, TraceOptions, distinct_or, seconds,
};
use super::failure::Failure;
use super::input::stem;
use super::output::{check_folder, print, print_json_warned, results_folder, write_files};
use super::progress::Progress;
use super::saving::Saving;
use super::source::Source;
use clap::Args;
use gridel_core::{Format, Settings, Structure};
use gridel_host::certify::{
    Enclosed, FormatPicture, MOST_PIXELS, Pictures, Report, World, certify, exact_picture, map,
    page, pictures, sentence,
};
use gridel_host::picture::write_png;
use gridel_host::render::too_many_pixels;
use gridel_host::table::{Align, Table, grouped};
use serde::Serialize;
use state::State;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// Prove how far each number format is from the exact picture
///
/// A blob defines one exact picture: its geometry, camera, samples, lights and effects, evaluated in
/// real arithmetic. For each pixel this computes an interval that contains the exact value. A pixel
/// is proved if its interval gives one 8-bit value. Pixels that stay open are computed again with
/// 128 and 256 bits. The result is the sampled picture, with the scene's samples per pixel, and not
/// the integral behind it.
///
/// For each number format every pixel is proved equal, proved different, or open with a reason.
///
/// A scene that moves is shown as its file states it, or at one time with `--time`.
///
/// Writes certify.html (the page), certify.json, map.png and exact.png to the folder, and
/// certify.state, from which an interrupted run of the same picture continues. A folder with the state of
/// another picture is rejected.
#[derive(Args)]
#[command(after_help = super::failure::EXIT_CODES)]
pub struct Arguments {
    /// Blob or scene file, or `-` for standard input
    #[arg(value_name = "BLOB|SCENE")]
    input: PathBuf,

    /// Number format to compare; give it again for each further one [default: all]
    #[arg(long, value_name = "NAME", value_parser = arguments::format())]
    format: Vec<Format>,

    /// Folder for the page, the report and the pictures [default: certify-SCENE, certify-stdin for
    /// standard input]
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,

    /// Certify a scene that moves at this time, in seconds [default: as its file states it, without
    /// tracks]
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_hyphen_values = true)]
    time: Option<f64>,

    /// Print the report as JSON
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    picture: PictureOptions,

    #[command(flatten)]
    geometry: GeometryOptions,
}

/// The names of the files.
const PAGE: &str = "certify.html";
const JSON: &str = "certify.json";
const MAP: &str = "map.png";
const EXACT: &str = "exact.png";

/// The JSON output.
#[derive(Serialize)]
struct Printed<'r> {
    folder: String,
    #[serde(flatten)]
    report: Commanded<'r>,
}

/// The report in JSON.
#[derive(Clone, Copy, Serialize)]
struct Commanded<'r> {
    /// The command that explains a pixel, up to the pixel: `X,Y --interval`, or `X,Y --format NAME`.
    explain: &'r str,
    #[serde(flatten)]
    report: &'r Report,
}

/// Certifies a picture.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let input = &arguments.input;
    arguments.output.as_deref().map_or(Ok(()), check_folder)?;
    let options = SceneOptions::from(arguments.geometry.clone())
        .sized(arguments.picture.size)
        .at(arguments.time);
    let with = TraceOptions {
        format: Format::F64,
        accel: None,
        quality: None,
    };
    let source = Source::to_trace(input, &options, &with, Structure::DualSplit)?;
    let scene = source.scene()?;
    let structure = source.structure(&scene, None)?;
    let settings = arguments.picture.settings(&scene);
    let count = usize::from(settings.width) * usize::from(settings.height);
    if let Some(clause) = too_many_pixels([settings.width, settings.height], MOST_PIXELS) {
        return Err(Failure::usage(clause, "ask for a smaller `--size`"));
    }
    let world = World::of(&scene).map_err(|unknown| {
        Failure::rejected(
            format!("{}: {unknown}", input.display()),
            "compile the scene without it, or use `gridel accuracy`, which measures without proof",
        )
    })?;
    let stem = stem(input);
    let folder = results_folder(arguments.output.as_deref(), "certify", &stem);
    let results = [PAGE, JSON, MAP, EXACT].map(|name| folder.join(name));
    let state = State::new(&folder, scene.header().checksum, source.time(), &settings);
    source.reject_lost(results.iter().chain([&state.path]))?;
    state.reject_foreign(&results)?;
    let mut pixels = state.read(count)?;
    fs::create_dir_all(&folder).map_err(|error| Failure::writing(&folder, &error))?;

    // Formats first: they reject settings that no picture has, in a moment.
    let formats = distinct_or(&arguments.format, &Format::ALL);
    let pictures = pictures(&scene, structure, settings, &formats).map_err(Failure::rendering)?;

    let progress = Progress::steps("certifying", settings.height.into());
    let mut saving = Saving::start();
    // Pixels are kept one by one; a picture of any cost loses a few seconds.
    certify(
        &world,
        &settings,
        &mut pixels,
        &|| progress.step(),
        |pixels| {
            if saving.is_due() {
                state.write(pixels)?;
            }
            Ok(())
        },
    )?;
    drop(progress);
    state.write(&pixels)?;

    let report = Report::of(&world, &settings, &pixels, &pictures);
    let command = explain_command(arguments, &settings);
    write_results(&results, &stem, (&report, &pixels, &pictures), &command)?;
    if arguments.json {
        let folder = folder.display().to_string();
        let report = Commanded {
            explain: &command,
            report: &report,
        };
        print_json_warned(&Printed { folder, report }, &source.warnings)
    } else {
        print(text(&folder, &report, &command))
    }
}

type Results<'r> = (&'r Report, &'r [Enclosed], &'r [FormatPicture]);

fn write_results(
    [page_path, json_path, map_path, exact_path]: &[PathBuf; 4],
    name: &str,
    (report, pixels, pictures): Results<'_>,
    command: &str,
) -> Result<(), Failure> {
    let size = report.size.map(u32::from);
    let (map, exact) = (map(pixels, pictures), exact_picture(pixels));
    let shown = Pictures {
        map: &map,
        exact: &exact,
    };
    let page = page(name, report, &shown, command).map_err(Failure::fault)?;
    let commanded = Commanded {
        explain: command,
        report,
    };
    write_files(&[
        (page_path, &|out| out.write_all(page.as_bytes())),
        (json_path, &|out| {
            // Written as it is made: the report of a large picture is long.
            serde_json::to_writer_pretty(&mut *out, &commanded)?;
            writeln!(out)
        }),
        (map_path, &|out| write_png(out, size, &map, None)),
        (exact_path, &|out| write_png(out, size, &exact, None)),
    ])
}

/// The command that explains a pixel, up to its place.
fn explain_command(arguments: &Arguments, settings: &Settings) -> String {
    let Settings {
        width,
        height,
        samples,
        depth,
        ..
    } = settings;
    let time = arguments.time.map(|seconds| format!(" --time={seconds}"));
    let time = time.unwrap_or_default();
    format!(
        "{}{time} --size {width}x{height} --samples {samples} --depth {depth} --pixel ",
        arguments.geometry.explain_command(&arguments.input),
    )
}

fn text(folder: &Path, report: &Report, command: &str) -> String {
    let mut text = sentence(report) + "\n\n";
    let mut table = Table::new([
        ("format", Align::Left),
        ("proved equal", Align::Right),
        ("proved different", Align::Right),
        ("open", Align::Right),
        ("largest proved error", Align::Right),
    ]);
    for format in &report.formats {
        table.row([
            format.format.to_owned(),
            grouped(format.equal),
            grouped(format.different),
            grouped(format.open),
            format!("{}/255", format.max_proved_error),
        ]);
    }
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{table}");
    if !report.reasons.is_empty() {
        let mut table = Table::new([
            ("open because of", Align::Left),
            ("pixels", Align::Right),
            ("on the boundary", Align::Right),
        ]);
        for reason in &report.reasons {
            table.row([
                reason.text.to_owned(),
                grouped(reason.pixels),
                grouped(reason.on_boundary),
            ]);
        }
        let _ = writeln!(text, "{table}");
        for reason in &report.reasons {
            if let Some(first) = reason.open_pixels.first() {
                let [x, y] = first.pixel;
                let _ = writeln!(text, "  {command}{x},{y} --interval");
            }
        }
        text.push('\n');
    }
    let page = folder.join(PAGE);
    let _ = write!(
        text,
        "It is the sampled picture that is certified. The page: {}",
        page.display()
    );
    text + "\n"
}
