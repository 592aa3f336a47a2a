//! The search for all hits: both ends of every crossing, and triangles by the half-open rule.

use crate::accel::Number;
use crate::accel::cull::Culling;
use crate::format::record::UnitBox;
use crate::geometry::primitive::Primitive;
use crate::geometry::triangle::PlaneCrossing;
use crate::geometry::{Crossing, LATER, LEAVING, Part, PrimitiveId, is_flat, triangle};
use crate::query::collect::Collect;
use crate::query::search::Search;

/// Searches that list all hits.
impl<N: Number, K: Culling<N>, F: Collect<N>> Search<'_, '_, N, K, F> {
    /// Considers both ends of a crossing, or the one of a flat primitive.
    #[inline(never)]
    pub(super) fn consider_both(&mut self, crossing: Crossing<N>, place: PrimitiveId) {
        let Crossing { enter, leave } = crossing;
        self.consider_end(enter, place);
        if !is_flat(place.kind) {
            self.consider_end((leave.0, leave.1 | LEAVING), place);
        }
    }

    /// Considers an end of a crossing that lies in the interval. All crossings lie in the scene's box. So for a ray
    /// that starts where the box begins, a crossing before the start is moved there, because only rounding put it
    /// before.
    fn consider_end(&mut self, (t, part): (N, Part), place: PrimitiveId) {
        let t = if t < N::ZERO && self.starts_at_box() {
            N::ZERO
        } else {
            t
        };
        if t >= self.ray.tmin && t <= self.tmax {
            self.commit((t, part), place);
        }
    }

    fn starts_at_box(&self) -> bool {
        let major = self.ray.major;
        let sides = self.scene.bounds().0.get(major);
        let (Some(&[first, last]), Some(&start)) = (sides, self.ray.origin.get(major)) else {
            return false;
        };
        let is_forward = self.ray.slope.get(major).is_some_and(|&x| x > N::ZERO);
        let before = if is_forward {
            start <= N::from_unit(first)
        } else {
            start >= N::from_unit(last)
        };
        before && self.ray.tmin == N::ZERO
    }

    /// Considers both ends of a crossing that rounding can have moved out of the primitive's box.
    #[inline(never)]
    pub(super) fn consider_both_in_box(
        &mut self,
        crossing: Crossing<N>,
        bounds: UnitBox,
        place: PrimitiveId,
    ) {
        let interval = self.cull.exact(self.ray).interval(&bounds);
        if interval.near > interval.far {
            return;
        }
        let (near, far) = (N::from_cull(interval.near), N::from_cull(interval.far));
        let clamp = |t: N| t.max(near).min(far);
        let Crossing { enter, leave } = crossing;
        let clamped = Crossing {
            enter: (clamp(enter.0), enter.1),
            leave: (clamp(leave.0), leave.1),
        };
        self.consider_both(clamped, place);
    }

    /// Considers the second crossing of a primitive that a line can enter twice.
    #[inline(always)]
    pub(super) fn consider_later<T: Primitive>(
        &mut self,
        first: Crossing<N>,
        record: &T,
        place: PrimitiveId,
    ) {
        let next = record.cross_after(self.ray, self.recip_norm2, first.leave.0);
        if let Some(Crossing { enter, leave }) = next {
            let later = Crossing {
                enter: (enter.0, enter.1 | LATER),
                leave: (leave.0, leave.1 | LATER),
            };
            self.consider_both_in_box(later, record.bounds(), place);
        }
    }

    /// Considers a triangle that the ray hits by the closed rule, given the crossing with its plane. It counts only if
    /// the ray also hits it by the half-open rule.
    ///
    /// A triangle that the ray passes edge on, because of rounding, counts as well, somewhere in its box. Otherwise the
    /// number of crossings of a closed mesh would be odd.
    #[inline(never)]
    pub(super) fn triangle_half_open(
        &mut self,
        corners: [[i32; 3]; 3],
        crossing: Option<PlaneCrossing<N>>,
        place: PrimitiveId,
    ) {
        if !triangle::passes(self.ray, corners) {
            return;
        }
        let place_on_ray = crossing.map_or(self.ray.tmin, |crossing| crossing.t);
        let flat = Crossing::flat(place_on_ray);
        if crossing.is_some_and(|crossing| crossing.is_steep) {
            self.consider_both(flat, place);
        } else {
            self.consider_both_in_box(flat, triangle::bounds(corners), place);
        }
    }
}
