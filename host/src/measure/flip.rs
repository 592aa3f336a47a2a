//! LDR-FLIP: the visible difference of two pictures that alternate on a display.
//!
//! Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild, "FLIP: A Difference Evaluator for Alternating
//! Images", HPG 2020. Filters both pictures by what the eye can resolve, and compares them in a perceptual color space.
//! Raises the difference where edges or points differ.

use crate::srgb::linear_of_srgb;

/// Pixels per degree of the field of view: a display of 3840 pixels, 0.7 m wide, seen from 0.7 m.
const PIXELS_PER_DEGREE: f64 = 67.020_64;

/// An sRGB picture.
#[derive(Clone, Copy, Debug)]
pub struct Picture<'p> {
    pub width: usize,
    /// Values of 0 to 1, row by row.
    pub pixels: &'p [[f64; 3]],
}

/// Three channels, row by row.
struct Planes {
    width: usize,
    height: usize,
    pixels: Vec<[f64; 3]>,
}

/// Returns the difference at every pixel, 0 to 1. The report for a picture is its mean.
///
/// Cost: some 2,000 multiplications per pixel.
pub fn flip(reference: Picture<'_>, test: Picture<'_>) -> Vec<f64> {
    let [reference, test] = [reference, test].map(opponent);
    let features = features(&reference, &test);
    let [reference, test] = [reference, test].map(|planes| perceived(&planes));
    let most = hyab(hunt([0.0, 1.0, 0.0]), hunt([0.0, 0.0, 1.0])).powf(COLOR_EXPONENT);
    let colors = reference.iter().zip(&test).map(|(&a, &b)| {
        let error = hyab(a, b).powf(COLOR_EXPONENT);
        let knee = 0.4 * most;
        if error < knee {
            error * 0.95 / knee
        } else {
            0.95 + (error - knee) / (most - knee) * 0.05
        }
    });
    colors
        .zip(features)
        .map(|(color, feature)| color.powf(1.0 - feature))
        .collect()
}

const COLOR_EXPONENT: f64 = 0.7;

/// The white of a display (D65).
const WHITE: [f64; 3] = [0.950_428_545, 1.0, 1.088_900_371];

/// CIE XYZ of linear sRGB.
const XYZ: [[f64; 3]; 3] = [
    [
        10_135_552.0 / 24_577_794.0,
        8_788_810.0 / 24_577_794.0,
        4_435_075.0 / 24_577_794.0,
    ],
    [
        2_613_072.0 / 12_288_897.0,
        8_788_810.0 / 12_288_897.0,
        887_015.0 / 12_288_897.0,
    ],
    [
        1_425_312.0 / 73_733_382.0,
        8_788_810.0 / 73_733_382.0,
        70_074_185.0 / 73_733_382.0,
    ],
];

fn times(matrix: [[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// Relative to white.
fn xyz(linear: [f64; 3]) -> [f64; 3] {
    let xyz = times(XYZ, linear);
    [0, 1, 2].map(|k| xyz[k] / WHITE[k])
}

/// sRGB to the opponent space Y, Cx, Cz.
fn opponent(picture: Picture<'_>) -> Planes {
    let pixel = |srgb: &[f64; 3]| {
        let [x, y, z] = xyz(srgb.map(linear_of_srgb));
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    };
    Planes {
        width: picture.width,
        height: picture.pixels.len() / picture.width.max(1),
        pixels: picture.pixels.iter().map(pixel).collect(),
    }
}

/// Filtered by the eye's contrast sensitivity, and in Hunt-adjusted L*a*b*.
fn perceived(planes: &Planes) -> Vec<[f64; 3]> {
    // Sums of two Gaussians: weights and widths for light, red against green, blue against yellow.
    const SENSITIVITY: [[[f64; 2]; 2]; 3] = [
        [[1.0, 0.0047], [0.0, 1e-5]],
        [[1.0, 0.0053], [0.0, 1e-5]],
        [[34.1, 0.04], [13.5, 0.025]],
    ];
    let pi = std::f64::consts::PI;
    let radius = (3.0 * (0.04 / (2.0 * pi * pi)).sqrt() * PIXELS_PER_DEGREE).ceil() as i32;
    let mut sum = vec![[0.0; 3]; planes.pixels.len()];
    for (channel, gaussians) in SENSITIVITY.iter().enumerate() {
        // Each Gaussian is separable, and all are divided by their common sum.
        let kernel = |b: f64| -> Vec<f64> {
            let at = |place: i32| {
                let x = f64::from(place) / PIXELS_PER_DEGREE;
                (-pi * pi * x * x / b).exp()
            };
            (-radius..=radius).map(at).collect()
        };
        let parts = gaussians.map(|[a, b]| (a * (pi / b).sqrt(), kernel(b)));
        let total: f64 = parts
            .iter()
            .map(|(weight, kernel)| weight * kernel.iter().sum::<f64>().powi(2))
            .sum();
        for (weight, kernel) in parts.iter().filter(|(weight, _)| *weight > 0.0) {
            let plane: Vec<f64> = planes.pixels.iter().map(|pixel| pixel[channel]).collect();
            let filtered = planes.filter(&plane, kernel, kernel);
            for (sum, value) in sum.iter_mut().zip(filtered) {
                sum[channel] += weight / total * value;
            }
        }
    }
    let inverse = inverse(XYZ);
    let pixel = |[y, cx, cz]: [f64; 3]| {
        let y = (y + 16.0) / 116.0;
        let xyz = [y + cx / 500.0, y, y - cz / 200.0];
        let rgb = times(inverse, [0, 1, 2].map(|k| xyz[k] * WHITE[k]));
        hunt(rgb.map(|channel| channel.clamp(0.0, 1.0)))
    };
    sum.into_iter().map(pixel).collect()
}

impl Planes {
    /// Returns a plane filtered along rows and then along columns; beyond its edges the last values repeat.
    fn filter(&self, plane: &[f64], across: &[f64], down: &[f64]) -> Vec<f64> {
        let (width, height) = (self.width as isize, self.height as isize);
        let at = |plane: &[f64], x: isize, y: isize| {
            plane[(y.clamp(0, height - 1) * width + x.clamp(0, width - 1)) as usize]
        };
        let pass = |plane: &[f64], kernel: &[f64], step: [isize; 2]| -> Vec<f64> {
            let reach = (kernel.len() / 2) as isize;
            let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
            let filtered = places.map(|(x, y)| {
                let weighted = (-reach..=reach).zip(kernel).map(|(place, weight)| {
                    weight * at(plane, x + place * step[0], y + place * step[1])
                });
                weighted.sum()
            });
            filtered.collect()
        };
        pass(&pass(plane, across, [1, 0]), down, [0, 1])
    }
}

/// Returns the difference of edges and points, 0 to 1.
fn features(reference: &Planes, test: &Planes) -> Vec<f64> {
    let deviation = 0.5 * 0.082 * PIXELS_PER_DEGREE;
    let radius = (3.0 * deviation).ceil() as i32;
    let kernel = |weight: &dyn Fn(f64) -> f64| -> Vec<f64> {
        let at = |x: f64| weight(x) * (-x * x / (2.0 * deviation * deviation)).exp();
        (-radius..=radius).map(|x| at(f64::from(x))).collect()
    };
    let smooth = kernel(&|_| 1.0);
    let normal: f64 = smooth.iter().sum();
    let smooth: Vec<f64> = smooth.iter().map(|weight| weight / normal).collect();
    // Positive weights add up to 1, negative ones to -1.
    let balanced = |kernel: Vec<f64>| -> Vec<f64> {
        let positive: f64 = kernel.iter().filter(|weight| **weight > 0.0).sum();
        let negative: f64 = -kernel.iter().filter(|weight| **weight < 0.0).sum::<f64>();
        let share = |weight: &f64| weight / if *weight > 0.0 { positive } else { negative };
        kernel.iter().map(share).collect()
    };
    let edge = balanced(kernel(&|x| -x));
    let point = balanced(kernel(&|x| x * x / (deviation * deviation) - 1.0));
    let found = |planes: &Planes, derivative: &[f64]| -> Vec<f64> {
        let light = |pixel: &[f64; 3]| (pixel[0] + 16.0) / 116.0;
        let plane: Vec<f64> = planes.pixels.iter().map(light).collect();
        let across = planes.filter(&plane, derivative, &smooth);
        let down = planes.filter(&plane, &smooth, derivative);
        across.iter().zip(down).map(|(x, y)| x.hypot(y)).collect()
    };
    let difference = |derivative: &[f64]| -> Vec<f64> {
        let (a, b) = (found(reference, derivative), found(test, derivative));
        a.iter().zip(b).map(|(a, b)| (a - b).abs()).collect()
    };
    let (edges, points) = (difference(&edge), difference(&point));
    edges
        .iter()
        .zip(points)
        .map(|(edge, point)| (edge.max(point) / std::f64::consts::SQRT_2).sqrt())
        .collect()
}

/// Hunt-adjusted L*a*b* of linear sRGB.
fn hunt(linear: [f64; 3]) -> [f64; 3] {
    let root = |t: f64| {
        let limit: f64 = 6.0 / 29.0;
        if t > limit.powi(3) {
            t.cbrt()
        } else {
            t / (3.0 * limit * limit) + 4.0 / 29.0
        }
    };
    let [x, y, z] = xyz(linear).map(root);
    let light = 116.0 * y - 16.0;
    let scale = 0.01 * light;
    [light, scale * 500.0 * (x - y), scale * 200.0 * (y - z)]
}

fn hyab(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}

fn inverse(m: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let rows = m.map(glam::DVec3::from_array);
    let inverse = glam::DMat3::from_cols(rows[0], rows[1], rows[2]).inverse();
    // Rows were taken for columns, so columns are rows again.
    inverse.to_cols_array_2d()
}

#[cfg(test)]
mod tests {
    use super::*;

    type Shade = fn(usize, usize) -> [u8; 3];

    fn noise(x: usize, y: usize) -> [u8; 3] {
        [x * 7, y * 11, x * y].map(|value| (value % 256) as u8)
    }

    fn picture(shade: Shade) -> Vec<[f64; 3]> {
        let places = (0..48).flat_map(|y| (0..64).map(move |x| (x, y)));
        places
            .map(|(x, y)| shade(x, y).map(|code| f64::from(code) / 255.0))
            .collect()
    }

    /// The values of the authors' own program (version 1.2, 67 pixels per degree).
    #[test]
    fn differences_are_those_of_the_authors_program() {
        const CASES: [(Shade, Shade, f64, f64); 7] = [
            (noise, noise, 0.0, 0.0),
            (noise, |x, y| noise(x + 1, y), 0.154_920, 0.183_507),
            (|_, _| [0; 3], |_, _| [255; 3], 0.967_365, 0.967_392),
            (|_, _| [120; 3], |_, _| [130; 3], 0.150_177, 0.150_179),
            (
                |x, _| {
                    if x < 32 {
                        [30, 60, 90]
                    } else {
                        [200, 180, 160]
                    }
                },
                |x, _| {
                    if x < 33 {
                        [30, 60, 90]
                    } else {
                        [200, 180, 160]
                    }
                },
                0.043_348,
                0.366_529,
            ),
            (
                |_, _| [90, 100, 110],
                |x, y| {
                    if (x, y) == (30, 20) {
                        [255, 0, 0]
                    } else {
                        [90, 100, 110]
                    }
                },
                0.001_660,
                0.304_604,
            ),
            (|_, _| [255, 0, 0], |_, _| [0, 255, 0], 0.986_650, 0.986_666),
        ];
        for (number, (reference, test, mean, at)) in CASES.into_iter().enumerate() {
            let (reference, test) = (picture(reference), picture(test));
            let of = |pixels| Picture { width: 64, pixels };
            let map = flip(of(&reference), of(&test));
            let found = map.iter().sum::<f64>() / map.len() as f64;
            // Theirs pools in a histogram of 100 steps and weighs pixels in single precision.
            assert!((found - mean).abs() < 2e-4, "case {number}: {found} {mean}");
            let found = map[20 * 64 + 30];
            assert!((found - at).abs() < 2e-4, "case {number}: {found} {at}");
        }
    }
}
