//! Puts a picture together from parts that were rendered on their own.
//!
//! The file of a part states which rows of which picture it holds ([`Rows`]) and how they were made. So parts may come
//! in any order, and parts of different pictures are rejected. Parts may overlap where they agree: two machines render
//! the same rows with the same bits.

mod frames;

pub use frames::{FramesError, NumberedPicture, in_order};

use crate::picture::{PictureFormat, Rows, write_png};
use crate::scene::TICKS_PER_SECOND;
use crate::table::grouped;
use std::cmp::Ordering;
use std::fmt;
use std::io::{self, BufRead, Read, Write};
use std::ops::Range;

/// One part: rows of a picture, three bytes per pixel.
#[derive(Clone, Debug)]
pub struct Part {
    width: u32,
    rows: Rows,
    pixels: Vec<u8>,
}

/// The reason why a file is not a part of a picture.
#[derive(Debug, thiserror::Error)]
pub enum PartError {
    #[error("it cannot be read: {0}")]
    Read(#[from] io::Error),
    #[error("it is not a PNG picture with 3 bytes per pixel: {0}")]
    Png(String),
    #[error("it is not a PPM picture (P6) with 3 bytes per pixel")]
    Ppm,
    #[error("its pixels take {} bytes, and it has {} of them", grouped(*.expected), grouped(*.found))]
    Truncated { expected: u64, found: u64 },
    #[error("it has more than the {} bytes of its pixels", grouped(*.expected))]
    TooLong { expected: u64 },
    #[error("it ends within its header")]
    Header,
    #[error(
        "it does not state which rows it has and how they were rendered, so it is not a part of a picture"
    )]
    Whole,
    #[error("it does not state which frame of an animation it is")]
    NoFrame,
    #[error("it says that it has the rows {}..{}, but it has {found}", .rows.start, .rows.end)]
    Rows { rows: Range<u16>, found: u32 },
}

/// The reason why parts do not make a picture. Parts are numbered in the order in which they were added.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MergeError {
    /// Two parts are of pictures of different sizes: width and height of each.
    Sizes([usize; 2], [[u32; 2]; 2]),
    /// Two parts were made differently: what differs, and how it is in each.
    Made([usize; 2], [String; 2]),
    /// Two parts have a row that is not the same in both.
    Differ([usize; 2], u32),
    /// No part has these rows.
    Missing(Range<u32>),
}

impl Part {
    /// Reads a part.
    ///
    /// # Errors
    /// If the file is not a picture of the format that says which rows it has.
    pub fn read(format: PictureFormat, input: impl BufRead + io::Seek) -> Result<Self, PartError> {
        let (width, height, note, pixels) = match format {
            PictureFormat::Png => read_png(input)?,
            PictureFormat::Ppm => read_ppm(input)?,
            PictureFormat::Rgb565 => return Err(PartError::Whole),
        };
        let rows: Rows = note
            .and_then(|note| note.parse().ok())
            .ok_or(PartError::Whole)?;
        if rows.part.len() != height as usize {
            return Err(PartError::Rows {
                rows: rows.part,
                found: height,
            });
        }
        Ok(Self {
            width,
            rows,
            pixels,
        })
    }
}

/// Width, height, the note about the rows, and the pixels of a picture.
type ReadPicture = (u32, u32, Option<String>, Vec<u8>);

fn read_png(input: impl BufRead + io::Seek) -> Result<ReadPicture, PartError> {
    let mut reader = open_png(input)?;
    let pixels = pixels(&mut reader)?;
    let info = reader.info();
    Ok((info.width, info.height, text(info, Rows::KEYWORD), pixels))
}

fn wrong_png(error: png::DecodingError) -> PartError {
    match error {
        png::DecodingError::IoError(error) => PartError::Read(error),
        error => PartError::Png(error.to_string()),
    }
}

/// Reads a PNG up to its pixels.
fn open_png<R: BufRead + io::Seek>(input: R) -> Result<png::Reader<R>, PartError> {
    let reader = png::Decoder::new(input).read_info().map_err(wrong_png)?;
    if reader.output_color_type() != (png::ColorType::Rgb, png::BitDepth::Eight) {
        let found = reader.output_color_type();
        return Err(PartError::Png(format!("its pixels are {found:?}")));
    }
    if reader.info().interlaced {
        return Err(PartError::Png(String::from("it is interlaced")));
    }
    Ok(reader)
}

/// The pixels of a PNG.
fn pixels<R: BufRead + io::Seek>(reader: &mut png::Reader<R>) -> Result<Vec<u8>, PartError> {
    // Row by row, because the header may claim more than there is.
    let mut pixels = Vec::new();
    while let Some(row) = reader.next_row().map_err(wrong_png)? {
        pixels.extend(row.data());
    }
    Ok(pixels)
}

/// The text of a PNG that stands under a keyword.
fn text(info: &png::Info<'_>, keyword: &str) -> Option<String> {
    let mut texts = info.uncompressed_latin1_text.iter();
    let chunk = texts.find(|chunk| chunk.keyword == keyword)?;
    Some(chunk.text.clone())
}

/// Bytes of the longest line of a PPM's header.
const LONGEST_LINE: u64 = 256;

fn read_ppm(mut input: impl BufRead) -> Result<ReadPicture, PartError> {
    let mut note = None;
    let mut words = Vec::new();
    while words.len() < 4 {
        let mut line = Vec::new();
        input
            .by_ref()
            .take(LONGEST_LINE)
            .read_until(b'\n', &mut line)?;
        let is_cut =
            line.len() < LONGEST_LINE as usize && words.first().is_some_and(|it| it == "P6");
        let line = String::from_utf8(line).map_err(|_| PartError::Ppm)?;
        let text = line.strip_suffix('\n').ok_or(match is_cut {
            true => PartError::Header,
            false => PartError::Ppm,
        })?;
        match text.strip_prefix("# rows ") {
            Some(rows) => note = Some(rows.to_owned()),
            None if text.starts_with('#') => {}
            None => words.extend(text.split_ascii_whitespace().map(str::to_owned)),
        }
    }
    let number = |word: &String| word.parse::<u16>().ok().filter(|&it| it > 0);
    let ([magic, width, height, white], Some(_)) = (&words[..], words.get(3)) else {
        return Err(PartError::Ppm);
    };
    let (Some(width), Some(height), "P6", "255") = (
        number(width),
        number(height),
        magic.as_str(),
        white.as_str(),
    ) else {
        return Err(PartError::Ppm);
    };
    let size = 3 * u64::from(width) * u64::from(height);
    let mut pixels = Vec::new();
    input.take(size + 1).read_to_end(&mut pixels)?;
    let found = pixels.len() as u64;
    match found.cmp(&size) {
        Ordering::Less => {
            return Err(PartError::Truncated {
                expected: size,
                found,
            });
        }
        Ordering::Equal => {}
        Ordering::Greater => return Err(PartError::TooLong { expected: size }),
    }
    Ok((width.into(), height.into(), note, pixels))
}

/// A picture whose rows come part by part.
///
/// ```
/// # use gridel_host::compile::{Options, compile};
/// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
/// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// # let blob = compile(&imported.scene, &Options::default())?.blob;
/// # let scene = blob.scene()?;
/// use gridel_core::{Format, Settings, Structure};
/// use gridel_host::merge::{Merge, Part};
/// use gridel_host::picture::{PictureFormat, RenderMetadata};
/// use gridel_host::render::{Job, render};
///
/// let settings = Settings { width: 16, height: 12, ..Settings::of(&scene) };
/// let mut job = Job::whole(Format::F32, Structure::DualSplit, settings);
/// let mut merge = Merge::default();
/// for rows in [0..5, 5..12] {
///     job.rows = rows;
///     let mut file = Vec::new();
///     let metadata = RenderMetadata::of(&scene, &job);
///     PictureFormat::Png.write(&mut file, &render(&scene, &job, &|| ())?, &metadata)?;
///     merge.add(&Part::read(PictureFormat::Png, std::io::Cursor::new(file))?)?;
/// }
/// assert_eq!(merge.size(), Some([16, 12]));
/// merge.finish()?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Default)]
pub struct Merge {
    /// Width and height, once there is a part.
    size: Option<[u32; 2]>,
    /// The metadata of the first part.
    made: Vec<(String, String)>,
    /// For each row, the part that it came with, and its pixels.
    rows: Vec<Option<(usize, Vec<u8>)>>,
    parts: usize,
}

impl Merge {
    /// Adds a part.
    ///
    /// # Errors
    /// If the part is of a picture of another size, if it was made in another way, or if a row differs from another
    /// part's.
    pub fn add(&mut self, part: &Part) -> Result<(), MergeError> {
        let number = self.parts;
        self.parts += 1;
        let size = [part.width, u32::from(part.rows.height)];
        let known = *self.size.get_or_insert(size);
        if known != size {
            return Err(MergeError::Sizes([0, number], [known, size]));
        }
        if number == 0 {
            self.made.clone_from(&part.rows.made);
        } else if let Some(differs) = difference(&self.made, &part.rows.made) {
            return Err(MergeError::Made([0, number], differs));
        }
        self.rows.resize(size[1] as usize, None);
        let pixels = part.pixels.chunks_exact(3 * part.width as usize);
        for (row, pixels) in part.rows.part.clone().zip(pixels) {
            match &mut self.rows[usize::from(row)] {
                Some((other, theirs)) if theirs != pixels => {
                    return Err(MergeError::Differ([*other, number], row.into()));
                }
                Some(_) => {}
                empty => *empty = Some((number, pixels.to_vec())),
            }
        }
        Ok(())
    }

    /// Width and height of the whole picture, once there is a part.
    pub fn size(&self) -> Option<[u32; 2]> {
        self.size
    }

    /// Returns the pixels of the whole picture.
    ///
    /// # Errors
    /// If rows are missing.
    pub fn finish(self) -> Result<Whole, MergeError> {
        let missing = |row: &Option<_>| row.is_none();
        if let Some(first) = self.rows.iter().position(missing) {
            let behind = self.rows[first..].iter().take_while(|row| missing(row));
            let end = first + behind.count();
            return Err(MergeError::Missing(first as u32..end as u32));
        }
        let pixels = self
            .rows
            .into_iter()
            .flatten()
            .flat_map(|(_, pixels)| pixels);
        Ok(Whole {
            size: self.size.unwrap_or_default(),
            pixels: pixels.collect(),
        })
    }
}

/// The first thing in which two pictures were made differently, as it is in each. Things are compared by their names.
fn difference(one: &[(String, String)], other: &[(String, String)]) -> Option<[String; 2]> {
    let value = |of: &[(String, String)], wanted: &str| {
        let mut pairs = of.iter().filter(|(name, _)| name == wanted);
        pairs.next().map(|(_, value)| value.clone())
    };
    let shown = |of: &[(String, String)], name: &str| {
        let value = value(of, name);
        value.map_or_else(|| format!("no {name}"), |it| made_with(name, &it))
    };
    let mut names = one.iter().chain(other).map(|(name, _)| name.as_str());
    let name = names.find(|name| value(one, name) != value(other, name))?;
    Some([shown(one, name), shown(other, name)])
}

/// A name and a value, with times in seconds.
fn made_with(name: &str, value: &str) -> String {
    let ticks = match name {
        "time" | "shutter" => value.parse::<i64>().ok(),
        _ => None,
    };
    match ticks {
        // A tick is 0.00002 s long.
        Some(ticks) => {
            let seconds = ticks as f64 / f64::from(TICKS_PER_SECOND);
            format!("{name} {} s", (seconds * 1e6).round() / 1e6)
        }
        None => format!("{name} {value}"),
    }
}

/// A picture that is whole again.
#[derive(Debug)]
pub struct Whole {
    pub size: [u32; 2],
    pixels: Vec<u8>,
}

impl Whole {
    /// Writes the bytes that one machine would have written.
    ///
    /// # Errors
    /// If `out` has one.
    pub fn write(&self, format: PictureFormat, out: &mut dyn Write) -> io::Result<()> {
        let [width, height] = self.size;
        match format {
            PictureFormat::Png => write_png(out, self.size, &self.pixels, None),
            _ => {
                write!(out, "P6\n{width} {height}\n255\n")?;
                out.write_all(&self.pixels)
            }
        }
    }
}

impl fmt::Display for MergeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            MergeError::Sizes(_, sizes) => f.write_str(&different_sizes(*sizes)),
            MergeError::Made(_, made) => f.write_str(&made_differently(made)),
            MergeError::Differ(_, row) => write!(f, "they have different pixels in row {row}"),
            MergeError::Missing(rows) => {
                write!(f, "no part has the rows {}..{}", rows.start, rows.end)
            }
        }
    }
}

impl std::error::Error for MergeError {}

/// Says that two pictures have different sizes.
fn different_sizes([one, other]: [[u32; 2]; 2]) -> String {
    format!(
        "one is of a picture of {}x{} pixels, the other of {}x{}",
        one[0], one[1], other[0], other[1]
    )
}

/// Says that two pictures were made differently.
fn made_differently([one, other]: &[String; 2]) -> String {
    format!("one was made with {one}, the other with {other}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_found_by_name_and_times_are_in_seconds() {
        let made = |text: &str| {
            let pairs = text.split(", ").filter_map(|pair| pair.split_once(' '));
            let pairs = pairs.map(|(name, value)| (name.to_owned(), value.to_owned()));
            pairs.collect::<Vec<_>>()
        };
        let plain = made("blob dcde075e, samples 4");
        let blurred = made("shutter 4800, moments 16, blob dcde075e, samples 4");
        let at = |ticks: &str| made(&format!("time {ticks}, blob dcde075e, samples 4"));
        let found = |one, other| difference(one, other).map(|it| it.join("; "));
        assert_eq!(found(&plain, &plain), None);
        assert_eq!(
            found(&plain, &blurred).as_deref(),
            Some("no shutter; shutter 0.1 s")
        );
        assert_eq!(
            found(&blurred, &plain).as_deref(),
            Some("shutter 0.1 s; no shutter")
        );
        assert_eq!(
            found(&at("24000"), &at("24001")).as_deref(),
            Some("time 0.5 s; time 0.500021 s")
        );
    }
}
