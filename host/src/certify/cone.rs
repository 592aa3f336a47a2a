//! Cylinders, cones and frusta: the part of a double cone between two caps on which the radius is not negative.
//!
//! Let `q` be a point relative to the base, `w` the axis, `h = w.w` and `a = q.w`. The mantle is where `h (h q.q - a^2)
//! = (r0 h + (r1 - r0) a)^2`. Only the nappe where the right side's root is positive counts.

use super::crossing::{
    APEX, BASE, Crossing, Grazes, MANTLE, Ray, Start, compare, exact, flat_normal,
};
use super::number::*;
use super::world::Cone;
use std::cmp::Ordering;

/// The known part of a line that lies between the caps of a solid, or in its mantle.
enum Cut<T> {
    /// The line is nowhere between.
    Outside,
    /// Where the line enters and leaves, `None` where it does without end. False if it may be outside all the same.
    Inside([Option<T>; 2], bool),
    /// Nothing is decided.
    Open,
}

/// Returns the crossings of the solid. `at` says which of the mantle, the base and the other cap the ray starts on.
pub fn crossings<N: Enclosure>(
    cone: &Cone,
    at: [bool; 3],
    ray: &Ray<N>,
    found: &mut Vec<Crossing<N>>,
) -> Result<(), Grazes> {
    let line = Line::new(cone, ray);
    let [at_mantle, at_base, at_apex] = at;
    let (caps, mut sure) = match line.between_caps(at_base, at_apex)? {
        Cut::Outside => return Ok(()),
        Cut::Inside(ends, sure) => (ends, sure),
        Cut::Open => return grazes(cone, ray),
    };
    let mantle = match line.in_mantle(at_mantle)? {
        Cut::Outside => return Ok(()),
        Cut::Inside(ends, is_sure) => {
            sure &= is_sure;
            ends
        }
        Cut::Open => return grazes(cone, ray),
    };
    let [enters, leaves] = [0, 1].map(|end| {
        [caps[end], mantle[end]]
            .into_iter()
            .flatten()
            .collect::<Vec<_>>()
    });
    for enter in &enters {
        for leave in &leaves {
            match compare(enter, leave) {
                Some(Ordering::Greater) => return Ok(()),
                Some(_) => {}
                None => sure = false,
            }
        }
    }
    ends(&enters, Ordering::Greater, sure, ray.start, found);
    ends(&leaves, Ordering::Less, sure, ray.start, found);
    Ok(())
}

/// A line in the frame of a solid.
struct Line<N: Enclosure> {
    /// From the base to the other cap.
    axis: Three<N>,
    /// The square of the axis.
    height2: N,
    base_radius: N,
    /// The radius of the other cap less that of the base.
    widening: N,
    /// From the base to the line's start.
    start: Three<N>,
    direction: Three<N>,
    /// Products with the axis.
    start_axial: N,
    direction_axial: N,
}

impl<N: Enclosure> Line<N> {
    fn new(cone: &Cone, ray: &Ray<N>) -> Self {
        let axis = exact::<N>(cone.axis);
        let start = minus(ray.origin, exact(cone.base));
        Self {
            axis,
            height2: norm2(axis),
            base_radius: N::int(cone.base_radius),
            widening: N::int(cone.apex_radius - cone.base_radius),
            start,
            direction: ray.direction,
            start_axial: dot(start, axis),
            direction_axial: dot(ray.direction, axis),
        }
    }

    /// Where the line is between the planes of the caps. The arguments are true where it starts on one.
    fn between_caps(&self, at_base: bool, at_apex: bool) -> Result<Cut<Crossing<N>>, Grazes> {
        let along = self.direction_axial;
        let distance = |is_there: bool, distance: N| if is_there { N::zero() } else { distance };
        let to_base = distance(at_base, -self.start_axial);
        let to_apex = distance(at_apex, self.height2 - self.start_axial);
        let cap = |distance: N, part: u8| {
            Ok(Some(Crossing {
                t: distance.div(along).ok_or(Grazes)?,
                fraction: Some([distance, along]),
                part,
                leaves: false,
                sure: true,
            }))
        };
        Ok(match along.sign() {
            Some(Ordering::Equal) => match (to_base.sign(), to_apex.sign()) {
                (Some(Ordering::Greater), _) | (_, Some(Ordering::Less)) => Cut::Outside,
                (base, apex) => Cut::Inside([None, None], base.is_some() && apex.is_some()),
            },
            Some(sign) => {
                let (base, apex) = (cap(to_base, BASE)?, cap(to_apex, APEX)?);
                let is_upward = sign == Ordering::Greater;
                Cut::Inside(
                    if is_upward {
                        [base, apex]
                    } else {
                        [apex, base]
                    },
                    true,
                )
            }
            None => Cut::Open,
        })
    }

    /// Where the line is in the mantle. The argument is true where it starts on it.
    fn in_mantle(&self, at_mantle: bool) -> Result<Cut<Crossing<N>>, Grazes> {
        let (q, d, w, h) = (self.start, self.direction, self.axis, self.height2);
        // Seen from the point of the line that is closest to the axis's middle, so that squares are small.
        let shift = if at_mantle {
            0.0
        } else {
            let from_middle = along(scale(w, N::scaled(1, 1)), -N::one(), q);
            dot(d, from_middle).div(norm2(d)).ok_or(Grazes)?.middle()
        };
        if !shift.is_finite() {
            return Err(Grazes);
        }
        let shift = N::float(shift);
        let e = self.widening * self.direction_axial;
        let g = self.base_radius * h + self.widening * self.start_axial + shift * e;
        let q_axial = self.start_axial + shift * self.direction_axial;
        let across =
            |v: Three<N>, axial: N| -> Three<N> { [0, 1, 2].map(|k| v[k] * h - w[k] * axial) };
        let (q_across, d_across) = (
            across(along(q, shift, d), q_axial),
            across(d, self.direction_axial),
        );
        // For vectors that are h times as long: |v|^2 is h (h v.v - a^2).
        let quadric = Quadric {
            a: norm2(d_across) - e.square(),
            b: dot(q_across, d_across) - g * e,
            c: match at_mantle {
                true => N::zero(),
                false => norm2(q_across) - g.square(),
            },
            g,
            e,
            starts_at_root: at_mantle,
        };
        let is_cylinder = self.widening.sign() == Some(Ordering::Equal);
        Ok(match quadric.inside(is_cylinder)? {
            Cut::Inside(ends, sure) => {
                let crossing = |t: N| Crossing {
                    t: t + shift,
                    fraction: None,
                    part: MANTLE,
                    leaves: false,
                    sure: true,
                };
                Cut::Inside(ends.map(|end| end.map(crossing)), sure)
            }
            Cut::Outside => Cut::Outside,
            Cut::Open => Cut::Open,
        })
    }
}

/// A line in a double cone: in it `a t^2 + 2 b t + c` is not positive, and on the nappe that counts `g + e t` is not
/// negative.
struct Quadric<N> {
    a: N,
    b: N,
    c: N,
    g: N,
    e: N,
    /// True if 0 is a root, where `c` is 0.
    starts_at_root: bool,
}

impl<N: Enclosure> Quadric<N> {
    fn inside(&self, is_cylinder: bool) -> Result<Cut<N>, Grazes> {
        match self.a.sign() {
            Some(Ordering::Equal) if self.b.sign() == Some(Ordering::Equal) => {
                // Along the mantle, inside or outside of it.
                Ok(match self.c.sign() {
                    Some(Ordering::Greater) => Cut::Outside,
                    Some(_) if is_cylinder => Cut::Inside([None, None], true),
                    _ => Cut::Open,
                })
            }
            Some(Ordering::Equal) => self.inside_once(),
            Some(sign) => self.inside_between(sign),
            None => Ok(Cut::Open),
        }
    }

    /// A line that is parallel to one of the mantle: it crosses one nappe, once.
    fn inside_once(&self) -> Result<Cut<N>, Grazes> {
        let root = (-self.c).div(self.b + self.b).ok_or(Grazes)?;
        let nappe = (self.g + self.e * root).sign();
        if nappe == Some(Ordering::Less) {
            return Ok(Cut::Outside);
        }
        Ok(match self.b.sign() {
            Some(Ordering::Greater) => Cut::Inside([None, Some(root)], nappe.is_some()),
            Some(_) => Cut::Inside([Some(root), None], nappe.is_some()),
            None => Cut::Open,
        })
    }

    /// A line that crosses twice: `sign` is that of `a`.
    fn inside_between(&self, sign: Ordering) -> Result<Cut<N>, Grazes> {
        let Self { a, b, c, g, e, .. } = *self;
        let square = b.square() - a * c;
        let mut sure = true;
        match square.sign() {
            Some(Ordering::Less) if sign == Ordering::Greater => return Ok(Cut::Outside),
            Some(_) => {}
            None => sure = false,
        }
        let (low, high) = if self.starts_at_root {
            // The other root is -2 b / a.
            let other = (-(b + b)).div(a).ok_or(Grazes)?;
            match b.sign() {
                Some(Ordering::Equal) => (N::zero(), N::zero()),
                Some(side) if (side == Ordering::Less) == (sign == Ordering::Greater) => {
                    (N::zero(), other)
                }
                Some(_) => (other, N::zero()),
                None => return Err(Grazes),
            }
        } else {
            roots([a, b, c], square.sqrt()).ok_or(Grazes)?
        };
        if sign == Ordering::Greater {
            // Both on one nappe: the real one if g is positive halfway.
            let halfway = (g * a - b * e).sign();
            if halfway == Some(Ordering::Less) {
                return Ok(Cut::Outside);
            }
            return Ok(Cut::Inside(
                [Some(low), Some(high)],
                sure && halfway.is_some(),
            ));
        }
        // One root on each nappe.
        Ok(match e.sign() {
            Some(Ordering::Greater) => Cut::Inside([Some(high), None], sure),
            Some(Ordering::Less) => Cut::Inside([None, Some(low)], sure),
            _ => Cut::Open,
        })
    }
}

/// Adds the last crossing where a ray enters, or the first where it leaves.
fn ends<N: Enclosure>(
    all: &[Crossing<N>],
    sign: Ordering,
    sure: bool,
    start: Start,
    found: &mut Vec<Crossing<N>>,
) {
    let leaves = sign == Ordering::Less;
    let mut left: Vec<Crossing<N>> = Vec::with_capacity(2);
    for (index, crossing) in all.iter().enumerate() {
        let beaten = (0..all.len()).any(|other| match compare(&all[other], crossing) {
            Some(order) if order == sign => true,
            Some(Ordering::Equal) => other < index,
            _ => false,
        });
        if !beaten {
            left.push(*crossing);
        }
    }
    for crossing in &left {
        Crossing {
            leaves,
            sure: sure && left.len() == 1,
            ..*crossing
        }
        .keep(start, found);
    }
}

/// The roots of a t^2 + 2 b t + c, the smaller one first.
fn roots<N: Enclosure>([a, b, c]: [N; 3], root: N) -> Option<(N, N)> {
    let is_negative = b.middle() < 0.0;
    let sum = if is_negative { root - b } else { -(b + root) };
    let first = sum.div(a)?;
    let second = match c.div(sum) {
        Some(second) => second,
        // Both roots are near 0: the other formula is as good.
        None => (if is_negative { -b - root } else { root - b }).div(a)?,
    };
    // `sum` has the sign opposite to that of b, so this one is the larger if a agrees with it.
    let first_is_larger = is_negative == (a.sign() == Some(Ordering::Greater));
    Some(if first_is_larger {
        (second, first)
    } else {
        (first, second)
    })
}

/// Decides rays that run nearly along a line of the mantle or across the axis. They miss if they stay away from the
/// sphere around the solid.
fn grazes<N: Enclosure>(cone: &Cone, ray: &Ray<N>) -> Result<(), Grazes> {
    let half = scale(exact::<N>(cone.axis), N::scaled(1, 1));
    let relative = minus(along(half, N::one(), exact(cone.base)), ray.origin);
    let widest = N::int(cone.base_radius.max(cone.apex_radius));
    let reach = norm2(half) + widest.square();
    let closest = dot(relative, ray.direction)
        .div(norm2(ray.direction))
        .ok_or(Grazes)?;
    let apart = norm2(along(relative, -closest, ray.direction));
    match (reach - apart).sign() {
        Some(Ordering::Less) => Ok(()),
        _ => Err(Grazes),
    }
}

/// Returns the outward normal.
pub fn normal<N: Enclosure>(cone: &Cone, part: u8, point: Three<N>) -> Option<Three<N>> {
    let Cone {
        base,
        axis,
        base_radius,
        apex_radius,
    } = *cone;
    let w = exact::<N>(axis);
    match part {
        BASE => return flat_normal(axis.map(|x| -x)),
        APEX => return flat_normal(axis),
        _ => {}
    }
    let q = minus(point, exact(base));
    let h = norm2(w);
    let along_axis = dot(q, w);
    let outward = unit([0, 1, 2].map(|k| q[k] * h - w[k] * along_axis))?;
    if base_radius == apex_radius {
        return Some(outward);
    }
    // Height and narrowing are the normal's parts across the axis and along it.
    let axis = unit(w)?;
    let (height, narrowing) = (h.sqrt(), N::int(base_radius - apex_radius));
    unit([0, 1, 2].map(|k| outward[k] * height + axis[k] * narrowing))
}
