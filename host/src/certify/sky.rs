//! The environment, in exact arithmetic: a map that is defined by integers, and a sun.

use super::crossing::exact;
use super::directions;
use super::number::*;
use gridel_core::format::environment::Environment;
use gridel_core::{RayKind, Scene};

/// The dimension of points of the map.
pub const DIMENSION: u16 = 0x1020;

/// Largest distance between the ends of a place: less than the range of one weight, so that nothing lies between them.
const NARROW: i64 = 1 << 13;

/// Radiance, and whether it is open what of the environment it is.
pub struct Sky<N> {
    pub radiance: Three<N>,
    pub is_open: bool,
}

/// Returns the light of a ray that hits nothing, by its kind; `None` where its bounds are too wide.
pub fn seen<N: Enclosure>(
    scene: &Scene<'_>,
    record: &Environment,
    direction: Three<N>,
    kind: RayKind,
) -> Option<Sky<N>> {
    let [shows_map, shows_sun] = match kind {
        RayKind::Primary | RayKind::Reflected | RayKind::Refracted => [true; 2],
        RayKind::Glossy | RayKind::Polished => [true, false],
        RayKind::Shadow | RayKind::Diffuse => [false; 2],
    };
    if !shows_map {
        return Some(Sky {
            radiance: [N::zero(); 3],
            is_open: false,
        });
    }
    let direction = unit(direction)?;
    let mut sky = map(scene, direction)?;
    if shows_sun && record.sun_radius > 0 {
        let off = minus(direction, record.sun_direction.map(ratio_of));
        let beyond = norm2(off) - ratio_of::<N>(record.sun_radius).square();
        let with_sun = plus(sky.radiance, record.sun_radiance.map(radiance_of));
        match positive(beyond) {
            Some(true) => {}
            Some(false) => sky.radiance = with_sun,
            None => {
                sky.radiance = hull(sky.radiance, with_sun);
                sky.is_open = true;
            }
        }
    }
    Some(sky)
}

/// The ends of a coordinate of the map, with 30 fraction bits, rounded down.
fn ends<N: Enclosure>(coordinate: N) -> Option<[i64; 2]> {
    let limit = |x: f64| x.clamp(-1.0, 1.0);
    let ends = coordinate
        .bounds()
        .map(|x| (limit(x) * f64::from(1 << 30)).floor() as i64);
    (ends[1] - ends[0] < NARROW).then_some(ends)
}

/// The radiance of the map in a direction of length 1.
fn map<N: Enclosure>(scene: &Scene<'_>, [x, y, z]: Three<N>) -> Option<Sky<N>> {
    let sum = x.abs() + y.abs() + z.abs();
    let [x, y] = [x.div(sum)?, y.div(sum)?];
    // Seen along z, and turned outwards on the lower half, to the side of the sign of either coordinate.
    let mut places = Vec::new();
    let is_below = positive(-z);
    if is_below != Some(true) {
        places.push([x, y]);
    }
    if is_below != Some(false) {
        let signs = |along: N| match positive(-along) {
            Some(true) => vec![-N::one()],
            Some(false) => vec![N::one()],
            None => vec![-N::one(), N::one()],
        };
        for sign_x in signs(x) {
            for sign_y in signs(y) {
                let rest = |of: N, sign: N| sign * (N::one() - of.abs());
                places.push([rest(y, sign_x), rest(x, sign_y)]);
            }
        }
    }
    let mut range: Option<[[i32; 2]; 3]> = None;
    for [x, y] in places {
        let (x, y) = (ends(x)?, ends(y)?);
        for place in [[x[0], y[0]], [x[0], y[1]], [x[1], y[0]], [x[1], y[1]]] {
            let found = scene.environment_radiance(place.map(|it| it as i32))?;
            let mut all = range.unwrap_or(found.map(|it| [it; 2]));
            for ([low, high], found) in all.iter_mut().zip(found) {
                (*low, *high) = ((*low).min(found), (*high).max(found));
            }
            range = Some(all);
        }
    }
    let range = range?;
    Some(Sky {
        radiance: range.map(|[low, high]| radiance_of::<N>(low).hull(radiance_of(high))),
        is_open: range.iter().any(|[low, high]| low != high),
    })
}

/// Returns a direction of the map as a light, of any length, and its radiance.
pub fn from_map<N: Enclosure>(scene: &Scene<'_>, point: [u32; 2]) -> Option<(Three<N>, Three<N>)> {
    let one = 1_i64 << 30;
    let place = scene.environment_place(point)?;
    let [x, y] = place.map(i64::from);
    let z = one - x.abs() - y.abs();
    let rest = |of: i64, sign: i64| (one - of.abs()) * if sign < 0 { -1 } else { 1 };
    let [x, y] = if z < 0 {
        [rest(y, x), rest(x, y)]
    } else {
        [x, y]
    };
    let direction = exact::<N>([x, y, z]);
    // Half the sum of the components at length 1, rounded down; their sum is one.
    let half_sum = N::scaled(1 << 59, 0).div(norm2(direction).sqrt())?;
    let [low, high] = half_sum.bounds().map(|it| it.floor() as i32);
    let (low, high) = (
        scene.environment_light(place, low)?,
        scene.environment_light(place, high)?,
    );
    let radiance = [0, 1, 2].map(|k| radiance_of::<N>(low[k]).hull(radiance_of(high[k])));
    Some((direction, radiance))
}

/// Returns a direction of the sun. The squares of lengths from its middle, on a sphere, are uniform.
pub fn in_sun<N: Enclosure>(record: &Environment, [u, v]: [u32; 2]) -> Option<Three<N>> {
    let half = ratio_of::<N>(record.sun_radius).half() * directions::ratio::<N>(u).sqrt();
    let square = half.square();
    let toward = N::one() - (square + square);
    let away = half * (N::one() - square).sqrt();
    let away = away + away;
    let [sine, cosine] = directions::turn::<N>(v);
    let sun = record.sun_direction.map(ratio_of);
    let sides = directions::perpendiculars(sun)?;
    Some(directions::combined(
        sun,
        toward,
        sides,
        [away * cosine, away * sine],
    ))
}
