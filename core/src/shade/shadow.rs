//! Shadows: one ray per light and hit.

use crate::accel::Number;
use crate::format::Effects;
use crate::format::limits::MAX_SHADOW_SURFACES;
use crate::format::record::Light;
use crate::number::extent;
use crate::observe::count::Observer;
use crate::observe::event::{Event, RayKind};
use crate::shade::Color;
use crate::shade::departure::{Origin, depart, secondary_ray};
use crate::shade::effect::{Effect, Tracer};
use crate::shade::surface::{Filter, Lighting, Reach, Surface};

pub(crate) struct Shadow;

impl Effect for Shadow {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects::SHADOW;

    fn is_required_by_light(_: &Light) -> bool {
        true
    }

    #[inline(always)]
    fn light<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        (): &mut (),
        _: &Surface<'_, N>,
        lighting: &Lighting<'_, N>,
        arriving: &mut Color<N>,
    ) {
        // No material states it, unlike for other effects: the scene itself can turn shadows off.
        if tracer.scene().effects().contains(Self::EFFECT) {
            *arriving = arriving.times(through(tracer, lighting));
        }
    }
}

/// The part of a light that arrives at a surface.
///
/// Opaque objects block all light. Light goes straight through the others, and their effects reduce it at every
/// surface.
fn through<'s, N: Number, X: Tracer<'s, N>>(
    tracer: &mut X,
    lighting: &Lighting<'_, N>,
) -> Color<N> {
    let scene = tracer.scene();
    let zero = N::Wide::default();
    let Lighting {
        mut origin,
        mut way,
        mut distance,
        to_light,
        norm,
        ..
    } = *lighting;
    let mut left = Color::WHITE;
    for _ in 0..=MAX_SHADOW_SURFACES {
        // The light itself, and objects that touch it, cast no shadow.
        let end = distance.map(|distance| {
            let magnitude = extent(origin.point).max(N::narrow(distance));
            distance - N::error_bound(magnitude).widen()
        });
        let Some(ray) = secondary_ray(scene, &origin, way, end) else {
            return left;
        };
        tracer.count().ray(RayKind::Shadow, &ray);
        if !tracer.filters() {
            let dark = tracer.any_hit(&ray);
            return if dark { Color::BLACK } else { left };
        }
        let Some(hit) = tracer.closest_hit(&ray) else {
            let Some(distance) = distance else {
                return left;
            };
            let mut reach = Reach {
                distance,
                norm,
                medium: None,
                left,
            };
            tracer.reach(&mut reach);
            return reach.left;
        };
        let Some(material) = scene.material(hit.object) else {
            return Color::BLACK;
        };
        let mut filter = Filter {
            hit: &hit,
            material,
            to_light,
            left,
            medium: None,
            interface: None,
            passes: false,
        };
        tracer.filter(&ray, &mut filter);
        if !filter.passes {
            return Color::BLACK;
        }
        left = filter.left;
        if X::Observer::ENABLED {
            tracer.count().event(Event::Filtered {
                left: left.ratios_to_f64(),
            });
        }
        if left.peak() * N::radiance(1 << 20) <= N::radiance(scene.view.cutoff) {
            return Color::BLACK;
        }
        origin = Origin::of(depart(scene, &hit, !hit.front, false));
        // The way continues along the same slopes, so its largest component stays the measure. It starts outside the
        // surface. So objects at its end, such as the light itself, can be nearer by that distance.
        let beside = (hit.error + hit.error).widen();
        distance = distance.map(|distance| distance - hit.t - beside);
        if distance.is_some_and(|rest| rest <= zero) {
            return left;
        }
        way = ray.slope.map(N::widen);
    }
    Color::BLACK
}
