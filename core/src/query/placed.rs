//! Hits of instances: each ray is mapped into the parts that it can meet, and hits are mapped back.

use crate::accel::{Accel, Number, StackView};
use crate::format::Leaf;
use crate::format::instance::Instance;
use crate::instances::map::{Map, PlacedSurface, beyond};
use crate::observe::count::Observer;
use crate::query::hit::{Hit, PrimitiveHit};
use crate::query::search_structure;
use crate::ray::Ray;
use crate::scene::Scene;
use crate::target::InstancesOnly;

/// Where a hit of an instance lies in the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct InInstance<N> {
    index: u32,
    /// The t on the scene's ray, counted from its start.
    t: N,
}

/// The nearest hit, given that of the scene's own objects.
///
/// A part has no hit before a mapped begin of the ray's interval or behind its mapped end, whatever is rounded: so both
/// kinds of queries agree, and the t in the scene is limited to the interval.
#[inline(always)]
pub(super) fn nearest<N: Number, A: Accel, C: Observer, const ANY: bool>(
    scene: &Scene<'_>,
    ray: &Ray<N>,
    own: Option<PrimitiveHit<N>>,
    stack: &mut StackView,
    count: &mut C,
    any: bool,
) -> Option<PrimitiveHit<N>> {
    let Some(placed) = scene.placed.get() else {
        return own;
    };
    if ray.tmax < ray.tmin {
        return own;
    }
    let mut nearest = own;
    // The t of the nearest hit, and the number of its instance: none for the scene's own objects.
    let mut best: Option<(N, Option<u32>)> = own.map(|own| (own.best.t, None));
    placed.top.walk(
        ray,
        best.map_or(ray.tmax, |best| best.0),
        count,
        |index, instance, count| {
            let tmax = best.map_or(ray.tmax, |(t, _)| t);
            let Some((part, first)) = placed.part(instance) else {
                return Some(tmax);
            };
            let mut chosen;
            let part = if part.space.same_choice(&scene.space) {
                part
            } else {
                chosen = *part;
                chosen.space.choose_as(&scene.space);
                &chosen
            };
            let end = best.map_or(ray.tmax, |(t, _)| ray.tmax.min(beyond(t)));
            let Some(mapped) = Map::new(instance).ray(part.bounds(), ray, end) else {
                return Some(tmax);
            };
            let met = search_structure::<N, A, C, ANY>(part, &mapped.ray, None, stack, count, any);
            let Some(met) = met else { return Some(tmax) };
            let t = mapped.to_scene(met.t.widen() + mapped.ray.start_t);
            let t = ray.tmax.min(ray.tmin.max(t));
            let is_nearer = best.is_none_or(|(least, holder)| {
                t < least || t == least && holder.is_some_and(|holder| instance.number < holder)
            });
            if !is_nearer {
                return Some(tmax);
            }
            best = Some((t, Some(instance.number)));
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

/// An instance by its place, and its part.
fn find<'s>(scene: &'s Scene<'_>, index: u32) -> Option<(&'s Instance, &'s Scene<'s>)> {
    let placed = scene.placed.get()?;
    let instance = placed.top.instances.get(index as usize)?;
    Some((instance, placed.part(instance)?.0))
}

/// The whole hit of a primitive of an instance.
#[cold]
#[inline(never)]
pub(super) fn hit<N: Number>(
    found: &PrimitiveHit<N>,
    placed: &InInstance<N>,
    scene: &Scene<'_>,
    ray: &Ray<N>,
) -> Option<Hit<N>> {
    let (instance, part) = find(scene, placed.index)?;
    let (map, best) = (Map::<N>::new(instance), found.best);
    let mapped = map.ray(part.bounds(), ray, ray.tmax)?;
    let shapes = &part.space.shapes;
    let near = mapped.ray.at(best.t);
    let (surface, front) = shapes.surface(best.place, best.part, &mapped.ray, near)?;
    let in_part = PlacedSurface {
        point: surface.point,
        normal: surface.normal,
        error: surface.error,
    };
    let surface = map.surface(ray.at(placed.t), &in_part);
    Some(Hit {
        t: found.t,
        point: surface.point,
        normal: surface.normal,
        front,
        object: scene.object(found.primitive),
        primitive: found.primitive,
        error: surface.error,
        is_exact: false,
        place: Leaf {
            kind: best.place.kind,
            first: part.key(best.place).2,
            count: 1,
        }
        .to_word(),
        instance: InstancesOnly::new(|| placed.index),
    })
}

/// [`Hit::inside`] of an instance: the place is found in its part, at the depth of the hit's error bound.
#[cold]
#[inline(never)]
pub(super) fn inside<N: Number>(hit: &Hit<N>, index: u32, scene: &Scene<'_>) -> [N; 3] {
    let found = find(scene, index).zip(Leaf::from_word(hit.place));
    let Some(((instance, part), leaf)) = found else {
        return hit.point;
    };
    let map = Map::<N>::new(instance);
    let PlacedSurface {
        point,
        normal,
        error,
    } = map.into_part(&PlacedSurface {
        point: hit.point,
        normal: hit.normal,
        error: hit.error,
    });
    let shapes = &part.space.shapes;
    let beneath = shapes.inside(leaf.kind, leaf.first as usize, [point, normal], error);
    let [x, y, z] = beneath;
    let way = map.step([x - point[0], y - point[1], z - point[2]]);
    let axis = |k: usize| hit.point[k] + way[k];
    [axis(0), axis(1), axis(2)]
}
