//! The pictures that errors are measured against: `f64`, or the exact picture.

use crate::certify::{Unknown, World, linear};
use gridel_core::{Scene, Settings};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// The pictures that errors are measured against: that of the reference, and that of each setting.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Truth {
    /// Rendered in double precision.
    #[default]
    F64,
    /// Enclosed by [`certify`](crate::certify), to the last of 16 bits.
    Exact,
}

impl Truth {
    pub const ALL: [Self; 2] = [Self::F64, Self::Exact];

    pub const fn name(self) -> &'static str {
        match self {
            Self::F64 => "f64",
            Self::Exact => "exact",
        }
    }

    /// Returns the name of its pictures in sentences, with the format's name between backticks.
    pub const fn picture(self) -> &'static str {
        match self {
            Self::F64 => "the picture of `f64`",
            Self::Exact => "the exact picture",
        }
    }
}

/// Returns the exact picture, linear, 65535 being white, and how many of its pixels are open. Open pixels have the
/// middle of their interval.
pub(super) fn exact_pixels(
    scene: &Scene<'_>,
    settings: &Settings,
) -> Result<(Vec<[u16; 3]>, usize), Unknown> {
    let world = World::of(scene)?;
    let width = usize::from(settings.width);
    let count = width * usize::from(settings.height);
    let place = |index: usize| [(index % width) as u16, (index / width) as u16];
    let pixels = (0..count).into_par_iter();
    let pixels: Vec<([u16; 3], bool)> = pixels
        .map(|index| linear(&world, settings, place(index)))
        .collect();
    let open = pixels.iter().filter(|(_, is_proved)| !is_proved).count();
    Ok((pixels.into_iter().map(|(linear, _)| linear).collect(), open))
}
