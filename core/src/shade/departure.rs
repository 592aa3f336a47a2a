//! The starts of rays that leave hits: outside of the surface, on the side to which they go.
//!
//! In `fixed` a plane can be hit farther away than lengths reach, less room for error bounds. The [point](Hit::point) of
//! such a hit is a nearer one of the plane. Rays to lights start from the place itself, and rays that wait from where
//! they come to the scene's box.

use crate::accel::Number;
use crate::format::limits::{ROOM_FOR_ERRORS, UNBOUNDED};
use crate::number::{Format, far_extent};
use crate::observe::count::NoCount;
use crate::query::{Hit, unbounded};
use crate::ray::Ray;
use crate::scene::Scene;
use crate::target::InSomeBuilds;

/// The start of a ray that leaves a hit.
#[derive(Clone, Copy)]
pub(crate) struct Origin<'f, N: Number> {
    /// A point of the surface.
    pub(crate) point: [N; 3],
    /// The place itself, if the hit's point can be a nearer one.
    far: Far<'f, N>,
}

/// The place of a hit whose point can be a nearer one. It is absent in builds without shapes that can be hit there.
pub(crate) type Far<'f, N> = InSomeBuilds<Option<&'f FarPlace<N>>, { UNBOUNDED as usize }>;

impl<'f, N: Number> Origin<'f, N> {
    #[inline(always)]
    pub(crate) fn of(point: [N; 3]) -> Self {
        Self {
            point,
            far: Far::of(None),
        }
    }

    /// The start of rays from a hit to lights.
    #[inline(always)]
    pub(crate) fn to_lights(scene: &Scene<'_>, hit: &Hit<N>, far: Far<'f, N>) -> Self {
        Self {
            point: depart(scene, hit, hit.front, true),
            far,
        }
    }

    #[inline(always)]
    pub(crate) fn place(&self) -> [N::Wide; 3] {
        match self.far.get() {
            Some(Some(FarPlace(place))) => *place,
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

/// Returns a ray from a hit, with all `t` up to an end, or without one. Only in scenes with shapes without bounds it
/// can start, and end, far from the scene's box.
#[inline(always)]
pub(crate) fn secondary_ray<N: Number>(
    scene: &Scene<'_>,
    origin: &Origin<'_, N>,
    way: [N::Wide; 3],
    end: Option<N::Wide>,
) -> Option<Ray<N>> {
    if UNBOUNDED && scene.has_unbounded {
        return from_anywhere(scene, origin, way, end);
    }
    let end = end.unwrap_or(N::FAR.widen());
    Ray::from_inside(scene.bounds(), origin.point, way, end)
}

/// [`secondary_ray`] in scenes with shapes without bounds.
#[cold]
#[inline(never)]
fn from_anywhere<N: Number>(
    scene: &Scene<'_>,
    origin: &Origin<'_, N>,
    way: [N::Wide; 3],
    end: Option<N::Wide>,
) -> Option<Ray<N>> {
    let (start, end) = (
        N::step_beside(N::ZERO).widen(),
        end.unwrap_or(N::far(i64::MAX)),
    );
    Ray::new(scene.bounds(), origin.place(), way, start, end).ok()
}

/// The place of a plane's hit whose point can be a nearer one. It lies outside of the plane, on the side that the ray
/// came from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FarPlace<N: Number>([N::Wide; 3]);

/// A share of a place's distance with 30 fraction bits. The place has an error of some 2^-29 of it.
const BESIDE: i32 = 1 << 4;

impl<N: Number> FarPlace<N> {
    /// Returns the place of a hit if its point can be a nearer one.
    #[inline(always)]
    pub(crate) fn of(ray: &Ray<N>, hit: &Hit<N>) -> Option<Self> {
        // A point that stands for a farther one lies at least this far away. On some axis it is half way between the
        // plane's own point, which reaches to half of the longest length, and a point beyond lengths less the room.
        let far = N::FAR.half().half() - N::from_unit(ROOM_FOR_ERRORS);
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
        // Twice the room of points, because the place is not rounded as they are. Between the two both are right.
        let room = N::from_unit(2 * ROOM_FOR_ERRORS);
        if far_extent::<N>(place) < (N::FAR - room).widen() {
            return None;
        }
        Some(Self(place).moved_off(hit, BESIDE))
    }

    /// The place moved to the side that the ray came from, by a share of its distance.
    #[inline(never)]
    fn moved_off(self, hit: &Hit<N>, share: i32) -> Self {
        let (Self(place), normal) = (self, hit.facing_normal());
        let by = N::wide_scale(far_extent::<N>(place), N::ratio(share));
        let axis = |k: usize| place[k] + N::wide_scale(by, normal[k]);
        Self([axis(0), axis(1), axis(2)])
    }

    /// Moves the start of a ray that waits to where it comes to the scene's box along its major axis. It stays where the
    /// ray does not come there, crosses another plane before, or is beyond lengths there. From a nearer point of the
    /// plane most of them pass the box, too.
    #[inline(never)]
    pub(crate) fn depart(
        self,
        scene: &Scene<'_>,
        hit: &Hit<N>,
        direction: [N; 3],
        origin: &mut [N; 3],
    ) {
        let zero = N::Wide::default();
        let goes_through = N::dot(direction, hit.facing_normal()) < zero;
        let place = if goes_through {
            self.moved_off(hit, -2 * BESIDE)
        } else {
            self
        };
        let start = Origin {
            point: *origin,
            far: Far::of(Some(&place)),
        };
        let Some(ray) = from_anywhere(scene, &start, direction.map(N::widen), None) else {
            return;
        };
        if ray.start_t <= zero {
            return;
        }
        let other = unbounded::nearest(scene, &ray, &mut NoCount);
        if other.is_some_and(|other| other.t <= ray.start_t) {
            return;
        }
        if let Some(start) = ray.far_point(ray.start_t).filter(is_length::<N>) {
            *origin = start.map(N::narrow);
        }
    }
}

/// Returns whether lengths hold a place.
fn is_length<N: Number>(place: &[N::Wide; 3]) -> bool {
    let extent = far_extent::<N>(*place);
    N::narrow(extent).widen() == extent
}
