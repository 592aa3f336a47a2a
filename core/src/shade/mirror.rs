//! Mirrors: one more ray per hit.

use crate::accel::Number;
use crate::format::Effects;
use crate::format::record::Material;
use crate::shade::Color;
use crate::shade::effect::{Effect, Tracer};
use crate::shade::material::is_any;
use crate::shade::surface::{Bounce, Surface};

pub(crate) struct Mirror;

impl Effect for Mirror {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects::MIRROR;
    const NEEDS_DIRECTION: bool = true;

    #[inline(always)]
    fn is_required_by_material(material: &Material) -> bool {
        is_any(&material.mirror)
    }

    #[inline(always)]
    fn bounce<'s, N: Number, X: Tracer<'s, N>>(
        _: &mut X,
        (): &mut (),
        surface: &Surface<'_, N>,
        bounce: &mut Bounce<N>,
    ) {
        // For a material without a mirror this is black, and no ray is sent.
        bounce.mirror(Color::ratios(surface.material.mirror));
    }
}
