//! Boxes along the axes.

use super::analytic::{Analytic, Geometric, Map, Normal, Surface};
use super::crossing::{far, overlap, slab};
use super::exact::{Line, Real, vector};
use super::keys::Keys;
use super::snapped::{ROUNDED_UP, integers, real};
use super::transform::{Mesh, Misfit, UNEVEN, axis_aligned};
use crate::random::Random;
use glam::{DAffine3, DVec3};
use gridel_core::format::record::UnitBox;
use gridel_core::geometry::cuboid;

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    pub min: DVec3,
    pub max: DVec3,
}

impl Geometric for Cuboid {
    fn ends(&self) -> [(DVec3, f64); 2] {
        [(self.min, 0.0), (self.max, 0.0)]
    }

    fn surface(&self) -> Surface {
        Surface::Box
    }

    /// A flat box is as a sheet is.
    fn feature(&self) -> Option<f64> {
        let sides = (self.max - self.min).to_array().into_iter();
        Some(
            sides
                .filter(|&side| side > 0.0)
                .fold(f64::INFINITY, f64::min),
        )
    }

    fn point(&self, _: DVec3, random: &mut Random) -> DVec3 {
        let share = DVec3::from_array([0; 3].map(|_| random.unit()));
        self.min + share * (self.max - self.min)
    }

    fn spans(&self, line: &Line, grow: &Real) -> Vec<(Real, Real)> {
        let span = (0..3).try_fold((-far(), far()), |span, axis| {
            let (low, high) = (Real::of(self.min[axis]), Real::of(self.max[axis]));
            let half = Real::of(0.5);
            let middle = (&low + &high) * &half;
            let reach = (high - low) * half + grow;
            let place = &line.origin[axis] - middle;
            overlap(Some(span), slab(&place, &line.slope[axis], &reach))
        });
        span.into_iter().collect()
    }

    fn excess(&self, point: [f64; 3]) -> f64 {
        let point = DVec3::from_array(point);
        (self.min - point).max(point - self.max).max_element()
    }

    fn normals(&self, _: [f64; 3]) -> Vec<Normal> {
        let ways = DVec3::AXES.into_iter().flat_map(|axis| [-axis, axis]);
        ways.map(|way| Normal::flat(vector(way))).collect()
    }
}

impl Analytic for Cuboid {
    const TEST_COST: f64 = 2.0;
    const KINDS: &[(&str, &[&str])] = &[("box", &["min", "max"])];

    type Record = cuboid::Cuboid;

    /// A box may be flat, but not a line or a point, which would have no surface.
    fn read<K: Keys>(_: &str, keys: &K) -> Result<Self, K::Error> {
        keys.require("min")?;
        keys.require("max")?;
        let (min, max) = (keys.point("min")?, keys.point("max")?);
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let (low, high) = (min[axis], max[axis]);
            if low > high {
                return Err(keys.error(
                    "min",
                    format!("the box is empty: on {name} `min` is {low} and `max` is {high}"),
                    "write the smaller number of each axis into `min`",
                ));
            }
        }
        if min.cmpeq(max).bitmask().count_ones() > 1 {
            return Err(keys.error(
                "max",
                "the box has no surface: `min` and `max` are equal on more than one axis".into(),
                "give the box an extent on at least two axes",
            ));
        }
        Ok(Self { min, max })
    }

    fn map(&self, by: &Map<'_>) -> Self {
        let (a, b) = ((by.point)(self.min), (by.point)(self.max));
        Self {
            min: a.min(b),
            max: a.max(b),
        }
    }

    fn has_extent(&self) -> bool {
        true
    }

    fn bounds(&self) -> [DVec3; 2] {
        [self.min, self.max]
    }

    fn support(&self, direction: DVec3) -> f64 {
        (self.min * direction)
            .max(self.max * direction)
            .element_sum()
    }

    fn faces(&self) -> Vec<DVec3> {
        let size = self.max - self.min;
        let face = |k: usize| 2.0 * size[(k + 1) % 3] * size[(k + 2) % 3] * DVec3::AXES[k];
        (0..3).flat_map(|k| [face(k), -face(k)]).collect()
    }

    fn transformed(&self, by: &DAffine3) -> Result<Self, Misfit> {
        let matrix3 = axis_aligned(by.matrix3).ok_or(UNEVEN)?;
        let by = DAffine3 { matrix3, ..*by };
        Ok(self.map(&Map {
            point: &|point| by.transform_point3(point),
            direction: &|direction| direction,
            length: &|length| length,
        }))
    }

    /// The six faces as twelve triangles, outside in front; a flat box has two faces.
    fn as_mesh(&self) -> Option<Mesh> {
        let Self { min, max } = *self;
        // Bit 0, 1, 2 of a vertex's index: at `max` on x, y, z.
        let corner = |index: u32| {
            let at_max = glam::BVec3::new(index & 1 != 0, index & 2 != 0, index & 4 != 0);
            DVec3::select(at_max, max, min)
        };
        let vertices = (0..8).map(corner).collect();
        let mut triangles = Vec::with_capacity(12);
        for axis in 0..3 {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            if min[u] == max[u] || min[v] == max[v] {
                continue;
            }
            let (u, v, top) = (1 << u, 1 << v, 1 << axis);
            triangles.extend([[0, v, u | v], [0, u | v, u]]);
            triangles.extend([[top, top | u, top | u | v], [top, top | u | v, top | v]]);
        }
        Some((vertices, triangles))
    }

    fn displacement(&self, other: &Self) -> f64 {
        let (low, high) = (self.min - other.min, self.max - other.max);
        low.abs().max(high.abs()).length() * ROUNDED_UP
    }

    fn record(&self) -> (cuboid::Cuboid, bool) {
        let [lowest, highest] = self.bounds().map(integers);
        (cuboid::Cuboid { lowest, highest }, true)
    }

    fn record_bounds(record: &cuboid::Cuboid) -> UnitBox {
        UnitBox::around(record.lowest, record.highest)
    }

    fn of_record(record: &cuboid::Cuboid) -> Self {
        Self {
            min: real(record.lowest),
            max: real(record.highest),
        }
    }
}
