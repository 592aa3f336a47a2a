//! Checkerboards.

use crate::accel::Number;
use crate::format::Effects;
use crate::format::record::Material;
use crate::ray::Ray;
use crate::shade::Color;
use crate::shade::effect::{Effect, Tracer};
use crate::shade::surface::Surface;

pub(crate) struct Checker;

impl Effect for Checker {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects::CHECKER;

    #[inline(always)]
    fn is_called_by_material(material: &Material) -> bool {
        material.checker_size > 0
    }

    /// A checkerboard is a solid texture. It is looked up beneath the surface by the hit's error
    /// bound, so that a face that lies exactly between two layers of cells has the colours of the
    /// layer inside, and no noise.
    #[inline(always)]
    fn surface<'s, N: Number, X: Tracer<'s, N>>(
        _: &mut X,
        (): &mut (),
        _: &Ray<N>,
        surface: &mut Surface<'_, N>,
    ) {
        let Surface { hit, material, .. } = *surface;
        if !surface.called.contains(Self::EFFECT) {
            return;
        }
        let length = |q13: i32| N::narrow(N::far(q13.into()));
        let size = length(material.checker_size);
        let parity = (0..3).fold(0, |parity, axis| {
            let place = hit.point[axis] - length(material.checker_origin[axis]);
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
