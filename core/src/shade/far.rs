//! Rays that leave a plane farther away than lengths of `fixed` reach. The [point](Hit::point) of such a hit is another
//! one of the plane, so these rays start elsewhere.

use crate::accel::Number;
use crate::axis::pick;
use crate::format::limits::UNBOUNDED;
use crate::number::{Format, extent};
use crate::observe::count::NoCount;
use crate::query::{Hit, unbounded};
use crate::ray::Ray;
use crate::scene::Scene;
use crate::target::InSomeBuilds;

/// A place beyond lengths that a plane was hit at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FarPlace<N: Number> {
    place: [N::Wide; 3],
    /// The plane.
    primitive: u32,
}

/// The place of a hit that is beyond lengths. It is absent in builds without shapes that can be hit there.
pub(crate) type FarHit<N> = InSomeBuilds<Option<FarPlace<N>>, { UNBOUNDED as usize }>;

impl<N: Number> FarPlace<N> {
    /// Returns the place of a hit if it is beyond the lengths of the format.
    #[inline(always)]
    pub(crate) fn of(ray: &Ray<N>, hit: &Hit<N>) -> Option<Self> {
        // A point that stands for a farther one lies at least this far away: a plane's own point reaches to half of
        // the longest length.
        let can_be_far = N::FORMAT == Format::Fixed
            && hit.is_unbounded()
            && extent(hit.point) >= N::FAR.half().half();
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
        let primitive = hit.primitive;
        lengths::<N>(place)
            .is_none()
            .then_some(Self { place, primitive })
    }

    /// Returns the start of a ray from here: where it comes to the scene's box along its major axis. `None` for a ray
    /// that does not come there, crosses another plane before, or is beyond lengths there. From a nearer point of the
    /// plane most of them pass the box, too.
    #[cold]
    #[inline(never)]
    pub(crate) fn depart(&self, scene: &Scene<'_>, way: [N::Wide; 3]) -> Option<[N; 3]> {
        // Most light comes from above, and most planes lie below.
        if !self.is_before_box(scene, way) {
            return None;
        }
        let zero = N::Wide::default();
        let ray = Ray::new(scene.bounds(), self.place, way, zero, N::far(i64::MAX)).ok()?;
        let mut is_free = true;
        unbounded::each(scene, &ray, &mut NoCount, |plane| {
            // Rounding can put the place behind its own plane.
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

    /// Returns whether the scene's box begins ahead of a ray from here, along its major axis.
    fn is_before_box(&self, scene: &Scene<'_>, way: [N::Wide; 3]) -> bool {
        let [x, y, z] = way.map(N::magnitude);
        let axis = match () {
            () if x >= y && x >= z => 0,
            () if y >= z => 1,
            () => 2,
        };
        let place = pick(self.place, axis);
        let [first, last] = pick(scene.bounds().0, axis).map(|side| N::from_unit(side).widen());
        if pick(way, axis) > N::Wide::default() {
            place < first
        } else {
            place > last
        }
    }
}

/// Returns a place as lengths, if it is within them.
fn lengths<N: Number>(place: [N::Wide; 3]) -> Option<[N; 3]> {
    let lengths = place.map(N::narrow);
    (lengths.map(N::widen) == place).then_some(lengths)
}
