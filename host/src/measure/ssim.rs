//! Structural similarity of two gray pictures.
//!
//! Wang, Bovik, Sheikh, Simoncelli, "Image Quality Assessment: From Error Visibility to Structural
//! Similarity", IEEE Transactions on Image Processing 13, 2004. Windows are tiles of 8 by 8 pixels that
//! do not overlap, all pixels of a tile have the same weight, and variances are unbiased estimates.

/// Pixels along the edge of a window.
const WINDOW: usize = 8;

/// The constants that keep the quotient finite, for values up to 255.
const C1: f64 = (0.01 * 255.0) * (0.01 * 255.0);
const C2: f64 = (0.03 * 255.0) * (0.03 * 255.0);

/// Returns the mean similarity of the windows, weighted by their pixels: 1 for equal pictures.
///
/// Both pictures are `width` pixels wide, row by row.
pub fn ssim(width: usize, a: &[u8], b: &[u8]) -> f64 {
    let height = a.len().min(b.len()) / width.max(1);
    let (mut sum, mut pixels) = (0.0, 0.0);
    for left in (0..width).step_by(WINDOW) {
        for top in (0..height).step_by(WINDOW) {
            let columns = left..(left + WINDOW).min(width);
            let rows = top..(top + WINDOW).min(height);
            let area = (columns.len() * rows.len()) as f64;
            let pairs = rows
                .flat_map(|y| columns.clone().map(move |x| y * width + x))
                .map(|index| [a[index], b[index]].map(f64::from));
            sum += area * similarity(pairs, area);
            pixels += area;
        }
    }
    sum / pixels
}

/// The similarity of one window of `area` pairs. Variances and covariance of a single pair are 0.
fn similarity(pairs: impl Iterator<Item = [f64; 2]> + Clone, area: f64) -> f64 {
    let mean = |side: usize| pairs.clone().map(|pair| pair[side]).sum::<f64>() / area;
    let means = [mean(0), mean(1)];
    let covariance = |i: usize, j: usize| -> f64 {
        let products = pairs
            .clone()
            .map(|pair| (pair[i] - means[i]) * (pair[j] - means[j]));
        products.sum::<f64>() / (area - 1.0).max(1.0)
    };
    let numerator = (2.0 * means[0] * means[1] + C1) * (2.0 * covariance(0, 1) + C2);
    let denominator = (means[0] * means[0] + means[1] * means[1] + C1)
        * (covariance(0, 0) + covariance(1, 1) + C2);
    numerator / denominator
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(width: usize, height: usize, seed: usize) -> Vec<u8> {
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let value = |(x, y)| ((x * 7 + y * 13 + seed * ((x * y) % 11)) % 256) as u8;
        places.map(value).collect()
    }

    /// Values of the same formulas in Python, with `variance` and `covariance` of its module `statistics`.
    #[test]
    fn values_are_those_of_the_paper() {
        for (width, height, a, b, expected) in [
            (16, 16, 0, 1, 0.9521224023108893),
            (19, 11, 0, 3, 0.805516473631756),
            (7, 5, 2, 9, 0.7845307999343825),
            (1, 1, 0, 0, 1.0),
            (64, 33, 5, 5, 1.0),
            (33, 20, 1, 200, 0.13522773584880213),
            (8, 8, 1, 2, 0.9945477742914144),
            (9, 17, 4, 40, 0.19920802527613019),
        ] {
            let (a, b) = (picture(width, height, a), picture(width, height, b));
            let found = ssim(width, &a, &b);
            assert!(
                (found - expected).abs() < 1e-13,
                "{width} x {height}: {found}"
            );
        }
    }

    #[test]
    fn black_and_white_are_barely_similar() {
        let found = ssim(12, &[0; 144], &[255; 144]);
        assert!((found - 9.999_000_099_990_003e-5).abs() < 1e-13, "{found}");
    }

    /// Half of a window is 100 in both pictures, half is 110 in one and 120 in the other. So the means are 105 and 110.
    /// Deviations are 5 and 10 everywhere, so the variances are 64 / 63 times 25 and 100, and the covariance is 64 / 63
    /// times 50.
    #[test]
    fn window_of_two_values_is_as_computed_by_hand() {
        let half = |value: u8| -> Vec<u8> {
            let place = |place: usize| if place % 8 < 4 { 100 } else { value };
            (0..64).map(place).collect()
        };
        let (c1, c2, n) = (6.5025, 58.5225, 64.0 / 63.0);
        let light = (2.0 * 105.0 * 110.0 + c1) / (105.0 * 105.0 + 110.0 * 110.0 + c1);
        let expected = light * (n * 100.0 + c2) / (n * 125.0 + c2);
        let found = ssim(8, &half(110), &half(120));
        assert!((found - expected).abs() < 1e-12, "{found}");
        assert!((found - 0.86216).abs() < 1e-5, "{found}");
    }
}
