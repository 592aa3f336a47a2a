//! Capped cylinders, cones and frusta.

use super::analytic::{Analytic, Geometric, Map, Normal};
use super::crossing::{far, overlap, roots, slab};
use super::disc::Disc;
use super::exact::{Line, Real, Vector, along, dot, minus, norm, scaled, unit, vector};
use super::keys::Keys;
use super::lattice::Lattice;
use super::snapped::{around, disc_reach, integers, real};
use crate::random::Random;
use glam::DVec3;
use gridel_core::format::record::UnitBox;
use gridel_core::geometry::cone;

/// Steps by which the surface of a cone may move before a better axis is searched for. Rounding the points and radii
/// moves it, and so does a lean of the axis.
const GOOD: f64 = 2.0;

/// A solid between two flat caps: a cylinder where the radii are equal, a cone where one is
/// 0, a frustum otherwise. NFF's open cones are closed by caps, because the solid is what
/// refraction needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    pub base: DVec3,
    pub base_radius: f64,
    pub apex: DVec3,
    pub apex_radius: f64,
}

impl Cone {
    /// Returns the two caps.
    fn caps(&self) -> [Disc; 2] {
        let normal = self.apex - self.base;
        self.ends().map(|(center, radius)| Disc {
            center,
            normal,
            radius,
        })
    }

    fn frame(&self) -> Frame {
        let half = Real::of(0.5);
        let (base, apex) = (vector(self.base), vector(self.apex));
        let up = minus(&apex, &base);
        let height = norm(&up);
        let narrowing = Real::of(self.base_radius - self.apex_radius);
        let slant = (&height * &height + &narrowing * &narrowing).sqrt();
        Frame {
            axis: unit(&up),
            middle: scaled(&along(&base, &Real::of(1.0), &apex), &half),
            cos: &height / &slant,
            sin: narrowing / slant,
            half_height: height * &half,
            radius: Real::of(self.base_radius + self.apex_radius) * half,
        }
    }
}

/// A solid of revolution: its middle, axis and half angle.
struct Frame {
    axis: Vector,
    middle: Vector,
    half_height: Real,
    radius: Real,
    cos: Real,
    sin: Real,
}

impl Frame {
    /// Returns a point's height along the axis, and its offset from the axis.
    fn parts(&self, from_middle: &Vector) -> (Real, Vector) {
        let y = dot(from_middle, &self.axis);
        let across = along(from_middle, &-&y, &self.axis);
        (y, across)
    }

    /// Returns the mantle's normal on the side of an offset from the axis.
    fn mantle(&self, across: &Vector, condition: f64) -> Normal {
        let radial = scaled(&unit(across), &self.cos);
        Normal {
            exact: along(&radial, &self.sin, &self.axis),
            condition,
            size: (&self.half_height / &self.cos).to_f64(),
        }
    }
}

impl Geometric for Cone {
    fn ends(&self) -> [(DVec3, f64); 2] {
        [(self.base, self.base_radius), (self.apex, self.apex_radius)]
    }

    fn feature(&self) -> Option<f64> {
        let height = self.base.distance(self.apex);
        Some(height.min(2.0 * self.base_radius.max(self.apex_radius)))
    }

    /// Returns a random point on the axis.
    fn point(&self, _: DVec3, random: &mut Random) -> DVec3 {
        self.base.lerp(self.apex, random.unit())
    }

    fn spans(&self, line: &Line, grow: &Real) -> Vec<(Real, Real)> {
        let frame = self.frame();
        let from = minus(&line.origin, &frame.middle);
        let d = &line.slope;
        let (y, rise) = (dot(&from, &frame.axis), dot(d, &frame.axis));
        let caps = slab(&y, &rise, &(&frame.half_height + grow));
        // cos rho <= g - e t.
        let cos2 = &frame.cos * &frame.cos;
        let g = &frame.cos * &frame.radius + grow - &frame.sin * &y;
        let e = &frame.sin * &rise;
        let a = &cos2 * (dot(d, d) - &rise * &rise) - &e * &e;
        let b = &cos2 * (dot(&from, d) - &y * &rise) + &g * &e;
        let c = &cos2 * (dot(&from, &from) - &y * &y) - &g * &g;
        let mantle = if a.is_zero() {
            if b.is_zero() {
                (!c.is_positive() && !g.is_negative()).then(|| (-far(), far()))
            } else if b.is_positive() == e.is_positive() {
                let root = -c / (&b + &b);
                Some(if b.is_positive() {
                    (-far(), root)
                } else {
                    (root, far())
                })
            } else {
                None
            }
        } else if a.is_positive() {
            roots(&a, &b, &c).filter(|_| !(&g * &a + &e * &b).is_negative())
        } else {
            roots(&a, &b, &c).map(|(low, high)| {
                if e.is_positive() {
                    (-far(), low)
                } else {
                    (high, far())
                }
            })
        };
        overlap(caps, mantle).into_iter().collect()
    }

    fn excess(&self, point: [f64; 3]) -> f64 {
        let frame = self.frame();
        let (y, across) = frame.parts(&minus(&vector(point), &frame.middle));
        let mantle = &frame.cos * (norm(&across) - &frame.radius) + &frame.sin * &y;
        mantle.max(y.abs() - &frame.half_height).to_f64()
    }

    fn normals(&self, point: [f64; 3]) -> Vec<Normal> {
        let frame = self.frame();
        let from_middle = minus(&vector(point), &frame.middle);
        let (_, across) = frame.parts(&from_middle);
        let distance = norm(&across).to_f64().max(1e-300);
        let condition = 1.0 + norm(&from_middle).to_f64() / distance;
        vec![
            frame.mantle(&across, condition),
            Normal::flat(frame.axis.clone()),
            Normal::flat(frame.axis.map(|x| -x)),
        ]
    }

    fn normal_towards(&self, direction: [f64; 3], point: [f64; 3], off: f64) -> Option<Normal> {
        let frame = self.frame();
        let (_, across) = frame.parts(&minus(&vector(point), &frame.middle));
        let (_, side) = frame.parts(&vector(direction));
        (norm(&across).to_f64() <= off).then(|| frame.mantle(&side, 1.0))
    }
}

impl Analytic for Cone {
    const TEST_COST: f64 = 6.0;
    const KINDS: &[(&str, &[&str])] = &[
        ("cylinder", &["base", "top", "radius"]),
        ("cone", &["base", "apex", "radius"]),
        ("frustum", &["base", "top", "base_radius", "top_radius"]),
    ];

    type Record = cone::Cone;

    fn read<K: Keys>(kind: &str, keys: &K) -> Result<Self, K::Error> {
        let ([base_radius, apex_radius], end) = match kind {
            "cylinder" => ([keys.length("radius")?; 2], "top"),
            "cone" => ([keys.length("radius")?, 0.0], "apex"),
            _ => (
                [keys.length("base_radius")?, keys.length("top_radius")?],
                "top",
            ),
        };
        keys.require(end)?;
        let (base, apex) = (keys.point("base")?, keys.point(end)?);
        if base == apex {
            let cause = format!("`base` and `{end}` are the same point");
            return Err(keys.error(end, cause, "move them apart, or use a disc"));
        }
        Ok(Self {
            base,
            base_radius,
            apex,
            apex_radius,
        })
    }

    fn kind(&self) -> &'static str {
        match self.apex_radius {
            0.0 => "cone",
            radius if radius == self.base_radius => "cylinder",
            _ => "frustum",
        }
    }

    fn map(&self, by: &Map<'_>) -> Self {
        Self {
            base: (by.point)(self.base),
            base_radius: (by.length)(self.base_radius),
            apex: (by.point)(self.apex),
            apex_radius: (by.length)(self.apex_radius),
        }
    }

    fn has_extent(&self) -> bool {
        let radii = self.base_radius + self.apex_radius;
        self.base != self.apex && radii > 0.0 && radii.is_finite()
    }

    fn bounds(&self) -> [DVec3; 2] {
        let reach = disc_reach(self.apex - self.base);
        let [base, apex] = self
            .ends()
            .map(|(center, radius)| [center - reach * radius, center + reach * radius]);
        [base[0].min(apex[0]), base[1].max(apex[1])]
    }

    fn support(&self, direction: DVec3) -> f64 {
        let [base, apex] = self.caps().map(|cap| cap.support(direction));
        base.max(apex)
    }

    /// Both solids are convex, so it is the displacement of the farther pair of caps.
    fn displacement(&self, other: &Self) -> f64 {
        let (these, others) = (self.caps(), other.caps());
        these[0]
            .displacement(&others[0])
            .max(these[1].displacement(&others[1]))
    }

    /// Rounding both ends to the lattice can move the surface by more than `GOOD` steps, because a short axis leans.
    /// Then the ends are the 1/256 units that move it least, whatever the lattice's step.
    fn settled(&self, rounded: Self, lattice: &Lattice) -> (Self, f64) {
        let displacement = self.displacement(&rounded);
        if displacement > GOOD * lattice.fine_steps() {
            straightest(self, (rounded, displacement))
        } else {
            (rounded, displacement)
        }
    }

    fn record(&self) -> (cone::Cone, bool) {
        let reach = disc_reach(self.apex - self.base);
        let ends = self.ends();
        let (bounds, fits) =
            around(&ends.map(|(center, radius)| (integers(center), reach * radius)));
        let record = cone::Cone {
            base: integers(self.base),
            apex: integers(self.apex),
            base_radius: self.base_radius as i32,
            apex_radius: self.apex_radius as i32,
            bounds,
        };
        (record, fits)
    }

    fn record_bounds(record: &cone::Cone) -> UnitBox {
        record.bounds
    }

    fn of_record(record: &cone::Cone) -> Self {
        Self {
            base: real(record.base),
            base_radius: record.base_radius.into(),
            apex: real(record.apex),
            apex_radius: record.apex_radius.into(),
        }
    }
}

/// The cone with ends and radii in 1/256 unit that is the least displaced from the given one, or
/// `best` if that is better.
///
/// Tries axes of all lengths along the major axis of the given one, from its own length on, and rounds the other two
/// components. A longer axis leans less, and moves the caps. So a length needs no trial once the caps alone move by
/// more than in the best one so far. For a coin of radius r that bounds the number of trials by some multiple of the
/// root of r, below 10,000.
fn straightest(given: &Cone, mut best: (Cone, f64)) -> (Cone, f64) {
    let Cone { base, apex, .. } = *given;
    let (axis, middle) = (apex - base, (base + apex) * 0.5);
    let (height, length) = (axis.length(), axis.abs().max_element());
    let first = length.round().max(1.0);
    let longer = std::iter::successors(Some(first), |length| Some(length + 1.0));
    let shorter = std::iter::successors(Some(first - 1.0), |length| Some(length - 1.0));
    let mut try_all = |lengths: &mut dyn Iterator<Item = f64>| {
        for trial in lengths.take_while(|&trial| trial >= 1.0) {
            let scale = trial / length;
            // Rounding adds less than 1 to the axis.
            if ((scale - 1.0).abs() * height - 1.0) * 0.5 >= best.1 {
                return;
            }
            let axis = (axis * scale).round();
            let base = (middle - axis * 0.5).round();
            let trial = Cone {
                base,
                base_radius: given.base_radius.round(),
                apex: base + axis,
                apex_radius: given.apex_radius.round(),
            };
            let displacement = given.displacement(&trial);
            if displacement < best.1 {
                best = (trial, displacement);
            }
        }
    };
    try_all(&mut longer.into_iter());
    try_all(&mut shorter.into_iter());
    best
}
