//! Linear pictures and AOVs, and the files that they go to.

use crate::npy;
use crate::render::Values;
use std::io::{self, Write};
use std::ops::Range;
use std::path::Path;

/// A file format of linear values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LinearFormat {
    /// NumPy's array file: one layer.
    Npy,
    /// OpenEXR with 32 bits per channel, compressed without loss: any number of layers. Needs the feature `exr`.
    Exr,
}

impl LinearFormat {
    /// Returns the format that a file's extension names: `npy` or `exr`.
    ///
    /// ```
    /// use gridel_host::layer::LinearFormat;
    ///
    /// assert_eq!(LinearFormat::of("a.exr".as_ref()), Some(LinearFormat::Exr));
    /// assert_eq!(LinearFormat::of("a.png".as_ref()), None);
    /// ```
    pub fn of(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        match extension.as_str() {
            "npy" => Some(Self::Npy),
            "exr" => Some(Self::Exr),
            _ => None,
        }
    }

    /// Returns whether this build writes the format.
    pub fn is_available(self) -> bool {
        self == Self::Npy || cfg!(feature = "exr")
    }
}

/// Values of the pixels of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// `None` for the picture itself, else the name of an [AOV](crate::render::Aov).
    pub name: Option<&'static str>,
    pub values: Values,
}

/// The place of some rows in a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Window {
    pub width: u16,
    /// Height of the whole picture.
    pub height: u16,
    pub rows: Range<u16>,
}

/// Writes one layer as NumPy's array file: see [`npy::write_pixels`].
///
/// # Errors
/// If `out` has one.
pub fn write_npy(out: &mut dyn Write, window: &Window, layer: &Layer) -> io::Result<()> {
    let size = [window.width.into(), window.rows.len()];
    npy::write_pixels(out, size, &layer.values)
}
