//! The light around a scene: a picture of a sky or a room, and a sun in it.
//!
//! Rays that hit nothing bring it, and surfaces are lit by it through at most two of the scene's lights. Each sample
//! sees one direction of the map, drawn in proportion to the brightness of texels, and one direction of the sun,
//! uniformly distributed. The map is an octahedral one (Praun and Hoppe, "Spherical Parametrization and Remeshing",
//! 2003), whose look-up takes one division and no sines. Rays use bilinear look-up, lights use single texels. Both have
//! the same light, except for the mixing across edges.

use super::basis::perpendicular;
use crate::accel::Number;
use crate::format::Effects;
use crate::format::environment::Environment as Record;
use crate::format::record::Light;
use crate::number::Angle;
use crate::observe::count::Observer;
use crate::observe::event::{Event, RayKind};
use crate::ray::Ray;
use crate::scene::environment::{direction_of, texel_at, turned};
use crate::shade::Color;
use crate::shade::effect::{Effect, Tracer};
use crate::shade::sampler::ratio;
use crate::shade::surface::{Aim, Lighting, Surface};

pub(crate) struct Environment;

/// The dimension of random points for the map.
const DIMENSION: u16 = 0x1020;

/// Returns whether rays of a kind bring the map, and whether they bring the sun. Where a surface has this light from a
/// light of the scene, its rays must not bring it again.
const fn is_seen_by(kind: RayKind) -> [bool; 2] {
    match kind {
        RayKind::Primary | RayKind::Reflected | RayKind::Refracted => [true; 2],
        RayKind::Glossy | RayKind::Polished => [true, false],
        RayKind::Shadow | RayKind::Diffuse => [false; 2],
    }
}

impl Effect for Environment {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects::ENVIRONMENT;

    /// Half of all directions light no surface, and the others bring more than a display shows: the mean of the samples
    /// counts.
    const DEVELOPS: bool = true;

    fn is_required_by_light(light: &Light) -> bool {
        light.is_environment()
    }

    #[inline(always)]
    fn aim<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        (): &mut (),
        number: u32,
        light: &Light,
        aim: &mut Aim<N>,
    ) {
        let scene = tracer.scene();
        if !light.is_environment() {
            return;
        }
        let Some((map, record)) = scene.environment_map() else {
            return;
        };
        let way = if light.kind == Light::SUN {
            // Lights beyond the first 4,096 share points with these.
            in_sun::<N>(record, tracer.point(number as u16 & 0xfff))
        } else {
            let place = map.draw(record, tracer.point(DIMENSION));
            direction_of(place).map(|axis| N::far(axis.into()))
        };
        *aim = Aim {
            way,
            distance: None,
            apparent_distance: None,
        };
    }

    #[inline(always)]
    fn face<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        (): &mut (),
        _: &Surface<'_, N>,
        lighting: &mut Lighting<'_, N>,
        _: &mut bool,
    ) {
        if X::Observer::ENABLED && lighting.light.is_environment() {
            let record = tracer.scene().environment();
            let map = record.filter(|_| lighting.light.kind == Light::ENVIRONMENT);
            let texel = map.map(|it| texel_at(it.size_bits, place_of(lighting.to_light).0));
            tracer.count().event(Event::FromEnvironment {
                direction: lighting.to_light.map(N::ratio_to_f64),
                texel,
            });
        }
    }

    #[inline(always)]
    fn light<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        (): &mut (),
        _: &Surface<'_, N>,
        lighting: &Lighting<'_, N>,
        arriving: &mut Color<N>,
    ) {
        if lighting.light.kind != Light::ENVIRONMENT {
            return;
        }
        if let Some((map, record)) = tracer.scene().environment_map() {
            let (place, half_sum) = place_of(lighting.to_light);
            *arriving = Color::radiance(map.sampled(record, place, half_sum.to_q30()));
        }
    }

    #[inline(always)]
    fn miss<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        (): &mut (),
        ray: &Ray<N>,
        radiance: &mut Color<N>,
    ) {
        let Some((map, record)) = tracer.scene().environment_map() else {
            return;
        };
        let [map_is_seen, sun_is_seen] = is_seen_by(tracer.kind());
        if !map_is_seen {
            *radiance = Color::BLACK;
            return;
        }
        let (place, _) = place_of(ray.slope);
        let in_sun = sun_is_seen && is_in_sun(record, ray.slope);
        *radiance = Color::radiance(map.mixed(record, place));
        if in_sun {
            *radiance = radiance.plus(Color::radiance(record.sun_radiance));
        }
        if X::Observer::ENABLED {
            tracer.count().event(Event::Environment {
                texel: texel_at(record.size_bits, place),
                sun: in_sun,
            });
        }
    }
}

/// Returns the place of a direction on the map, and half the sum of the magnitudes of its components. The magnitudes
/// are at most 1, and the largest is at least 1/2.
#[inline(never)]
fn place_of<N: Number>(direction: [N; 3]) -> ([i32; 2], N) {
    let [x, y, z] = direction;
    let sum = x.abs().half() + y.abs().half() + z.abs().half();
    let inverse = N::ONE.half().div(sum);
    let on_axis = |along: N| (along * inverse).to_q30().clamp(-(1 << 30), 1 << 30);
    let place = [on_axis(x), on_axis(y)];
    let is_below = z < N::ZERO;
    (if is_below { turned(place) } else { place }, sum)
}

/// Returns true if a direction, of any length, hits the sun.
#[inline(never)]
fn is_in_sun<N: Number>(record: &Record, direction: [N; 3]) -> bool {
    if record.sun_radius == 0 {
        return false;
    }
    let (direction, _) = N::normalize(direction);
    let sun = record.sun_direction.map(N::ratio);
    let off = |k: usize| direction[k].half() - sun[k].half();
    let (off, radius) = ([off(0), off(1), off(2)], N::ratio(record.sun_radius).half());
    N::dot(off, off) <= radius.wide(radius)
}

/// Returns a random direction of the sun: the squares of lengths from its middle, on a sphere, are uniformly
/// distributed.
#[inline(never)]
fn in_sun<N: Number>(record: &Record, [u, v]: [u32; 2]) -> [N::Wide; 3] {
    let half = N::ratio(record.sun_radius).half() * ratio::<N>(u).sqrt();
    let square = half * half;
    let toward = N::ONE - (square + square);
    let away = half * (N::ONE - square).sqrt();
    let away = away + away;
    let [sine, cosine] = Angle(v).sin_cos().map(N::ratio);
    let (right, up) = (away * cosine, away * sine);
    let sun = record.sun_direction.map(N::ratio);
    let [first, second] = perpendicular(sun);
    let axis = |k: usize| sun[k] * toward + first[k] * right + second[k] * up;
    [axis(0), axis(1), axis(2)].map(N::widen)
}

#[cfg(test)]
mod tests;
