//! The collection of hits in a search.

use crate::accel::Number;
use crate::geometry::{Part, PrimitiveId};
use crate::query::candidate::Candidate;
use crate::scene::Scene;
use crate::target::{WIDE, wide_only};

/// Collects the hits of a search: keeps the best one, or lists all of them.
pub(super) trait Collect<N: Number> {
    /// True if both ends of every crossing are hits, and triangles follow the [half-open
    /// rule](crate::geometry::half_open).
    const ALL: bool = false;

    /// Returns true if there is a hit.
    fn is_any(&self) -> bool;

    /// Returns true if the last collected hit is one of this primitive; for observers.
    fn is_at(&self, place: PrimitiveId) -> bool;

    /// Collects a hit in the remaining interval. Returns the t beyond which hits are ignored from here on, if that
    /// changes.
    fn commit(&mut self, scene: &Scene<'_>, hit: (N, Part), place: PrimitiveId) -> Option<N>;

    /// Keeps the normal of a triangle, of any length, if the last collected hit is one of it.
    #[inline(always)]
    fn keep_normal(&mut self, _place: PrimitiveId, _normal: [N; 3]) {}
}

/// The best hit so far.
impl<N: Number> Collect<N> for Option<Candidate<N>> {
    #[inline(always)]
    fn is_any(&self) -> bool {
        self.is_some()
    }

    #[inline(always)]
    fn is_at(&self, place: PrimitiveId) -> bool {
        self.is_some_and(|best| best.place == place)
    }

    /// Commits the hit unless an earlier primitive is hit at the same t.
    #[inline(always)]
    fn commit(&mut self, scene: &Scene<'_>, (t, part): (N, Part), place: PrimitiveId) -> Option<N> {
        // No hit lies beyond the best one, so this one is nearer, or as near.
        let tie = self.filter(|best| t >= best.t);
        if tie.is_some_and(|best| scene.key(best.place) <= scene.key(place)) {
            return None;
        }
        *self = Some(Candidate::new((t, part), place));
        Some(t)
    }

    #[inline(always)]
    fn keep_normal(&mut self, place: PrimitiveId, normal: [N; 3]) {
        if WIDE
            && let Some(best) = self
            && best.place == place
        {
            best.normal = wide_only(|| normal);
        }
    }
}
