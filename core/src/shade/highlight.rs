//! Highlights of the lights (Blinn-Phong).

use crate::accel::Number;
use crate::format::Effects;
use crate::format::record::Material;
use crate::shade::Color;
use crate::shade::effect::{Effect, Tracer};
use crate::shade::material::is_any;
use crate::shade::surface::{Gleam, Lighting, Surface};

pub(crate) struct Highlight;

impl Effect for Highlight {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects::HIGHLIGHT;
    const NEEDS_DIRECTION: bool = true;

    #[inline(always)]
    fn is_required_by_material(material: &Material) -> bool {
        is_any(&material.highlight)
    }

    #[inline(always)]
    fn reflect<'s, N: Number, X: Tracer<'s, N>>(
        _: &mut X,
        (): &mut (),
        surface: &Surface<'_, N>,
        lighting: &Lighting<'_, N>,
        reflected: &mut Color<N>,
        _: &mut Option<Gleam<N>>,
    ) {
        let material = surface.material;
        if !surface.required.contains(Self::EFFECT) {
            return;
        }
        // Halfway between the light and the ray's origin.
        let axis = |k: usize| lighting.to_light[k].half() - surface.direction[k].half();
        let (halfway, _) = N::normalize([axis(0), axis(1), axis(2)]);
        let cos = N::from_wide(N::dot(surface.shading_normal, halfway))
            .max(N::ZERO)
            .min(N::ONE);
        let strength = power(cos, material.exponent());
        *reflected = reflected.plus_up_to_one(Color::ratios(material.highlight).scaled(strength));
    }
}

/// A ratio in \[0, 1\] to the power of a positive integer.
fn power<N: Number>(base: N, exponent: u16) -> N {
    let (mut result, mut square, mut rest) = (N::ONE, base, exponent);
    while rest > 0 {
        if rest & 1 == 1 {
            result = result * square;
        }
        square = square * square;
        rest >>= 1;
    }
    result
}
