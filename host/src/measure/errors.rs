//! Pictures and first hits against a reference.

use super::first_hits::FirstHit;
use super::flip::{self, flip};
use super::median;
use super::ssim::ssim;
use crate::srgb::srgb_of_linear;
use gridel_core::Rgb888;
use gridel_core::render::Pixel;
use serde::{Deserialize, Serialize};

/// Errors of a picture against the reference. Display values are sRGB, 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// Root of the mean square difference of display values, over all pixels and channels.
    pub rmse: f64,
    /// Largest difference of a display value.
    pub largest: f64,
    /// Pixels with a display value that is off by more than 1/255.
    pub pixels_off: usize,
    /// Mean structural similarity of the gray pictures, in windows of 8 by 8 (Wang and others 2004);
    /// 1 is the same.
    pub ssim: f64,
    /// Mean of FLIP: 0 is the same, 1 as different as can be.
    pub flip: f64,
    /// Rays through the middles of pixels that meet another object than in the reference, or another instance.
    pub other_objects: usize,
    /// For rays that hit the same object: the median and the largest error of the distance, in
    /// units of its last place in single precision.
    pub t_ulps: [f64; 2],
}

/// A linear value as a display shows it, 0 to 1.
fn display(linear: u16) -> f64 {
    srgb_of_linear(f64::from(linear) / 65535.0)
}

impl Errors {
    /// Compares the pixels and the first hits of a picture of some width with those of a reference.
    pub fn of(
        width: u16,
        reference: (&[[u16; 3]], &[Option<FirstHit>]),
        (pixels, hits): (&[[u16; 3]], &[Option<FirstHit>]),
    ) -> Self {
        let [rmse, largest] = rmse_and_largest(reference.0, pixels);
        let [expected, found] = [reference.0, pixels]
            .map(|p| -> Vec<[f64; 3]> { p.iter().map(|pixel| pixel.map(display)).collect() });
        let is_off = |(a, b): &(&[f64; 3], &[f64; 3])| {
            (0..3).any(|channel| (a[channel] - b[channel]).abs() > 1.0 / 255.0)
        };
        let pixels_off = expected.iter().zip(&found).filter(is_off).count();
        let picture = |pixels| flip::Picture {
            width: width.into(),
            pixels,
        };
        let differences = flip(picture(&expected), picture(&found));
        let gray = |pixels: &[[u16; 3]]| -> Vec<u8> {
            let luma = |linear: &[u16; 3]| {
                let [r, g, b] = Rgb888::encode(*linear, None).0.map(f64::from);
                (0.2126 * r + 0.7152 * g + 0.0722 * b).round() as u8
            };
            pixels.iter().map(luma).collect()
        };

        let mut other_objects = 0;
        let mut ulps = Vec::new();
        for (expected, found) in reference.1.iter().zip(hits) {
            match (expected, found) {
                (Some(expected), Some(found)) if expected.is_on(found) => {
                    let at = expected.distance;
                    let error = (at - found.distance).abs();
                    ulps.push(error / last_place_in_single_precision(at));
                }
                (None, None) => {}
                _ => other_objects += 1,
            }
        }
        let largest_ulps = ulps.iter().copied().fold(0.0, f64::max);
        Self {
            rmse,
            largest,
            pixels_off,
            ssim: ssim(width.into(), &gray(reference.0), &gray(pixels)),
            flip: differences.iter().sum::<f64>() / differences.len().max(1) as f64,
            other_objects,
            t_ulps: [median(&ulps).unwrap_or(0.0), largest_ulps],
        }
    }
}

/// Returns the unit of the last place of a number in single precision. For 0 and subnormal numbers it is that of the
/// smallest normal one.
fn last_place_in_single_precision(number: f64) -> f64 {
    let normal = number.abs().max(f32::MIN_POSITIVE.into());
    f64::powi(2.0, normal.log2().floor() as i32 - 23)
}

/// Returns the root of the mean square difference of display values of two pictures, and the largest difference.
pub fn rmse_and_largest(reference: &[[u16; 3]], pixels: &[[u16; 3]]) -> [f64; 2] {
    let pairs = reference.iter().flatten().zip(pixels.iter().flatten());
    let (mut squares, mut largest) = (0.0, 0.0_f64);
    for (&a, &b) in pairs {
        let apart = (display(a) - display(b)).abs();
        squares += apart * apart;
        largest = largest.max(apart);
    }
    let rmse = (squares / (3 * pixels.len()).max(1) as f64).sqrt();
    [rmse, largest]
}

/// Returns the differences of display values, eight times enlarged, as sRGB pixels: black means equal.
///
/// ```
/// use gridel_host::measure::difference_picture;
///
/// let (black, white) = ([[0; 3]], [[65_535; 3]]);
/// assert_eq!(difference_picture(&black, &black), [0; 3]);
/// assert_eq!(difference_picture(&black, &white), [255; 3]);
/// ```
pub fn difference_picture(reference: &[[u16; 3]], pixels: &[[u16; 3]]) -> Vec<u8> {
    let pairs = reference.iter().flatten().zip(pixels.iter().flatten());
    pairs
        .map(|(&a, &b)| (8.0 * 255.0 * (display(a) - display(b)).abs()).round() as u8)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hits_at_the_eye_have_an_error_too() {
        let hit = |distance| {
            Some(FirstHit {
                object: 0,
                instance: None,
                distance,
            })
        };
        let pixels = [[0; 3]; 3];
        let expected = [hit(0.0), hit(0.0), hit(1.0)];
        let found = [hit(0.0), hit(1.0), hit(1.0)];
        let errors = Errors::of(3, (&pixels, &expected), (&pixels, &found));
        assert_eq!(errors.other_objects, 0);
        assert_eq!(errors.t_ulps[0], 0.0);
        assert!(errors.t_ulps[1] > 1e6 && errors.t_ulps[1].is_finite());
    }

    #[test]
    fn median_of_two_errors_of_t_is_their_mean() {
        let hit = |distance| {
            Some(FirstHit {
                object: 0,
                instance: None,
                distance,
            })
        };
        let pixels = [[0; 3]; 2];
        let expected = [hit(1.0), hit(1.0)];
        let found = [hit(1.0), hit(1.0 + 4.0 * f64::from(f32::EPSILON))];
        let errors = Errors::of(2, (&pixels, &expected), (&pixels, &found));
        assert_eq!(errors.t_ulps, [2.0, 4.0]);
    }
}
