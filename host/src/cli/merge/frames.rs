//! Numbered pictures become an animation.

use super::misfit::misfit;
use crate::cli::failure::Failure;
use crate::cli::output::{print, print_json, reject_inputs, write_file};
use crate::cli::progress::Progress;
use gridel_host::animation::{Animation, AnimationFormat};
use gridel_host::merge::{FramesError, NumberedPicture, PartError, in_order};
use serde::Serialize;
use std::fs::File;
use std::io::{self, BufReader};
use std::path::{Path, PathBuf};

/// The report of `merge` for an animation.
#[derive(Serialize)]
struct Merged {
    pictures: String,
    frames: [u32; 2],
    per_second: u16,
    width: u32,
    height: u32,
}

/// Merges frames and writes the animation.
pub fn run(
    inputs: &[PathBuf],
    output: &Path,
    as_json: bool,
    format: AnimationFormat,
) -> Result<(), Failure> {
    reject_inputs(inputs.iter().map(|it| it.as_path()), [output], "a frame")?;
    let read = |path: &Path| {
        open(path)
            .map_err(PartError::from)
            .and_then(NumberedPicture::read)
            .map_err(|error| wrong(path, &error))
    };
    let pictures = inputs
        .iter()
        .map(|path| read(path))
        .collect::<Result<Vec<_>, _>>()?;
    let order = in_order(&pictures).map_err(|error| failure(inputs, &error))?;
    // The command line requires at least one file.
    let Some((&first, &last)) = order.first().zip(order.last()) else {
        return Ok(());
    };
    let [first, last] = [first, last].map(|index| &pictures[index]);
    let animation = Animation {
        format,
        size: first.size,
        pictures: order.len() as u32,
        per_second: first.note.frame.per_second,
    };
    format.check_rate(animation.per_second).map_err(|error| {
        let cause = format!("{}: {error}", output.display());
        Failure::usage(cause, "merge them into an .apng")
    })?;
    let progress = Progress::steps("merging", order.len() as u64);
    // The failure of a frame, in contrast to that of writing the file.
    let mut failure = None;
    let written = write_file(output, |out| {
        animation.write(out, &mut |number| {
            let path = &inputs[order[number as usize]];
            let pixels = open(path)
                .map_err(PartError::from)
                .and_then(NumberedPicture::read_pixels);
            progress.step();
            pixels.map_err(|error| {
                failure = Some(wrong(path, &error));
                io::Error::other("a frame is missing")
            })
        })
    });
    drop(progress);
    if let Some(failure) = failure {
        return Err(failure);
    }
    written?;
    let merged = Merged {
        pictures: output.display().to_string(),
        frames: [first.note.frame.number, last.note.frame.number + 1],
        per_second: animation.per_second,
        width: first.size[0],
        height: first.size[1],
    };
    if as_json {
        return print_json(&merged);
    }
    let [first, end] = merged.frames;
    print(format!(
        "{}: frames {first}..{end} at {} per second, {} x {}\n",
        merged.pictures, merged.per_second, merged.width, merged.height
    ))
}

fn open(path: &Path) -> io::Result<BufReader<File>> {
    File::open(path).map(BufReader::new)
}

fn wrong(path: &Path, error: &PartError) -> Failure {
    if let PartError::Read(error) = error {
        return Failure::reading(path, error);
    }
    Failure::failed(
        format!("{} cannot be merged: {error}", path.display()),
        "frames are what `gridel render --frames A..B -o NAME-%03d.png` writes",
    )
}

fn failure(inputs: &[PathBuf], error: &FramesError) -> Failure {
    match error {
        FramesError::Sizes(both, _) | FramesError::Made(both, _) | FramesError::Rates(both, _) => {
            misfit(
                inputs,
                *both,
                error,
                "render all frames with one gridel from one blob, with the same options but for the range of `--frames`",
            )
        }
        FramesError::Twice(both, _) => misfit(inputs, *both, error, "leave one of them out"),
        FramesError::Missing(number) => Failure::failed(
            format!("the animation is not whole: {error}"),
            format!("render it with `--frames {number}..{}`", number + 1),
        ),
    }
}
