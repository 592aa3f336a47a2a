//! The starts of rays that leave hits: outside of the surface, on the side to which they go.
//!
//! In `fixed` a plane can be hit farther away than lengths reach. The [point](Hit::point) of such a hit is another one
//! of the plane. Rays to lights start from the place itself, and rays that wait from where they come to the scene's box.

use crate::accel::Number;
use crate::format::limits::UNBOUNDED;
use crate::number::{Format, far_extent};
use crate::observe::count::NoCount;
use crate::query::{Hit, unbounded};
use crate::ray::Ray;
use crate::scene::Scene;
use crate::target::InSomeBuilds;

/// The start of a ray that leaves a hit.
#[derive(Clone, Copy)]
pub(crate) struct Origin<N: Number> {
    point: [N; 3],
    /// The place, if it is beyond lengths.
    far: InSomeBuilds<Option<[N::Wide; 3]>, { UNBOUNDED as usize }>,
}

impl<N: Number> Origin<N> {
    #[inline(always)]
    pub(crate) fn of(point: [N; 3]) -> Self {
        Self {
            point,
            far: InSomeBuilds::of(None),
        }
    }

    /// The start of rays from a hit to lights.
    #[inline(always)]
    pub(crate) fn to_lights(scene: &Scene<'_>, hit: &Hit<N>, far: &FarHit<N>) -> Self {
        let far = far.get().copied().flatten();
        Self {
            point: depart(scene, hit, hit.front, true),
            far: InSomeBuilds::new(|| Some(far?.place)),
        }
    }

    /// The start as lengths. For one beyond them it is another point of the surface.
    #[inline(always)]
    pub(crate) fn point(&self) -> [N; 3] {
        self.point
    }

    #[inline(always)]
    pub(crate) fn place(&self) -> [N::Wide; 3] {
        match self.far.get() {
            Some(Some(place)) => *place,
            _ => self.point.map(N::widen),
        }
    }
}

/// Returns the start of a ray that leaves a hit. On its way to a light the ray can start on the surface itself, because
/// it certainly leads away from it. A mirrored ray can be rounded into the surface.
///
/// Out of line, because copies of it took more of the call stack than the call.
#[inline(never)]
pub(crate) fn depart<N: Number>(
    scene: &Scene<'_>,
    hit: &Hit<N>,
    outward: bool,
    to_light: bool,
) -> [N; 3] {
    match (outward, to_light) {
        (true, true) => hit.offset_point(),
        (true, false) => hit.outside(),
        _ => hit.inside(scene),
    }
}

/// Returns the start of a ray that waits until it is traced.
#[inline(always)]
pub(crate) fn depart_later<N: Number>(
    scene: &Scene<'_>,
    hit: &Hit<N>,
    far: &FarHit<N>,
    outward: bool,
    direction: [N; 3],
) -> [N; 3] {
    let far = far.get().and_then(|far| far.as_ref());
    match far.and_then(|far| far.depart(scene, direction.map(N::widen))) {
        Some(origin) => origin,
        None => depart(scene, hit, outward, false),
    }
}

/// Returns a ray from a hit, with all `t` up to an end, or without one. Only in scenes with shapes without bounds it
/// can start, and end, far from the scene's box.
#[inline(always)]
pub(crate) fn secondary_ray<N: Number>(
    scene: &Scene<'_>,
    origin: &Origin<N>,
    way: [N::Wide; 3],
    end: Option<N::Wide>,
) -> Option<Ray<N>> {
    if UNBOUNDED && scene.has_unbounded {
        return Ray::from_anywhere(scene.bounds(), origin.place(), way, end);
    }
    let end = end.unwrap_or(N::FAR.widen());
    Ray::from_inside(scene.bounds(), origin.point, way, end)
}

/// The place of a hit beyond lengths. It is absent in builds without shapes that can be hit there.
pub(crate) type FarHit<N> = InSomeBuilds<Option<FarPlace<N>>, { UNBOUNDED as usize }>;

/// A place beyond lengths at which a plane was hit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FarPlace<N: Number> {
    /// Outside of the plane, on the side that the ray came from.
    place: [N::Wide; 3],
    /// The plane.
    primitive: u32,
}

impl<N: Number> FarPlace<N> {
    /// Returns the place of a hit if it is beyond the lengths of the format.
    #[inline(always)]
    pub(crate) fn of(ray: &Ray<N>, hit: &Hit<N>) -> Option<Self> {
        // A point that stands for a farther one lies at least this far away: a plane's own point reaches to half of
        // the longest length.
        let far = N::FAR.half().half();
        let can_be_far = N::FORMAT == Format::Fixed
            && hit.point.iter().any(|&x| x >= far || x <= -far)
            && hit.is_unbounded();
        if can_be_far {
            Self::beyond(ray, hit)
        } else {
            None
        }
    }

    #[cold]
    #[inline(never)]
    fn beyond(ray: &Ray<N>, hit: &Hit<N>) -> Option<Self> {
        let place = ray.far_point(hit.t)?;
        if lengths::<N>(place).is_some() {
            return None;
        }
        // It has an error of some 2^-29 of its distance. Without products, each coordinate moves on its own.
        let off = N::wide_scale(far_extent::<N>(place), N::ratio(1 << 4));
        let normal = hit.facing_normal();
        let axis = |k: usize| match normal[k] {
            up if up > N::ZERO => place[k] + off,
            down if down < N::ZERO => place[k] - off,
            _ => place[k],
        };
        Some(Self {
            place: [axis(0), axis(1), axis(2)],
            primitive: hit.primitive,
        })
    }

    /// Returns the start of a ray that waits: where it comes to the scene's box along its major axis. `None` for a ray
    /// that does not come there, crosses another plane before, or is beyond lengths there. From a nearer point of the
    /// plane most of them pass the box, too.
    #[cold]
    #[inline(never)]
    fn depart(&self, scene: &Scene<'_>, way: [N::Wide; 3]) -> Option<[N; 3]> {
        let zero = N::Wide::default();
        let ray = Ray::new(scene.bounds(), self.place, way, zero, N::far(i64::MAX)).ok()?;
        if ray.start_t <= zero {
            return None;
        }
        let mut is_free = true;
        unbounded::each(scene, &ray, &mut NoCount, |plane| {
            // A ray that goes through its own plane crosses it at once.
            is_free &= plane.t > ray.start_t || scene.primitive_at(plane.place) == self.primitive;
            false
        });
        if !is_free {
            return None;
        }
        if ray.holds_start() {
            return Some(ray.origin);
        }
        lengths::<N>(ray.far_point(ray.start_t)?)
    }
}

/// Returns a place as lengths, if it is within them.
fn lengths<N: Number>(place: [N::Wide; 3]) -> Option<[N; 3]> {
    let lengths = place.map(N::narrow);
    (lengths.map(N::widen) == place).then_some(lengths)
}
