//! Tori: the solid that a disc sweeps along a circle.
//!
//! Let `q` be a point relative to the center, `w` the axis, `h = w.w` and `G = q.q + R^2 - r^2`. Let `S = |q x w|^2`,
//! which is h times the square of the distance from the axis. The surface is where `F = h G^2 - 4 R^2 S` is 0 and G is
//! not negative. (Where G is negative lies the inner sheet of a spindle torus, which is inside of the solid.)
//!
//! Along a ray F is a quartic. Its roots are isolated by subdivision: coefficients of Bernstein's polynomials whose
//! signs are known count the roots of a stretch, none or one. Newton's steps narrow each root. A stretch that they do
//! not narrow is halved. Signs stay open where the ray nearly touches the surface: it may cross such a stretch or not.

use super::crossing::{Crossing, Grazes, Ray, exact};
use super::number::*;
use super::world::Torus;
use std::cmp::Ordering;

/// A polynomial; its first coefficient is that of 1.
type Quartic<N> = [N; 5];

/// Most stretches that are examined along a ray.
const STRETCHES: usize = 1500;
/// Most times that a stretch is halved.
const HALVINGS: u32 = 280;
/// Most of Newton's steps. Each doubles the digits, except the first ones, which halve the stretch.
const STEPS: usize = 64;
/// Most stretches with crossings: numbers of parts.
const PARTS: u8 = 6;

/// A part of a line, and the coefficients of Bernstein's polynomials on it.
struct Stretch<N> {
    first: N,
    last: N,
    coefficients: Quartic<N>,
    halvings: u32,
}

/// An interval in which a quartic may be 0.
enum Piece<N> {
    /// One root, from below or from above.
    Root { between: N, rises: bool },
    /// Any number of roots.
    Open { first: N, last: N },
}

/// Returns the crossings of the solid. `itself` says that the ray starts on its surface. Parts are numbered along the
/// ray.
pub fn crossings<N: Enclosure>(
    torus: &Torus,
    itself: bool,
    ray: &Ray<N>,
    found: &mut Vec<Crossing<N>>,
) -> Result<(), Grazes> {
    let Torus {
        center,
        axis,
        major,
        minor,
    } = *torus;
    let (d, w) = (ray.direction, exact::<N>(axis));
    let q = minus(ray.origin, exact(center));
    let length = norm2(d);
    let closest = (-dot(q, d)).div(length).ok_or(Grazes)?;
    let reach = N::int(major + minor).square();
    let chord = reach - norm2(along(q, closest, d));
    if chord.sign() == Some(Ordering::Less) {
        return Ok(());
    }
    let half = chord.div(length).ok_or(Grazes)?.sqrt();
    // Seen from the point of the line that is closest to the center, so that squares are small.
    let shift = N::float(if itself { 0.0 } else { closest.middle() });
    let q = along(q, shift, d);
    let from_shift = closest - shift;
    let [low, _] = (from_shift - half).bounds();
    let [_, high] = (from_shift + half).bounds();
    if !(low.is_finite() && high.is_finite()) {
        return Err(Grazes);
    }
    let g = [
        norm2(q) + N::int(major).square() - N::int(minor).square(),
        dot(q, d),
        length,
    ];
    let mut quartic = quartic([q, d, w], g, N::int(2 * major).square());
    let mut low = low;
    if itself {
        // The first root is 0; the others are those of a polynomial one degree lower.
        quartic = [quartic[1], quartic[2], quartic[3], quartic[4], N::zero()];
        if high <= 0.0 {
            return Ok(());
        }
        low = 0.0;
    }
    let pieces = isolated(&quartic, [N::float(low), N::float(high)])?;
    let mut part = 0;
    let mut keep = |t: N, leaves: bool, sure: bool, part: u8| {
        Crossing {
            t: t + shift,
            fraction: None,
            part,
            leaves,
            sure,
        }
        .keep(ray.start, found);
    };
    for piece in pieces {
        if part >= PARTS {
            return Err(Grazes);
        }
        match piece {
            Piece::Root { between, rises } => {
                let t = narrowed(&quartic, between);
                let outer = if minor > major {
                    ((g[2] * t + g[1] + g[1]) * t + g[0]).sign()
                } else {
                    Some(Ordering::Greater)
                };
                if outer == Some(Ordering::Less) {
                    continue;
                }
                keep(t, rises, outer == Some(Ordering::Greater), part);
                part += u8::from(rises);
            }
            Piece::Open { first, last } => {
                let t = first.hull(last);
                keep(t, false, false, part);
                keep(t, true, false, part);
                part += 1;
            }
        }
    }
    Ok(())
}

/// The quartic along a line, of the coefficients of `q.q + R^2 - r^2` (the middle one by halves) and `4 R^2`.
fn quartic<N: Enclosure>([q, d, w]: [Three<N>; 3], g: [N; 3], wide: N) -> Quartic<N> {
    let h = norm2(w);
    let (q_across, d_across) = (cross(q, w), cross(d, w));
    let [e, b, a] = g;
    let twice = |x: N| x + x;
    [
        h * e.square() - wide * norm2(q_across),
        twice(twice(h * b * e) - wide * dot(q_across, d_across)),
        h * (twice(twice(b.square())) + twice(a * e)) - wide * norm2(d_across),
        twice(twice(h * a * b)),
        h * a.square(),
    ]
}

fn value<N: Enclosure>(polynomial: &[N], x: N) -> N {
    let mut rest = polynomial.iter().rev();
    let first = rest.next().copied().unwrap_or_else(N::zero);
    rest.fold(first, |sum, &coefficient| sum * x + coefficient)
}

fn slope<N: Enclosure>([_, b, c, d, e]: &Quartic<N>, x: N) -> N {
    let times = |of: N, by: i64| of * N::int(by);
    value(&[*b, times(*c, 2), times(*d, 3), times(*e, 4)], x)
}

/// The coefficients of Bernstein's polynomials on a stretch.
fn bernstein<N: Enclosure>(polynomial: &Quartic<N>, [first, last]: [N; 2]) -> Option<Quartic<N>> {
    // The polynomial of the part of the stretch.
    let mut c = *polynomial;
    for low in 0..4 {
        for power in (low..4).rev() {
            c[power] = c[power] + first * c[power + 1];
        }
    }
    let size = last - first;
    let mut power = N::one();
    for coefficient in &mut c {
        *coefficient = *coefficient * power;
        power = power * size;
    }
    let [a0, a1, a2, a3, a4] = c;
    let quarter = |x: N| x.half().half();
    let sixth = a2.div(N::int(6))?;
    Some([
        a0,
        a0 + quarter(a1),
        a0 + a1.half() + sixth,
        a0 + a1 - quarter(a1) + a2.half() + quarter(a3),
        a0 + a1 + a2 + a3 + a4,
    ])
}

/// The coefficients on both halves of a stretch.
fn halves<N: Enclosure>(coefficients: &Quartic<N>) -> [Quartic<N>; 2] {
    let (mut left, mut right) = (*coefficients, *coefficients);
    for (step, first) in left.iter_mut().enumerate().skip(1) {
        for index in 0..5 - step {
            right[index] = (right[index] + right[index + 1]).half();
        }
        *first = right[0];
    }
    [left, right]
}

/// Returns the number of sign changes of the coefficients: the number of roots within, if it is 0 or 1. `None` if it is
/// open.
fn changes<N: Enclosure>(coefficients: &Quartic<N>) -> Option<u32> {
    let mut changes = 0;
    let mut before = None;
    for (index, coefficient) in coefficients.iter().enumerate() {
        let sign = coefficient.sign()?;
        let is_end = index == 0 || index == 4;
        if sign == Ordering::Equal {
            if is_end {
                return None;
            }
            continue;
        }
        changes += u32::from(before.is_some_and(|before| before != sign));
        before = Some(sign);
    }
    Some(changes)
}

/// The parts of a stretch where a quartic may be 0, in order.
fn isolated<N: Enclosure>(quartic: &Quartic<N>, ends: [N; 2]) -> Result<Vec<Piece<N>>, Grazes> {
    let [first, last] = ends;
    let mut pieces: Vec<Piece<N>> = Vec::with_capacity(4);
    let mut stack = vec![Stretch {
        first,
        last,
        coefficients: bernstein(quartic, ends).ok_or(Grazes)?,
        halvings: 0,
    }];
    let mut looked_at = 0;
    let mut grows = false;
    while let Some(stretch) = stack.pop() {
        looked_at += 1;
        if looked_at > STRETCHES {
            return Err(Grazes);
        }
        let Stretch { first, last, .. } = stretch;
        let all = &stretch.coefficients;
        let changes = changes(all);
        if changes == Some(0) {
            grows = false;
            continue;
        }
        let between = first.hull(last);
        if changes == Some(1) && slope(quartic, between).sign().is_some_and(Ordering::is_ne) {
            let rises = all[4].sign() == Some(Ordering::Greater);
            pieces.push(Piece::Root { between, rises });
            grows = false;
            continue;
        }
        // If all of a stretch is open, its halves are open.
        if all.iter().all(|it| it.sign().is_none()) || stretch.halvings >= HALVINGS {
            match pieces.last_mut() {
                Some(Piece::Open { last: end, .. }) if grows => *end = last,
                _ => pieces.push(Piece::Open { first, last }),
            }
            grows = true;
            continue;
        }
        let [left, right] = halves(all);
        let middle = (first + last).half().point();
        let half = |first: N, last: N, coefficients: Quartic<N>| Stretch {
            first,
            last,
            coefficients,
            halvings: stretch.halvings + 1,
        };
        stack.push(half(middle, last, right));
        stack.push(half(first, middle, left));
    }
    Ok(pieces.into_iter().map(|it| closed(quartic, it)).collect())
}

/// Returns a root, if an open stretch holds exactly one whose place alone was open.
fn closed<N: Enclosure>(quartic: &Quartic<N>, piece: Piece<N>) -> Piece<N> {
    let Piece::Open { first, last } = piece else {
        return piece;
    };
    let between = first.hull(last);
    let ends = [first, last].map(|x| value(quartic, x).sign());
    let is_steep = slope(quartic, between).sign().is_some_and(Ordering::is_ne);
    match ends {
        [Some(Ordering::Less), Some(Ordering::Greater)] if is_steep => Piece::Root {
            between,
            rises: true,
        },
        [Some(Ordering::Greater), Some(Ordering::Less)] if is_steep => Piece::Root {
            between,
            rises: false,
        },
        _ => piece,
    }
}

/// The only root in a stretch where the slope has a sign.
fn narrowed<N: Enclosure>(quartic: &Quartic<N>, between: N) -> N {
    let mut root = between;
    for _ in 0..STEPS {
        // For a slope somewhere between, the root is off by the value over it.
        let from = root.point();
        let here = value(quartic, from);
        let slope = slope(quartic, root);
        let Some(off) = here.div(slope) else {
            break;
        };
        let next = from - off;
        let was = root.radius();
        if next.radius() < 0.5 * was {
            root = next;
            continue;
        }
        // The root is in the half where the quartic, which is monotonic, changes its sign.
        let is_before = match (here.sign(), slope.sign()) {
            (Some(here), Some(slope)) if here.is_ne() => here == slope,
            _ => {
                if next.radius() < was {
                    root = next;
                }
                break;
            }
        };
        let reach = N::float(was);
        root = from.hull(if is_before {
            from - reach
        } else {
            from + reach
        });
    }
    root
}

/// Returns the outward normal; `None` where it is open, near the axis of a torus without a hole.
pub fn normal<N: Enclosure>(torus: &Torus, point: Three<N>) -> Option<Three<N>> {
    let Torus {
        center,
        axis,
        major,
        ..
    } = *torus;
    let (q, w) = (minus(point, exact(center)), exact::<N>(axis));
    let (h, height) = (norm2(w), dot(q, w));
    let outward = unit([0, 1, 2].map(|k| q[k] * h - w[k] * height))?;
    unit(along(q, -N::int(major), outward))
}

#[cfg(test)]
mod tests;
