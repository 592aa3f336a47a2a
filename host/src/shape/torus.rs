//! Tori. The real roots of the textbook's quartic, in arithmetic of 320 bits, decide where a line crosses one.

use super::analytic::{Analytic, Geometric, Map, Normal};
use super::direction;
use super::exact::{Line, Real, Vector, along, dot, minus, norm, unit, vector};
use super::keys::Keys;
use super::snapped::{ROUNDED_UP, around, disc_reach, integers, real};
use crate::random::Random;
use glam::DVec3;
use gridel_core::format::record::UnitBox;
use gridel_core::geometry::torus;
use std::cmp::Ordering;

/// The solid that a disc of the minor radius sweeps along a circle of the major radius around an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus {
    pub center: DVec3,
    /// The direction of the axis; any length above 0.
    pub axis: DVec3,
    pub major_radius: f64,
    pub minor_radius: f64,
}

impl Torus {
    fn ring(&self) -> Ring {
        Ring {
            center: vector(self.center),
            axis: unit(&vector(self.axis)),
            major: Real::of(self.major_radius),
            minor: Real::of(self.minor_radius),
        }
    }

    /// Returns its reach from its center along each axis of coordinates.
    fn reach(&self) -> DVec3 {
        disc_reach(self.axis) * self.major_radius + self.minor_radius
    }
}

impl Geometric for Torus {
    fn is_convex(&self) -> bool {
        false
    }

    fn ends(&self) -> [(DVec3, f64); 2] {
        [(self.center, self.major_radius + self.minor_radius); 2]
    }

    fn feature(&self) -> Option<f64> {
        Some(2.0 * self.minor_radius)
    }

    fn point(&self, direction: DVec3, _: &mut Random) -> DVec3 {
        let axis = self.axis.normalize();
        self.center + self.major_radius * (direction - direction.dot(axis) * axis)
    }

    fn spans(&self, line: &Line, grow: &Real) -> Vec<(Real, Real)> {
        let ring = self.ring();
        let minor = &ring.minor + grow;
        if minor.is_positive() {
            ring.spans(line, &minor)
        } else {
            Vec::new()
        }
    }

    fn excess(&self, point: [f64; 3]) -> f64 {
        let ring = self.ring();
        (ring.distance(&vector(point)) - &ring.minor).to_f64()
    }

    fn normals(&self, point: [f64; 3]) -> Vec<Normal> {
        let (ring, point) = (self.ring(), vector(point));
        vec![Normal {
            exact: ring.normal(&point),
            condition: 1.0 + self.extent() / self.minor_radius.min(ring.distance_from_axis(&point)),
            size: f64::INFINITY,
        }]
    }

    /// Returns the normals where it meets its axis: the axis, in both directions.
    fn normals_within(&self, point: [f64; 3], off: f64) -> Option<Vec<Normal>> {
        let axis = self.ring().axis_within(&vector(point), off)?;
        Some(vec![
            Normal::flat(axis.clone()),
            Normal::flat(axis.map(|x| -x)),
        ])
    }
}

impl Analytic for Torus {
    const TEST_COST: f64 = 12.0;
    const KINDS: &[(&str, &[&str])] =
        &[("torus", &["center", "axis", "major_radius", "minor_radius"])];

    type Record = torus::Torus;

    fn read<K: Keys>(_: &str, keys: &K) -> Result<Self, K::Error> {
        Ok(Self {
            center: keys.point("center")?,
            axis: keys.direction("axis")?,
            major_radius: keys.length("major_radius")?,
            minor_radius: keys.length("minor_radius")?,
        })
    }

    fn map(&self, by: &Map<'_>) -> Self {
        Self {
            center: (by.point)(self.center),
            axis: (by.direction)(self.axis),
            major_radius: (by.length)(self.major_radius),
            minor_radius: (by.length)(self.minor_radius),
        }
    }

    /// Returns true if the minor radius is above 0. With a major radius of 0 the torus is a sphere.
    fn has_extent(&self) -> bool {
        self.minor_radius > 0.0
    }

    fn bounds(&self) -> [DVec3; 2] {
        let reach = self.reach();
        [self.center - reach, self.center + reach]
    }

    fn support(&self, direction: DVec3) -> f64 {
        let circle = self.major_radius * direction::unit(self.axis).cross(direction).length();
        self.center.dot(direction) + circle + self.minor_radius * direction.length()
    }

    /// The displacement is that of the circles plus that of the minor radii. Circles are at most as far apart as their
    /// centers, their radii and the ends of their axes, of the smaller radius's length.
    ///
    /// From a point beneath a surface the path outward is equally short, except in the pit of a spindle torus. There it
    /// reaches the axis first, and continues along the axis.
    fn displacement(&self, other: &Self) -> f64 {
        let (major, minor) = (self.major_radius, self.minor_radius);
        let turned = direction::unit(self.axis).distance(direction::unit(other.axis))
            * major.min(other.major_radius);
        let circles =
            self.center.distance(other.center) + (major - other.major_radius).abs() + turned;
        let apart = circles + (minor - other.minor_radius).abs();
        let along_axis = |torus: &Self| {
            let (major, minor) = (torus.major_radius, torus.minor_radius);
            let height = |r: f64| ((r - major).max(0.0) * (r + major)).sqrt();
            height(minor) - height((minor - apart).max(0.0))
        };
        (apart + along_axis(self).max(along_axis(other))) * ROUNDED_UP
    }

    fn record(&self) -> (torus::Torus, bool) {
        let center = integers(self.center);
        let (bounds, fits) = around(&[(center, self.reach())]);
        let record = torus::Torus {
            center,
            axis: integers(self.axis),
            major_radius: self.major_radius as i32,
            minor_radius: self.minor_radius as i32,
            bounds,
        };
        (record, fits)
    }

    fn record_bounds(record: &torus::Torus) -> UnitBox {
        record.bounds
    }

    fn of_record(record: &torus::Torus) -> Self {
        Self {
            center: real(record.center),
            axis: real(record.axis),
            major_radius: record.major_radius.into(),
            minor_radius: record.minor_radius.into(),
        }
    }
}

/// Bits to which roots are found, of the interval that holds them.
const BITS: usize = 220;

/// A torus in real numbers.
struct Ring {
    center: Vector,
    /// The axis, of length 1.
    axis: Vector,
    major: Real,
    minor: Real,
}

impl Ring {
    /// Returns the distance of a point from the circle.
    fn distance(&self, point: &Vector) -> Real {
        let (y, outward) = self.parts(point);
        let beyond = norm(&outward) - &self.major;
        (&beyond * &beyond + &y * &y).sqrt()
    }

    /// Returns a point's height along the axis, and its offset from it.
    fn parts(&self, point: &Vector) -> (Real, Vector) {
        let q = minus(point, &self.center);
        let y = dot(&q, &self.axis);
        let outward = along(&q, &-&y, &self.axis);
        (y, outward)
    }

    /// The axis, if a point lies on it or so near by.
    fn axis_within(&self, point: &Vector, off: f64) -> Option<Vector> {
        let (_, outward) = self.parts(point);
        (norm(&outward) <= Real::of(off)).then(|| self.axis.clone())
    }

    /// Returns the distance of a point from the axis.
    fn distance_from_axis(&self, point: &Vector) -> f64 {
        let (_, outward) = self.parts(point);
        norm(&outward).to_f64().max(f64::MIN_POSITIVE)
    }

    /// The outward normal next to a point.
    fn normal(&self, point: &Vector) -> Vector {
        let (_, outward) = self.parts(point);
        let circle = along(&self.center, &self.major, &unit(&outward));
        unit(&minus(point, &circle))
    }

    /// Returns the spans of a line inside of the torus with this minor radius, above 0, in order.
    fn spans(&self, line: &Line, minor: &Real) -> Vec<(Real, Real)> {
        let d = &line.slope;
        let square = dot(d, d);
        let from = minus(&line.origin, &self.center);
        let closest = -dot(&from, d) / &square;
        let p = along(&from, &closest, d);
        let (y, rise) = (dot(&p, &self.axis), dot(d, &self.axis));
        let of = Real::of;
        let (c, b) = (dot(&p, &p), dot(&p, d));
        let k = &c + &self.major * &self.major - minor * minor;
        let wide = of(4.0) * &self.major * &self.major;
        let quartic = [
            &k * &k - &wide * (&c - &y * &y),
            of(4.0) * &b * &k - of(2.0) * &wide * (&b - &y * &rise),
            of(4.0) * &b * &b + of(2.0) * &square * &k - &wide * (&square - &rise * &rise),
            of(4.0) * &square * &b,
            &square * &square,
        ];
        // In lengths of the slope, which may be short.
        let reach = ((&self.major + minor) * of(1.0625) + of(1e-9)) / square.sqrt();
        let mut ends = vec![-&reach];
        ends.extend(roots(&quartic, &reach));
        // Along the axis of a spindle torus both sheets are met at once, so no sign changes.
        ends.extend(roots(&slope(&quartic), &reach));
        ends.push(reach);
        ends.sort_by(|a, b| a.partial_cmp(b).unwrap_or(Ordering::Equal));
        let mut spans: Vec<(Real, Real)> = Vec::new();
        for pair in ends.windows(2) {
            // The roots of the inner sheet of a spindle torus are inside.
            let middle = (&pair[0] + &pair[1]) * of(0.5);
            let place = along(&line.origin, &(&closest + &middle), d);
            if self.distance(&place) > *minor {
                continue;
            }
            let (enter, leave) = (&closest + &pair[0], &closest + &pair[1]);
            match spans.last_mut() {
                Some(last) if last.1 == enter => last.1 = leave,
                _ => spans.push((enter, leave)),
            }
        }
        spans
    }
}

fn value(polynomial: &[Real], x: &Real) -> Real {
    let rest = polynomial.iter().rev();
    rest.fold(Real::of(0.0), |sum, coefficient| sum * x + coefficient)
}

fn slope(polynomial: &[Real]) -> Vec<Real> {
    let powers = (1..polynomial.len()).map(|power| &polynomial[power] * Real::of(power as f64));
    powers.collect()
}

/// The roots of a polynomial between `-reach` and `reach` at which it changes its sign, in order. Its
/// coefficients begin with that of 1.
fn roots(polynomial: &[Real], reach: &Real) -> Vec<Real> {
    if polynomial.len() < 2 {
        return Vec::new();
    }
    let slope = slope(polynomial);
    // Between the roots of its slope it is monotonic.
    let mut ends = vec![-reach];
    ends.extend(roots(&slope, reach));
    ends.push(reach.clone());
    let of_pair = |pair: &[Real]| {
        let (first, last) = (value(polynomial, &pair[0]), value(polynomial, &pair[1]));
        if first.is_negative() == last.is_negative() {
            return None;
        }
        Some(root(polynomial, &slope, &pair[0], &pair[1]))
    };
    ends.windows(2).filter_map(of_pair).collect()
}

/// The one root between two places, by Newton's steps, or where they lead out, by halves.
fn root(polynomial: &[Real], slope: &[Real], first: &Real, last: &Real) -> Real {
    let (mut low, mut high) = (first.clone(), last.clone());
    let rises = value(polynomial, &low).is_negative();
    let half = Real::of(0.5);
    let least = (&high - &low) * Real::of(f64::powi(2.0, -(BITS as i32)));
    let mut x = (&low + &high) * &half;
    for _ in 0..BITS {
        let y = value(polynomial, &x);
        if y.is_negative() == rises {
            low = x.clone();
        } else {
            high = x.clone();
        }
        let steepness = value(slope, &x);
        let middle = (&low + &high) * &half;
        let next = if steepness == Real::of(0.0) {
            middle
        } else {
            let step = y / steepness;
            // Where the last steps are roundings, they may lead out.
            if step.abs() < least {
                break;
            }
            let next = &x - step;
            if next > low && next < high {
                next
            } else {
                middle
            }
        };
        let done = (&next - &x).abs() < least;
        x = next;
        if done {
            break;
        }
    }
    x
}
