//! Strips of triangles: the test of [`triangle`](super::triangle) on six triangles at once.
//!
//! Every vertex is projected once and every edge crossed once, with the very operations of the
//! test of one triangle, so the signs are the same. Where a product difference rounds to zero its
//! sign needs exact arithmetic, and the triangles at that edge are tested one by one; that happens
//! to one ray in some ten thousand.

use super::Strips;
use super::triangle::Projection;
use crate::blob::cluster::{Rows, Strip};
use crate::blob::record::{Vertex16, Vertex24};
use crate::eight::Eight;
use crate::number::{Format, Number};
use crate::ray::Ray;

/// The projection of a scene's strips along a ray.
#[inline(always)]
pub(crate) fn projection<N: Number>(ray: &Ray<N>, strips: &Strips<'_>) -> Projection<N> {
    match (strips, ray.major) {
        (Strips::S16(_), 0) => Projection::of::<0, Vertex16>(ray),
        (Strips::S16(_), 1) => Projection::of::<1, Vertex16>(ray),
        (Strips::S16(_), _) => Projection::of::<2, Vertex16>(ray),
        (Strips::S24(_), 0) => Projection::of::<0, Vertex24>(ray),
        (Strips::S24(_), 1) => Projection::of::<1, Vertex24>(ray),
        (Strips::S24(_), _) => Projection::of::<2, Vertex24>(ray),
    }
}

/// The places of a strip whose triangles a ray meets: what [`Projection::meets`] says of each.
///
/// `major` is the ray's major axis. Cost in `f32`: some 100 operations in four lanes.
#[inline(always)]
pub(crate) fn met<N: Number, S: Strip>(projection: &Projection<N>, major: usize, strip: &S) -> u32 {
    if N::FORMAT != Format::F32 {
        return met_one_by_one(projection, major, strip, strip.members().places());
    }
    let (met, doubtful) = met_in_lanes(projection, major, strip);
    if doubtful == 0 {
        return met;
    }
    met & !doubtful | met_one_by_one(projection, major, strip, doubtful)
}

/// The places that are met, and those of which lanes cannot say.
#[inline(always)]
fn met_in_lanes<N: Number, S: Strip>(
    projection: &Projection<N>,
    major: usize,
    strip: &S,
) -> (u32, u32) {
    let Projection { origin, shear } = projection;
    let all = |number: N| Eight::splat(number.to_f32());
    let row = |axis: usize| strip.rows().measure(axis);
    let (first, second, last) = match major {
        0 => (row(1), row(2), row(0)),
        1 => (row(2), row(0), row(1)),
        _ => (row(0), row(1), row(2)),
    };
    let depth = last - all(origin[2]);
    let x = first - all(origin[0]) - depth * all(shear[0]);
    let y = second - all(origin[1]) - depth * all(shear[1]);
    let (x1, y1) = (x.next(), y.next());
    let (x2, y2) = (x1.next(), y1.next());
    // From each vertex to the next, and to the one after that.
    let side = x * y1 - y * x1;
    let across = x * y2 - y * x2;
    let (side_zero, across_zero) = (side.zero(), across.zero());
    // Of a difference that is not zero.
    let (side, across) = (side.signs(), across.signs());
    let places = strip.members().places();
    // Round a triangle run two sides and, backwards, the edge across.
    let met = !(side ^ side >> 1) & (side ^ across);
    let doubtful = side_zero | side_zero >> 1 | across_zero;
    (met & places, doubtful & places)
}

/// Tests triangles in a number format's own arithmetic.
#[inline(never)]
fn met_one_by_one<N: Number, S: Strip>(
    projection: &Projection<N>,
    major: usize,
    strip: &S,
    places: u32,
) -> u32 {
    match major {
        0 => met_along::<0, N, S>(projection, strip, places),
        1 => met_along::<1, N, S>(projection, strip, places),
        _ => met_along::<2, N, S>(projection, strip, places),
    }
}

fn met_along<const MAJOR: usize, N: Number, S: Strip>(
    projection: &Projection<N>,
    strip: &S,
    places: u32,
) -> u32 {
    let mut met = 0;
    let mut rest = places;
    while rest != 0 {
        let place = rest.trailing_zeros();
        rest &= rest - 1;
        if let Some([a, b, c]) = strip.vertices(place) {
            let meets = projection.meets::<MAJOR, <S::Rows as Rows>::Vertex>(&a, &b, &c);
            met |= u32::from(meets) << place;
        }
    }
    met
}
