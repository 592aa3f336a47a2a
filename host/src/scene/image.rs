//! Images for textures: PNG and JPEG.

use super::error::CauseAndRemedy;
use crate::srgb::linear_of_srgb;
use std::fmt;
use std::io::Cursor;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Extensions of the files of textures and environments. Their content decides how they are read.
pub const IMAGE_EXTENSIONS: &[&str] = if cfg!(feature = "exr") {
    &["png", "jpg", "jpeg", "hdr", "exr"]
} else {
    &["png", "jpg", "jpeg", "hdr"]
};

/// Most texels of an image that is read: 8192 by 8192.
const MOST_TEXELS: usize = 1 << 26;
/// Most texels of all images of a scene: two gigabytes.
const MOST_TEXELS_OF_ALL: usize = 1 << 29;
/// Most texels of a side of an image that is read.
const MOST_SIDE: usize = 1 << 15;

/// An image of 8 bits per channel, in sRGB.
#[derive(Clone, PartialEq, Eq)]
pub struct Image {
    /// Its source, for messages.
    pub name: String,
    width: u32,
    height: u32,
    pixels: Vec<[u8; 4]>,
    /// Found once: many materials may share an image.
    is_opaque: bool,
}

impl fmt::Debug for Image {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            name,
            width,
            height,
            ..
        } = self;
        write!(f, "Image({name:?}, {width}x{height})")
    }
}

impl Image {
    /// Makes an image from pixels row by row, the upper row first: red, green, blue and alpha in sRGB. `None` unless
    /// there are as many pixels as that, and at least one.
    ///
    /// ```
    /// use gridel_host::scene::Image;
    ///
    /// assert!(Image::new("two", 2, 1, vec![[0; 4]; 2]).is_some());
    /// assert!(Image::new("two", 2, 2, vec![[0; 4]; 2]).is_none());
    /// ```
    pub fn new(name: &str, width: u32, height: u32, pixels: Vec<[u8; 4]>) -> Option<Self> {
        let count = (width as usize).checked_mul(height as usize)?;
        (count > 0 && count == pixels.len()).then(|| Self {
            name: String::from(name),
            width,
            height,
            is_opaque: pixels.iter().all(|pixel| pixel[3] == 255),
            pixels,
        })
    }

    /// Returns an image of one white pixel.
    pub(crate) fn blank() -> Self {
        Self {
            name: String::new(),
            width: 1,
            height: 1,
            pixels: vec![[255; 4]],
            is_opaque: true,
        }
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// Pixels row by row, the upper row first: red, green, blue and alpha in sRGB.
    pub fn pixels(&self) -> &[[u8; 4]] {
        &self.pixels
    }

    /// Returns the mean of all pixels, as linear light.
    ///
    /// ```
    /// use gridel_host::scene::Image;
    ///
    /// let image = Image::new("half", 2, 1, vec![[0, 0, 0, 255], [255, 0, 255, 255]]).unwrap();
    /// assert_eq!(image.mean(), [0.5, 0.0, 0.5]);
    /// ```
    pub fn mean(&self) -> [f64; 3] {
        let mut counts = [[0_u64; 256]; 3];
        for pixel in &self.pixels {
            for (counts, channel) in counts.iter_mut().zip(pixel) {
                counts[usize::from(*channel)] += 1;
            }
        }
        counts.map(|counts| {
            let linear = |value: usize| linear_of_srgb(value as f64 / 255.0);
            let sum = counts.iter().enumerate();
            let sum: f64 = sum
                .map(|(value, &count)| count as f64 * linear(value))
                .sum();
            sum / self.pixels.len() as f64
        })
    }

    /// Returns the mean of the red channel, 0 to 1, for images of numbers rather than of light.
    pub(super) fn mean_of_red(&self) -> f64 {
        let sum: u64 = self.pixels.iter().map(|&[red, ..]| u64::from(red)).sum();
        sum as f64 / (255.0 * self.pixels.len() as f64)
    }

    /// Returns the image of normals that has the other sign along u and v: 0 is -1 there, and 255 is 1.
    pub(super) fn turned(&self) -> Self {
        let turn = |&[red, green, blue, alpha]: &[u8; 4]| [255 - red, 255 - green, blue, alpha];
        Self {
            pixels: self.pixels.iter().map(turn).collect(),
            name: self.name.clone(),
            ..*self
        }
    }

    /// Returns whether every pixel is opaque.
    ///
    /// ```
    /// use gridel_host::scene::Image;
    ///
    /// let image = Image::new("half", 2, 1, vec![[0, 0, 0, 255], [0, 0, 0, 254]]).unwrap();
    /// assert!(!image.is_opaque());
    /// ```
    pub fn is_opaque(&self) -> bool {
        self.is_opaque
    }

    /// Reads a PNG or JPEG file, by its content, for a scene whose images are counted.
    pub(super) fn decode(
        name: &str,
        bytes: &[u8],
        texels: &Texels,
    ) -> Result<Self, CauseAndRemedy> {
        let (width, height, pixels) = if bytes.starts_with(b"\x89PNG\r\n\x1a\n") {
            png(bytes, texels)?
        } else if bytes.starts_with(b"\xff\xd8") {
            jpeg(bytes, texels)?
        } else {
            return Err(CauseAndRemedy::new(
                "is neither PNG nor JPEG",
                "convert it to PNG or JPEG",
            ));
        };
        Self::new(name, width as u32, height as u32, pixels)
            .ok_or_else(|| CauseAndRemedy::new("has no pixels", "save the image again"))
    }
}

/// Width, height and pixels.
type Decoded = (usize, usize, Vec<[u8; 4]>);

/// The texels that all images of a scene have together.
#[derive(Clone, Debug, Default)]
pub(super) struct Texels(Arc<AtomicUsize>);

impl Texels {
    /// Counts an image before memory is taken for it.
    ///
    /// # Errors
    /// If it is too large, alone or with those before it.
    pub(super) fn add(&self, width: usize, height: usize) -> Result<(), CauseAndRemedy> {
        let texels = width.saturating_mul(height);
        if width > MOST_SIDE || height > MOST_SIDE || texels > MOST_TEXELS {
            return Err(CauseAndRemedy::new(
                format!(
                    "has {width}x{height} pixels; at most {MOST_TEXELS} are read, and {MOST_SIDE} along a side"
                ),
                "make the image smaller",
            ));
        }
        if self.0.fetch_add(texels, Ordering::Relaxed) + texels > MOST_TEXELS_OF_ALL {
            return Err(CauseAndRemedy::new(
                format!(
                    "has {width}x{height} pixels, and with them the images of the scene have more than {MOST_TEXELS_OF_ALL}"
                ),
                "make the images smaller, or use fewer",
            ));
        }
        Ok(())
    }
}

fn png(bytes: &[u8], texels: &Texels) -> Result<Decoded, CauseAndRemedy> {
    let broken = |error: png::DecodingError| {
        CauseAndRemedy::new(format!("is broken: {error}"), "save the image again as PNG")
    };
    let limits = png::Limits {
        bytes: 8 * MOST_TEXELS,
    };
    let mut decoder = png::Decoder::new_with_limits(Cursor::new(bytes), limits);
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(broken)?;
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    texels.add(width, height)?;
    let size = reader
        .output_buffer_size()
        .ok_or_else(|| CauseAndRemedy::new("is too large", "make the image smaller"))?;
    let mut buffer = vec![0; size];
    let info = reader.next_frame(&mut buffer).map_err(broken)?;
    buffer.truncate(info.buffer_size());
    if info.bit_depth == png::BitDepth::Sixteen {
        let channels = buffer.as_chunks().0.iter();
        let channels =
            channels.map(|&it| (f64::from(u16::from_be_bytes(it)) / 257.0).round() as u8);
        buffer = channels.collect();
    }
    let pixels = buffer.chunks_exact(info.color_type.samples());
    Ok((width, height, pixels.map(pixel).collect()))
}

fn jpeg(bytes: &[u8], texels: &Texels) -> Result<Decoded, CauseAndRemedy> {
    use zune_jpeg::zune_core::bytestream::ZCursor;
    use zune_jpeg::zune_core::colorspace::ColorSpace;
    use zune_jpeg::zune_core::options::DecoderOptions;
    let broken = |error: zune_jpeg::errors::DecodeErrors| {
        let remedy = "save the image again as a baseline or progressive JPEG, or as PNG";
        CauseAndRemedy::new(format!("is broken: {error}"), remedy)
    };
    // Without instructions that only some machines have, so that all decode the same bits.
    let options = DecoderOptions::default()
        .set_use_unsafe(false)
        .set_strict_mode(true)
        .set_max_width(MOST_SIDE)
        .set_max_height(MOST_SIDE)
        .jpeg_set_out_colorspace(ColorSpace::RGB);
    let mut decoder = zune_jpeg::JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers().map_err(broken)?;
    let (width, height) = decoder
        .dimensions()
        .ok_or_else(|| CauseAndRemedy::new("has no size", "save the image again"))?;
    texels.add(width, height)?;
    let buffer = decoder.decode().map_err(broken)?;
    let channels = buffer.len() / (width * height).max(1);
    if !(1..=4).contains(&channels) {
        return Err(CauseAndRemedy::new(
            "is cut short",
            "copy the file again, as binary",
        ));
    }
    Ok((
        width,
        height,
        buffer.chunks_exact(channels).map(pixel).collect(),
    ))
}

/// A pixel of gray, or red, green and blue, with alpha or without.
fn pixel(channels: &[u8]) -> [u8; 4] {
    match *channels {
        [gray] => [gray, gray, gray, 255],
        [gray, alpha] => [gray, gray, gray, alpha],
        [red, green, blue] => [red, green, blue, 255],
        [red, green, blue, alpha, ..] => [red, green, blue, alpha],
        [] => [0; 4],
    }
}

#[cfg(test)]
pub(crate) mod tests;
