//! The search through instances: each ray is mapped into the parts that it can hit.

use crate::accel::{Number, StackView};
use crate::instances::map::{Map, PlacedRay, beyond};
use crate::observe::count::Observer;
use crate::observe::event::Event;
use crate::query::candidate::Candidate;
use crate::query::hit::{InInstance, PrimitiveHit};
use crate::ray::Ray;
use crate::scene::Scene;
use crate::target::{InstancesOnly, inline_on_boards};

/// A search through a part, with any structure.
pub(super) type SearchPart<'f, N, C> =
    &'f mut dyn FnMut(&Scene<'_>, &Ray<N>, &mut StackView, &mut C) -> Option<Candidate<N>>;

/// The type that finds the hits in parts.
pub(super) struct PartSearch<F> {
    /// True if the first hit is enough.
    pub(super) any: bool,
    pub(super) search: F,
}

/// A part with the walks that are chosen in its scene.
#[inline(always)]
pub(super) fn choose_as<'p, 'a>(
    part: &'p Scene<'a>,
    scene: &Scene<'_>,
    chosen: &'p mut Option<Scene<'a>>,
) -> &'p Scene<'a> {
    if part.geometry.same_choice(&scene.geometry) {
        return part;
    }
    let chosen = chosen.insert(*part);
    chosen.geometry.choose_as(&scene.geometry);
    chosen
}

inline_on_boards!(
    /// The nearest hit, given that of the scene's own objects and a search through parts.
    ///
    /// A part has no hit before a mapped begin of the ray's interval or behind its mapped end, however they were
    /// rounded. So both kinds of queries agree, and the t in the scene is limited to the interval.
    pub(super) fn nearest<N: Number, C: Observer>(
        scene: &Scene<'_>,
        ray: &Ray<N>,
        own: Option<PrimitiveHit<N>>,
        stack: &mut StackView,
        count: &mut C,
        parts: PartSearch<
            impl FnMut(&Scene<'_>, &Ray<N>, &mut StackView, &mut C) -> Option<Candidate<N>>,
        >,
    ) -> Option<PrimitiveHit<N>> {
        let PartSearch { any, mut search } = parts;
        let Some(placed) = scene.placed.get() else {
            return own;
        };
        if ray.tmax < ray.tmin {
            return own;
        }
        let mut nearest = own;
        // The t of the nearest hit, and number and place of its instance: none for the scene's own objects.
        let mut best: Option<(N, Option<[u32; 2]>)> = own.map(|own| (own.best.t, None));
        placed.top.walk(
            ray,
            best.map_or(ray.tmax, |best| best.0),
            count,
            |index, instance, count| {
                let tmax = best.map_or(ray.tmax, |(t, _)| t);
                let Some((part, first)) = placed.part(instance) else {
                    return Some(tmax);
                };
                let mut chosen = None;
                let part = choose_as(part, scene, &mut chosen);
                let end = best.map_or(ray.tmax, |(t, _)| ray.tmax.min(beyond(t)));
                let Some(mapped) = Map::new(instance).ray(part.bounds(), ray, end) else {
                    return Some(tmax);
                };
                count.instances(1);
                if C::ENABLED {
                    count.event(mapped.entered(index, first));
                }
                let met = search(part, &mapped.ray, stack, count);
                let Some(met) = met else {
                    if C::ENABLED {
                        count.event(Event::InstanceLeft { nearest: false });
                    }
                    return Some(tmax);
                };
                let t = mapped.t_in_scene(met.t.widen() + mapped.ray.start_t);
                let t = ray.tmax.min(ray.tmin.max(t));
                let number = [instance.number, index];
                let is_nearer = best.is_none_or(|(least, holder)| {
                    t < least || t == least && holder.is_some_and(|holder| number < holder)
                });
                if C::ENABLED {
                    count.event(Event::InstanceLeft { nearest: is_nearer });
                }
                if !is_nearer {
                    return Some(tmax);
                }
                best = Some((t, Some(number)));
                nearest = Some(PrimitiveHit {
                    t: t.widen() + ray.start_t,
                    primitive: first.wrapping_add(part.primitive_at(met.place)),
                    best: met,
                    placed: InstancesOnly::new(|| Some(InInstance { index, t })),
                });
                (!any).then_some(t)
            },
        );
        nearest
    }
);

/// An instance that a ray enters.
pub(super) struct Entered<'p, 'a, N: Number> {
    pub(super) part: &'p Scene<'a>,
    pub(super) mapped: PlacedRay<N>,
    /// The instance's place among the scene's.
    pub(super) index: u32,
    /// Its number in scene-file order.
    pub(super) number: u32,
    pub(super) first_primitive: u32,
}

/// Calls `visit` with every instance that a ray can enter, given the t beyond which hits are ignored, if there is one.
/// `visit` returns its new value.
#[inline(never)]
pub(super) fn each<N: Number, C: Observer>(
    scene: &Scene<'_>,
    ray: &Ray<N>,
    limit: Option<N>,
    count: &mut C,
    mut visit: impl FnMut(Entered<'_, '_, N>, &mut C) -> Option<N>,
) {
    let Some(placed) = scene.placed.get() else {
        return;
    };
    if ray.tmax < ray.tmin {
        return;
    }
    let mut limit = limit;
    let nearest = |limit: Option<N>| limit.map_or(ray.tmax, |limit| ray.tmax.min(limit));
    placed
        .top
        .walk(ray, nearest(limit), count, |index, instance, count| {
            let tmax = nearest(limit);
            let Some((part, first_primitive)) = placed.part(instance) else {
                return Some(tmax);
            };
            let mut chosen = None;
            let part = choose_as(part, scene, &mut chosen);
            let end = limit.map_or(ray.tmax, |limit| ray.tmax.min(beyond(limit)));
            let Some(mapped) = Map::new(instance).ray(part.bounds(), ray, end) else {
                return Some(tmax);
            };
            count.instances(1);
            if C::ENABLED {
                count.event(mapped.entered(index, first_primitive));
            }
            let number = instance.number;
            limit = visit(
                Entered {
                    part,
                    mapped,
                    index,
                    number,
                    first_primitive,
                },
                count,
            );
            if C::ENABLED {
                count.event(Event::InstanceLeft { nearest: false });
            }
            Some(nearest(limit))
        });
}
