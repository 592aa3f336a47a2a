//! Animations: pictures that follow each other in one file.
//!
//! Pictures are encoded one after the other, as they come, so that memory does not grow with their number. The same
//! pictures give the same bytes, wherever they were rendered.

use crate::palette::{distance, median_cut, nearest};
use crate::picture::png_error;
use gif::{Encoder, Frame, Repeat};
use std::io::{self, Write};
use std::path::Path;

/// A file format of animations; all of them repeat without end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AnimationFormat {
    /// Animated PNG, 8 bits per channel, sRGB.
    Apng,
    /// GIF: each picture has a palette of 256 colors of its own, and times are hundredths of a second.
    Gif,
}

/// An animation: the size of its pictures, how many there are, and how many per second.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Animation {
    pub format: AnimationFormat,
    pub size: [u32; 2],
    /// At least 1.
    pub pictures: u32,
    /// At least 1.
    pub per_second: u16,
}

/// More pictures per second than programs show of a format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{} shows at most {} frames per second, and these are {per_second}",
    format.file(), format.most_per_second()
)]
pub struct TooFast {
    format: AnimationFormat,
    per_second: u16,
}

/// Makes a picture by its number, counted from 0: sRGB, three bytes per pixel.
pub type NextPicture<'p> = &'p mut dyn FnMut(u32) -> io::Result<Vec<u8>>;

impl AnimationFormat {
    /// Returns the format that a file's extension names: `apng` or `gif`.
    ///
    /// ```
    /// use gridel_host::animation::AnimationFormat;
    ///
    /// assert_eq!(AnimationFormat::of("a.GIF".as_ref()), Some(AnimationFormat::Gif));
    /// assert_eq!(AnimationFormat::of("a.png".as_ref()), None);
    /// ```
    pub fn of(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        match extension.as_str() {
            "apng" => Some(Self::Apng),
            "gif" => Some(Self::Gif),
            _ => None,
        }
    }

    /// Returns the most pictures per second that programs show.
    pub fn most_per_second(self) -> u16 {
        match self {
            Self::Apng => 1000,
            // Browsers slow down frames that are shown for less than two hundredths.
            Self::Gif => 50,
        }
    }

    /// Checks that programs show so many pictures per second.
    ///
    /// # Errors
    /// If it is more than [`Self::most_per_second`].
    pub fn check_rate(self, per_second: u16) -> Result<(), TooFast> {
        match per_second > self.most_per_second() {
            true => Err(TooFast {
                format: self,
                per_second,
            }),
            false => Ok(()),
        }
    }

    /// Returns the name of its files in a sentence.
    fn file(self) -> &'static str {
        match self {
            Self::Apng => "an .apng",
            Self::Gif => "a .gif",
        }
    }
}

impl Animation {
    /// Writes the animation; requests each picture once, in order.
    ///
    /// # Errors
    /// If `out` or a picture has one, or a picture has another size.
    ///
    /// ```
    /// use gridel_host::animation::{Animation, AnimationFormat};
    ///
    /// let animation = Animation {
    ///     format: AnimationFormat::Apng,
    ///     size: [2, 1],
    ///     pictures: 3,
    ///     per_second: 10,
    /// };
    /// let mut file = Vec::new();
    /// animation.write(&mut file, &mut |number| Ok(vec![number as u8; 6]))?;
    /// assert!(file.starts_with(b"\x89PNG"));
    /// # Ok::<(), std::io::Error>(())
    /// ```
    pub fn write(&self, out: &mut dyn Write, next: NextPicture<'_>) -> io::Result<()> {
        match self.format {
            AnimationFormat::Apng => self.write_apng(out, next),
            AnimationFormat::Gif => self.write_gif(out, next),
        }
    }

    fn write_apng(&self, out: &mut dyn Write, next: NextPicture<'_>) -> io::Result<()> {
        let [width, height] = self.size;
        let mut encoder = png::Encoder::new(out, width, height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
        encoder.set_animated(self.pictures, 0).map_err(png_error)?;
        encoder
            .set_frame_delay(1, self.per_second)
            .map_err(png_error)?;
        let mut writer = encoder.write_header().map_err(png_error)?;
        for number in 0..self.pictures {
            writer.write_image_data(&next(number)?).map_err(png_error)?;
        }
        writer.finish().map_err(png_error)
    }

    fn write_gif(&self, out: &mut dyn Write, next: NextPicture<'_>) -> io::Result<()> {
        let plain = |error: gif::EncodingError| match error {
            gif::EncodingError::Io(error) => error,
            error => io::Error::other(error),
        };
        let side = |side: u32| u16::try_from(side).map_err(io::Error::other);
        let (width, height) = (side(self.size[0])?, side(self.size[1])?);
        let mut encoder = Encoder::new(out, width, height, &[]).map_err(plain)?;
        encoder.set_repeat(Repeat::Infinite).map_err(plain)?;
        // Hundredths of a second until a picture, to nearest, so that the rate is right on average.
        let rate = u64::from(self.per_second.max(1));
        let time = |number: u32| (u64::from(number) * 100 + rate / 2) / rate;
        for number in 0..self.pictures {
            let pixels = next(number)?;
            if pixels.len() != 3 * usize::from(width) * usize::from(height) {
                return Err(io::Error::other("the pictures are not of one size"));
            }
            let mut frame = frame([width, height], &pixels);
            frame.delay = (time(number + 1) - time(number)) as u16;
            encoder.write_frame(&frame).map_err(plain)?;
        }
        Ok(())
    }
}

/// A frame of a GIF: all colors of a picture, or the 256 that show it better of two choices. Boxes are better for few
/// more colors, and the network of `color_quant` for many.
fn frame([width, height]: [u16; 2], pixels: &[u8]) -> Frame<'static> {
    /// Most colors of a frame.
    const COLORS: usize = 256;
    /// The network learns from so many pixels at least, or from all; and from one in ten at least.
    const LOOKED_AT: usize = 1 << 16;
    let (rgb, _) = pixels.as_chunks::<3>();
    let colors: Vec<[u8; 4]> = rgb.iter().map(|&[r, g, b]| [r, g, b, 255]).collect();
    let boxes = median_cut(&colors, COLORS);
    let palette: Vec<u8> = boxes.iter().flat_map(|&[r, g, b, _]| [r, g, b]).collect();
    let by_boxes = nearest(&boxes, &colors);
    let by_boxes = Frame::from_palette_pixels(width, height, by_boxes, palette, None);
    let error = |frame: &Frame<'_>| {
        let (palette, _) = frame
            .palette
            .as_deref()
            .unwrap_or_default()
            .as_chunks::<3>();
        let shown = frame.buffer.iter().map(|&number| {
            let [r, g, b] = palette
                .get(usize::from(number))
                .copied()
                .unwrap_or_default();
            [r, g, b, 255]
        });
        let errors = shown
            .zip(&colors)
            .map(|(shown, color)| distance(&shown, color));
        errors.map(u64::from).sum::<u64>()
    };
    let lost = error(&by_boxes);
    if lost == 0 {
        return by_boxes;
    }
    let speed = (colors.len() / LOOKED_AT).clamp(1, 10) as i32;
    let by_network = Frame::from_rgb_speed(width, height, pixels, speed);
    match error(&by_network) < lost {
        true => by_network,
        false => by_boxes,
    }
}

/// The name of numbered files, such as `out-%03d.png`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NumberedName {
    before: String,
    digits: usize,
    behind: String,
}

impl NumberedName {
    /// Reads a name with `%d`, or with `%0Nd` for at least `N` digits; `None` without one.
    ///
    /// # Errors
    /// If there are several, or the `%` has another meaning. The error gives the reason.
    ///
    /// ```
    /// use gridel_host::animation::NumberedName;
    ///
    /// let name = NumberedName::read("out-%03d.png")?.expect("a number");
    /// assert_eq!(name.of(7), "out-007.png");
    /// assert_eq!(name.of(12345), "out-12345.png");
    /// assert_eq!(NumberedName::read("out.png")?, None);
    /// # Ok::<(), String>(())
    /// ```
    pub fn read(name: &str) -> Result<Option<Self>, String> {
        let Some((before, rest)) = name.split_once('%') else {
            return Ok(None);
        };
        let number = rest.split_once('d').and_then(|(digits, behind)| {
            let digits = match digits {
                "" => 1,
                _ => digits
                    .strip_prefix('0')?
                    .parse()
                    .ok()
                    .filter(|it| *it <= 9)?,
            };
            Some((digits, behind))
        });
        match number {
            Some((digits, behind)) if !behind.contains('%') => Ok(Some(Self {
                before: before.to_owned(),
                digits,
                behind: behind.to_owned(),
            })),
            Some(_) => Err(String::from("the name has more than one `%`")),
            None => {
                let is_digit = |it: &char| it.is_ascii_digit();
                let digits: String = rest.chars().take_while(is_digit).collect();
                let letter = rest
                    .chars()
                    .nth(digits.len())
                    .map_or(String::new(), String::from);
                Err(format!("unsupported `%{digits}{letter}`"))
            }
        }
    }

    /// Returns the name with a number.
    pub fn of(&self, number: u32) -> String {
        let Self {
            before,
            digits,
            behind,
        } = self;
        format!("{before}{number:0digits$}{behind}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(number: u32) -> Vec<u8> {
        (0..4 * 3 * 3)
            .map(|byte| (number * 60 + byte) as u8)
            .collect()
    }

    fn written(format: AnimationFormat, pictures: u32, per_second: u16) -> Vec<u8> {
        let animation = Animation {
            format,
            size: [4, 3],
            pictures,
            per_second,
        };
        let mut file = Vec::new();
        animation
            .write(&mut file, &mut |number| Ok(picture(number)))
            .unwrap();
        file
    }

    #[test]
    fn apng_holds_every_picture_and_its_time() {
        for pictures in [1, 4] {
            let file = written(AnimationFormat::Apng, pictures, 24);
            let mut reader = png::Decoder::new(io::Cursor::new(file))
                .read_info()
                .unwrap();
            let control = reader.info().animation_control().copied().unwrap();
            assert_eq!((control.num_frames, control.num_plays), (pictures, 0));
            for number in 0..pictures {
                let mut pixels = vec![0; 36];
                reader.next_frame(&mut pixels).unwrap();
                assert_eq!(pixels, picture(number), "{number}");
                let frame = reader.info().frame_control().copied().unwrap();
                assert_eq!((frame.delay_num, frame.delay_den), (1, 24));
            }
        }
    }

    #[test]
    fn gif_holds_few_colors_as_they_are_and_keeps_the_rate() {
        let file = written(AnimationFormat::Gif, 12, 24);
        assert_eq!(file, written(AnimationFormat::Gif, 12, 24));
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(&file[..]).unwrap();
        let mut hundredths = 0;
        for number in 0..12 {
            let frame = decoder.read_next_frame().unwrap().unwrap();
            hundredths += frame.delay;
            let colors = frame.buffer.chunks_exact(4).flat_map(|pixel| &pixel[..3]);
            assert_eq!(colors.copied().collect::<Vec<_>>(), picture(number));
        }
        assert!(decoder.read_next_frame().unwrap().is_none());
        assert_eq!(hundredths, 50);
    }

    #[test]
    fn gif_chooses_the_colors_of_small_pictures_from_all_of_their_pixels() {
        // More colors than a frame holds, each of them once.
        let pixels: Vec<u8> = (0..40 * 30)
            .flat_map(|it| [it % 40 * 6, it / 40 * 8, 128].map(|it| it as u8))
            .collect();
        let animation = Animation {
            format: AnimationFormat::Gif,
            size: [40, 30],
            pictures: 1,
            per_second: 10,
        };
        let mut file = Vec::new();
        animation
            .write(&mut file, &mut |_| Ok(pixels.clone()))
            .unwrap();
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(&file[..]).unwrap();
        let frame = decoder.read_next_frame().unwrap().unwrap();
        let colors = frame.buffer.chunks_exact(4).flat_map(|pixel| &pixel[..3]);
        let off = |colors: &mut dyn Iterator<Item = u8>| {
            let errors = colors.zip(&pixels).map(|(a, b)| u32::from(a.abs_diff(*b)));
            errors.sum::<u32>()
        };
        let all = off(&mut colors.copied());
        let tenth = Frame::from_rgb_speed(40, 30, &pixels, 10);
        let palette = tenth.palette.as_ref().unwrap();
        let indices = tenth.buffer.iter().map(|&it| usize::from(it));
        let tenth = off(&mut indices.flat_map(|it| palette[3 * it..][..3].to_vec()));
        assert!(all < tenth * 2 / 3, "{all} {tenth}");
    }

    #[test]
    fn gif_keeps_nearly_all_colors_of_a_picture_with_few_more_than_it_holds() {
        // 300 colors, 40 pixels of each.
        let pixels: Vec<u8> = (0..300_u32)
            .flat_map(|it| {
                [
                    (it % 7 * 36) as u8,
                    (it / 7 * 5) as u8,
                    (it % 11 * 23) as u8,
                ]
                .repeat(40)
            })
            .collect();
        let kept = |frame: &Frame<'_>| {
            let palette = frame.palette.as_ref().unwrap();
            let shown = frame
                .buffer
                .iter()
                .map(|&it| &palette[3 * usize::from(it)..][..3]);
            shown
                .zip(pixels.chunks_exact(3))
                .filter(|(shown, color)| shown == color)
                .count()
        };
        let by_network = kept(&Frame::from_rgb_speed(100, 120, &pixels, 1));
        let found = kept(&frame([100, 120], &pixels));
        assert!(
            found > 200 * 40 && by_network < 100 * 40,
            "{found} {by_network}"
        );
    }

    #[test]
    fn an_error_of_a_picture_ends_the_animation() {
        for format in [AnimationFormat::Apng, AnimationFormat::Gif] {
            let animation = Animation {
                format,
                size: [4, 3],
                pictures: 3,
                per_second: 1,
            };
            let write = |next: NextPicture<'_>| animation.write(&mut Vec::new(), next);
            let failed = write(&mut |number| match number {
                1 => Err(io::Error::other("no more")),
                _ => Ok(picture(number)),
            });
            assert_eq!(failed.unwrap_err().to_string(), "no more");
            assert!(write(&mut |_| Ok(vec![0; 35])).is_err());
        }
    }

    #[test]
    fn names_have_one_number_or_none() {
        let name = |text| NumberedName::read(text).unwrap().unwrap();
        assert_eq!(name("%d.ppm").of(3), "3.ppm");
        assert_eq!(name("a/b-%05d").of(31), "a/b-00031");
        assert_eq!(NumberedName::read("plain.png"), Ok(None));
        let refused = |name| NumberedName::read(name).unwrap_err();
        assert_eq!(refused("out-%5d.png"), "unsupported `%5d`");
        assert_eq!(refused("%d-%d.png"), "the name has more than one `%`");
        for wrong in [
            "%",
            "%x.png",
            "%3d.png",
            "%00000000010d",
            "%d-%d.png",
            "50%.png",
        ] {
            assert!(NumberedName::read(wrong).is_err(), "{wrong}");
        }
    }
}
