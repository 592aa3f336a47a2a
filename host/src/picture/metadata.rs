//! Metadata of pictures in their files, so that only parts and frames that were made alike are joined.

use crate::render::{Job, Picture};
use gridel_core::{Format, Scene};
use std::fmt;
use std::ops::Range;
use std::str::FromStr;

/// All that decides the colors of a picture's pixels, except their place and the picture's size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RenderMetadata {
    /// Checksum of the blob.
    pub blob: u32,
    /// Checksum of camera, surroundings, lights and materials, which can be others than the blob's.
    pub view: u32,
    pub format: Format,
    pub samples: u16,
    pub depth: u8,
    pub dither: bool,
    /// The moment, for a scene that moves.
    pub moment: Option<Moment>,
    /// The exposure, for a picture with motion blur.
    pub exposure: Option<Exposure>,
    /// True for a part of a picture that has all of its rows: its file states them as those of any other part.
    pub is_part: bool,
}

/// The time that a shutter is open, in ticks of the blob's tracks, and the number of moments at which samples are
/// taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exposure {
    pub open: u32,
    pub moments: u16,
}

/// The time at which a picture of a moving scene is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Moment {
    /// A time in ticks of the blob's tracks.
    Time(i32),
    /// One of the pictures of an animation.
    Frame(Frame),
}

/// A picture of an animation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame {
    /// Counted from 0, which is at time 0; below 2^32 - 1.
    pub number: u32,
    /// Pictures per second.
    pub per_second: u16,
}

/// The note of a file about a picture of an animation: its number, and how it was made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FrameNote {
    pub frame: Frame,
    /// Names and values, as [`RenderMetadata`] shows them.
    pub made: Vec<(String, String)>,
}

impl FrameNote {
    /// Keyword of the text in PNG files.
    pub const KEYWORD: &str = "Frame";

    pub(super) fn of(metadata: &RenderMetadata) -> Option<Self> {
        let Some(Moment::Frame(frame)) = metadata.moment else {
            return None;
        };
        Some(Self {
            frame,
            made: metadata.pairs(),
        })
    }
}

impl fmt::Display for FrameNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Frame { number, per_second } = self.frame;
        write!(f, "{number} at {per_second} per second")?;
        write_pairs(f, "; ", &self.made)
    }
}

impl FromStr for FrameNote {
    type Err = ();

    fn from_str(text: &str) -> Result<Self, ()> {
        let (frame, made) = text.split_once("; ").ok_or(())?;
        let (number, rate) = frame.split_once(" at ").ok_or(())?;
        let rate = rate.strip_suffix(" per second").ok_or(())?;
        let frame = Frame {
            // A range of frames ends behind its last one.
            number: number.parse().ok().filter(|it| *it < u32::MAX).ok_or(())?,
            per_second: rate.parse().map_err(|_| ())?,
        };
        let made = pairs(made).filter(|_| frame.per_second > 0).ok_or(())?;
        Ok(Self { frame, made })
    }
}

/// Writes names and values, with a text before the first.
fn write_pairs(f: &mut fmt::Formatter<'_>, first: &str, pairs: &[(String, String)]) -> fmt::Result {
    for (number, (name, value)) in pairs.iter().enumerate() {
        let before = if number == 0 { first } else { ", " };
        write!(f, "{before}{name} {value}")?;
    }
    Ok(())
}

impl RenderMetadata {
    /// Returns the metadata of a job's picture of a scene.
    pub fn of(scene: &Scene<'_>, job: &Job) -> Self {
        Self {
            blob: scene.header().checksum,
            view: checksum_of_view(scene),
            format: job.format,
            samples: job.settings.samples,
            depth: job.settings.depth,
            dither: job.settings.dither,
            moment: None,
            exposure: None,
            is_part: false,
        }
    }

    /// Returns the metadata at a moment.
    pub fn at(self, moment: Option<Moment>) -> Self {
        Self { moment, ..self }
    }

    /// Returns the metadata with motion blurred.
    pub fn exposed(self, exposure: Option<Exposure>) -> Self {
        Self { exposure, ..self }
    }

    /// Returns the metadata of a part, even if it has all rows.
    pub fn as_part(self, is_part: bool) -> Self {
        Self { is_part, ..self }
    }
}

/// Returns the checksum of the values of a scene that a program may replace.
fn checksum_of_view(scene: &Scene<'_>) -> u32 {
    let parts: [&[u8]; 3] = [
        bytemuck::bytes_of(scene.view()),
        bytemuck::cast_slice(scene.lights()),
        bytemuck::cast_slice(scene.materials()),
    ];
    // FNV-1a of 32 bits.
    let bytes = parts.into_iter().flatten();
    bytes.fold(0x811c_9dc5, |hash, &byte| {
        (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193)
    })
}

impl RenderMetadata {
    /// Names and values, and the version of this program, whose arithmetic it is.
    fn pairs(&self) -> Vec<(String, String)> {
        let Self {
            blob,
            view,
            format,
            samples,
            depth,
            dither,
            moment,
            exposure,
            is_part: _,
        } = self;
        let mut pairs: Vec<(&str, String)> = Vec::new();
        if let Some(Moment::Time(ticks)) = moment {
            pairs.push(("time", ticks.to_string()));
        }
        if let Some(Exposure { open, moments }) = exposure {
            pairs.push(("shutter", open.to_string()));
            pairs.push(("moments", moments.to_string()));
        }
        pairs.extend([
            ("blob", format!("{blob:08x}")),
            ("view", format!("{view:08x}")),
            ("format", String::from(format.name())),
            ("samples", samples.to_string()),
            ("depth", depth.to_string()),
            ("dither", String::from(if *dither { "on" } else { "off" })),
            ("gridel", String::from(env!("CARGO_PKG_VERSION"))),
        ]);
        let owned = |(name, value): (&str, String)| (name.to_owned(), value);
        pairs.into_iter().map(owned).collect()
    }
}

impl fmt::Display for RenderMetadata {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write_pairs(f, "", &self.pairs())
    }
}

/// The rows of a picture that a file has, as PNG and PPM files of a part state them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rows {
    /// The rows, from the top.
    pub part: Range<u16>,
    /// Height of the whole picture.
    pub height: u16,
    /// Metadata of the picture: names and values, as [`RenderMetadata`] shows them.
    pub made: Vec<(String, String)>,
}

impl Rows {
    /// Keyword of the text in PNG files.
    pub const KEYWORD: &str = "Rows";

    /// The rows of a part; `None` for a whole picture.
    pub(super) fn of(picture: &Picture, metadata: &RenderMetadata) -> Option<Self> {
        let (part, height) = (picture.rows.clone(), picture.height);
        (metadata.is_part || part != (0..height)).then(|| Self {
            part,
            height,
            made: metadata.pairs(),
        })
    }
}

/// Names and values of a list such as `samples 4, depth 5`.
fn pairs(text: &str) -> Option<Vec<(String, String)>> {
    let pair = |pair: &str| {
        let (name, value) = pair.split_once(' ')?;
        Some((name.to_owned(), value.to_owned()))
    };
    text.split(", ").map(pair).collect()
}

impl fmt::Display for Rows {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { part, height, made } = self;
        write!(f, "{}..{} of {height}", part.start, part.end)?;
        write_pairs(f, "; ", made)
    }
}

impl FromStr for Rows {
    type Err = ();

    fn from_str(text: &str) -> Result<Self, ()> {
        let (rows, made) = text.split_once("; ").ok_or(())?;
        let (part, height) = rows.split_once(" of ").ok_or(())?;
        let (start, end) = part.split_once("..").ok_or(())?;
        let number = |text: &str| text.parse::<u16>().map_err(|_| ());
        let (part, height) = (number(start)?..number(end)?, number(height)?);
        let inside = part.start < part.end && part.end <= height;
        let made = pairs(made).filter(|_| inside).ok_or(())?;
        Ok(Self { part, height, made })
    }
}
