//! Picture files: from linear pixels to PNG, PPM or the raw 16-bit pixels of small displays.

use crate::render::{Job, Picture};
use gridel_core::render::Pixel;
use gridel_core::{Format, Rgb565, Rgb888, Scene};
use std::fmt;
use std::io::{self, Write};
use std::ops::Range;
use std::path::Path;
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
    /// For a scene that moves.
    pub moment: Option<Moment>,
    /// For a picture in which motion is blurred.
    pub exposure: Option<Exposure>,
}

/// How long a shutter is open, in ticks of the blob's tracks, and at how many moments of that time samples are taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exposure {
    pub open: u32,
    pub moments: u16,
}

/// When a picture of a scene that moves is taken.
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
    /// Counted from 0, which is at time 0.
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

    fn of(metadata: &RenderMetadata) -> Option<Self> {
        let Some(Moment::Frame(frame)) = metadata.moment else {
            return None;
        };
        Some(Self {
            frame,
            made: pairs(&metadata.to_string()).unwrap_or_default(),
        })
    }
}

impl fmt::Display for FrameNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Frame { number, per_second } = self.frame;
        write!(f, "{number} at {per_second} per second")?;
        write_pairs(f, &self.made)
    }
}

impl FromStr for FrameNote {
    type Err = ();

    fn from_str(text: &str) -> Result<Self, ()> {
        let (frame, made) = text.split_once("; ").ok_or(())?;
        let (number, rate) = frame.split_once(" at ").ok_or(())?;
        let rate = rate.strip_suffix(" per second").ok_or(())?;
        let frame = Frame {
            number: number.parse().map_err(|_| ())?,
            per_second: rate.parse().map_err(|_| ())?,
        };
        let made = pairs(made).filter(|_| frame.per_second > 0).ok_or(())?;
        Ok(Self { frame, made })
    }
}

/// Writes names and values behind the text so far.
fn write_pairs(f: &mut fmt::Formatter<'_>, pairs: &[(String, String)]) -> fmt::Result {
    for (number, (name, value)) in pairs.iter().enumerate() {
        let before = if number == 0 { "; " } else { ", " };
        write!(f, "{before}{name} {value}")?;
    }
    Ok(())
}

impl RenderMetadata {
    /// How a job's picture of a scene is made.
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

/// Names and values, and the version of this program, whose arithmetic it is.
impl fmt::Display for RenderMetadata {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            blob,
            view,
            format,
            samples,
            depth,
            dither,
            moment,
            exposure,
        } = self;
        if let Some(Moment::Time(ticks)) = moment {
            write!(f, "time {ticks}, ")?;
        }
        if let Some(Exposure { open, moments }) = exposure {
            write!(f, "shutter {open}, moments {moments}, ")?;
        }
        write!(
            f,
            "blob {blob:08x}, view {view:08x}, format {}, samples {samples}, depth {depth}, dither {}, gridel {}",
            format.name(),
            if *dither { "on" } else { "off" },
            env!("CARGO_PKG_VERSION")
        )
    }
}

/// The rows of a picture that a file has, as PNG and PPM files of a part state them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rows {
    /// The rows, from the top.
    pub part: Range<u16>,
    /// Height of the whole picture.
    pub height: u16,
    /// How the picture was made: names and values, as [`RenderMetadata`] shows them.
    pub made: Vec<(String, String)>,
}

impl Rows {
    /// Keyword of the text in PNG files.
    pub const KEYWORD: &str = "Rows";

    /// The rows of a part; `None` for a whole picture.
    fn of(picture: &Picture, metadata: &RenderMetadata) -> Option<Self> {
        let (part, height) = (picture.rows.clone(), picture.height);
        (part != (0..height)).then(|| Self {
            part,
            height,
            made: pairs(&metadata.to_string()).unwrap_or_default(),
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
        write_pairs(f, made)
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

/// How a picture is stored.
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
    /// The format that a file's extension names: `png`, `ppm` or `rgb565`.
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

/// A picture as sRGB, three bytes per pixel.
pub fn srgb(picture: &Picture, dither: bool) -> Vec<u8> {
    let pixels: Vec<Rgb888> = encoded(picture, dither);
    bytemuck::cast_slice(&pixels).to_vec()
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
    write().map_err(|error| match error {
        // As it is, so that a full disk is still known as one.
        png::EncodingError::IoError(error) => error,
        error => error.into(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

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
