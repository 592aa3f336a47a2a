//! Cylinders, cones and frusta: the part of a double cone between two caps on which the radius is not negative.
//!
//! Let `q` be a point relative to the base, `w` the axis, `h = w.w` and `a = q.w`. The mantle is where `h (h q.q - a^2)
//! = (r0 h + (r1 - r0) a)^2`. Only the nappe where the right side's root is positive counts.

use super::crossing::{
    APEX, BASE, Crossing, Grazes, MANTLE, Ray, Start, compare, exact, flat_normal,
};
use super::number::*;
use super::world::Form;
use std::cmp::Ordering;

/// One end of an interval on the line; `None` reaches without end.
type End<N> = Option<Crossing<N>>;

/// Returns the crossings of the solid. `at` says which of the mantle, the base and the other cap the ray starts on.
pub fn crossings<N: Enclosure>(
    form: &Form,
    at: [bool; 3],
    ray: &Ray<N>,
    found: &mut Vec<Crossing<N>>,
) -> Result<(), Grazes> {
    let Form::Cone {
        base,
        axis,
        base_radius,
        apex_radius,
    } = *form
    else {
        return Ok(());
    };
    let w = exact::<N>(axis);
    let h = norm2(w);
    let (q, d) = (minus(ray.origin, exact(base)), ray.direction);
    let (q_axial, d_axial) = (dot(q, w), dot(d, w));
    let mut sure = true;

    // Between the caps.
    let cap = |distance: N, part: u8| {
        Some(Crossing {
            t: distance.over(d_axial)?,
            fraction: Some([distance, d_axial]),
            part,
            leaves: false,
            sure: true,
        })
    };
    let to_base = if at[1] { N::zero() } else { -q_axial };
    let to_apex = if at[2] { N::zero() } else { h - q_axial };
    let (mut enters, mut leaves): (Vec<Crossing<N>>, Vec<Crossing<N>>) = (Vec::new(), Vec::new());
    match d_axial.sign() {
        Some(Ordering::Equal) => match (to_base.sign(), to_apex.sign()) {
            (Some(Ordering::Greater), _) | (_, Some(Ordering::Less)) => return Ok(()),
            (Some(_), Some(_)) => {}
            _ => sure = false,
        },
        Some(sign) => {
            let base = cap(to_base, BASE).ok_or(Grazes)?;
            let apex = cap(to_apex, APEX).ok_or(Grazes)?;
            let (near, far) = if sign == Ordering::Greater {
                (base, apex)
            } else {
                (apex, base)
            };
            enters.push(near);
            leaves.push(far);
        }
        None => return grazes(form, ray),
    }

    // In the mantle: a t^2 + 2 b t + c is not positive.
    let slope = N::int(apex_radius - base_radius);
    let (g, e) = (N::int(base_radius) * h + slope * q_axial, slope * d_axial);
    // Seen from the point of the line that is closest to the axis's middle, so that squares are small.
    let shift = if at[0] {
        0.0
    } else {
        let closest = (dot(d, along(scale(w, N::scaled(1, 1)), -N::one(), q))).over(norm2(d));
        closest.ok_or(Grazes)?.middle()
    };
    if !shift.is_finite() {
        return Err(Grazes);
    }
    let shift = N::float(shift);
    let (q, g) = (along(q, shift, d), g + shift * e);
    let across = |v: Three<N>, axial: N| -> Three<N> { [0, 1, 2].map(|k| v[k] * h - w[k] * axial) };
    let q_axial = q_axial + shift * d_axial;
    let (q_across, d_across) = (across(q, q_axial), across(d, d_axial));
    // For vectors that are h times as long: |v|^2 is h (h v.v - a^2).
    let a = norm2(d_across) - e.square();
    let b = dot(q_across, d_across) - g * e;
    let c = if at[0] {
        N::zero()
    } else {
        norm2(q_across) - g.square()
    };
    let mantle = |t: N| Crossing {
        t: t + shift,
        fraction: None,
        part: MANTLE,
        leaves: false,
        sure: true,
    };
    let (enter, leave): (End<N>, End<N>) = match a.sign() {
        Some(Ordering::Equal) if b.sign() == Some(Ordering::Equal) => match c.sign() {
            // Along the mantle, inside or outside of it.
            Some(Ordering::Greater) => return Ok(()),
            Some(_) if slope.sign() == Some(Ordering::Equal) => (None, None),
            _ => return grazes(form, ray),
        },
        Some(Ordering::Equal) => {
            // Parallel to a line of the mantle: it crosses one nappe, once.
            let root = (-c).over(b + b).ok_or(Grazes)?;
            let inside = (g + e * root).sign();
            if inside == Some(Ordering::Less) {
                return Ok(());
            }
            sure &= inside.is_some();
            match b.sign() {
                Some(Ordering::Greater) => (None, Some(mantle(root))),
                Some(_) => (Some(mantle(root)), None),
                None => return grazes(form, ray),
            }
        }
        None => return grazes(form, ray),
        Some(sign) => {
            let square = b.square() - a * c;
            match square.sign() {
                Some(Ordering::Less) if sign == Ordering::Greater => return Ok(()),
                Some(_) => {}
                None => sure = false,
            }
            let root = square.sqrt();
            let (low, high) = if at[0] {
                // One root is 0, the other -2 b / a.
                let other = (-(b + b)).over(a).ok_or(Grazes)?;
                match b.sign() {
                    Some(Ordering::Equal) => (N::zero(), N::zero()),
                    Some(side) if (side == Ordering::Less) == (sign == Ordering::Greater) => {
                        (N::zero(), other)
                    }
                    Some(_) => (other, N::zero()),
                    None => return Err(Grazes),
                }
            } else {
                roots([a, b, c], root).ok_or(Grazes)?
            };
            if sign == Ordering::Greater {
                // Both on one nappe: the real one if g is positive halfway.
                let halfway = (g * a - b * e).sign();
                if halfway == Some(Ordering::Less) {
                    return Ok(());
                }
                sure &= halfway.is_some();
                (Some(mantle(low)), Some(mantle(high)))
            } else {
                // One root on each nappe.
                match e.sign() {
                    Some(Ordering::Greater) => (Some(mantle(high)), None),
                    Some(Ordering::Less) => (None, Some(mantle(low))),
                    _ => return grazes(form, ray),
                }
            }
        }
    };
    enters.extend(enter);
    leaves.extend(leave);
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
    let first = sum.over(a)?;
    let second = match c.over(sum) {
        Some(second) => second,
        // Both roots are near 0: the other formula is as good.
        None => (if is_negative { -b - root } else { root - b }).over(a)?,
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
fn grazes<N: Enclosure>(form: &Form, ray: &Ray<N>) -> Result<(), Grazes> {
    let Form::Cone {
        base,
        axis,
        base_radius,
        apex_radius,
    } = *form
    else {
        return Err(Grazes);
    };
    let half = scale(exact::<N>(axis), N::scaled(1, 1));
    let relative = minus(along(half, N::one(), exact(base)), ray.origin);
    let widest = N::int(base_radius.max(apex_radius));
    let reach = norm2(half) + widest.square();
    let closest = dot(relative, ray.direction)
        .over(norm2(ray.direction))
        .ok_or(Grazes)?;
    let apart = norm2(along(relative, -closest, ray.direction));
    match (reach - apart).sign() {
        Some(Ordering::Less) => Ok(()),
        _ => Err(Grazes),
    }
}

/// Returns the outward normal.
pub fn normal<N: Enclosure>(form: &Form, part: u8, point: Three<N>) -> Option<Three<N>> {
    let Form::Cone {
        base,
        axis,
        base_radius,
        apex_radius,
    } = *form
    else {
        return None;
    };
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
