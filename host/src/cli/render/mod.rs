//! `gridel render`: a picture of a scene, or those of one that moves.

mod frames;
mod outputs;
mod picture;
mod report;
mod shutter;

use super::arguments::TargetPoint;
use super::arguments::{self, PictureOptions, SceneOptions, TraceOptions};
use super::failure::Failure;
use super::source::Source;
use super::threads;
use clap::Args;
use frames::{Output, Shot, TimeOptions};
use gridel_core::{Scene, Settings, Structure};
use gridel_host::render::{Job, MOST_PIXELS};
use gridel_host::table::grouped;
use outputs::{OutputOptions, Outputs};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Render a picture from a blob or a scene file, or an animation
///
/// Options that are not given come from the scene file. The picture is the same, bit for bit, with
/// any number of threads, on every machine, and in every acceleration structure.
#[derive(Args)]
#[command(after_help = super::failure::EXIT_CODES)]
pub struct Arguments {
    /// Blob or scene file, or `-` for standard input
    #[arg(value_name = "BLOB|SCENE")]
    input: PathBuf,

    #[command(flatten)]
    files: OutputOptions,

    #[command(flatten)]
    time: TimeOptions,

    #[command(flatten)]
    with: TraceOptions,

    #[command(flatten)]
    picture: PictureOptions,

    /// Number of threads, 1 to 1024 [default: one per core]
    #[arg(long, value_name = "N", value_parser = arguments::threads())]
    threads: Option<usize>,

    /// Render only rows A to B - 1, counted from 0 at the top
    #[arg(long, value_name = "A..B", value_parser = arguments::rows, allow_hyphen_values = true)]
    rows: Option<Range<u16>>,

    /// Print the results as JSON
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    scene_options: SceneOptions,

    #[command(flatten)]
    target_point: TargetPoint,
}

/// The output.
enum Target<'a> {
    Frames(Output, Range<u32>),
    Picture(Outputs<'a>),
}

impl<'a> Target<'a> {
    /// Returns true if the picture is linear radiance.
    fn is_linear(&self) -> bool {
        matches!(self, Self::Picture(outputs) if outputs.is_linear())
    }

    /// All files that are written; `output` is the requested one.
    fn files(&self, output: &Path) -> Vec<PathBuf> {
        match self {
            Self::Picture(outputs) => outputs.files().map(Path::to_owned).collect(),
            Self::Frames(frames, range) => frames.files(output, range),
        }
    }

    /// Returns the requested output, or an error for names that cannot be written to.
    fn of(arguments: &'a Arguments) -> Result<Self, Failure> {
        let Some(frames) = &arguments.time.frames else {
            return Ok(Self::Picture(Outputs::of(
                &arguments.input,
                &arguments.files,
                arguments.scene_options.tone_mapping.is_some(),
            )?));
        };
        let output = Output::of(
            &arguments.time,
            frames,
            &arguments.input,
            &arguments.files.output,
        )?;
        Ok(Self::Frames(output, frames.clone()))
    }

    /// Returns the largest number of pixels in memory at once.
    fn most_pixels(&self) -> usize {
        match self {
            Self::Frames(..) => MOST_PIXELS,
            Self::Picture(outputs) => outputs.most_pixels(),
        }
    }
}

/// Renders a picture, or frames, and writes them.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let target = Target::of(arguments)?;
    let TimeOptions { time, shutter, .. } = &arguments.time;
    let opens = shutter.shutter.is_some();
    if opens && time.is_none() && arguments.time.frames.is_none() {
        return Err(Failure::usage(
            "a shutter is open from a time on, and none is given",
            "add `--time SECONDS`, such as `--time 0`",
        ));
    }
    let mut source = Source::to_trace(
        &arguments.input,
        &arguments
            .target_point
            .with_target(&arguments.scene_options)
            .sized(arguments.picture.size)
            .at(time.filter(|_| !opens))
            .opening_at(time.filter(|_| opens)),
        &arguments.with,
        Structure::Wide,
    )?;
    source.reject_lost(target.files(&arguments.files.output))?;
    // Pictures for displays have their own limit, in every format.
    if target.is_linear() {
        source.warn_of_dim_reflections(Some(arguments.with.format));
    }
    let scene = source.scene()?;
    let unresolved = source.warn_of_unresolved(&scene, Some(arguments.with.format));
    let job = job(arguments, (&source, &scene), target.most_pixels())?;
    let pool = threads::start(arguments.threads.unwrap_or(0))?;

    let shot = Shot {
        options: &arguments.time,
        output: &arguments.files.output,
        as_json: arguments.json,
        source: &source,
        scene: &scene,
        job: &job,
        pool: &pool,
        unresolved,
    };
    match target {
        Target::Picture(outputs) => {
            let has_stats = arguments.files.stats;
            picture::run(shot, &outputs, (has_stats, arguments.rows.is_some()))
        }
        Target::Frames(output, frames) => frames::run(shot, frames, &output),
    }
}

/// Returns the settings of the rendering; an error for rows that the picture does not have, and for too many pixels at
/// once.
fn job(
    arguments: &Arguments,
    (source, scene): (&Source, &Scene<'_>),
    most_pixels: usize,
) -> Result<Job, Failure> {
    let settings = Settings {
        dither: arguments.files.dither,
        ..arguments.picture.settings(scene)
    };
    let Settings { width, height, .. } = settings;
    let rows = arguments.rows.clone().unwrap_or(0..height);
    if rows.end > height {
        return Err(Failure::usage(
            format!(
                "rows {}..{} end behind the picture, which has {height}",
                rows.start, rows.end
            ),
            format!("rows count from 0; ask for a range within 0..{height}"),
        ));
    }
    let pixels = usize::from(width) * rows.len();
    if pixels > most_pixels {
        let most = most_pixels / usize::from(width);
        return Err(Failure::usage(
            format!(
                "{} pixels exceed the {} that fit in memory at once",
                grouped(pixels),
                grouped(most_pixels)
            ),
            match arguments.time.frames {
                Some(_) => String::from("ask for a smaller `--size`"),
                None => {
                    format!(
                        "render at most {most} rows at a time, with `--rows 0..{most}` and so on"
                    )
                }
            },
        ));
    }
    Ok(Job {
        format: arguments.with.format,
        structure: source.structure(scene, arguments.with.accel)?,
        settings,
        rows,
        count: arguments.files.stats || arguments.files.heat_map.is_some(),
    })
}
