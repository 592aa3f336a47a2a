//! Repeatable random points, for the effects that draw some.
//!
//! An effect asks the ray loop for a point of the unit square, at any of its places:
//!
//! ```text
//! let [u, v] = tracer.point(dimension);    // 32 fraction bits each
//! let ratio = ratio::<N>(u);               // from 0 to 1 in any number format
//! let [sine, cosine] = Angle(v).sin_cos(); // a turn
//! ```
//!
//! The point follows from only five numbers: column and row of the pixel, sample, bounce, and dimension. All waiting
//! rays have the same pixel and sample, and the ray loop knows the bounce by the ray's depth and kind. So a waiting ray
//! stores nothing for it. The dimension separates the points that one ray draws for different purposes. Two effects
//! with one dimension would draw the same point, so each has numbers of its own:
//!
//! | dimension | what for | drawn at |
//! |---|---|---|
//! | 0 to 0x0fff | the light of this number | `aim` |
//! | 0x1000 | the lens | `camera` |
//! | 0x1010 | the facet of a rough surface | `bounce` |
//! | 0x1020 | the environment as a light | `aim` |
//! | 0x1030 | the direction of indirect light | `bounce` |
//!
//! A point is one of Sobol's first two dimensions, which put one of the first 2^k points into every elementary interval
//! of area 2^-k. Every pixel, bounce and dimension has its own shuffle of the points and its own scramble of each axis.
//! They keep that property (Owen, "Randomly Permuted (t,m,s)-Nets and (t,s)-Sequences", 1995). Both are hashes that
//! change no bit because of a lower one. (Laine and Karras, "Stratified Sampling for Stochastic Transparency", 2011;
//! Burley, "Practical Hash-based Owen Scrambling", 2020.) So the samples of a pixel are spread evenly in each
//! dimension, and independently of those of other dimensions, bounces and pixels.
//!
//! All arithmetic is in integers of 32 bits, without a table, so every number format and machine draws the same points.
//! A picture of 2^k samples is better than one of a similar number that is not a power of two.

use crate::accel::Number;

/// The points of one sample of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sampler {
    pixel: [u16; 2],
    sample: u16,
}

impl Sampler {
    /// Returns the sampler for a sample, counted from 0, of a pixel of the picture.
    #[inline(always)]
    pub fn new(pixel: [u16; 2], sample: u16) -> Self {
        Self { pixel, sample }
    }

    /// Returns a point of the unit square, with 32 fraction bits.
    ///
    /// `bounce` separates the rays of a sample. `dimension` separates the draws of one ray: two effects, or two lights,
    /// with the same number would draw the same point. Both can be any number.
    ///
    /// ```
    /// use gridel_core::RayKind;
    /// use gridel_core::shade::sampler::Sampler;
    ///
    /// // The first light, seen from where the camera's ray of the pixel's second sample ends.
    /// let sampler = Sampler::new([3, 7], 1);
    /// let bounce = RayKind::Primary as u16;
    /// assert_eq!(sampler.point(bounce, 0), sampler.point(bounce, 0));
    /// assert_ne!(sampler.point(bounce, 0), sampler.point(bounce, 1));
    /// ```
    #[inline(never)]
    pub fn point(self, bounce: u16, dimension: u16) -> [u32; 2] {
        let [x, y] = self.pixel;
        let place = mixed(u32::from(x) | u32::from(y) << 16);
        let seed = mixed(place ^ (u32::from(bounce) | u32::from(dimension) << 16));
        scrambled_point(self.sample.into(), seed)
    }
}

/// Returns a coordinate of a point as a ratio, from 0 to 1.
#[inline(always)]
pub(super) fn ratio<N: Number>(coordinate: u32) -> N {
    N::ratio((coordinate >> 2) as i32)
}

/// Point `index` of the sequence that a seed shuffles and scrambles.
fn scrambled_point(index: u32, seed: u32) -> [u32; 2] {
    let index = scrambled(index, seed);
    // The first dimension is the index with its bits mirrored.
    let first = mirrored_scramble(index, mixed(seed ^ 0x68bc_21eb));
    let second = mirrored_scramble(mirrored_second_dimension(index), mixed(seed ^ 0x02e5_be93));
    [first, second]
}

/// The second dimension of Sobol's sequence with its bits mirrored. Its generator matrix is Pascal's triangle modulo 2.
/// A bit is the sum of those bits of the index whose numbers have all the bits of its own number (Lucas' theorem).
fn mirrored_second_dimension(index: u32) -> u32 {
    let mut x = index;
    x ^= x >> 1 & 0x5555_5555;
    x ^= x >> 2 & 0x3333_3333;
    x ^= x >> 4 & 0x0f0f_0f0f;
    x ^= x >> 8 & 0x00ff_00ff;
    x ^ x >> 16
}

/// Returns a value, scrambled: the seed and the higher bits decide whether a bit changes.
fn scrambled(value: u32, seed: u32) -> u32 {
    mirrored_scramble(value.reverse_bits(), seed)
}

/// Scrambles a value whose bits are mirrored; the result's bits are not mirrored.
///
/// Multiplication and addition carry upwards only. The constants are from Vegdahl, "Building a Better LK Hash", 2021.
fn mirrored_scramble(mirrored: u32, seed: u32) -> u32 {
    let mut x = mirrored;
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul(seed >> 16 | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^= x.wrapping_mul(0x53a2_2864);
    x.reverse_bits()
}

/// A hash of 32 bits, one to one. The constants are from Wellons, "Prospecting for Hash Functions", 2018.
fn mixed(value: u32) -> u32 {
    let mut x = value;
    x = (x ^ x >> 16).wrapping_mul(0x7feb_352d);
    x = (x ^ x >> 15).wrapping_mul(0x846c_a68b);
    x ^ x >> 16
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Maximum number of samples per pixel.
    const MOST: u32 = 4096;

    fn unit(point: [u32; 2]) -> [f64; 2] {
        point.map(|x| f64::from(x) / 4_294_967_296.0)
    }

    #[test]
    fn every_elementary_interval_has_one_of_the_first_points() {
        for seed in [0, 1, 0xffff_ffff, 0x1234_5678, 0x8000_0000] {
            for bits in 0..=12 {
                for wide in 0..=bits {
                    let mut seen = vec![false; 1 << bits];
                    for index in 0..1 << bits {
                        let [x, y] = scrambled_point(index, seed);
                        // Shifts of 32 give 0 in 64 bits.
                        let column = u64::from(x) >> (32 - wide);
                        let row = u64::from(y) >> (32 - (bits - wide));
                        let cell = (column << (bits - wide) | row) as usize;
                        assert!(
                            !seen[cell],
                            "seed {seed}, 2^{bits} points, 2^{wide} columns"
                        );
                        seen[cell] = true;
                    }
                }
            }
        }
    }

    /// Correlation of two series of numbers in 0 to 1.
    fn correlation(a: &[f64], b: &[f64]) -> f64 {
        let products = a.iter().zip(b).map(|(a, b)| (a - 0.5) * (b - 0.5));
        12.0 * products.sum::<f64>() / a.len() as f64
    }

    #[test]
    fn pixels_bounces_and_dimensions_are_independent() {
        // The first points of many sequences, and those of a neighbor: 3 / sqrt(n) is three standard errors.
        let side = 64_u16;
        let series = |axis: usize, of: &dyn Fn(u16, u16) -> [u32; 2]| -> Vec<f64> {
            let places = (0..side).flat_map(|y| (0..side).map(move |x| (x, y)));
            places.map(|(x, y)| unit(of(x, y))[axis]).collect()
        };
        for sample in [0, 1, 5, 100, 4095] {
            let at =
                |x, y, bounce, dimension| Sampler::new([x, y], sample).point(bounce, dimension);
            for axis in 0..2 {
                let first = series(axis, &|x, y| at(x, y, 0, 0));
                let mean = first.iter().sum::<f64>() / first.len() as f64;
                let most = 4.0 / f64::from(side);
                assert!((mean - 0.5).abs() < most * 0.29, "{mean}");
                for (name, second) in [
                    ("column", series(axis, &|x, y| at(x + 1, y, 0, 0))),
                    ("row", series(axis, &|x, y| at(x, y + 1, 0, 0))),
                    ("bounce", series(axis, &|x, y| at(x, y, 1, 0))),
                    ("dimension", series(axis, &|x, y| at(x, y, 0, 1))),
                    ("axis", series(1 - axis, &|x, y| at(x, y, 0, 0))),
                ] {
                    let found = correlation(&first, &second);
                    assert!(found.abs() < most, "sample {sample}, {name}: {found}");
                }
            }
        }
    }

    /// Root mean square error of the mean of a function over 64 scrambles.
    fn error(samples: u32, exact: f64, of: &dyn Fn([f64; 2]) -> f64) -> f64 {
        let squares = (0..64).map(|scramble| {
            let points = (0..samples).map(|index| scrambled_point(index, mixed(scramble)));
            let mean = points.map(|point| of(unit(point))).sum::<f64>() / f64::from(samples);
            (mean - exact) * (mean - exact)
        });
        libm::sqrt(squares.sum::<f64>() / 64.0)
    }

    #[test]
    fn second_dimension_is_that_of_pascals_triangle() {
        for index in (0..4096).chain([u32::MAX, 0x8000_0000, 0x1234_5678]) {
            let (mut column, mut sum) = (1_u32 << 31, 0);
            for bit in 0..32 {
                if index >> bit & 1 == 1 {
                    sum ^= column;
                }
                column ^= column >> 1;
            }
            assert_eq!(mirrored_second_dimension(index).reverse_bits(), sum);
        }
    }

    #[test]
    fn means_converge_faster_than_random_ones() {
        let quarter = core::f64::consts::PI / 4.0;
        let disc: &dyn Fn([f64; 2]) -> f64 = &|[x, y]| f64::from(u8::from(x * x + y * y < 1.0));
        let smooth: &dyn Fn([f64; 2]) -> f64 = &|[x, y]| x * y * y;
        for (of, exact, exponent) in [(disc, quarter, 0.7), (smooth, 1.0 / 6.0, 1.3)] {
            let (few, many) = (error(16, exact, of), error(MOST, exact, of));
            let found = libm::log2(few / many) / 8.0;
            assert!(found >= exponent, "{found}: {few}, {many}");
        }
    }

    #[test]
    fn points_are_these() {
        let points = [0, 1, 4095].map(|sample| Sampler::new([3, 7], sample).point(1, 2));
        assert_eq!(points, POINTS, "{points:#x?}");
    }

    /// Recorded: a change here changes every picture with random effects.
    const POINTS: [[u32; 2]; 3] = [
        [0x7b37_707d, 0x62db_3d6d],
        [0xba3c_0f94, 0x9b0e_e456],
        [0xe4fe_9b26, 0xee5b_01c4],
    ];
}
