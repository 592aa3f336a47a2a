//! The pictures of a scene that moves: an animation, or numbered files.

use super::report::RenderingReport;
use super::shutter::{ShutterOptions, changes, scenes};
use crate::cli::arguments;
use crate::cli::failure::Failure;
use crate::cli::input::is_standard;
use crate::cli::output::{
    Content, Warned, check_writable, json, print, reject_inputs, unsupported, write_file,
    write_files,
};
use crate::cli::progress::Progress;
use crate::cli::source::Source;
use clap::Args;
use gridel_core::{Scene, Tracks};
use gridel_host::animation::{Animation, AnimationFormat, NumberedName};
use gridel_host::picture::{Exposure, Frame, Moment, PictureFormat, RenderMetadata, srgb};
use gridel_host::render::{Job, Picture, render_moments};
use gridel_host::resolution::Unresolved;
use gridel_host::table::grouped;
use rayon::ThreadPool;
use serde::Serialize;
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Times of scenes that move.
#[derive(Args, Clone, Debug)]
pub struct TimeOptions {
    /// Show a scene that moves at this time, in seconds [default: as its file states it, without tracks]
    #[arg(long, value_name = "SECONDS", value_parser = arguments::seconds, allow_hyphen_values = true)]
    pub time: Option<f64>,

    /// Render frames A to B - 1 of a scene that moves: an animation, .apng or .gif (256 colors per frame), or
    /// numbered pictures, such as out-%03d.png. Frame N is at N / FPS seconds
    #[arg(long, value_name = "A..B", value_parser = arguments::frames, allow_hyphen_values = true,
        conflicts_with_all = ["time", "rows", "stats", "heat_map"])]
    pub frames: Option<Range<u32>>,

    /// Frames per second, 1 to 1000; a .gif has at most 50 [default: 24]
    #[arg(long, value_name = "N", requires = "frames", conflicts_with = "time",
        value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub fps: Option<u16>,

    #[command(flatten)]
    pub shutter: ShutterOptions,
}

/// The most numbered pictures of a run: more than an hour at 24 per second. All names are checked first.
const MOST_FILES: u32 = 100_000;

/// Rejects frames behind the last tick, which would all show the same.
fn check_times(tracks: &Tracks<'_>, frames: &Range<u32>, per_second: u16) -> Result<(), Failure> {
    let (last, rate) = (i32::MAX as u64, u64::from(per_second));
    let ticks = u64::from(tracks.ticks_per_second());
    // The first frame whose nearest tick is behind the last one.
    let most = ((last + 1) * rate - rate / 2).div_ceil(ticks);
    if u64::from(frames.end) <= most {
        return Ok(());
    }
    Err(Failure::usage(
        format!(
            "frame {} is behind the end of time, which is at {} s",
            frames.end - 1,
            last / ticks
        ),
        format!("at {per_second} frames per second, ask for frames within 0..{most}"),
    ))
}

/// The destination of frames.
pub enum Output {
    Animation(AnimationFormat),
    Numbered(NumberedName, PictureFormat),
}

impl TimeOptions {
    fn per_second(&self) -> u16 {
        self.fps.unwrap_or(24)
    }
}

impl Output {
    /// Returns all files that are written; `path` is the requested one.
    pub fn files(&self, path: &Path, frames: &Range<u32>) -> Vec<PathBuf> {
        match self {
            Self::Animation(_) => vec![path.to_owned()],
            Self::Numbered(name, _) => frames.clone().map(|it| name.of(it).into()).collect(),
        }
    }

    /// Returns the output of some frames; an error for names that cannot be written to.
    pub fn of(
        options: &TimeOptions,
        frames: &Range<u32>,
        input: &Path,
        path: &Path,
    ) -> Result<Self, Failure> {
        const NAMES: &str = ".apng, .gif or numbered pictures such as out-%03d.png";
        let shown = path.display();
        if is_standard(path) {
            return Err(Failure::usage(
                "several frames cannot go to standard output",
                format!("give the output a name: {NAMES}"),
            ));
        }
        let numbered = NumberedName::read(path.to_str().unwrap_or_default());
        if let Some(format) = AnimationFormat::of(path) {
            if matches!(numbered, Ok(Some(_))) {
                return Err(Failure::usage(
                    format!("{shown}: an animation is one file, and has no number"),
                    "leave %d out, or write pictures: .png, .ppm or .rgb565",
                ));
            }
            format.check_rate(options.per_second()).map_err(|error| {
                let most = format.most_per_second();
                let remedy = format!("use `--fps {most}` or less, or write an .apng");
                Failure::usage(format!("{shown}: {error}"), remedy)
            })?;
            reject_inputs([input], [path], "the input")?;
            check_writable(path)?;
            return Ok(Self::Animation(format));
        }
        let name = numbered.map_err(|cause| {
            Failure::usage(
                format!("{shown}: {cause}"),
                "write the frame's number as %d, or as %03d for at least 3 digits",
            )
        })?;
        let Some(name) = name else {
            return Err(match PictureFormat::of(path) {
                Some(_) => Failure::usage(
                    format!("{shown} is one picture, and several frames are asked for"),
                    format!("use {NAMES}"),
                ),
                None => unsupported(path, "animation", NAMES),
            });
        };
        let format = PictureFormat::of(path)
            .ok_or_else(|| unsupported(path, "image", ".png, .ppm or .rgb565"))?;
        let count = frames.end - frames.start;
        if count > MOST_FILES {
            let end = frames.start + MOST_FILES;
            return Err(Failure::usage(
                format!(
                    "{} frames are more files than the {} of one run",
                    grouped(count as usize),
                    grouped(MOST_FILES as usize)
                ),
                format!(
                    "render them in several runs, such as `--frames {}..{end}`",
                    frames.start
                ),
            ));
        }
        for number in frames.clone() {
            let path = PathBuf::from(name.of(number));
            // A new file is not the input, and is written as the first of them.
            if number == frames.start || path.exists() {
                reject_inputs([input], [&path], "the input")?;
                check_writable(&path)?;
            }
        }
        Ok(Self::Numbered(name, format))
    }
}

/// The report of `render --frames`.
#[derive(Serialize)]
struct Rendered {
    pictures: String,
    frames: [u32; 2],
    per_second: u16,
    width: u16,
    height: u16,
    #[serde(flatten)]
    rendering: RenderingReport,
    /// Objects that the format does not resolve.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    unresolved: Vec<Unresolved>,
}

/// The inputs of a picture, or of frames.
pub struct Shot<'s> {
    pub options: &'s TimeOptions,
    pub output: &'s Path,
    pub as_json: bool,
    pub source: &'s Source,
    pub scene: &'s Scene<'s>,
    pub job: &'s Job,
    pub pool: &'s ThreadPool,
    pub unresolved: Vec<Unresolved>,
}

/// Renders frames and writes them.
pub fn run(shot: Shot<'_>, frames: Range<u32>, output: &Output) -> Result<(), Failure> {
    let tracks = shot.source.tracks()?;
    let Shot { job, .. } = shot;
    let path = shot.output;
    let per_second = shot.options.per_second();
    check_times(&tracks, &frames, per_second)?;
    let mut warnings = shot.source.warnings.clone();
    let shutter = &shot.options.shutter;
    let exposure = shutter.exposure(&tracks, job.settings.samples, &mut warnings)?;
    let progress = Progress::steps("rendering", frames.len() as u64);
    let begun = Instant::now();
    match output {
        Output::Animation(format) => {
            let animation = Animation {
                format: *format,
                size: [job.settings.width.into(), job.settings.height.into()],
                pictures: frames.len() as u32,
                per_second,
            };
            // The failure of a frame, in contrast to that of writing the file.
            let mut failure = None;
            let written = write_file(path, |out| {
                animation.write(out, &mut |number| {
                    let frame = shot.frame((&tracks, exposure), frames.start + number, per_second);
                    let (picture, _) = frame.map_err(|error| {
                        failure = Some(error);
                        io::Error::other("a frame is missing")
                    })?;
                    progress.step();
                    Ok(srgb(&picture, job.settings.dither))
                })
            });
            if let Some(failure) = failure {
                return Err(failure);
            }
            written?;
        }
        Output::Numbered(name, format) => {
            for number in frames.clone() {
                let (picture, metadata) = shot.frame((&tracks, exposure), number, per_second)?;
                let path = PathBuf::from(name.of(number));
                let content: Content<'_> = &|out| format.write(out, &picture, &metadata);
                write_files(&[(&path, content)])?;
                progress.step();
            }
        }
    }
    drop(progress);
    let rendered = Rendered {
        pictures: path.display().to_string(),
        frames: [frames.start, frames.end],
        per_second,
        width: job.settings.width,
        height: job.settings.height,
        rendering: RenderingReport::of(job, shot.pool, exposure, begun.elapsed()),
        unresolved: shot.unresolved,
    };
    match shot.as_json {
        true => print(json(&Warned {
            value: &rendered,
            warnings: &warnings,
        })?),
        false => print(rendered.text()),
    }
}

impl Shot<'_> {
    fn frame(
        &self,
        (tracks, exposure): (&Tracks<'_>, Option<Exposure>),
        number: u32,
        per_second: u16,
    ) -> Result<(Picture, RenderMetadata), Failure> {
        let time = tracks.frame_time(number, per_second.into());
        let changes = changes(self.source, (self.scene, tracks), time, exposure)?;
        let moments = scenes(&changes, self.scene)?;
        let rendered = self
            .pool
            .install(|| render_moments(&moments, self.job, &|| ()));
        let picture = rendered.map_err(Failure::rendering)?;
        let moment = Moment::Frame(Frame { number, per_second });
        // Common to all frames: the scene at rest, and the options.
        let metadata = RenderMetadata::of(self.scene, self.job)
            .at(Some(moment))
            .exposed(exposure);
        Ok((picture, metadata))
    }
}

impl Rendered {
    fn text(&self) -> String {
        let [first, end] = self.frames;
        format!(
            "{}: frames {first}..{end} at {} per second, {} x {}, {}\n",
            self.pictures, self.per_second, self.width, self.height, self.rendering
        )
    }
}
