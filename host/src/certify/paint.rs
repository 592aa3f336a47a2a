//! Colors of vertices and textures, in exact arithmetic.
//!
//! A vertex color is interpolated in real arithmetic. A texture is defined by integers at multiples of 2^-20 of the
//! image, at or below the coordinates. Where several multiples are possible, all are looked up.

use super::hit::Hit;
use super::log2::Log2;
use super::number::*;
use super::shade;
use super::world::{Form, Paint, World};
use gridel_core::format::record::Material;
use gridel_core::scene::Footprint;

/// The most places of a texture that are looked up for a point.
const MOST_PLACES: i64 = 64;

/// The weight of the diffuse color, and whether the texture's color is open.
pub struct Weight<N> {
    pub color: Three<N>,
    pub is_open: bool,
}

/// Returns colors of vertices and a texture at a hit; `None` where the bounds of the point are too wide.
pub fn weight<N: Enclosure>(
    world: &World<'_>,
    hit: &Hit<N>,
    material: &Material,
    size: Option<Log2>,
) -> Option<Weight<N>> {
    let white = Weight {
        color: [N::one(); 3],
        is_open: false,
    };
    let solid = &world.space(hit.instance).solids[hit.solid as usize];
    let Form::Triangle {
        corners, normal, ..
    } = solid.form
    else {
        return Some(white);
    };
    let Paint {
        colors,
        coordinates,
    } = solid.paint;
    let has_texture = material.maps & Material::MAPS_TEXTURE != 0;
    let coordinates = coordinates.filter(|_| has_texture);
    if colors.is_none() && coordinates.is_none() {
        return Some(white);
    }
    let (_, weights) = shade::weights(world, hit, corners, normal)?;
    let mut found = white;
    if let Some(colors) = colors {
        for (channel, color) in found.color.iter_mut().enumerate() {
            *color = mixed(weights, colors.map(|it| it[channel]))?;
        }
    }
    if let Some(coordinates) = coordinates {
        let texture = texture(world, material, size, (weights, coordinates));
        found.color = times(found.color, texture.color);
        found.is_open = texture.is_open;
    }
    Some(found)
}

/// The part of a surface that is there.
pub struct Alpha<N> {
    pub part: N,
    pub is_open: bool,
}

/// Returns the alpha of a surface at a hit; `None` where the bounds of the point are too wide.
pub fn alpha<N: Enclosure>(
    world: &World<'_>,
    hit: &Hit<N>,
    material: &Material,
    size: Option<Log2>,
) -> Option<Alpha<N>> {
    let whole = Alpha {
        part: N::one(),
        is_open: false,
    };
    let is_used = material.maps & Material::MAPS_ALPHA != 0 && !material.is_glass();
    let solid = &world.space(hit.instance).solids[hit.solid as usize];
    let (
        true,
        Some(coordinates),
        Form::Triangle {
            corners, normal, ..
        },
    ) = (is_used, solid.paint.coordinates, solid.form)
    else {
        return Some(whole);
    };
    let Some(maps) = world.scene.surface_maps(material) else {
        return Some(whole);
    };
    // With 30 fraction bits, as alphas of textures have: 255 is 1.
    let ratio = |byte: u8| (i64::from(byte) << 30) / 255;
    let (_, weights) = shade::weights(world, hit, corners, normal)?;
    let mut range: Option<[i64; 2]> = None;
    let is_known = at_places(weights, coordinates, size, |place, footprint| {
        let alpha = world.scene.texture_alpha(material, place, footprint);
        let mut alpha = alpha.map_or(1 << 30, i64::from);
        if maps.cutoff > 0 {
            alpha = i64::from(alpha >= ratio(maps.cutoff)) << 30;
        }
        let [low, high] = range.unwrap_or([alpha; 2]);
        range = Some([low.min(alpha), high.max(alpha)]);
    });
    let [low, high] = range.filter(|_| is_known).unwrap_or([0, 1 << 30]);
    let mut part = N::scaled(low, 30).hull(N::scaled(high, 30));
    if maps.cutoff == 0 {
        part = part * N::scaled(ratio(maps.opacity), 30);
    }
    Some(Alpha {
        part,
        is_open: low != high,
    })
}

/// The mean of the squares of roots of 8 bits; `None` where its bounds are too wide.
fn mixed<N: Enclosure>(weights: Three<N>, roots: [u8; 3]) -> Option<N> {
    let squares = roots.map(|root| i64::from(root) * i64::from(root));
    let [a, b, c] = squares.map(N::int);
    let sum = weights[0] * a + weights[1] * b + weights[2] * c;
    let ratio = sum.div(N::int(255 * 255))?;
    Some(ratio.at_least(N::zero()).at_most(N::one()))
}

/// Calls a function with the multiples at which a texture may be looked up, for each possible footprint of a sample.
/// Returns whether there are few enough.
pub fn at_places<N: Enclosure>(
    weights: Three<N>,
    coordinates: [[i32; 2]; 3],
    size: Option<Log2>,
    mut call: impl FnMut([i32; 2], Footprint),
) -> bool {
    // The first and the last of the multiples along u and v.
    let [u, v] = [0, 1].map(|axis: usize| {
        let at = |corner: usize| weights[corner] * N::int(coordinates[corner][axis].into());
        let [low, high] = (at(0) + at(1) + at(2)).bounds();
        [low.floor() as i64, high.floor() as i64]
    });
    let places = |[low, high]: [i64; 2]| high.saturating_sub(low).saturating_add(1);
    let count = places(u).saturating_mul(places(v));
    if !(1..=MOST_PLACES).contains(&count) {
        return false;
    }
    let footprints: Vec<Footprint> = match size.map(Log2::footprints) {
        None => vec![Footprint::point()],
        Some(None) => return false,
        Some(Some(all)) => all.collect(),
    };
    for v in v[0]..=v[1] {
        for u in u[0]..=u[1] {
            for &footprint in &footprints {
                call([u as i32, v as i32], footprint);
            }
        }
    }
    true
}

fn texture<N: Enclosure>(
    world: &World<'_>,
    material: &Material,
    size: Option<Log2>,
    (weights, coordinates): (Three<N>, [[i32; 2]; 3]),
) -> Weight<N> {
    let mut range: Option<[[i32; 2]; 3]> = None;
    let is_known = at_places(weights, coordinates, size, |place, footprint| {
        let color = world.scene.texture_color(material, place, footprint);
        let color = color.unwrap_or([1 << 30; 3]);
        range = Some(match range {
            None => color.map(|it| [it, it]),
            Some(range) => [0, 1, 2].map(|k: usize| {
                let [low, high] = range[k];
                [low.min(color[k]), high.max(color[k])]
            }),
        });
    });
    // Any color.
    let range = range.filter(|_| is_known).unwrap_or([[0, 1 << 30]; 3]);
    Weight {
        color: range.map(|[low, high]| ratio_of::<N>(low).hull(ratio_of(high))),
        is_open: range.iter().any(|[low, high]| low != high),
    }
}

#[cfg(test)]
mod tests {
    use super::super::deep::{Ball, with_bits};
    use super::*;

    #[test]
    fn colors_of_corners_without_known_weights_are_open_and_not_black() {
        with_bits(128, || {
            let any = Ball::zero().hull(Ball::float(f64::MAX));
            assert!(mixed([any * any; 3], [255; 3]).is_none());
        });
    }
}
