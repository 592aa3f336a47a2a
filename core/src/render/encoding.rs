//! The conversion of linear radiance to the pixels of a display: sRGB, 8 bits or 5-6-5, dithered on
//! demand.
//!
//! All arithmetic is in integers, so that all number formats share it.

/// Linear radiance with 16 bits per channel: 65535 is display white.
pub(crate) type Linear = [u16; 3];

/// A pixel in a display's own form.
pub trait Pixel: Copy + Default {
    /// Encodes a pixel. `dither` is `None` for rounding to nearest, else the place of the pixel in
    /// the picture, for an ordered pattern of 8 by 8.
    ///
    /// ```
    /// use gridel_core::render::Pixel;
    /// use gridel_core::{Rgb565, Rgb888};
    ///
    /// assert_eq!(Rgb888::encode([65_535, 14_146, 0], None), Rgb888([255, 128, 0]));
    /// assert_eq!(Rgb565::encode([65_535; 3], None), Rgb565(0xffff));
    /// ```
    fn encode(linear: [u16; 3], dither: Option<[u16; 2]>) -> Self;
}

/// Eight bits per channel: red, green, blue.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(transparent)]
pub struct Rgb888(pub [u8; 3]);

/// Sixteen bits: five of red (the uppermost), six of green, five of blue.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(transparent)]
pub struct Rgb565(pub u16);

impl Pixel for Rgb888 {
    fn encode(linear: [u16; 3], dither: Option<[u16; 2]>) -> Self {
        Self(linear.map(|channel| quantize(channel, 255, dither) as u8))
    }
}

impl Pixel for Rgb565 {
    fn encode(linear: [u16; 3], dither: Option<[u16; 2]>) -> Self {
        let [red, green, blue] = linear;
        let (red, green, blue) = (
            quantize(red, 31, dither),
            quantize(green, 63, dither),
            quantize(blue, 31, dither),
        );
        Self((red << 11 | green << 5 | blue) as u16)
    }
}

/// Returns the perceived brightness of a color (IEC 61966-2-1's weights, which add up to 1 here).
#[cfg(feature = "embedded-graphics-core")]
pub(crate) fn luminance([red, green, blue]: Linear) -> u16 {
    let weighted = 13_933 * u32::from(red) + 46_871 * u32::from(green) + 4_732 * u32::from(blue);
    (weighted >> 16) as u16
}

/// An sRGB code of 0 to `most` for a linear value.
pub(crate) fn quantize(linear: u16, most: u32, dither: Option<[u16; 2]>) -> u32 {
    // In units of 1 / (256 * 255) of a code step of the display.
    let scaled = srgb(linear) * most;
    let threshold = dither.map_or(128, |[x, y]| u32::from(bayer(x, y)) * 4 + 2);
    ((scaled + threshold * 255) / (256 * 255)).min(most)
}

/// The sRGB code of a linear value, 0 to 255 with 8 fraction bits: exact at every code, straight
/// lines in between.
fn srgb(linear: u16) -> u32 {
    let above = LINEAR_OF_SRGB.partition_point(|&code| code <= linear);
    // The first entry is 0, so at least one is not above.
    let below = above.saturating_sub(1);
    let (Some(&low), Some(&high)) = (LINEAR_OF_SRGB.get(below), LINEAR_OF_SRGB.get(above)) else {
        return 255 << 8;
    };
    // The table ascends, so no difference wraps.
    let (rest, step) = (linear.wrapping_sub(low), high.wrapping_sub(low));
    let part = (u32::from(rest) << 8).checked_div(step.into());
    ((below as u32) << 8).wrapping_add(part.unwrap_or(0))
}

/// The linear values whose sRGB codes are these display values, 65535 being white.
#[cold]
#[inline(never)]
pub(crate) fn from_display(values: [u16; 3]) -> Linear {
    values.map(|value| {
        // A code with 16 fraction bits; white is 255 exactly, the others within 1/65536.
        let value = u32::from(value);
        let code = (value + (value >> 15)) * 255;
        let (below, part) = ((code >> 16) as usize, code & 0xffff);
        let Some(&low) = LINEAR_OF_SRGB.get(below) else {
            return u16::MAX;
        };
        let high = LINEAR_OF_SRGB.get(below.wrapping_add(1)).unwrap_or(&low);
        // The table ascends, by at most 583 at a step.
        let step = u32::from(high.wrapping_sub(low));
        low.wrapping_add(((step * part + 0x8000) >> 16) as u16)
    })
}

/// Bayer's matrix of order 8: every number of 0 to 63 once.
fn bayer(x: u16, y: u16) -> u16 {
    let (a, b) = (x ^ y, y);
    (a & 1) << 5 | (b & 1) << 4 | (a & 2) << 2 | (b & 2) << 1 | (a & 4) >> 1 | (b & 4) >> 2
}

/// The linear value of every sRGB code (IEC 61966-2-1), 65535 being white.
#[rustfmt::skip]
static LINEAR_OF_SRGB: [u16; 256] = [
    0, 20, 40, 60, 80, 99, 119, 139, 159, 179, 199, 219,
    241, 264, 288, 313, 340, 367, 396, 427, 458, 491, 526, 562,
    599, 637, 677, 718, 761, 805, 851, 898, 947, 997, 1048, 1101,
    1156, 1212, 1270, 1330, 1391, 1453, 1517, 1583, 1651, 1720, 1790, 1863,
    1937, 2013, 2090, 2170, 2250, 2333, 2418, 2504, 2592, 2681, 2773, 2866,
    2961, 3058, 3157, 3258, 3360, 3464, 3570, 3678, 3788, 3900, 4014, 4129,
    4247, 4366, 4488, 4611, 4736, 4864, 4993, 5124, 5257, 5392, 5530, 5669,
    5810, 5953, 6099, 6246, 6395, 6547, 6700, 6856, 7014, 7174, 7335, 7500,
    7666, 7834, 8004, 8177, 8352, 8528, 8708, 8889, 9072, 9258, 9445, 9635,
    9828, 10022, 10219, 10417, 10619, 10822, 11028, 11235, 11446, 11658, 11873, 12090,
    12309, 12530, 12754, 12980, 13209, 13440, 13673, 13909, 14146, 14387, 14629, 14874,
    15122, 15371, 15623, 15878, 16135, 16394, 16656, 16920, 17187, 17456, 17727, 18001,
    18277, 18556, 18837, 19121, 19407, 19696, 19987, 20281, 20577, 20876, 21177, 21481,
    21787, 22096, 22407, 22721, 23038, 23357, 23678, 24002, 24329, 24658, 24990, 25325,
    25662, 26001, 26344, 26688, 27036, 27386, 27739, 28094, 28452, 28813, 29176, 29542,
    29911, 30282, 30656, 31033, 31412, 31794, 32179, 32567, 32957, 33350, 33745, 34143,
    34544, 34948, 35355, 35764, 36176, 36591, 37008, 37429, 37852, 38278, 38706, 39138,
    39572, 40009, 40449, 40891, 41337, 41785, 42236, 42690, 43147, 43606, 44069, 44534,
    45002, 45473, 45947, 46423, 46903, 47385, 47871, 48359, 48850, 49344, 49841, 50341,
    50844, 51349, 51858, 52369, 52884, 53401, 53921, 54445, 54971, 55500, 56032, 56567,
    57105, 57646, 58190, 58737, 59287, 59840, 60396, 60955, 61517, 62082, 62650, 63221,
    63795, 64372, 64952, 65535,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_the_standards() {
        for (code, &linear) in LINEAR_OF_SRGB.iter().enumerate() {
            let s = code as f64 / 255.0;
            let exact = if s <= 0.04045 {
                s / 12.92
            } else {
                ((s + 0.055) / 1.055).powf(2.4)
            };
            assert_eq!(linear, (exact * 65535.0).round() as u16, "code {code}");
        }
    }

    /// Every code is recovered from its linear value, and codes never fall as light grows.
    #[test]
    fn encoding_inverts_the_table_and_is_monotone() {
        for (code, &linear) in LINEAR_OF_SRGB.iter().enumerate() {
            assert_eq!(Rgb888::encode([linear; 3], None).0, [code as u8; 3]);
        }
        let mut last = 0;
        for linear in 0..=u16::MAX {
            let code = quantize(linear, 255, None);
            assert!(code >= last);
            last = code;
        }
        assert_eq!(last, 255);
        assert_eq!(Rgb565::encode([u16::MAX; 3], None).0, 0xffff);
        assert_eq!(Rgb565::encode([0; 3], None).0, 0);
    }

    /// A display value reaches the display unchanged.
    #[test]
    fn display_values_come_out_as_they_went_in() {
        for code in 0..=255_u16 {
            let linear = from_display([code * 257; 3]);
            assert_eq!(Rgb888::encode(linear, None).0, [code as u8; 3]);
        }
        for value in 0..=u16::MAX {
            let found = f64::from(srgb(from_display([value; 3])[0])) / 256.0;
            let exact = f64::from(value) / 257.0;
            // Where a code's step is 20 linear values, rounding to one is half of 0.05 codes.
            assert!((found - exact).abs() < 0.03, "{value}: {found}");
        }
    }

    /// The mean of a dithered 8 by 8 block is the undithered value, within a fraction of a code.
    #[test]
    fn dithering_keeps_the_mean() {
        for linear in (0..u16::MAX).step_by(997) {
            let mut sum = 0;
            for x in 0..8 {
                for y in 0..8 {
                    sum += quantize(linear, 31, Some([x, y]));
                }
            }
            let exact = f64::from(srgb(linear)) * 31.0 / (256.0 * 255.0);
            assert!(
                (f64::from(sum) / 64.0 - exact).abs() < 1.0 / 64.0,
                "linear {linear}"
            );
        }
    }
}
