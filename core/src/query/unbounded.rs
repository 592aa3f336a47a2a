//! Shapes without bounds, which lie in no structure: every query tests all of them before it walks a structure.

use crate::accel::Number;
use crate::format::Kind;
use crate::format::kind::shapes;
use crate::geometry::PrimitiveId;
use crate::geometry::primitive::Primitive;
use crate::observe::count::Observer;
use crate::observe::event::Event;
use crate::ray::Ray;
use crate::scene::Scene;

/// Returns the nearest hit in the caller's interval, and its t as the caller counts it. At the same t, the hit that
/// comes first in the scene file counts.
#[cold]
#[inline(never)]
pub(super) fn nearest<N: Number, C: Observer>(
    scene: &Scene<'_>,
    ray: &Ray<N>,
    count: &mut C,
) -> Option<(N::Wide, PrimitiveId)> {
    let mut best: Option<(N::Wide, PrimitiveId)> = None;
    each(scene, ray, count, |t, place| {
        if best.is_none_or(|(least, first)| {
            t < least || t == least && scene.key(place) < scene.key(first)
        }) {
            best = Some((t, place));
        }
        best.is_some_and(|best| best.1 == place)
    });
    best
}

/// Calls `hit` with every hit in the caller's interval, in the order of their records. `hit` returns true if it is the
/// nearest so far.
#[inline(always)]
pub(super) fn each<N: Number, C: Observer>(
    scene: &Scene<'_>,
    ray: &Ray<N>,
    count: &mut C,
    mut hit: impl FnMut(N::Wide, PrimitiveId) -> bool,
) {
    let [tmin, tmax] = ray.given_interval();
    let mut consider = |t: Option<N::Wide>, place: PrimitiveId, count: &mut C| {
        let in_interval = t.filter(|&t| t >= tmin && t <= tmax);
        let nearest = in_interval.is_some_and(|t| hit(t, place));
        count.objects(1);
        if C::ENABLED {
            count.event(Event::Candidate {
                kind: place.kind,
                primitive: scene.primitive_at(place),
                crossing: t.map(|t| [N::far_to_f64(t - ray.start_t); 2]),
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
                for (slot, record) in (0..).zip(scene.space.shapes.$field) {
                    let met = ray.meet_far(|place| record.cross_far(place, ray.slope));
                    consider(met.map(|met| met.t()), PrimitiveId::in_slot(Kind::$kind, slot), count);
                }
            })*
        };
    }
    shapes!(each);
}
