//! Points of lights drawn by solid angle: all that a surface sees of a light counts alike, or nearly so.

use crate::accel::Number;
use crate::format::light_form::LightForm;
use crate::number::{Format, extent, far_extent};
use crate::shade::basis::{cross, perpendicular};
use crate::shade::light::{Distance, ROOT_OF_HALF, Way, length};
use crate::shade::surface::Aim;

/// √π - 1, with 30 fraction bits.
const ROOT_OF_PI_LESS_1: i32 = 829_416_007;

/// Turns the way to the middle of a sphere into the way to where a random direction hits it; no way from inside the
/// sphere.
///
/// (Shirley, Wang and Zimmerman, "Monte Carlo Techniques for Direct Lighting Calculations", 1996.)
pub(super) fn of_sphere<N: Number>(
    form: &LightForm,
    aim: &mut Aim<N>,
    u: N,
    [sine, cosine]: [N; 2],
) {
    let way = Way::<N>::of(aim.way, aim.distance);
    aim.way = [N::Wide::default(); 3];
    let Some(Way { unit, distance }) = way else {
        return;
    };
    let radius = distance.half_length(form.edges[0][0]);
    let widest = radius.div(distance.half);
    if widest <= N::ZERO || widest >= N::ONE {
        return;
    }
    let square = widest * widest;
    let one = N::ONE.half();
    // 1 - cos of the cone's angle, and of the direction's.
    let widening = one.div(one + (N::ONE - square).sqrt().half());
    let cap = square * widening;
    let sag = cap * u;
    let away = (sag + (sag - sag * sag)).sqrt().min(widest);
    let toward = N::ONE - sag;
    let [first, second] = perpendicular(unit);
    let (right, up) = (away * cosine, away * sine);
    let axis = |k: usize| unit[k] * toward + first[k] * right + second[k] * up;
    let direction = [axis(0), axis(1), axis(2)];
    // In halves, from the middle of the chord to the surface.
    let part = away.div(widest).min(N::ONE);
    let inward = radius * (N::ONE - part * part).sqrt();
    let end = distance.whole((distance.half * toward - inward) * extent(direction));
    *aim = Aim {
        way: direction.map(N::widen),
        distance: Some(end + end),
        // A cone takes 2 s² / (1 + cos) of π, where s is the sine of its angle.
        apparent_distance: Some(distance.for_twice(widening)),
    };
}

/// The quotient of two numbers.
#[inline(always)]
fn quotient<N: Number>(a: N, b: N) -> N {
    in_one_place(move || a.div(b))
}

/// √(a² + b²) of lengths.
#[inline(always)]
fn hypotenuse<N: Number>(a: N, b: N) -> N {
    in_one_place(move || N::root(a.wide(a) + b.wide(b)))
}

/// Computes a number. In integers that takes much code, which the program holds once and not wherever it is used.
#[inline(always)]
fn in_one_place<N: Number>(number: impl FnOnce() -> N) -> N {
    #[inline(never)]
    fn out_of_line<N>(number: impl FnOnce() -> N) -> N {
        number()
    }
    match N::FORMAT {
        Format::Fixed => out_of_line(number),
        Format::F32 | Format::F64 => number(),
    }
}

/// Returns the way to a random point of a rectangle, triangle or disc; `None` from behind.
///
/// The light consists of rows. A row is drawn by the angle at which it lies as seen from the foot of the surface on the
/// light's plane, and a point of the row by the angle between its ends. Both angles take part by functions without
/// trigonometry: the tangent of half of the first, the sine of the second. So not all points bring the same: that
/// differs by a factor of 2 at most with the angle of the row, and with the angle between its ends.
///
/// Exactly equal points need arc cosines, which `fixed` does not have: Ureña, Fajardo and King, "An Area-Preserving
/// Parametrization for Spherical Rectangles", 2013.
// Out of line, so that what is far away keeps the registers.
#[cold]
#[inline(never)]
pub(super) fn of_flat<N: Number>(
    form: &LightForm,
    way: [N::Wide; 3],
    [u, v]: [N; 2],
) -> Option<Aim<N>> {
    // Quarters of lengths, so that sums of all that is near are in range, and then with as many bits as squares have
    // room for.
    let quarter = |length: N| length.half().half();
    let corner = way.map(|component| quarter(N::narrow(component)));
    let [first, second] = form.edges.map(|edge| edge.map(|it| quarter(length(it))));
    let size = extent(corner) + extent(first) + extent(second);
    let bits = N::headroom(size + size);
    let [corner, first, second] =
        [corner, first, second].map(|v| v.map(|component| component.scale_up(bits)));
    let normal = form.normal.map(N::ratio);
    let (along, side) = N::normalize(first);
    let across = cross(normal, along);
    let on = |axis: [N; 3], way: [N; 3]| N::from_wide(N::dot(axis, way));
    let (height, depth) = (-on(normal, corner), on(across, second));
    if height <= N::ZERO || depth <= N::ZERO {
        return None;
    }
    let from = on(across, corner);
    let near = match form.shape {
        LightForm::DISC => from - side,
        _ => from,
    };
    let far = from + depth;

    // The tangent of half the angle: x / (h + √(h² + x²)).
    let half_tangent = |row: N| quotient(row, height + hypotenuse(height, row));
    let [nearest, farthest] = [half_tangent(near), half_tangent(far)];
    let turn = farthest.half() - nearest.half();
    let tangent = nearest + turn * u + turn * u;
    let square = tangent * tangent;
    let one = N::ONE.half();
    let narrowing = quotient(one, one + square.half());
    let (sine, cosine) = (tangent * narrowing, one - square * narrowing);
    let row = quotient(height * sine, cosine.max(N::ZERO))
        .max(near)
        .min(far);
    let away = hypotenuse(height, row);

    let place = quotient(row - from, depth);
    let start = on(along, corner) + on(along, second) * place;
    let [left, right] = match form.shape {
        LightForm::DISC => {
            let middle = on(along, corner);
            let chord = side * (N::ONE - place * place).sqrt();
            [middle - chord, middle + chord]
        }
        LightForm::TRIANGLE => [start, start + side * (N::ONE - place)],
        _ => [start, start + side],
    };
    let sine_of = |end: N| quotient(end, hypotenuse(end, away));
    let [leftmost, rightmost] = [sine_of(left), sine_of(right)];
    let width = rightmost.half() - leftmost.half();
    let sine = leftmost + width * v + width * v;
    let cosine = (N::ONE - sine * sine).sqrt();
    let place = quotient(away * sine, cosine).max(left).min(right);

    let axis = |k: usize| along[k] * place + across[k] * row - normal[k] * height;
    let whole = |quarter: N| N::wide_times(quarter.scale_down(bits).widen(), 4);
    let way = [axis(0), axis(1), axis(2)].map(whole);
    // What fills the solid angle w brings w / π of its radiance. At half of the root of its area a light has 4 / π of
    // it, and the product below is an eighth of w.
    let root = N::root(side.wide(depth));
    let half = match form.shape {
        LightForm::DISC => root + root * N::ratio(ROOT_OF_PI_LESS_1),
        LightForm::TRIANGLE => root * N::ratio(ROOT_OF_HALF),
        _ => root,
    };
    Some(Aim {
        way,
        distance: Some(far_extent::<N>(way)),
        apparent_distance: Some(
            Distance::near(half.scale_down(bits)).for_twice(turn * narrowing * width),
        ),
    })
}
