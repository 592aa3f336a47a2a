//! Packs of spheres: the test of [`sphere`](super::sphere) on eight at once, up to where it rejects.

use crate::blob::cluster::{Pack, Rows};
use crate::eight::Eight;
use crate::number::{Format, Number};
use crate::ray::Ray;

/// The lanes of a pack whose spheres the line of a ray may meet: all that
/// [`sphere::cross`](super::sphere::cross) does not reject, and perhaps others.
///
/// In `f32` the operations are those of that kernel, and only what it accepts is left; other
/// formats have every sphere tested there.
#[inline(always)]
pub(crate) fn met<N: Number, P: Pack>(ray: &Ray<N>, recip_norm2: N, pack: &P) -> u32 {
    let lanes = !(u32::MAX << (pack.members().count() & 31));
    if N::FORMAT != Format::F32 {
        return lanes;
    }
    let all = |number: N| Eight::splat(number.to_f32());
    let slope = ray.slope.map(all);
    let relative = |axis: usize| pack.rows().units(axis) - all(ray.origin[axis]);
    let (x, y, z) = (relative(0), relative(1), relative(2));
    let closest = (x * slope[0] + y * slope[1] + z * slope[2]) * all(recip_norm2);
    let apart = [
        x - closest * slope[0],
        y - closest * slope[1],
        z - closest * slope[2],
    ];
    let radii = pack.radii();
    let farthest = apart[0].abs().max(apart[1].abs()).max(apart[2].abs());
    let square = apart[0] * apart[0] + apart[1] * apart[1] + apart[2] * apart[2];
    lanes & farthest.at_most(radii) & Eight::splat(0.0).at_most(radii * radii - square)
}
