//! `gridel render`: a picture of a scene, or those of one that moves.

mod frames;
mod outputs;
mod shutter;

use super::arguments::TargetPoint;
use super::arguments::{self, PictureOptions, SceneOptions, TraceOptions};
use super::changes::Changes;
use super::failure::Failure;
use super::output::{Warned, json, print_about};
use super::progress::Progress;
use super::source::{Source, tick};
use super::threads;
use clap::Args;
use frames::{Output, Shot, TimeOptions};
use gridel_core::{Counters, Scene, Settings, Structure};
use gridel_host::picture::{Exposure, Moment, RenderMetadata};
use gridel_host::render::{Job, MOST_PIXELS, Picture};
use gridel_host::resolution::Unresolved;
use gridel_host::table::{Align, Table, counted, grouped};
use outputs::{AovFile, HeatMapFile, OutputOptions, Outputs};
use serde::Serialize;
use shutter::scenes;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

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

/// The report of `render`.
#[derive(Serialize)]
struct Rendered {
    picture: String,
    width: u16,
    height: u16,
    rows: [u16; 2],
    format: &'static str,
    accel: &'static str,
    samples: u16,
    depth: u8,
    threads: usize,
    /// While the shutter is open.
    #[serde(skip_serializing_if = "Option::is_none")]
    moments: Option<u16>,
    seconds: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    stats: Option<Stats>,
    #[serde(skip_serializing_if = "Option::is_none")]
    heat_map: Option<HeatMapFile>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    aovs: Vec<AovFile>,
    /// Objects that the format does not resolve.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    unresolved: Vec<Unresolved>,
}

#[derive(Serialize)]
struct Stats {
    rays: u64,
    primary: u64,
    shadow: u64,
    reflected: u64,
    refracted: u64,
    diffuse: u64,
    planes: u64,
    boxes: u64,
    cells: u64,
    primitives: u64,
    /// Instances that rays entered.
    instances: u64,
    rays_per_second: f64,
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

    let outputs = match target {
        Target::Picture(outputs) => outputs,
        Target::Frames(output, frames) => {
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
            return frames::run(shot, frames, &output);
        }
    };
    let blurred = blurred(arguments, (&source, &scene), &job)?;
    let warnings = match &blurred {
        Some(blurred) => [source.warn_of_unblurred(), blurred.warnings.clone()].concat(),
        None => source.warnings.clone(),
    };
    let moments = match &blurred {
        Some(blurred) => scenes(&blurred.changes, &scene)?,
        None => vec![scene],
    };
    let scene = moments[0];
    let progress = Progress::steps("rendering", job.rows.len() as u64);
    let begun = Instant::now();
    let rendered = pool.install(|| outputs.render(&moments, &job, &|| progress.step()));
    let taken = begun.elapsed();
    drop(progress);
    let image = rendered.map_err(Failure::rendering)?;

    let shown = image.shown();
    let stats = shown.and_then(|picture| stats(arguments, picture, taken));
    let time = blurred.as_ref().map(|it| it.time).or(source.time());
    let metadata = RenderMetadata::of(&scene, &job)
        .at(time.map(Moment::Time))
        .exposed(blurred.as_ref().map(|it| it.exposure))
        .as_part(arguments.rows.is_some());
    let written = pool.install(|| outputs.write((&scene, &job), &image, &metadata));
    let (heat_map, aovs) = written?;
    let rendered = Rendered {
        picture: arguments.files.output.display().to_string(),
        width: job.settings.width,
        height: job.settings.height,
        rows: [job.rows.start, job.rows.end],
        format: job.format.name(),
        accel: job.structure.name(),
        samples: job.settings.samples,
        depth: job.settings.depth,
        threads: pool.current_num_threads(),
        moments: blurred.map(|it| it.exposure.moments),
        seconds: taken.as_secs_f64(),
        stats,
        heat_map,
        aovs,
        unresolved,
    };
    let report = match arguments.json {
        true => json(&Warned {
            value: &rendered,
            warnings: &warnings,
        })?,
        false => rendered.text(),
    };
    print_about(&arguments.files.output, report)
}

/// A picture in which motion is blurred.
struct Blurred {
    /// The time at which the shutter opens, in ticks.
    time: i32,
    exposure: Exposure,
    /// The changes at each moment.
    changes: Vec<Changes>,
    /// The warnings of the shutter.
    warnings: Vec<String>,
}

/// The moments of a picture, if motion is to be blurred.
fn blurred(
    arguments: &Arguments,
    (source, scene): (&Source, &Scene<'_>),
    job: &Job,
) -> Result<Option<Blurred>, Failure> {
    let TimeOptions { time, shutter, .. } = &arguments.time;
    let (Some(seconds), Some(_)) = (time, shutter.shutter) else {
        return Ok(None);
    };
    let tracks = source.tracks()?;
    let mut warnings = Vec::new();
    let exposure = shutter.exposure(&tracks, job.settings.samples, &mut warnings)?;
    let Some(exposure) = exposure else {
        return Ok(None);
    };
    let time = tick(&tracks, *seconds)?;
    let changes = shutter::changes(source, (scene, &tracks), time, Some(exposure))?;
    Ok(Some(Blurred {
        time,
        exposure,
        changes,
        warnings,
    }))
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

fn stats(arguments: &Arguments, picture: &Picture, time: Duration) -> Option<Stats> {
    let counters = picture.counters.filter(|_| arguments.files.stats)?;
    let Counters {
        planes,
        boxes,
        primitives,
        cells,
        instances,
        primary,
        shadow,
        reflected,
        refracted,
        diffuse,
    } = counters;
    Some(Stats {
        rays: counters.rays(),
        primary,
        shadow,
        reflected,
        refracted,
        diffuse,
        planes,
        boxes,
        cells,
        primitives,
        instances,
        rays_per_second: counters.rays() as f64 / time.as_secs_f64(),
    })
}

impl Rendered {
    fn text(&self) -> String {
        let [first, end] = self.rows;
        let rows = if (first, end) == (0, self.height) {
            String::new()
        } else {
            format!(", rows {first}..{end}")
        };
        let mut text = format!(
            "{}: {} x {}{rows}, {}, {}, {} per pixel{}, {:.3} s with {}\n",
            self.picture,
            self.width,
            self.height,
            self.format,
            self.accel,
            counted(self.samples.into(), "sample"),
            shutter::of_moments(self.moments),
            self.seconds,
            counted(self.threads, "thread")
        );
        if let Some(map) = &self.heat_map {
            text.push_str(&format!(
                "{}: white is {} boxes and primitives tested\n",
                map.file,
                grouped(map.maximum)
            ));
        }
        for aov in &self.aovs {
            text.push_str(&format!("{}: {}\n", aov.file.display(), aov.name));
        }
        if let Some(stats) = &self.stats {
            text.push_str(&format!("\n{}", stats.table()));
        }
        text
    }
}

impl Stats {
    fn table(&self) -> Table {
        let mut table = Table::new([
            ("counted", Align::Left),
            ("number", Align::Right),
            ("per ray", Align::Right),
        ]);
        let per_ray = |count: u64| format!("{:.2}", count as f64 / self.rays.max(1) as f64);
        for (what, count) in [
            ("rays", self.rays),
            ("  primary", self.primary),
            ("  shadow", self.shadow),
            ("  reflected", self.reflected),
            ("  refracted", self.refracted),
            ("  diffuse", self.diffuse),
            ("planes tested", self.planes),
            ("boxes tested", self.boxes),
            ("cells entered", self.cells),
            ("primitives tested", self.primitives),
            ("instances entered", self.instances),
        ] {
            table.row([what.to_owned(), grouped(count), per_ray(count)]);
        }
        table.row([
            String::from("rays per second"),
            grouped(self.rays_per_second.round()),
            String::new(),
        ]);
        table
    }
}
