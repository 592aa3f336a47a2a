//! The state from which an interrupted run continues.

use crate::cli::failure::Failure;
use crate::cli::output::{of_another_run, warn};
use flate2::Crc;
use gridel_core::Settings;
use gridel_host::certify::Enclosed;
use gridel_host::output::write_whole;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The name of its file.
const STATE: &str = "certify.state";

/// The version of what is proved and how. Raise it with every change, so that older states are not continued.
const RULES: u32 = 8;

/// The file from which an interrupted run continues: a line with the key, the pixels, and a checksum of both.
pub struct State {
    pub path: PathBuf,
    key: String,
}

impl State {
    /// The state of a picture in a folder of results.
    pub fn new(folder: &Path, checksum: u32, time: Option<i32>, settings: &Settings) -> Self {
        Self {
            path: folder.join(STATE),
            key: key(checksum, time, settings),
        }
    }

    /// Rejects files in the place of results where no state says that they are results.
    pub fn reject_foreign(&self, results: &[PathBuf]) -> Result<(), Failure> {
        let foreign = match self.path.exists() {
            true => None,
            false => results.iter().find(|path| path.exists()),
        };
        let Some(path) = foreign else {
            return Ok(());
        };
        Err(Failure::usage(
            format!(
                "{} exists, and no {STATE} of an earlier run is beside it: it would be overwritten",
                path.display()
            ),
            "give another folder with `-o`, or move that file away",
        ))
    }

    /// The pixels of a run before this one; none are done if there was none, or its state is damaged.
    ///
    /// # Errors
    /// If the state cannot be read, or is of another picture, which may have taken hours.
    pub fn read(&self, count: usize) -> Result<Vec<Enclosed>, Failure> {
        let mut pixels = vec![Enclosed::default(); count];
        let bytes = match fs::read(&self.path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(pixels),
            Err(error) => return Err(Failure::reading(&self.path, &error)),
        };
        // The checksum holds for the key, too: without it, a damaged key looks like that of another picture.
        if let Some(content) = undamaged(&bytes) {
            let kept = content.strip_prefix(self.key.as_bytes());
            let kept = kept.ok_or_else(|| of_another_run(&self.path))?;
            let into: &mut [u8] = bytemuck::cast_slice_mut(&mut pixels);
            if kept.len() == into.len() {
                into.copy_from_slice(kept);
                return Ok(pixels);
            }
        }
        warn(format!(
            "{} is damaged; all pixels are evaluated again, and the file is replaced",
            self.path.display()
        ));
        Ok(pixels)
    }

    pub fn write(&self, pixels: &[Enclosed]) -> Result<(), Failure> {
        // Without a copy, which would be as large as the pixels of the largest picture: 320 MiB.
        let parts = [self.key.as_bytes(), bytemuck::cast_slice(pixels)];
        let sum = sum_of(&parts).to_le_bytes();
        write_whole(&self.path, |out| {
            parts.iter().try_for_each(|part| out.write_all(part))?;
            out.write_all(&sum)
        })
        .map_err(|error| Failure::writing(&self.path, &error))
    }
}

/// The key and the pixels of a state; `None` if it is damaged.
fn undamaged(bytes: &[u8]) -> Option<&[u8]> {
    let (content, sum) = bytes.split_last_chunk()?;
    (u32::from_le_bytes(*sum) == sum_of(&[content])).then_some(content)
}

/// The checksum of the parts of a state.
fn sum_of(parts: &[&[u8]]) -> u32 {
    let mut sum = Crc::new();
    parts.iter().for_each(|part| sum.update(part));
    sum.sum()
}

/// Returns a key of the certified picture, so that the state of another picture is not continued.
fn key(checksum: u32, time: Option<i32>, settings: &Settings) -> String {
    let Settings {
        width,
        height,
        samples,
        depth,
        ..
    } = settings;
    let time = time.map_or(String::new(), |ticks| format!(" time {ticks}"));
    format!(
        "gridel {} certify {RULES} blob {checksum:08x}{time} size {width}x{height} samples {samples} depth {depth}\n",
        env!("CARGO_PKG_VERSION")
    )
}
