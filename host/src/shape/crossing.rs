//! Crossings of lines with planes, layers and quadrics, by textbook formulas in almost exact arithmetic.

use super::exact::{Line, Real, Vector, dot, minus, norm};

/// The t where a line enters and leaves.
pub type Span = Option<(Real, Real)>;

/// Returns a t beyond everything.
pub fn far() -> Real {
    Real::of(1e300)
}

pub fn overlap(a: Span, b: Span) -> Span {
    let ((a, b), (c, d)) = (a?, b?);
    let (enter, leave) = (a.max(c), b.min(d));
    (enter <= leave).then_some((enter, leave))
}

/// Returns the interval of t in which `-half <= y + t rise <= half`.
pub fn slab(y: &Real, rise: &Real, half: &Real) -> Span {
    if rise.is_zero() {
        return (y.abs() <= *half).then(|| (-far(), far()));
    }
    let (a, b) = ((-half - y) / rise, (half - y) / rise);
    (!half.is_negative()).then(|| if a <= b { (a, b) } else { (b, a) })
}

/// Roots of `a t^2 + 2 b t + c` in order, `a` not zero.
pub fn roots(a: &Real, b: &Real, c: &Real) -> Span {
    // Where a is negative, the line is steeper than a cone's mantle and meets both of its nappes,
    // perhaps at the tip.
    let square = b * b - a * c;
    if square.is_negative() && a.is_positive() {
        return None;
    }
    let root = square.sqrt();
    let (first, second) = ((-b - &root) / a, (root - b) / a);
    Some(if first <= second {
        (first, second)
    } else {
        (second, first)
    })
}

/// Returns the t at which a line crosses a plane, and the cosine between them times the slope's length.
pub fn plane_crossing(line: &Line, normal: &Vector, point: &Vector) -> Option<(Real, Real)> {
    let tilt = dot(normal, &line.slope);
    if tilt.is_zero() {
        return None;
    }
    Some((dot(normal, &minus(point, &line.origin)) / &tilt, tilt.abs()))
}

/// Returns the span of a flat shape on a line along its plane: none, or with a thickness perhaps anywhere.
pub fn within_plane(line: &Line, normal: &Vector, point: &Vector, grow: &Real) -> Span {
    let apart = dot(normal, &minus(point, &line.origin)).abs();
    (grow.is_positive() && apart <= *grow).then(|| (-far(), far()))
}

/// Returns the span of a flat shape with a thickness. `inside` is how far inside its rim the line crosses it. The rim's
/// position is as uncertain as the plane's, times the tangent of the angle of incidence.
pub fn flat_span(t: Real, inside: Real, tilt: &Real, line: &Line, grow: &Real) -> Span {
    let across = norm(&line.slope) / tilt;
    let rim = grow * (Real::of(1.0) + across);
    if (inside + rim).is_negative() {
        return None;
    }
    let thickness = grow.clone().max(Real::of(0.0)) / tilt;
    Some((&t - &thickness, t + thickness))
}
