//! Pictures as people compare them: 8 bits per channel, side by side.

use crate::picture::{srgb, write_png};
use crate::render;
use std::fs::File;
use std::io::{self, BufReader, Write};
use std::path::Path;

/// A picture in sRGB, three bytes per pixel, row by row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    pub size: [u32; 2],
    pub pixels: Vec<u8>,
}

/// The difference of two pictures of one size.
pub(super) struct Difference {
    /// The most that any channel differs, in codes of 255.
    pub(super) largest: u8,
    /// Pixels with a channel that differs by more than the tolerance.
    pub(super) beyond: u64,
}

impl Image {
    /// A picture as it is written to a file without dithering.
    pub(super) fn of(picture: &render::Picture) -> Self {
        Self {
            size: [picture.width.into(), picture.rows.len() as u32],
            pixels: srgb(picture, false),
        }
    }

    /// Reads a PNG of one to four channels of 8 bits without transparent pixels.
    ///
    /// # Errors
    /// If the file cannot be read, or is no such picture.
    pub fn read(path: &Path) -> io::Result<Self> {
        let file = File::open(path)?;
        // A picture in memory may take this much, however small its file is.
        let limits = png::Limits { bytes: 1 << 29 };
        let decoder = png::Decoder::new_with_limits(BufReader::new(file), limits);
        let mut reader = decoder.read_info()?;
        let channels = match reader.output_color_type() {
            (png::ColorType::Grayscale, png::BitDepth::Eight) => 1,
            (png::ColorType::GrayscaleAlpha, png::BitDepth::Eight) => 2,
            (png::ColorType::Rgb, png::BitDepth::Eight) => 3,
            (png::ColorType::Rgba, png::BitDepth::Eight) => 4,
            (color, depth) => {
                return Err(io::Error::other(format!(
                    "it has {color:?} pixels of {depth:?} bits, and only RGB and gray of 8 bits per channel are \
                     compared"
                )));
            }
        };
        let bytes = reader
            .output_buffer_size()
            .filter(|&bytes| bytes <= limits.bytes);
        let mut pixels = vec![0; bytes.ok_or_else(|| io::Error::other("it is too large"))?];
        let frame = reader.next_frame(&mut pixels)?;
        if matches!(channels, 2 | 4)
            && pixels
                .chunks_exact(channels)
                .any(|it| it[channels - 1] < 255)
        {
            return Err(io::Error::other(
                "it has transparent pixels, and rendered pictures have none; save it without transparency",
            ));
        }
        let pixels = pixels
            .chunks_exact(channels)
            .flat_map(|pixel| match *pixel {
                [gray] | [gray, _] => [gray; 3],
                [red, green, blue, ..] => [red, green, blue],
                [] => [0; 3],
            });
        Ok(Self {
            size: [frame.width, frame.height],
            pixels: pixels.collect(),
        })
    }

    /// Writes the picture as PNG.
    ///
    /// # Errors
    /// If `out` has one.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        write_png(out, self.size, &self.pixels, None)
    }

    /// Returns the difference from another picture; `None` if the sizes differ.
    pub(super) fn difference(&self, other: &Self, allowed: u8) -> Option<Difference> {
        if self.size != other.size {
            return None;
        }
        let (mut largest, mut beyond) = (0, 0);
        for (a, b) in self
            .pixels
            .chunks_exact(3)
            .zip(other.pixels.chunks_exact(3))
        {
            let apart = a
                .iter()
                .zip(b)
                .map(|(a, b)| a.abs_diff(*b))
                .max()
                .unwrap_or(0);
            largest = largest.max(apart);
            beyond += u64::from(apart > allowed);
        }
        Some(Difference { largest, beyond })
    }

    /// Returns the expected picture, the rendered one and their differences side by side: differences are
    /// stretched so that the largest is white. Only the two where the sizes differ.
    ///
    /// # Errors
    /// If `out` has one.
    pub fn write_beside(&self, expected: &Self, out: &mut dyn Write) -> io::Result<()> {
        let mut panels = vec![expected, self];
        let mut text = String::from("From the left: what was expected, what was rendered");
        let apart;
        if let Some(Difference { largest, .. }) = self.difference(expected, 0) {
            let stretched =
                self.pixels.iter().zip(&expected.pixels).map(|(a, b)| {
                    (u32::from(a.abs_diff(*b)) * 255 / u32::from(largest.max(1))) as u8
                });
            apart = Self {
                size: self.size,
                pixels: stretched.collect(),
            };
            panels.push(&apart);
            text += &format!(", and the difference; white is {largest} of 255");
        }
        let height = panels.iter().map(|panel| panel.size[1]).max().unwrap_or(0);
        let width: u32 = panels.iter().map(|panel| panel.size[0]).sum();
        let mut pixels = Vec::with_capacity(3 * width as usize * height as usize);
        for y in 0..height as usize {
            for panel in &panels {
                let row = 3 * panel.size[0] as usize;
                match panel.pixels.get(y * row..(y + 1) * row) {
                    Some(bytes) => pixels.extend_from_slice(bytes),
                    None => pixels.resize(pixels.len() + row, 0),
                }
            }
        }
        write_png(out, [width, height], &pixels, Some(("Description", text)))
    }
}
