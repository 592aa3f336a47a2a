//! Normal maps, in exact arithmetic.

use super::crossing::exact;
use super::hit::Hit;
use super::log2::Log2;
use super::number::*;
use super::paint::at_places;
use super::shade;
use super::world::{Form, World};
use gridel_core::format::record::Material;
use std::cmp::Ordering;

/// A normal with bumps, and whether it is open which texels it is mixed from.
pub struct Bumped<N> {
    pub normal: Three<N>,
    pub is_open: bool,
}

/// Returns the normal of a hit with the bumps of its material, on the side of another one; `None` for a surface without
/// bumps.
///
/// The outer `None` means that the bounds are too wide.
pub fn bumped<N: Enclosure>(
    world: &World<'_>,
    hit: &Hit<N>,
    (material, size): (&Material, Option<Log2>),
    normal: Three<N>,
) -> Option<Option<Bumped<N>>> {
    let solid = &world.space(hit.instance).solids[hit.solid as usize];
    let has_map = material.maps & Material::MAPS_NORMAL != 0;
    let (
        true,
        Some(coordinates),
        Form::Triangle {
            corners,
            normal: across,
            ..
        },
    ) = (has_map, solid.paint.coordinates, solid.form)
    else {
        return Some(None);
    };
    let Some((along_u, is_mirrored)) = along_u(corners, coordinates) else {
        return Some(None);
    };
    let (_, weights) = shade::weights(world, hit, corners, across)?;
    let mut range: Option<[[i32; 2]; 3]> = None;
    let mut map = None;
    let is_known = at_places(weights, coordinates, size, |place, footprint| {
        let Some((texel, its_map)) = world.scene.mapped_normal(material, place, footprint) else {
            return;
        };
        let mut all = range.unwrap_or(texel.map(|it| [it; 2]));
        for ([low, high], found) in all.iter_mut().zip(texel) {
            (*low, *high) = ((*low).min(found), (*high).max(found));
        }
        (range, map) = (Some(all), Some(its_map));
    });
    if !is_known {
        return None;
    }
    let (Some(range), Some(map)) = (range, map) else {
        return Some(None);
    };
    let [x, y, z] = range.map(|[low, high]| ratio_of::<N>(low).hull(ratio_of(high)));
    // 65535 is 1.
    let factor = |it: u16| N::scaled(i64::from(it) + i64::from(it >> 15), 16);
    let (level, rise) = (factor(map.across), factor(map.along));
    let y = if is_mirrored { -y } else { y };

    let front = if hit.front { normal } else { opposite(normal) };
    let mut tangent = exact(along_u);
    if let Some(placed) = world.placed.get(hit.instance as usize) {
        tangent = placed.normal(tangent);
    }
    let right = unit(along(tangent, -dot(tangent, front), front))?;
    let up = cross(front, right);
    let sum = along(scale(right, x * level), y * level, up);
    let bumped = unit(along(sum, z * rise, front))?;
    Some(Some(Bumped {
        normal: if hit.front { bumped } else { opposite(bumped) },
        is_open: range.iter().any(|[low, high]| low != high),
    }))
}

/// Returns the direction in which u grows over a triangle, of any length, and whether the image appears mirrored from
/// its front.
fn along_u(corners: [[i64; 3]; 3], coordinates: [[i32; 2]; 3]) -> Option<([i64; 3], bool)> {
    let [a, b, c] = corners;
    let apart = |corner: usize| {
        [0, 1].map(|k: usize| i64::from(coordinates[corner][k]) - i64::from(coordinates[0][k]))
    };
    let (to_b, to_c) = (apart(1), apart(2));
    let area =
        i128::from(to_b[0]) * i128::from(to_c[1]) - i128::from(to_b[1]) * i128::from(to_c[0]);
    let sign = match area.cmp(&0) {
        Ordering::Less => -1,
        Ordering::Equal => return None,
        Ordering::Greater => 1,
    };
    let along =
        [0, 1, 2].map(|k: usize| sign * ((b[k] - a[k]) * to_c[1] - (c[k] - a[k]) * to_b[1]));
    (along != [0; 3]).then_some((along, sign > 0))
}
