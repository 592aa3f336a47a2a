//! Flat discs.

use super::analytic::{Analytic, Geometric, Map, Normal, Surface};
use super::crossing::{flat_span, plane_crossing, within_plane};
use super::direction::unit;
use super::exact::{self, Line, Real, dot, minus, norm, vector};
use super::keys::Keys;
use super::snapped::{ROUNDED_UP, around, disc_reach, integers, real};
use crate::random::Random;
use glam::DVec3;
use gridel_core::format::record::UnitBox;
use gridel_core::geometry::disc;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    pub center: DVec3,
    /// Any length above 0.
    pub normal: DVec3,
    pub radius: f64,
}

impl Geometric for Disc {
    fn is_flat(&self) -> bool {
        true
    }

    fn ends(&self) -> [(DVec3, f64); 2] {
        [(self.center, self.radius); 2]
    }

    fn surface(&self) -> Surface {
        Surface::Plane {
            normal: self.normal,
            point: self.center,
        }
    }

    fn feature(&self) -> Option<f64> {
        Some(2.0 * self.radius)
    }

    fn point(&self, direction: DVec3, _: &mut Random) -> DVec3 {
        let normal = self.normal.normalize();
        self.center + self.radius * (direction - direction.dot(normal) * normal)
    }

    fn spans(&self, line: &Line, grow: &Real) -> Vec<(Real, Real)> {
        let normal = exact::unit(&vector(self.normal));
        let center = vector(self.center);
        let span = match plane_crossing(line, &normal, &center) {
            Some((t, tilt)) => {
                let apart = norm(&minus(&line.at(&t), &center));
                flat_span(t, Real::of(self.radius) - apart, &tilt, line, grow)
            }
            None => within_plane(line, &normal, &center, grow),
        };
        span.into_iter().collect()
    }

    fn excess(&self, point: [f64; 3]) -> f64 {
        let apart = minus(&vector(point), &vector(self.center));
        dot(&exact::unit(&vector(self.normal)), &apart)
            .abs()
            .to_f64()
    }

    fn normals(&self, _: [f64; 3]) -> Vec<Normal> {
        vec![Normal::flat(exact::unit(&vector(self.normal)))]
    }
}

impl Analytic for Disc {
    const TEST_COST: f64 = 2.0;
    const KINDS: &[(&str, &[&str])] = &[("disc", &["center", "normal", "radius"])];

    type Record = disc::Disc;

    fn read<K: Keys>(_: &str, keys: &K) -> Result<Self, K::Error> {
        Ok(Self {
            center: keys.point("center")?,
            normal: keys.direction("normal")?,
            radius: keys.length("radius")?,
        })
    }

    fn map(&self, by: &Map<'_>) -> Self {
        Self {
            center: (by.point)(self.center),
            normal: (by.direction)(self.normal),
            radius: (by.length)(self.radius),
        }
    }

    fn has_extent(&self) -> bool {
        self.radius > 0.0
    }

    fn bounds(&self) -> [DVec3; 2] {
        let reach = disc_reach(self.normal) * self.radius;
        [self.center - reach, self.center + reach]
    }

    fn support(&self, direction: DVec3) -> f64 {
        self.center.dot(direction) + self.radius * unit(self.normal).cross(direction).length()
    }

    fn faces(&self) -> Vec<DVec3> {
        vec![unit(self.normal) * (2.0 * std::f64::consts::PI * self.radius * self.radius)]
    }

    /// The largest distance between two discs. It is the distance of their centers plus the difference of their radii
    /// plus the smaller radius times the sine of their angle.
    fn displacement(&self, other: &Self) -> f64 {
        // Scaled, so that squares stay in range.
        let [n, m] = [self.normal, other.normal].map(|it| it / it.abs().max_element());
        let sine = n.cross(m).length() / (n.length() * m.length());
        let turned = sine * self.radius.min(other.radius);
        let round = self.center.distance(other.center) + (self.radius - other.radius).abs();
        (round + turned) * ROUNDED_UP
    }

    fn record(&self) -> (disc::Disc, bool) {
        let center = integers(self.center);
        let reach = disc_reach(self.normal) * self.radius;
        let (bounds, fits) = around(&[(center, reach)]);
        let record = disc::Disc {
            center,
            normal: integers(self.normal),
            radius: self.radius as i32,
            bounds,
        };
        (record, fits)
    }

    fn record_bounds(record: &disc::Disc) -> UnitBox {
        record.bounds
    }

    fn of_record(record: &disc::Disc) -> Self {
        Self {
            center: real(record.center),
            normal: real(record.normal),
            radius: record.radius.into(),
        }
    }
}
