//! Indirect light: the surroundings of a surface light it, along one random direction per hit.
//!
//! Directions are drawn in proportion to the cosine to the normal, by Malley's method: points of a disc raised to the
//! hemisphere. So a diffuse surface returns its color times the mean of the light from these directions (Kajiya, "The
//! Rendering Equation", 1986). Rays to the lights bring the light of lights; a diffuse ray does not bring it again.

use crate::accel::Number;
use crate::format::Effects;
use crate::format::limits::INDIRECT;
use crate::number::Angle;
use crate::observe::event::RayKind;
use crate::query::Hit;
use crate::shade::basis::perpendicular;
use crate::shade::effect::{Effect, Tracer};
use crate::shade::sampler::ratio;
use crate::shade::surface::{Bounce, Secondary, Surface};

pub(crate) struct Indirect;

/// The dimension of the sampler's points.
const DIRECTION: u16 = 0x1030;

impl Effect for Indirect {
    /// Number of diffuse reflections that led to the ray.
    type State<N: Number> = [u8; INDIRECT as usize];

    const EFFECT: Effects = Effects::INDIRECT;

    /// The light from a random direction can be brighter than a display shows: the mean of the samples counts.
    const DEVELOPS: bool = true;

    #[inline(always)]
    fn bounce<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        state: &mut Self::State<N>,
        surface: &Surface<'_, N>,
        _: &mut Bounce<N>,
    ) {
        let reflections = state.first().copied().unwrap_or(u8::MAX);
        if reflections >= tracer.scene().bounces() {
            return;
        }
        let secondary = Secondary {
            kind: RayKind::Diffuse,
            direction: around(surface.shading_normal, tracer.point(DIRECTION)),
            outward: surface.hit.front,
            weight: surface.weight.times(surface.diffuse),
        };
        tracer.send(surface.hit, secondary);
    }

    #[inline(always)]
    fn leave<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        state: &mut Self::State<N>,
        _: &Hit<N>,
        secondary: &mut Secondary<N>,
    ) {
        if secondary.kind == RayKind::Diffuse {
            if let Some(reflections) = state.first_mut() {
                *reflections = reflections.saturating_add(1);
            }
        } else if secondary.kind == RayKind::Refracted && tracer.kind() == RayKind::Diffuse {
            // Lights shine through glass and through transparent parts, too.
            secondary.kind = RayKind::Diffuse;
        }
    }
}

/// A random direction around a normal, of length 1.
#[inline(never)]
fn around<N: Number>(normal: [N; 3], [u, v]: [u32; 2]) -> [N; 3] {
    let square = ratio::<N>(u);
    let (away, toward) = (square.sqrt(), (N::ONE - square).sqrt());
    let [sine, cosine] = Angle(v).sin_cos().map(N::ratio);
    let (along, across) = (away * cosine, away * sine);
    let [first, second] = perpendicular(normal);
    let axis = |k: usize| first[k] * along + second[k] * across + normal[k] * toward;
    [axis(0), axis(1), axis(2)]
}
