//! Rays that leave a plane farther away than lengths of `fixed` reach. The [point](Hit::point) of such a hit is another
//! one of the plane, so these rays start elsewhere.

use crate::accel::Number;
use crate::geometry::plane;
use crate::number::{Format, extent, far_extent};
use crate::observe::count::NoCount;
use crate::query::{Hit, unbounded};
use crate::ray::Ray;
use crate::scene::Scene;

/// Returns the place of a hit if it is beyond the lengths of the format.
#[inline(always)]
pub(crate) fn far_place<N: Number>(ray: &Ray<N>, hit: &Hit<N>) -> Option<[N::Wide; 3]> {
    // A point that stands for a farther one lies at least this far away: a plane's own point reaches to half of
    // the longest length.
    let can_be_far = N::FORMAT == Format::Fixed
        && hit.is_unbounded()
        && extent(hit.point) >= N::FAR.half().half();
    if can_be_far { beyond(ray, hit) } else { None }
}

#[cold]
#[inline(never)]
fn beyond<N: Number>(ray: &Ray<N>, hit: &Hit<N>) -> Option<[N::Wide; 3]> {
    let place = ray.far_point(hit.t)?;
    let is_length = |&x: &N::Wide| N::narrow(x).widen() == x;
    (!place.iter().all(is_length)).then_some(place)
}

/// Returns the start of a ray that leaves a far place: where it comes to the scene's box along its major axis. A ray
/// that crosses a plane before starts at its place. Coordinates beyond lengths become the last length, beside which
/// nothing of the box lies either.
#[cold]
#[inline(never)]
pub(crate) fn depart_far<N: Number>(
    scene: &Scene<'_>,
    place: [N::Wide; 3],
    way: [N::Wide; 3],
) -> Option<[N; 3]> {
    // A place that far away is rounded, and can lie behind its own plane.
    let beside = N::wide_over(far_extent::<N>(place), 1 << 16);
    let ray = Ray::new(scene.bounds(), place, way, beside, N::far(i64::MAX)).ok()?;
    let crossed = unbounded::nearest(scene, &ray, &mut NoCount);
    let is_free = crossed.is_none_or(|plane| plane.t > ray.start_t);
    if is_free && ray.holds_start() {
        return Some(ray.origin);
    }
    let zero = N::Wide::default();
    let moved = is_free && ray.start_t > zero;
    let point = ray.far_point(if moved { ray.start_t } else { zero })?;
    Some(point.map(plane::held::<N>))
}
