//! Where a line crosses a torus, by the real roots of the textbook's quartic in arithmetic of 320 bits.

use super::exact::{Line, Real, Vector, along, dot, minus, norm, unit, vector};
use std::cmp::Ordering;

/// Bits to which roots are found, of the interval that holds them.
const BITS: usize = 220;

/// A torus in units.
pub(super) struct Torus {
    pub center: Vector,
    /// Of length 1.
    pub axis: Vector,
    pub major: Real,
    pub minor: Real,
}

impl Torus {
    pub fn new(center: [f64; 3], axis: [f64; 3], [major, minor]: [f64; 2]) -> Self {
        Self {
            center: vector(center),
            axis: unit(&vector(axis)),
            major: Real::of(major),
            minor: Real::of(minor),
        }
    }

    /// How far a point is from the circle.
    pub fn distance(&self, point: &Vector) -> Real {
        let (y, outward) = self.parts(point);
        let beyond = norm(&outward) - &self.major;
        (&beyond * &beyond + &y * &y).sqrt()
    }

    /// A point's height along the axis, and its way from it.
    fn parts(&self, point: &Vector) -> (Real, Vector) {
        let q = minus(point, &self.center);
        let y = dot(&q, &self.axis);
        let outward = along(&q, &-&y, &self.axis);
        (y, outward)
    }

    /// The axis, if a point lies on it or so near by.
    pub fn axis_within(&self, point: &Vector, off: f64) -> Option<Vector> {
        let (_, outward) = self.parts(point);
        (norm(&outward) <= Real::of(off)).then(|| self.axis.clone())
    }

    /// How far a point is from the axis.
    pub fn distance_from_axis(&self, point: &Vector) -> f64 {
        let (_, outward) = self.parts(point);
        norm(&outward).to_f64().max(f64::MIN_POSITIVE)
    }

    /// The outward normal next to a point.
    pub fn normal(&self, point: &Vector) -> Vector {
        let (_, outward) = self.parts(point);
        let circle = along(&self.center, &self.major, &unit(&outward));
        unit(&minus(point, &circle))
    }

    /// Where a line is inside of the torus with its minor radius changed to one above 0, in order.
    pub fn spans(&self, line: &Line, minor: &Real) -> Vec<(Real, Real)> {
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
        let reach = (&self.major + minor) * of(1.0625) + of(1e-9);
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
    // Between the roots of its slope it goes one way.
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
            let next = &x - y / steepness;
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
