//! Checkerboards.

use crate::accel::Number;
use crate::axis::pick;
use crate::format::Effects;
use crate::format::record::Material;
use crate::number::{Format, extent};
use crate::query::Hit;
use crate::ray::Ray;
use crate::shade::Color;
use crate::shade::effect::{Effect, Tracer};
use crate::shade::light::length;
use crate::shade::surface::Surface;

pub(crate) struct Checker;

impl Effect for Checker {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects::CHECKER;

    #[inline(always)]
    fn is_required_by_material(material: &Material) -> bool {
        material.checker_size > 0
    }

    /// A checkerboard is a solid texture. It is looked up beneath the surface by the hit's error bound. So a face that
    /// lies exactly between two layers of cells has the colors of the layer inside, and no noise.
    #[inline(always)]
    fn surface<'s, N: Number, X: Tracer<'s, N>>(
        _: &mut X,
        (): &mut (),
        ray: &Ray<N>,
        surface: &mut Surface<'_, N>,
    ) {
        let Surface { hit, material, .. } = *surface;
        if !surface.required.contains(Self::EFFECT) {
            return;
        }
        let size = length::<N>(material.checker_size);
        let parity = (0..3).fold(0, |parity, axis| {
            let origin = length::<N>(material.checker_origin[axis]);
            let place = if hit.is_unbounded() {
                far_point(ray, hit, axis, origin, size)
            } else {
                hit.point[axis] - origin
            };
            // Far enough for the difference and the quotient to be other numbers.
            let step = N::step_beside(place);
            let depth = hit.error.max(step + step);
            parity ^ (place - depth * hit.normal[axis]).cell(size)
        });
        surface.diffuse = Color::ratios(if parity & 1 == 0 {
            material.diffuse
        } else {
            material.odd
        });
    }
}

/// Returns the place of a hit in the pattern on one axis, without whole repetitions, even beyond the range of lengths.
#[cold]
#[inline(never)]
fn far_point<N: Number>(ray: &Ray<N>, hit: &Hit<N>, axis: usize, origin: N, size: N) -> N {
    let place = ray.far_point(hit.t).unwrap_or(hit.point.map(N::widen));
    let is_exact = hit.offset_point() == hit.point && pick(hit.normal, axis) != N::ZERO;
    let is_near = N::FORMAT != Format::Fixed || extent(place.map(N::narrow)) < N::FAR.half();
    let point = if is_near || is_exact {
        pick(hit.point, axis).widen()
    } else {
        pick(place, axis)
    };
    N::remainder(point - origin.widen(), size + size)
}
