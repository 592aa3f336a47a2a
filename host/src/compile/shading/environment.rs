//! The light around a scene as a map: resampled, and with what part of its light comes from where.
//!
//! The map is octahedral: see `gridel_core::format::environment`. Every texel is the mean of the radiance in it.

use super::exposure::Exposure;
use super::radiance::radiance;
use crate::compile::CompileError;
use crate::compile::section::{Section, section};
use crate::scene::{BRIGHTEST, Color, Environment, Panorama, Sky};
use crate::shape::unit;
use crate::table::grouped;
use glam::DVec3;
use gridel_core::Up;
use gridel_core::format::SectionKind;
use gridel_core::format::environment::Environment as Record;
use gridel_core::format::record::Light;
use serde::Serialize;
use std::f64::consts::{PI, TAU};
use std::fmt;

/// Points of a texel along a side at which solid angles and gradients are evaluated.
const POINTS: usize = 8;

/// Points of a picture for each texel where texels are widest, along both sides.
const POINTS_OF_PICTURE: usize = 16;

/// 1 with 20 fraction bits.
const WHITE: f64 = (1 << 20) as f64;

/// The map of a scene, and its lights.
#[derive(Debug)]
pub struct EnvironmentData {
    record: Record,
    texels: Vec<u32>,
    rows: Vec<u32>,
    columns: Vec<u16>,
    /// The map where it is not black, and the sun.
    pub lights: Vec<Light>,
    pub figures: EnvironmentFigures,
}

/// The storage of an environment.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct EnvironmentFigures {
    /// Rows of the map.
    pub size: u32,
    pub bytes: usize,
    /// The part of the light that is lost because texels are brighter than a blob holds.
    pub lost: f64,
}

impl fmt::Display for EnvironmentFigures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { size, bytes, .. } = self;
        write!(
            f,
            "{size} x {size} texels, {} bytes",
            grouped(*bytes as u64)
        )
    }
}

impl EnvironmentFigures {
    /// Returns a warning where light is lost.
    pub fn warning(&self) -> Option<String> {
        (self.lost > 0.0).then(|| {
            format!(
                "the environment has texels brighter than {:.0}, which is the most that a blob holds: {:.1} % of its light \
                 is lost; lower `exposure` or `intensity`, or state the sun as `sun`",
                f64::from(Record::BRIGHTEST) / WHITE,
                100.0 * self.lost
            )
        })
    }
}

/// A texel of the map before it is stored.
#[derive(Clone, Copy, Debug, Default)]
struct Texel {
    radiance: Color,
    /// Steradians.
    solid_angle: f64,
    /// The largest ratio of solid angle to area of the map in it.
    stretch: f64,
}

impl EnvironmentData {
    /// Compiles an environment in a scene with a direction up.
    pub fn of(
        environment: &Environment,
        up: Up,
        exposure: &Exposure,
    ) -> Result<Self, CompileError> {
        let side = environment.size as usize;
        let mut texels = match &environment.sky {
            Sky::Gradient { .. } => {
                sampled(side, |towards| gradient(&environment.sky, towards, up))
            }
            Sky::Picture(picture) => resampled(side, picture, environment.rotation, up),
        };
        let factor = environment.intensity * exposure.factor;
        let brightest = f64::from(Record::BRIGHTEST) / WHITE;
        let (mut all, mut lost) = (0.0, 0.0);
        for texel in &mut texels {
            for channel in &mut texel.radiance {
                *channel *= factor;
                all += *channel * texel.solid_angle;
                lost += (*channel - brightest).max(0.0) * texel.solid_angle;
                *channel = channel.min(brightest);
            }
        }
        let packed: Vec<u32> = texels.iter().map(|texel| packed(texel.radiance)).collect();
        // Directions are drawn by the stored values.
        for (texel, packed) in texels.iter_mut().zip(&packed) {
            texel.radiance = unpacked(*packed);
        }
        let light = texels.iter().map(|texel| {
            let [red, green, blue] = texel.radiance;
            (red + green + blue) * texel.solid_angle
        });
        let light: Vec<f64> = light.collect();
        let of_rows: Vec<f64> = light.chunks(side).map(|row| row.iter().sum()).collect();
        let rows = starts(&of_rows, 1 << 32);
        let columns = light.chunks(side).flat_map(|row| starts(row, 1 << 16));
        let columns: Vec<u16> = columns.map(|it| it as u16).collect();
        let rows: Vec<u32> = rows.into_iter().map(|it| it as u32).collect();
        check_brightness(&texels, of_rows.iter().sum())?;

        let (record, sun) = sun_of(environment, exposure)?;
        let map = Light {
            vector: [0; 3],
            color: [1 << 20; 3],
            kind: Light::ENVIRONMENT,
        };
        let is_lit = light.iter().any(|&it| it > 0.0);
        let bytes = size_of::<Record>() + 6 * texels.len() + 4 * side;
        Ok(Self {
            record,
            texels: packed,
            rows,
            columns,
            lights: is_lit.then_some(map).into_iter().chain(sun).collect(),
            figures: EnvironmentFigures {
                size: environment.size,
                bytes,
                lost: if lost > 0.0 { lost / all } else { 0.0 },
            },
        })
    }

    /// Returns its sections.
    pub fn sections(&self) -> [Section; 4] {
        [
            section(SectionKind::Environment, &[self.record]),
            section(SectionKind::EnvironmentTexels, &self.texels),
            section(SectionKind::EnvironmentRows, &self.rows),
            section(SectionKind::EnvironmentColumns, &self.columns),
        ]
    }
}

/// The record, and the sun as a light.
fn sun_of(
    environment: &Environment,
    exposure: &Exposure,
) -> Result<(Record, Option<Light>), CompileError> {
    let plain = Record {
        size_bits: environment.size.trailing_zeros(),
        sun_direction: [0; 3],
        sun_radius: 0,
        sun_radiance: [0; 3],
    };
    let Some(sun) = environment.sun else {
        return Ok((plain, None));
    };
    let color = exposure.of_color(sun.light(), || String::from("sun"))?;
    let towards = -unit(sun.direction) * f64::from(1 << 30);
    let record = Record {
        sun_direction: towards.round().to_array().map(|x| x as i32),
        sun_radius: (sun.radius() * f64::from(1 << 30)).round() as i32,
        // A brighter sun is limited to what a record holds.
        sun_radiance: radiance(color.map(|channel| channel / sun.solid_angle_over_pi())),
        ..plain
    };
    let light = Light {
        vector: [0; 3],
        color: radiance(color),
        kind: Light::SUN,
    };
    Ok((record, (color != [0.0; 3]).then_some(light)))
}

/// Returns an error where a sample of the map as a light, L over π times the density, is beyond the range of `fixed`.
fn check_brightness(texels: &[Texel], all: f64) -> Result<(), CompileError> {
    let area = 4.0 / texels.len() as f64;
    let samples = texels.iter().flat_map(|texel| {
        let [red, green, blue] = texel.radiance;
        // The texel's part of all light is its density.
        let light = (red + green + blue) * texel.solid_angle;
        let inverse = if light > 0.0 { all / light } else { 0.0 };
        let most = area * texel.stretch * inverse / PI;
        [red, green, blue].map(|channel| channel * most)
    });
    let value = samples.fold(0.0, f64::max);
    if value > BRIGHTEST {
        return Err(CompileError::TooBright {
            what: String::from("environment, all of it together,"),
            value,
            most: BRIGHTEST,
        });
    }
    Ok(())
}

/// A radiance as a texel.
fn packed(radiance: Color) -> u32 {
    let fixed = radiance.map(|channel| (channel * WHITE).round());
    let peak = fixed.into_iter().fold(0.0, f64::max);
    let mut exponent = 0;
    while (peak / f64::from(1_u32 << exponent)).round() > 511.0 {
        exponent += 1;
    }
    let [red, green, blue] =
        fixed.map(|channel| (channel / f64::from(1_u32 << exponent)).round() as u32);
    red | green << 9 | blue << 18 | exponent << 27
}

fn unpacked(texel: u32) -> Color {
    let channel = |shift: u32| f64::from((texel >> shift & 511) << (texel >> 27)) / WHITE;
    [channel(0), channel(9), channel(18)]
}

/// Returns the part of `whole` that comes before each weight. A weight above 0 gets a part above 0, and so does the
/// last, before which the others must end; others get none. All are equal if all weights are 0.
fn starts(weights: &[f64], whole: u64) -> Vec<u64> {
    let sum: f64 = weights.iter().sum();
    let is_drawn = |index: usize| sum <= 0.0 || weights[index] > 0.0 || index + 1 == weights.len();
    let count = (0..weights.len()).filter(|&it| is_drawn(it)).count() as u64;
    let shared = (whole - count) as f64;
    let width = |index: usize| {
        let part = if sum > 0.0 {
            weights[index] / sum
        } else {
            1.0 / count as f64
        };
        u64::from(is_drawn(index)) + (part * shared).floor() as u64
    };
    let mut widths: Vec<u64> = (0..weights.len()).map(width).collect();
    // The remainder of rounding goes to the widest.
    let left = whole.saturating_sub(widths.iter().sum());
    if let Some(widest) = widths.iter_mut().max() {
        *widest += left;
    }
    let mut before = 0;
    let start = |width: u64| {
        let start = before;
        before += width;
        start
    };
    widths.into_iter().map(start).collect()
}

/// The direction of a place of the map, a point of the octahedron.
fn direction([x, y]: [f64; 2]) -> DVec3 {
    let z = 1.0 - x.abs() - y.abs();
    if z >= 0.0 {
        DVec3::new(x, y, z)
    } else {
        let rest = |of: f64, sign: f64| (1.0 - of.abs()).copysign(sign);
        DVec3::new(rest(y, x), rest(x, y), z)
    }
}

/// The place of a direction on the map, in texels.
fn place(towards: DVec3, side: usize) -> [usize; 2] {
    let DVec3 { x, y, z } = towards / (towards.x.abs() + towards.y.abs() + towards.z.abs());
    let rest = |of: f64, sign: f64| (1.0 - of.abs()).copysign(sign);
    let on_map = if z >= 0.0 {
        [x, y]
    } else {
        [rest(y, x), rest(x, y)]
    };
    on_map.map(|it| ((0.5 * (it + 1.0) * side as f64) as usize).min(side - 1))
}

/// The means of a function of direction over texels.
fn sampled(side: usize, radiance: impl Fn(DVec3) -> Color) -> Vec<Texel> {
    let step = 2.0 / (side * POINTS) as f64;
    let at = |texel: usize, point: usize| ((texel * POINTS + point) as f64 + 0.5) * step - 1.0;
    let texel = |index: usize| {
        let (mut sum, mut weights, mut stretch) = ([0.0; 3], 0.0, 0.0_f64);
        for point in 0..POINTS * POINTS {
            let x = at(index % side, point % POINTS);
            let y = at(index / side, point / POINTS);
            let point = direction([x, y]);
            // Steradians per area.
            let weight = point.length().powi(-3);
            let found = radiance(point / point.length());
            for (sum, channel) in sum.iter_mut().zip(found) {
                *sum += weight * channel;
            }
            weights += weight;
            stretch = stretch.max(weight);
        }
        Texel {
            radiance: sum.map(|it| it / weights),
            solid_angle: weights * step * step,
            stretch,
        }
    };
    (0..side * side).map(texel).collect()
}

/// Right, up and ahead as panoramas and gradients have them.
fn frame(up: Up) -> [DVec3; 3] {
    match up {
        Up::Y => [DVec3::X, DVec3::Y, DVec3::NEG_Z],
        Up::Z => [DVec3::X, DVec3::Z, DVec3::Y],
    }
}

fn gradient(sky: &Sky, towards: DVec3, up: Up) -> Color {
    let Sky::Gradient {
        zenith,
        horizon,
        ground,
    } = sky
    else {
        return [0.0; 3];
    };
    let height = towards.dot(frame(up)[1]);
    if height < 0.0 {
        return *ground;
    }
    let part = height * (2.0 - height);
    [0, 1, 2].map(|channel| horizon[channel] + part * (zenith[channel] - horizon[channel]))
}

/// Returns the means of a picture over texels. Each pixel is cut into enough parts that every texel gets some. Each
/// part counts with its solid angle in the texel that it lies in.
fn resampled(side: usize, picture: &Panorama, rotation: f64, up: Up) -> Vec<Texel> {
    let [width, height] = picture.size();
    let across = (2 * POINTS_OF_PICTURE * side).div_ceil(width);
    let down = (POINTS_OF_PICTURE * side).div_ceil(height);
    let [right, up, ahead] = frame(up);
    let longitude = |column: usize| {
        let part = (column as f64 + 0.5) / (across * width) as f64;
        let angle = TAU * (part - 0.5) - rotation.to_radians();
        libm::cos(angle) * ahead + libm::sin(angle) * right
    };
    let longitudes: Vec<DVec3> = (0..across * width).map(longitude).collect();
    let mut texels = sampled(side, |_| [0.0; 3]);
    let mut weights = vec![0.0; texels.len()];
    for (row, pixels) in picture.rows().enumerate() {
        for part in 0..down {
            let polar = PI * ((row * down + part) as f64 + 0.5) / (down * height) as f64;
            let (level, weight) = (libm::cos(polar) * up, libm::sin(polar));
            for (column, towards) in longitudes.iter().enumerate() {
                let [x, y] = place(level + weight * *towards, side);
                let index = y * side + x;
                let pixel = pixels[column / across];
                for (sum, channel) in texels[index].radiance.iter_mut().zip(pixel) {
                    *sum += weight * f64::from(channel);
                }
                weights[index] += weight;
            }
        }
    }
    for (texel, weight) in texels.iter_mut().zip(weights) {
        texel.radiance = texel
            .radiance
            .map(|sum| if weight > 0.0 { sum / weight } else { 0.0 });
    }
    texels
}

#[cfg(test)]
mod tests;
