//! The light around a scene: its map and its sun.

use super::exact::Exact;
use super::lights::Aim;
use super::numbers::{black, color, floor, fraction, mixed, one, real, sum};
use super::random::{beside, part, turn};
use gridel_core::RayKind;
use gridel_core::format::environment::Environment;
use gridel_host::shape::exact::{Real, Vector, dot, minus, unit};

/// The ratio 1.
const ONE: i32 = 1 << 30;

/// The dimension of random points for the map.
const MAP: u16 = 0x1020;

/// The sum of the magnitudes of components.
fn extent([x, y, z]: &Vector) -> Real {
    x.abs() + y.abs() + z.abs()
}

/// The place of a direction on the map: on the octahedron, rounded down, and turned outwards below.
fn place_of(direction: &Vector) -> [i32; 2] {
    let whole = extent(direction);
    let on_axis = |k: usize| {
        let along = &direction[k] / &whole * real(f64::from(ONE));
        floor(&along).clamp(-i64::from(ONE), i64::from(ONE)) as i32
    };
    let place = [on_axis(0), on_axis(1)];
    match direction[2].is_negative() {
        true => turned(place),
        false => place,
    }
}

/// (x, y) becomes (1 - |y|, 1 - |x|) with the signs of x and y; its own inverse.
fn turned([x, y]: [i32; 2]) -> [i32; 2] {
    let rest = |of: i32, sign: i32| (ONE - of.abs()) * if sign < 0 { -1 } else { 1 };
    [rest(y, x), rest(x, y)]
}

/// The point of the octahedron that lies at a place of the map.
fn direction_of(place: [i32; 2]) -> Vector {
    let z = ONE - place[0].abs() - place[1].abs();
    let [x, y] = if z < 0 { turned(place) } else { place };
    [x, y, z].map(|x| fraction(x, 30))
}

fn is_in_sun(record: &Environment, direction: &Vector) -> bool {
    let off = minus(&unit(direction), &color(record.sun_direction, 30));
    let radius = fraction(record.sun_radius, 30);
    record.sun_radius > 0 && dot(&off, &off) <= &radius * &radius
}

/// Returns a direction of the sun. Squares of lengths from its middle, on a sphere, are uniform.
pub fn in_sun(record: &Environment, [u, v]: [u32; 2]) -> Vector {
    let half = fraction(record.sun_radius, 30) * real(0.5) * part(u).sqrt();
    let square = &half * &half;
    let toward = one() - real(2.0) * &square;
    let away = real(2.0) * &half * (one() - &square).sqrt();
    let sun = color(record.sun_direction, 30);
    let [first, second] = beside(&sun);
    let [sine, cosine] = turn(v);
    mixed(
        [&sun, &first, &second],
        [&toward, &(&away * cosine), &(&away * sine)],
    )
}

impl Exact<'_> {
    /// Returns true if the sun is brighter than its record holds.
    pub fn is_sun_limited(&self) -> bool {
        let record = self.scene.environment();
        record.is_some_and(|it| it.sun_radiance.contains(&i32::MAX))
    }

    /// The map as a light.
    pub fn map_light(&self, point: impl Fn(u16) -> [u32; 2]) -> Option<Aim> {
        let place = self.scene.environment_place(point(MAP))?;
        let way = direction_of(place);
        let half_sum = floor(&(extent(&unit(&way)) * real(f64::from(ONE / 2))));
        let brought = self.scene.environment_light(place, half_sum as i32)?;
        Some(Aim::far(way, color(brought, 20)))
    }

    /// Returns the light of a ray that hits nothing, by its kind.
    pub fn missed(&self, kind: RayKind, direction: &Vector) -> Vector {
        let Some(record) = self.scene.environment() else {
            return color(self.scene.view().background, 20);
        };
        // Rays do not bring the light again that reaches a surface as a light of the scene.
        let (sees_map, sees_sun) = match kind {
            RayKind::Primary | RayKind::Reflected | RayKind::Refracted => (true, true),
            RayKind::Glossy | RayKind::Polished => (true, false),
            RayKind::Shadow | RayKind::Diffuse => (false, false),
        };
        if !sees_map {
            return black();
        }
        let place = place_of(direction);
        let radiance = self.scene.environment_radiance(place).expect("a map");
        let radiance = color(radiance, 20);
        if sees_sun && is_in_sun(record, direction) {
            return sum(&radiance, &color(record.sun_radiance, 20));
        }
        radiance
    }
}
