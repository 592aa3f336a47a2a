//! Surfaces that emit light, such as visible lamps.
//!
//! Light leaves the front of a surface, the side to which its normal points. The lights of the scene light other
//! surfaces with it: the compiler makes lights with an area from surfaces that glow.

use crate::accel::Number;
use crate::format::Effects;
use crate::observe::count::Observer;
use crate::observe::event::{Event, RayKind};
use crate::shade::Color;
use crate::shade::effect::{Effect, Tracer};
use crate::shade::surface::Surface;

pub(crate) struct Emission;

impl Effect for Emission {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects::EMISSION;

    #[inline(always)]
    fn emit<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        (): &mut (),
        surface: &Surface<'_, N>,
        local: &mut Color<N>,
    ) {
        // No material states it, unlike for other effects: a section of the blob does.
        let emission = tracer.scene().emission(surface.hit.object);
        if let Some(emission) = emission.filter(|_| surface.hit.front) {
            // The surface that sent such a ray is already lit by it, or has reflected it by the formula.
            let is_counted = matches!(tracer.kind(), RayKind::Diffuse | RayKind::Glossy);
            if emission.lights != 0 && is_counted {
                if X::Observer::ENABLED {
                    tracer.count().event(Event::EmittedByLight);
                }
                return;
            }
            let emitted = Color::radiance(emission.radiance);
            *local = local.plus(emitted);
            if X::Observer::ENABLED {
                tracer.count().event(Event::Emitted {
                    radiance: emitted.to_f64(),
                });
            }
        }
    }
}
