//! Picture files: from linear pixels to PNG, PPM or the raw 16-bit pixels of small displays.

mod metadata;

pub use metadata::{Exposure, Frame, FrameNote, Moment, RenderMetadata, Rows};

use crate::render::Picture;
use gridel_core::render::Pixel;
use gridel_core::{Rgb565, Rgb888};
use std::io::{self, Write};
use std::path::Path;

/// Returns a hash of a picture in hexadecimal: 64-bit FNV-1a over its linear channels of 16 bits. The lower byte comes
/// first, red before green before blue, row by row.
///
/// ```
/// use gridel_host::picture::hash;
///
/// assert_eq!(hash(&[]), "cbf29ce484222325");
/// assert_ne!(hash(&[[0; 3]]), hash(&[[1; 3]]));
/// ```
pub fn hash(pixels: &[[u16; 3]]) -> String {
    let channels = pixels.iter().flatten();
    let bytes = channels.flat_map(|channel| channel.to_le_bytes());
    let hash = bytes.fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    });
    format!("{hash:016x}")
}

/// A file format of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureFormat {
    /// PNG, 8 bits per channel, sRGB.
    Png,
    /// The binary portable pixmap `P6`, 8 bits per channel, sRGB.
    Ppm,
    /// Two bytes per pixel, little-endian, without a header: 5 bits of red (the uppermost), 6 of
    /// green, 5 of blue, sRGB.
    Rgb565,
}

impl PictureFormat {
    /// Returns the format that a file's extension names: `png`, `ppm` or `rgb565`.
    ///
    /// ```
    /// use gridel_host::picture::PictureFormat;
    ///
    /// assert_eq!(PictureFormat::of("a.PNG".as_ref()), Some(PictureFormat::Png));
    /// assert_eq!(PictureFormat::of("a.jpg".as_ref()), None);
    /// ```
    pub fn of(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        match extension.as_str() {
            "png" => Some(Self::Png),
            "ppm" => Some(Self::Ppm),
            "rgb565" => Some(Self::Rgb565),
            _ => None,
        }
    }

    /// Writes a picture. Dithering depends on a pixel's place in the whole picture, so rows that are rendered
    /// separately match.
    ///
    /// # Errors
    /// If `out` has one.
    pub fn write(
        self,
        out: &mut dyn Write,
        picture: &Picture,
        metadata: &RenderMetadata,
    ) -> io::Result<()> {
        let dither = metadata.dither;
        let size = [picture.width.into(), picture.rows.len() as u32];
        match self {
            Self::Png => {
                let pixels: Vec<Rgb888> = encoded(picture, dither);
                let rows =
                    Rows::of(picture, metadata).map(|rows| (Rows::KEYWORD, rows.to_string()));
                let frame =
                    FrameNote::of(metadata).map(|note| (FrameNote::KEYWORD, note.to_string()));
                write_png(out, size, bytemuck::cast_slice(&pixels), rows.or(frame))
            }
            Self::Ppm => {
                let pixels: Vec<Rgb888> = encoded(picture, dither);
                writeln!(out, "P6")?;
                if let Some(rows) = Rows::of(picture, metadata) {
                    writeln!(out, "# rows {rows}")?;
                }
                write!(out, "{} {}\n255\n", size[0], size[1])?;
                out.write_all(bytemuck::cast_slice(&pixels))
            }
            Self::Rgb565 => {
                let pixels: Vec<Rgb565> = encoded(picture, dither);
                let bytes: Vec<u8> = pixels.iter().flat_map(|p| p.0.to_le_bytes()).collect();
                out.write_all(&bytes)
            }
        }
    }
}

/// Converts a picture to sRGB, three bytes per pixel.
pub fn srgb(picture: &Picture, dither: bool) -> Vec<u8> {
    let pixels: Vec<Rgb888> = encoded(picture, dither);
    bytemuck::cast_slice(&pixels).to_vec()
}

/// Converts linear pixels to sRGB, three bytes each, without dithering.
pub fn srgb_of(pixels: &[[u16; 3]]) -> Vec<u8> {
    let pixels = pixels.iter();
    pixels.flat_map(|&it| Rgb888::encode(it, None).0).collect()
}

fn encoded<P: Pixel>(picture: &Picture, dither: bool) -> Vec<P> {
    let rows = picture.pixels.chunks(picture.width.into());
    let places = picture
        .rows
        .clone()
        .zip(rows)
        .flat_map(|(y, row)| (0..).zip(row).map(move |(x, &linear)| ([x, y], linear)));
    places
        .map(|(place, linear)| P::encode(linear, dither.then_some(place)))
        .collect()
}

/// Writes sRGB pixels, three bytes each, as PNG; with a text and its keyword if there is one.
///
/// # Errors
/// If `out` has one.
///
/// ```
/// let mut file = Vec::new();
/// let red_and_blue = [255, 0, 0, 0, 0, 255];
/// gridel_host::picture::write_png(&mut file, [2, 1], &red_and_blue, None)?;
/// assert!(file.starts_with(b"\x89PNG"));
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn write_png(
    out: &mut dyn Write,
    [width, height]: [u32; 2],
    pixels: &[u8],
    text: Option<(&str, String)>,
) -> io::Result<()> {
    let mut encoder = png::Encoder::new(out, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
    let write = || {
        if let Some((keyword, text)) = text {
            encoder.add_text_chunk(keyword.to_owned(), text)?;
        }
        let mut writer = encoder.write_header()?;
        writer.write_image_data(pixels)?;
        writer.finish()
    };
    write().map_err(png_error)
}

/// The error of a file that cannot be written as PNG; that of the system as it is, so that a full disk is known as one.
pub(crate) fn png_error(error: png::EncodingError) -> io::Error {
    match error {
        png::EncodingError::IoError(error) => error,
        error => error.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gridel_core::Format;

    fn ramp(rows: std::ops::Range<u16>) -> Picture {
        let pixels = rows
            .clone()
            .flat_map(|y| (0..16).map(move |x| [4096 * x, 7000 + 100 * y, 60_000 - 3000 * x]))
            .collect();
        Picture {
            width: 16,
            height: 9,
            rows,
            pixels,
            counters: None,
            work: Vec::new(),
        }
    }

    fn written(format: PictureFormat, picture: &Picture, dither: bool) -> Vec<u8> {
        let mut bytes = Vec::new();
        let metadata = RenderMetadata {
            view: 7,
            blob: 0xab,
            format: Format::F32,
            samples: 4,
            depth: 5,
            dither,
            moment: None,
            exposure: None,
            is_part: false,
        };
        format.write(&mut bytes, picture, &metadata).unwrap();
        bytes
    }

    #[test]
    fn png_and_ppm_hold_the_same_pixels() {
        let picture = ramp(0..5);
        let ppm = written(PictureFormat::Ppm, &picture, false);
        let made = "blob 000000ab, view 00000007, format f32, samples 4, depth 5, dither off";
        let version = env!("CARGO_PKG_VERSION");
        let header = format!("P6\n# rows 0..5 of 9; {made}, gridel {version}\n16 5\n255\n");
        let pixels = ppm.strip_prefix(header.as_bytes()).unwrap();
        let png = written(PictureFormat::Png, &picture, false);
        let mut reader = png::Decoder::new(io::Cursor::new(png)).read_info().unwrap();
        assert!(reader.info().srgb.is_some());
        let mut decoded = vec![0; 16 * 5 * 3];
        reader.next_frame(&mut decoded).unwrap();
        assert_eq!(decoded, pixels);
    }

    #[test]
    fn dithered_rows_match_the_whole() {
        for format in [PictureFormat::Ppm, PictureFormat::Rgb565] {
            let whole = written(format, &ramp(0..9), true);
            let part = written(format, &ramp(3..6), true);
            let row = match format {
                PictureFormat::Rgb565 => 32,
                _ => 48,
            };
            let headers = [whole.len() - 9 * row, part.len() - 3 * row];
            assert_eq!(part[headers[1]..], whole[headers[0] + 3 * row..][..3 * row]);
            assert_ne!(whole, written(format, &ramp(0..9), false));
        }
    }

    #[test]
    fn pixels_of_displays_are_little_endian() {
        let mut picture = ramp(0..1);
        picture.pixels = vec![[65535, 0, 0]; 16];
        assert_eq!(
            written(PictureFormat::Rgb565, &picture, false),
            [0x00, 0xf8].repeat(16)
        );
    }
}
