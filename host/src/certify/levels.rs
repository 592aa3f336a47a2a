//! Levels of textures: the area of an image that a sample covers, by the integers with which a blob defines it.

use super::hit::Hit;
use super::log2::Log2;
use super::number::*;
use super::path::Path;
use super::world::{Form, World};
use gridel_core::Settings;
use gridel_core::format::instance::MATRIX_BITS;
use gridel_core::number::log2::{log2, log2_of_length, log2_of_power};

/// Fraction bits of texture coordinates, and of the places of corners.
const COORDINATE_BITS: i32 = 20;
const PLACE_BITS: i32 = 8;
/// Fraction bits of lengths.
const LENGTH_BITS: i32 = 13;

/// Returns the distance of rays of neighboring samples, per distance from the eye.
pub fn spread(world: &World<'_>, settings: &Settings) -> i32 {
    let view = world.scene.view();
    let [up, forward] = [view.up, view.forward].map(|it| log2_of_length(it.map(i64::from)));
    // Up reaches over half of the height.
    let pixel = up + log2_of_power(1) - forward - log2(settings.height.into());
    pixel - (log2(settings.samples.into()) >> 1)
}

/// The largest component of a ray's direction, in which slopes are counted.
fn largest<N: Enclosure>(path: &Path<N>) -> N {
    let [x, y, z] = path.ray.direction.map(N::abs);
    x.at_least(y).at_least(z)
}

/// The length of a direction whose largest component is 1.
fn norm<N: Enclosure>(path: &Path<N>, largest: N) -> Option<Log2> {
    let square = largest.square().div(norm2(path.ray.direction))?;
    Some(Log2::of_ratio(square).negative().half())
}

/// Returns the length of all rays up to a hit, in units with 13 fraction bits.
pub fn length<N: Enclosure>(path: &Path<N>, hit: &Hit<N>) -> Option<Log2> {
    let largest = largest(path);
    // A step is 32 of these.
    let along = Log2::of(hit.t * largest * N::int(32), 0.5);
    let own = along.plus(norm(path, largest)?);
    let whole = path.length.map_or(own, |before| before.sum(own));
    Some(whole.at_least(0))
}

/// Returns the side of a square as large as the area of an image that a sample sees. `Some(None)` where there is no
/// image, or no size.
///
/// The outer `None` means that the bounds are too wide.
pub fn footprint<N: Enclosure>(
    world: &World<'_>,
    (path, hit): (&Path<N>, &Hit<N>),
    length: Log2,
    spread: i32,
) -> Option<Option<Log2>> {
    let Some(density) = density(world, hit) else {
        return Some(None);
    };
    let largest = largest(path);
    let cosine = dot(path.ray.direction, hit.normal).abs().div(largest)?;
    let stretched = norm(path, largest)?.plus(Log2::of_ratio(cosine).negative());
    let width = length.and(spread - log2_of_power(LENGTH_BITS));
    Some(Some(width.plus(stretched.half()).and(density)))
}

/// Returns the distance of texture coordinates per unit of length.
fn density<N: Enclosure>(world: &World<'_>, hit: &Hit<N>) -> Option<i32> {
    let solid = &world.space(hit.instance).solids[hit.solid as usize];
    let (Form::Triangle { normal, .. }, Some([a, b, c])) = (solid.form, solid.paint.coordinates)
    else {
        return None;
    };
    let apart = |to: [i32; 2], k: usize| i64::from(to[k]) - i64::from(a[k]);
    let product = |i: usize, j: usize| apart(b, i) * apart(c, j);
    let mapped = product(0, 1).saturating_sub(product(1, 0)).unsigned_abs();
    if mapped == 0 {
        return None;
    }
    let areas = log2(mapped) - log2_of_length(normal);
    let own = (areas >> 1) - log2_of_power(COORDINATE_BITS - PLACE_BITS);
    let stretch = match world.scene.instances().get(hit.instance as usize) {
        None => 0,
        Some(instance) => {
            let row = log2_of_length(instance.matrix[0].map(i64::from));
            row + log2_of_power(i32::from(instance.exponent) - MATRIX_BITS as i32)
        }
    };
    Some(own + stretch)
}
