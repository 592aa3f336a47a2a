//! Spheres.

use super::analytic::{Analytic, Geometric, Map, Normal, Surface};
use super::crossing::roots;
use super::exact::{Line, Real, dot, minus, norm, unit, vector};
use super::keys::Keys;
use super::snapped::{ROUNDED_UP, integers, real};
use crate::random::Random;
use glam::DVec3;
use gridel_core::format::record::UnitBox;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    pub center: DVec3,
    pub radius: f64,
}

/// A sphere in 1/256 unit.
#[derive(Clone, Copy, Debug)]
pub struct SnappedSphere {
    pub center: [i32; 3],
    pub radius: i32,
}

impl Geometric for Sphere {
    fn ends(&self) -> [(DVec3, f64); 2] {
        [(self.center, self.radius); 2]
    }

    fn surface(&self) -> Surface {
        let Self { center, radius } = *self;
        Surface::Sphere { center, radius }
    }

    fn feature(&self) -> Option<f64> {
        Some(2.0 * self.radius)
    }

    fn point(&self, direction: DVec3, _: &mut Random) -> DVec3 {
        self.center + self.radius * direction
    }

    fn spans(&self, line: &Line, grow: &Real) -> Vec<(Real, Real)> {
        let radius = Real::of(self.radius) + grow;
        let from = minus(&line.origin, &vector(self.center));
        let c = dot(&from, &from) - &radius * &radius;
        let span = roots(&dot(&line.slope, &line.slope), &dot(&from, &line.slope), &c);
        span.filter(|_| !radius.is_negative()).into_iter().collect()
    }

    fn excess(&self, point: [f64; 3]) -> f64 {
        let distance = norm(&minus(&vector(point), &vector(self.center)));
        (distance - Real::of(self.radius)).to_f64()
    }

    fn normals(&self, point: [f64; 3]) -> Vec<Normal> {
        let outward = minus(&vector(point), &vector(self.center));
        vec![Normal::flat(unit(&outward))]
    }
}

impl Analytic for Sphere {
    const TEST_COST: f64 = 1.0;
    const KINDS: &[(&str, &[&str])] = &[("sphere", &["center", "radius"])];

    type Record = SnappedSphere;

    fn read<K: Keys>(_: &str, keys: &K) -> Result<Self, K::Error> {
        Ok(Self {
            center: keys.point("center")?,
            radius: keys.length("radius")?,
        })
    }

    fn map(&self, by: &Map<'_>) -> Self {
        Self {
            center: (by.point)(self.center),
            radius: (by.length)(self.radius),
        }
    }

    fn has_extent(&self) -> bool {
        self.radius > 0.0
    }

    fn bounds(&self) -> [DVec3; 2] {
        [self.center - self.radius, self.center + self.radius]
    }

    fn support(&self, direction: DVec3) -> f64 {
        self.center.dot(direction) + self.radius * direction.length()
    }

    fn displacement(&self, other: &Self) -> f64 {
        let moved = self.center.distance(other.center);
        (moved + (self.radius - other.radius).abs()) * ROUNDED_UP
    }

    fn record(&self) -> (SnappedSphere, bool) {
        let record = SnappedSphere {
            center: integers(self.center),
            radius: self.radius as i32,
        };
        (record, true)
    }

    fn record_bounds(record: &SnappedSphere) -> UnitBox {
        let SnappedSphere { center, radius } = *record;
        UnitBox::around(center.map(|x| x - radius), center.map(|x| x + radius))
    }

    fn of_record(record: &SnappedSphere) -> Self {
        Self {
            center: real(record.center),
            radius: record.radius.into(),
        }
    }
}
