//! Shapes without bounds, which lie in no structure: every query tests all of them before it walks a structure.

use crate::accel::Number;
use crate::format::Kind;
use crate::format::kind::shapes;
use crate::geometry::PrimitiveId;
use crate::geometry::primitive::Primitive;
use crate::observe::count::Observer;
use crate::observe::event::Event;
use crate::ray::{FarPoint, Ray};
use crate::scene::Scene;

/// The hit of a ray with a shape without bounds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FarHit<N: Number> {
    /// Distance from the ray's start, as kernels count.
    pub(super) after_start: N,
    /// Distance as the caller counts it. It distinguishes hits that lie farther away than kernels count.
    pub(crate) t: N::Wide,
    pub(crate) place: PrimitiveId,
}

/// Returns the nearest hit in the interval that the caller gave. Ties go to the hit that comes first in the scene file.
#[cold]
#[inline(never)]
pub(crate) fn nearest<N: Number, C: Observer>(
    scene: &Scene<'_>,
    ray: &Ray<N>,
    count: &mut C,
) -> Option<FarHit<N>> {
    let mut best: Option<FarHit<N>> = None;
    each(scene, ray, count, |hit| {
        let is_nearer = best.is_none_or(|best| {
            let (mine, other) = ((hit.after_start, hit.t), (best.after_start, best.t));
            mine < other || mine == other && scene.key(hit.place) < scene.key(best.place)
        });
        if is_nearer {
            best = Some(hit);
        }
        is_nearer
    });
    best
}

/// Calls `consider` with every hit in the interval that the caller gave, in the order of their records. It returns
/// whether the hit is the nearest so far.
#[inline(always)]
pub(crate) fn each<N: Number, C: Observer>(
    scene: &Scene<'_>,
    ray: &Ray<N>,
    count: &mut C,
    mut consider: impl FnMut(FarHit<N>) -> bool,
) {
    let [tmin, tmax] = ray.given_interval();
    let mut test = |met: Option<FarPoint<N>>, place: PrimitiveId, count: &mut C| {
        let hit = met.map(|met| FarHit::<N> {
            after_start: ray.after_start(&met),
            t: met.t(),
            place,
        });
        let in_interval = hit.filter(|hit| hit.t >= tmin && hit.t <= tmax);
        let nearest = in_interval.is_some_and(&mut consider);
        count.primitives(1);
        if C::ENABLED {
            let (_, origin_t) = ray.reference_point();
            count.event(Event::Candidate {
                kind: place.kind,
                primitive: scene.primitive_at(place),
                crossing: hit.map(|hit| [N::far_to_f64(hit.t - origin_t); 2]),
                nearest,
            });
        }
    };
    macro_rules! each {
        (
            forms { $($form:tt)* }
            records { $(
                $(#[doc = $doc:literal])* $kind:ident = $number:literal, $name:literal,
                [$field:ident: $module:ident::$record:ident], $section:tt;
            )* }
        ) => {
            $(if Kind::$kind.is_available() && !Kind::$kind.is_bounded() {
                for (slot, record) in (0..).zip(scene.geometry.shapes.$field) {
                    let met = ray.meet_far(|place| record.cross_far(place, ray.slope));
                    test(met, PrimitiveId::in_slot(Kind::$kind, slot), count);
                }
            })*
        };
    }
    shapes!(each);
}
