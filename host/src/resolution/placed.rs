//! Surfaces where they lie in the scene.

use super::bound::{Extent, bound, placed_bound, spacing};
use crate::shape::{ExactMap, Solid};
use gridel_core::Format;

/// A surface, as it lies in the scene.
#[derive(Clone)]
pub(super) struct Placed<'c> {
    /// Its largest error bound.
    pub(super) most: f64,
    pub(super) extent: Extent,
    pub(super) solid: Solid,
    pub(super) map: Option<&'c ExactMap>,
}

impl Placed<'_> {
    /// The error bound next to the middle of a box.
    pub(super) fn bound(&self, format: Format, beside: &Extent) -> f64 {
        let middle = 0.5 * (beside.lowest + beside.highest);
        let place = middle.clamp(self.extent.lowest, self.extent.highest);
        let Some(map) = self.map else {
            return bound(format, &self.solid, place);
        };
        let in_part = map.point(place.to_array());
        let own = bound(format, &self.solid, in_part.into());
        let magnitude = in_part.into_iter().fold(0.0, |most, x| x.abs().max(most));
        let place_in = [map.reach(place.to_array()), place.abs().max_element()];
        placed_bound(format, map, own.max(spacing(format, magnitude)), place_in)
    }
}
