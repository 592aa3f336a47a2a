//! Work as a picture: how many boxes and primitives each pixel had tested.

use crate::picture::write_png;
use crate::render::Picture;
use gridel_core::Rgb888;
use gridel_core::render::Pixel;
use std::io::{self, Write};

/// The work of each pixel, and the most that any has.
#[derive(Clone, Copy, Debug)]
pub struct HeatMap<'p> {
    picture: &'p Picture,
    /// Boxes and primitives of the pixel with the most.
    pub maximum: u32,
}

impl<'p> HeatMap<'p> {
    /// Returns the map of a picture whose work was counted.
    pub fn of(picture: &'p Picture) -> Self {
        let maximum = picture.work.iter().copied().max().unwrap_or(0);
        Self { picture, maximum }
    }

    /// Writes the map as PNG: black is no work, white the maximum, which the file states. Colors
    /// follow the square root of the work. Otherwise the few pixels with the most would leave all
    /// others black.
    ///
    /// # Errors
    /// If `out` has one.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        let work = self.picture.work.iter();
        let pixels: Vec<u8> = work
            .flat_map(|&work| work_color(work, self.maximum).0)
            .collect();
        let description = format!(
            "Boxes and primitives tested for each pixel, by their square root: black 0, white {}",
            self.maximum
        );
        let size = [self.picture.width.into(), self.picture.rows.len() as u32];
        write_png(out, size, &pixels, Some(("Description", description)))
    }
}

/// Returns the color of a pixel in a map.
pub fn work_color(work: u32, maximum: u32) -> Rgb888 {
    let share = f64::from(work) / f64::from(maximum.max(1));
    Rgb888::encode(color(share.sqrt()), None)
}

/// The linear color for a place on the ramp, 0 to 1.
///
/// A path through Oklab (Ottosson, "A perceptual color space for image processing", 2020), so that
/// equal steps look equal. Lightness rises evenly from black to white while the hue turns from blue
/// over red to yellow. The chroma in between is the largest that sRGB can show.
fn color(share: f64) -> [u16; 3] {
    let lightness = share;
    let chroma = 0.72 * share * (1.0 - share);
    let hue = (275.0 + 190.0 * share).to_radians();
    let (a, b) = (chroma * libm::cos(hue), chroma * libm::sin(hue));
    let cone = |weight_a: f64, weight_b: f64| {
        let root = lightness + weight_a * a + weight_b * b;
        root * root * root
    };
    let l = cone(0.396_337_777_4, 0.215_803_757_3);
    let m = cone(-0.105_561_345_8, -0.063_854_172_8);
    let s = cone(-0.089_484_177_5, -1.291_485_548_0);
    let linear = [
        4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
        -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
        -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s,
    ];
    // The cast saturates.
    linear.map(|channel| (channel * 65535.0).round() as u16)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn luminance(share: f64) -> f64 {
        let [red, green, blue] = color(share).map(f64::from);
        0.2126 * red + 0.7152 * green + 0.0722 * blue
    }

    #[test]
    fn the_ramp_runs_from_black_to_white_and_only_gets_lighter() {
        assert_eq!(color(0.0), [0; 3]);
        assert!(color(1.0).iter().all(|&channel| channel > 65_500));
        for step in 0..100 {
            let share = f64::from(step) / 100.0;
            assert!(luminance(share) < luminance(share + 0.01), "{share}");
        }
    }

    #[test]
    fn the_maximum_is_white_and_named() {
        let picture = Picture {
            width: 3,
            height: 2,
            rows: 0..1,
            pixels: vec![[0; 3]; 3],
            counters: None,
            work: vec![0, 70, 140],
        };
        let map = HeatMap::of(&picture);
        assert_eq!(map.maximum, 140);
        let mut file = Vec::new();
        map.write(&mut file).unwrap();
        let mut reader = png::Decoder::new(io::Cursor::new(file))
            .read_info()
            .unwrap();
        let text = &reader.info().uncompressed_latin1_text[0];
        assert!(text.text.ends_with("white 140"), "{}", text.text);
        let mut pixels = [0; 9];
        reader.next_frame(&mut pixels).unwrap();
        assert_eq!((pixels[0], pixels[8]), (0, 255));
    }
}
