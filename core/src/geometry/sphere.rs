//! Spheres, tested at the point of the line that is closest to the center.
//!
//! The discriminant comes from the vector between that point and the center. So nothing is lost to cancellation when
//! the sphere is small or far away. (Haines, Günther, Akenine-Möller, "Precision Improvements for Ray/Sphere
//! Intersection", Ray Tracing Gems, 2019.)
//!
//! **Crossings are not clamped to the sphere's box, because they lie in its interval.** A grazing ray's t can have a
//! large error, but the point there does not. Let the closest point be off by `D` along the ray, and the vector from
//! the center to it by `e` across. Let half the chord be off by `h`, and let the slope have the length `s`. Squares add
//! up to the radius's, except for products of these with at most twice the radius. So the point lies no farther from
//! the center than the radius and `e + s (D + h)`, apart from the rounding of the squares. That rounding is a few parts
//! in 2^24 of the radius.
//!
//! In `f32`, let the center be less than 2^17 units away and the radius at most 2^15. Then `s D` is below .1 unit
//! (seven roundings of up to `2^17 sqrt(3)`), and all the rest below .05. In `fixed` all is below 2^-7. Culling widens
//! boxes by 1/4 unit, of which `f32` uses 2^-5 for its own rounding (see [`cull`](crate::accel)).

use crate::format::limits::WIDE_LATTICE;
use crate::format::range::At;
use crate::format::record::{Sphere16, Sphere24, UnitBox};
use crate::format::width::Sphere;
use crate::format::{BlobError, Field, SectionKind, Sections};
use crate::geometry::primitive::{InScene, MAX_RADIUS};
use crate::geometry::{Crossing, Surface};
use crate::number::Arithmetic;
use crate::ray::Ray;

/// All spheres.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Spheres<'a> {
    S16(&'a [Sphere16]),
    S24(&'a [Sphere24]),
}

impl<'a> Spheres<'a> {
    pub(crate) fn read(sections: &Sections<'a>, short: bool) -> Result<Self, BlobError> {
        let section = SectionKind::Spheres;
        Ok(if short {
            Spheres::S16(sections.records(section)?)
        } else {
            Spheres::S24(sections.records(section)?)
        })
    }

    /// Proves that the first spheres have a radius and lie in the scene's box.
    pub(crate) fn validate(&self, count: usize, bounds: &UnitBox) -> Result<(), BlobError> {
        let section = SectionKind::Spheres;
        (0..count).try_for_each(|index| {
            let at = At { section, index };
            let scene = InScene { at, bounds };
            let (center, radius) = self.get(index).unwrap_or_default();
            at.within(Field::Radius, radius.into(), 1, MAX_RADIUS)?;
            let moved = |length: i32| center.map(|x| x.wrapping_add(length));
            scene.point(Field::LowestCoordinate, moved(radius.wrapping_neg()))?;
            scene.point(Field::HighestCoordinate, moved(radius))
        })
    }

    pub(crate) fn len(&self) -> usize {
        match self {
            Spheres::S16(spheres) => spheres.len(),
            Spheres::S24(spheres) => spheres.len(),
        }
    }

    pub(crate) fn get(&self, index: usize) -> Option<([i32; 3], i32)> {
        match self {
            Spheres::S16(spheres) => spheres.get(index).map(Sphere::lattice),
            Spheres::S24(_) if !WIDE_LATTICE => None,
            Spheres::S24(spheres) => spheres.get(index).map(Sphere::lattice),
        }
    }
}

/// The crossing with a sphere. `recip_norm2` is [`Vectors::recip_norm2`](crate::number::Vectors::recip_norm2) of the ray's slopes.
///
/// Cost: 18 multiplications and additions to reject, and a square root to accept.
#[inline(always)]
pub(crate) fn cross<N: Arithmetic>(
    ray: &Ray<N>,
    recip_norm2: N,
    center: [i32; 3],
    radius: i32,
) -> Option<Crossing<N>> {
    let axis = |k: usize| N::from_lattice(center[k]) - ray.origin[k];
    let relative = [axis(0), axis(1), axis(2)];
    let radius = N::from_lattice(radius);
    let closest = N::from_wide(N::wide_scale(N::dot(relative, ray.slope), recip_norm2));
    let axis = |k: usize| relative[k] - closest * ray.slope[k];
    let apart = [axis(0), axis(1), axis(2)];
    // The box is tested first, so that squares stay in range.
    if !(apart[0].abs() <= radius && apart[1].abs() <= radius && apart[2].abs() <= radius) {
        return None;
    }
    let square = radius.wide(radius) - N::dot(apart, apart);
    if square < N::Wide::default() {
        return None;
    }
    Some(tangent_crossing(ray, closest, square, recip_norm2))
}

/// Returns the crossing whose middle lies at `closest`. `square` is the radius squared less the square of the line's
/// distance from the center.
#[inline(always)]
pub(crate) fn tangent_crossing<N: Arithmetic>(
    ray: &Ray<N>,
    closest: N,
    square: N::Wide,
    recip_norm2: N,
) -> Crossing<N> {
    let half = N::root(N::wide_scale(square, recip_norm2));
    Crossing {
        enter: ray.ahead((closest - half, 0)),
        leave: (closest + half, 0),
    }
}

/// The box of a sphere.
#[inline(always)]
pub(crate) fn bounds(center: [i32; 3], radius: i32) -> UnitBox {
    UnitBox::around(
        center.map(|x| x.wrapping_sub(radius)),
        center.map(|x| x.wrapping_add(radius)),
    )
}

/// The normal points outward. The point lies a radius from the center, however t was rounded.
pub(crate) fn surface<N: Arithmetic>(center: [i32; 3], radius: i32, point: [N; 3]) -> Surface<N> {
    let center = center.map(N::from_lattice);
    let radius = N::from_lattice(radius);
    let axis = |k: usize| point[k] - center[k];
    let (normal, _) = N::normalize([axis(0), axis(1), axis(2)]);
    let axis = |k: usize| center[k] + radius * normal[k];
    let point = [axis(0), axis(1), axis(2)];
    // The error of the rounded point, which turns the normals of small spheres far from the lattice's middle.
    let axis = |k: usize| point[k] - center[k];
    let (normal, _) = N::normalize([axis(0), axis(1), axis(2)]);
    Surface {
        normal,
        point,
        error: N::curve_error(radius, normal, point),
        is_exact: false,
    }
}
