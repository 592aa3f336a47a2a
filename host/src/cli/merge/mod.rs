//! `gridel merge`: parts of a picture become one, and pictures an animation.

mod frames;
mod misfit;

use super::failure::Failure;
use super::output::{check_writable, print, print_json, reject_same, unsupported, write_file};
use super::progress::Progress;
use clap::Args;
use gridel_host::animation::AnimationFormat;
use gridel_host::merge::{Merge, MergeError, Part};
use gridel_host::picture::PictureFormat;
use gridel_host::table::counted;
use misfit::misfit;
use serde::Serialize;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

/// Join parts of a picture, or frames of an animation
///
/// Parts are what `render --rows` writes. Each stores its rows, its blob and its settings. Parts can come
/// from several machines, in any order, and can overlap if they agree. Parts of different pictures are
/// rejected. The result has the bytes that one machine writes.
///
/// Frames are numbered .png files that `render --frames` writes. Each stores its number, rate, blob and
/// settings. The animation has the bytes that one machine writes.
#[derive(Args)]
#[command(after_help = super::failure::EXIT_CODES)]
pub struct Arguments {
    /// Parts, .png or .ppm, or frames, .png
    #[arg(required = true, value_name = "PART")]
    parts: Vec<PathBuf>,

    /// Picture to write, with the extension of the parts; or animation of frames, .apng or .gif
    #[arg(short, long, value_name = "PICTURE")]
    output: PathBuf,

    /// Print the results as JSON
    #[arg(long)]
    json: bool,
}

/// The report of `merge`.
#[derive(Serialize)]
struct Merged {
    picture: String,
    width: u32,
    height: u32,
    parts: usize,
}

/// Merges parts and writes the picture.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let output = &arguments.output;
    if let Some(format) = AnimationFormat::of(output) {
        return frames::run(&arguments.parts, output, arguments.json, format);
    }
    let format = format_of(output)?;
    for part in &arguments.parts {
        if format_of(part)? != format {
            return Err(Failure::usage(
                format!(
                    "{} and {} are not of one format",
                    part.display(),
                    output.display()
                ),
                "render the parts in the format of the picture",
            ));
        }
        reject_same(part, output)?;
    }
    check_writable(output)?;
    let progress = Progress::steps("merging", arguments.parts.len() as u64);
    let mut merge = Merge::default();
    for path in &arguments.parts {
        let file = File::open(path).map_err(|error| Failure::reading(path, &error))?;
        let part = Part::read(format, BufReader::new(file)).map_err(|error| {
            Failure::failed(
                format!("{} cannot be merged: {error}", path.display()),
                "parts are what `gridel render --rows A..B` writes",
            )
        })?;
        merge
            .add(&part)
            .map_err(|error| failure(arguments, &error))?;
        progress.step();
    }
    drop(progress);
    let whole = merge.finish().map_err(|error| failure(arguments, &error))?;
    write_file(output, |out| whole.write(format, out))?;
    let merged = Merged {
        picture: output.display().to_string(),
        width: whole.size[0],
        height: whole.size[1],
        parts: arguments.parts.len(),
    };
    if arguments.json {
        print_json(&merged)
    } else {
        print(format!(
            "{}: {}x{} pixels from {}\n",
            merged.picture,
            merged.width,
            merged.height,
            counted(merged.parts, "part")
        ))
    }
}

fn format_of(path: &Path) -> Result<PictureFormat, Failure> {
    match PictureFormat::of(path) {
        Some(format @ (PictureFormat::Png | PictureFormat::Ppm)) => Ok(format),
        Some(PictureFormat::Rgb565) => Err(Failure::usage(
            format!("{} does not say which rows it has", path.display()),
            "render parts as .png or .ppm; .rgb565 files have nothing but pixels, and joined in the \
             order of their rows, as with `cat`, they are the whole",
        )),
        None => Err(unsupported(
            path,
            "image",
            ".png or .ppm, and for an animation .apng or .gif",
        )),
    }
}

fn failure(arguments: &Arguments, error: &MergeError) -> Failure {
    let parts = &arguments.parts;
    match error {
        MergeError::Sizes(both, _) => misfit(parts, *both, error, "merge parts of one picture"),
        MergeError::Made(both, _) => misfit(
            parts,
            *both,
            error,
            "render all parts with one gridel from one blob, with the same options but for `--rows`",
        ),
        MergeError::Differ(both, _) => misfit(
            parts,
            *both,
            error,
            "render both with the same scene, number format and settings",
        ),
        MergeError::Missing(rows) => Failure::failed(
            format!("the picture is not whole: {error}"),
            format!("render them with `--rows {}..{}`", rows.start, rows.end),
        ),
    }
}
