//! The rays of samples, from a pinhole or a lens, in exact arithmetic.

use super::crossing::{Ray, Start, exact};
use super::directions;
use super::media::Inside;
use super::number::*;
use super::path::Path;
use super::world::World;
use gridel_core::format::lens::Lens;
use gridel_core::format::record::View;
use gridel_core::shade::sampler::Sampler;
use gridel_core::{RayKind, Settings};

/// Steps that a pixel is divided into on each axis.
const SUBPIXELS: i64 = 256;

/// The dimension of points of the lens.
const LENS: u16 = 0x1000;

/// The place of a sample in its pixel, in subpixels: the first two dimensions of Sobol's sequence, in the middle of
/// their cells.
fn within(index: u16, count: u16) -> [i64; 2] {
    if count == 1 {
        return [SUBPIXELS / 2; 2];
    }
    let first = (0..8).fold(0, |sum, bit| sum | i64::from(index >> bit & 1) << (7 - bit));
    // Pascal's triangle modulo 2: column `bit` has an entry in row `row` if `row` holds the bits of... `bit`.
    let second = (0..8_u32).fold(0_i64, |sum, bit| {
        if index >> bit & 1 == 0 {
            return sum;
        }
        let column = (0..8_u32).filter(|row| row & bit == *row);
        sum ^ column.fold(0, |column, row| column | 1 << (7 - row))
    });
    let mut cells = 1;
    while cells < i64::from(count) {
        cells *= 2;
    }
    let half_cell = (SUBPIXELS / 2) / cells;
    [first + half_cell, second + half_cell]
}

/// Returns the ray of a sample; `None` where it is open which point of the lens it comes from.
pub fn path<N: Enclosure>(
    world: &World<'_>,
    settings: &Settings,
    pixel: [u16; 2],
    sample: u16,
) -> Option<Path<N>> {
    let view = world.scene.view();
    let [dx, dy] = within(sample, settings.samples);
    let [x, y] = pixel.map(|it| i64::from(it) * SUBPIXELS);
    let (x, y) = (x + dx, y + dy);
    let [width, height] = [settings.width, settings.height].map(|side| i64::from(side) * SUBPIXELS);
    // The direction times the height in subpixels: below 2^28 times 2^24, and three of that.
    let direction = [0, 1, 2].map(|k| {
        i64::from(view.forward[k]) * height
            + i64::from(view.right[k]) * (2 * x - width)
            + i64::from(view.up[k]) * (height - 2 * y)
    });
    let mut path = Path {
        ray: Ray {
            origin: view.eye.map(|x| N::scaled(x, 5)),
            direction: exact(direction),
            start: Start::Free,
        },
        weight: [N::one(); 3],
        depth: 0,
        kind: RayKind::Primary,
        points: Sampler::new(pixel, sample),
        reflections: 0,
        inside: Inside::default(),
        length: None,
    };
    if let Some(lens) = world.scene.lens() {
        path.ray = through(lens, view, &path)?;
    }
    Some(path)
}

/// A ray from the eye as it leaves a random point of the lens.
fn through<N: Enclosure>(lens: &Lens, view: &View, path: &Path<N>) -> Option<Ray<N>> {
    let [forward, right, up] =
        [view.forward, view.right, view.up].map(|it| exact(it.map(i64::from)));
    let (forward, right, up) = (unit(forward)?, unit(right)?, unit(up)?);
    let [u, v] = path.point(LENS);
    let radius = directions::ratio::<N>(u).sqrt() * N::scaled(lens.radius, 5);
    let [sine, cosine] = directions::turn::<N>(v);
    let offset = plus(scale(right, radius * cosine), scale(up, radius * sine));
    // Where the ray from the eye meets the plane of focus, times the cosine to the camera's axis.
    let there = scale(path.ray.direction, N::scaled(lens.focus, 5));
    let toward = dot(forward, path.ray.direction);
    Some(Ray {
        origin: plus(path.ray.origin, offset),
        direction: minus(there, scale(offset, toward)),
        start: Start::Free,
    })
}
