//! Infinite planes.

use super::analytic::{Analytic, Geometric, Map, Normal, Surface};
use super::crossing::{far, flat_span, plane_crossing, within_plane};
use super::direction::unit;
use super::exact::{self, Line, Real, dot, minus, vector};
use super::keys::Keys;
use super::lattice::Lattice;
use super::snapped::{ROUNDED_UP, integers, real};
use super::transform::{Misfit, orientation, to_size_one};
use crate::random::Random;
use glam::{DAffine3, DVec3};
use gridel_core::format::limits::FARTHEST_POINT;
use gridel_core::format::record::UnitBox;
use gridel_core::geometry::plane;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    pub point: DVec3,
    /// The normal, of any length above 0.
    pub normal: DVec3,
}

impl Geometric for Plane {
    fn is_flat(&self) -> bool {
        true
    }

    /// Its point, which counts among coordinates.
    fn ends(&self) -> [(DVec3, f64); 2] {
        [(self.point, 0.0); 2]
    }

    fn surface(&self) -> Surface {
        Surface::Plane {
            normal: self.normal,
            point: self.point,
        }
    }

    fn feature(&self) -> Option<f64> {
        None
    }

    /// Returns the reach of a scene's box.
    fn size(&self) -> f64 {
        f64::from(u16::MAX)
    }

    fn point(&self, direction: DVec3, _: &mut Random) -> DVec3 {
        let normal = self.normal.normalize();
        let across = direction - direction.dot(normal) * normal;
        self.point + f64::from(i16::MAX) * across
    }

    fn spans(&self, line: &Line, grow: &Real) -> Vec<(Real, Real)> {
        let normal = exact::unit(&vector(self.normal));
        let point = vector(self.point);
        let span = match plane_crossing(line, &normal, &point) {
            Some((t, tilt)) => flat_span(t, far(), &tilt, line, grow),
            None => within_plane(line, &normal, &point, grow),
        };
        span.into_iter().collect()
    }

    fn excess(&self, point: [f64; 3]) -> f64 {
        let apart = minus(&vector(point), &vector(self.point));
        let normal = exact::unit(&vector(self.normal));
        dot(&normal, &apart).abs().to_f64()
    }

    fn normals(&self, _: [f64; 3]) -> Vec<Normal> {
        vec![Normal::flat(exact::unit(&vector(self.normal)))]
    }
}

impl Analytic for Plane {
    const TEST_COST: f64 = 2.0;
    const KINDS: &[(&str, &[&str])] = &[("plane", &["point", "normal"])];

    type Record = plane::Plane;

    fn read<K: Keys>(_: &str, keys: &K) -> Result<Self, K::Error> {
        Ok(Self {
            point: keys.point("point")?,
            normal: keys.direction("normal")?,
        })
    }

    fn map(&self, by: &Map<'_>) -> Self {
        Self {
            point: (by.point)(self.point),
            normal: (by.direction)(self.normal),
        }
    }

    fn has_extent(&self) -> bool {
        self.normal != DVec3::ZERO
    }

    /// Its point.
    fn bounds(&self) -> [DVec3; 2] {
        [self.point; 2]
    }

    fn support(&self, direction: DVec3) -> f64 {
        self.point.dot(direction)
    }

    fn transformed(&self, by: &DAffine3) -> Result<Self, Misfit> {
        orientation(by.matrix3)?;
        // Vectors at right angles to the plane stay so.
        let turned = to_size_one(by.matrix3).1.inverse().transpose();
        Ok(Self {
            point: by.transform_point3(self.point),
            normal: turned * unit(self.normal),
        })
    }

    /// Returns the largest displacement within the range of box coordinates.
    fn displacement(&self, other: &Self) -> f64 {
        // Scaled, so that squares stay in range.
        let [n, m] = [self.normal, other.normal].map(|it| it / it.abs().max_element());
        let sine = n.cross(m).length() / (n.length() * m.length());
        let reach = other.point.length() + f64::from(i16::MAX) * 256.0 * 3.0_f64.sqrt();
        let apart = (self.point - other.point).dot(n.normalize()).abs();
        (apart + sine * reach) * ROUNDED_UP
    }

    /// Rounds only the coordinates that count. For a plane at right angles to an axis that is the one on the axis.
    /// Otherwise it is all of the plane's point. If that point is far away, it is the point nearest to the lattice's
    /// middle.
    fn settled(&self, rounded: Self, lattice: &Lattice) -> (Self, f64) {
        let along = rounded.normal.normalize();
        let tilts = along.abs().cmpgt(DVec3::ZERO);
        let is_tilted = tilts.bitmask().count_ones() > 1;
        let is_near = self.point.abs().max_element() <= f64::from(i16::MAX) * 256.0;
        let point = if is_tilted && is_near {
            self.point
        } else {
            // By the given normal: far from its point, a plane with the rounded one lies elsewhere.
            let normal = self.normal.normalize();
            DVec3::select(tilts, normal * self.point.dot(normal), DVec3::ZERO)
        };
        let step = lattice.fine_steps();
        let settled = Self {
            point: (point / step).round() * step,
            normal: rounded.normal,
        };
        let displacement = self.displacement(&settled);
        (settled, displacement)
    }

    fn record(&self) -> (plane::Plane, bool) {
        let record = plane::Plane {
            point: integers(self.point),
            normal: integers(self.normal),
        };
        (
            record,
            self.point.abs().max_element() <= FARTHEST_POINT as f64,
        )
    }

    fn record_bounds(_: &plane::Plane) -> UnitBox {
        UnitBox([[i16::MIN, i16::MAX]; 3])
    }

    fn of_record(record: &plane::Plane) -> Self {
        Self {
            point: real(record.point),
            normal: real(record.normal),
        }
    }
}
