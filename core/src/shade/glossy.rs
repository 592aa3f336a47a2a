//! Rough mirrors and rough glass: rays leave by random facets of the surface, and lights are reflected in all of them.
//!
//! One facet is drawn per hit. At it, mirrors and glass send the same rays as at a smooth surface. Lights that are
//! surfaces, too, count once:
//!
//! - Below a roughness of 0.3 rays hit them, as in smooth mirrors. Random points of them would rarely lie where facets
//!   mirror, and would then be brighter than a sample can be.
//! - From a roughness of 0.3 on the formula reflects them, and lights that no ray hits. A ray that leaves by a facet
//!   then does not bring their light.
//!
//! The same rules apply to the sun of an environment. But most suns are brighter than a record holds, and rays bring no
//! more. The formula then reflects the sun at every roughness, and reflected rays do not bring it. Rays always bring the
//! map.

use crate::accel::Number;
use crate::format::Effects;
use crate::format::environment::Environment;
use crate::format::record::Light;
use crate::observe::count::Observer;
use crate::observe::event::{Event, RayKind};
use crate::query::Hit;
use crate::scene::Scene;
use crate::shade::Color;
use crate::shade::effect::{Effect, Tracer};
use crate::shade::facets::Facets;
use crate::shade::glass::{self, split};
use crate::shade::surface::{Bounce, Gleam, Lighting, Secondary, Surface};

pub(crate) struct Glossy;

/// The α from which the formula reflects lights that are surfaces: that of a roughness of 0.3.
const WIDE: i32 = 96_636_764;

/// The dimension of the point that draws a facet.
const FACET: u16 = 0x1010;

impl Effect for Glossy {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects::GLOSSY;
    const NEEDS_DIRECTION: bool = true;

    /// Few facets mirror a small light, and these samples bring more than a display shows: the mean counts.
    const DEVELOPS: bool = true;

    #[inline(always)]
    fn reflect<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        (): &mut (),
        surface: &Surface<'_, N>,
        lighting: &Lighting<'_, N>,
        _: &mut Color<N>,
        gleam: &mut Option<Gleam<N>>,
    ) {
        // No material states it, unlike for other effects: a section of the blob does.
        let scene = tracer.scene();
        let Some(alpha) = scene.roughness(surface.hit.object) else {
            return;
        };
        let light = lighting.light;
        let is_met = match light.kind {
            // Facets that are seen at grazing angles mirror a small part of the map much brighter than the rest.
            Light::ENVIRONMENT => true,
            Light::SUN => alpha < WIDE && !is_sun_limited(scene),
            _ => alpha < WIDE && scene.is_shown(light),
        };
        if !is_met {
            *gleam = mirrored(alpha, surface, lighting.to_light);
        }
    }

    #[inline(always)]
    fn bounce<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        (): &mut (),
        surface: &Surface<'_, N>,
        bounce: &mut Bounce<N>,
    ) {
        let Some(alpha) = tracer.scene().roughness(surface.hit.object) else {
            return;
        };
        let facets = Facets::new(alpha, bounce.normal, bounce.cos_in);
        let facet = facets.draw(surface.direction, tracer.point(FACET));
        bounce.normal = facet;
        bounce.cos_in = -N::from_wide(N::dot(surface.direction, facet));
        bounce.cos_in = bounce.cos_in.max(N::ZERO).min(N::ONE);
        bounce.facets = Some(facets);
        if X::Observer::ENABLED {
            tracer.count().event(Event::Facet {
                normal: facet.map(N::ratio_to_f64),
            });
        }
    }

    #[inline(always)]
    fn leave<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        (): &mut (),
        hit: &Hit<N>,
        secondary: &mut Secondary<N>,
    ) {
        match secondary.kind {
            RayKind::Reflected => {
                let scene = tracer.scene();
                match scene.roughness(hit.object) {
                    Some(alpha) if alpha >= WIDE => secondary.kind = RayKind::Glossy,
                    Some(_) if is_sun_limited(scene) => secondary.kind = RayKind::Polished,
                    _ => {}
                }
            }
            // Lights shine through glass and through transparent parts.
            RayKind::Refracted if matches!(tracer.kind(), RayKind::Glossy | RayKind::Polished) => {
                secondary.kind = tracer.kind();
            }
            _ => {}
        }
    }
}

/// Returns true if rays to the scene's sun would bring only a part of its light.
fn is_sun_limited(scene: &Scene<'_>) -> bool {
    scene.environment().is_some_and(Environment::is_sun_limited)
}

/// Returns the part of a light that facets mirror, if any.
#[inline(never)]
fn mirrored<N: Number>(alpha: i32, surface: &Surface<'_, N>, to_light: [N; 3]) -> Option<Gleam<N>> {
    let Surface { material, .. } = *surface;
    let (normal, direction) = (surface.shading_normal, surface.direction);
    // Halfway between the light and the ray's origin.
    let axis = |k: usize| to_light[k].half() - direction[k].half();
    let (halfway, _) = N::normalize([axis(0), axis(1), axis(2)]);
    let cos_in = -N::from_wide(N::dot(direction, normal));
    let cos_out = N::from_wide(N::dot(to_light, normal)).min(N::ONE);
    let facets = Facets::new(alpha, normal, cos_in);
    let (ratio, power) = facets.reflect(cos_out, halfway);
    let mut color = Color::ratios(material.mirror);
    if material.is_glass() {
        let cos = -N::from_wide(N::dot(direction, halfway));
        let cos = cos.max(N::ZERO).min(N::ONE);
        let split = split(surface.interface(), direction, halfway, cos);
        color = color.plus_up_to_one(glass::mirrored(material, split.reflected));
    }
    let ratio = color.scaled(ratio);
    (ratio != Color::BLACK).then_some(Gleam { ratio, power })
}
