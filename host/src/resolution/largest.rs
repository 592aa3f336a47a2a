//! The surfaces with the largest error bounds, in memory that does not grow with the scene.

use super::placed::Placed;
use std::cmp::Ordering;

/// Surfaces with the largest bounds that objects are compared with.
const MOST_SURFACES: usize = 4096;

/// The place of a surface among those of its scene: 0 or the rank of its instance, and its number there.
type Place = (usize, usize);

/// The surfaces with the largest bounds so far; of equal bounds the first in the order of their places.
#[derive(Default)]
pub(super) struct Largest<'c> {
    /// Up to twice as many as are returned, so that few additions select.
    kept: Vec<(Place, Placed<'c>)>,
    /// The least bound that counts.
    least: f64,
}

fn by_bound((a_place, a): &(Place, Placed<'_>), (b_place, b): &(Place, Placed<'_>)) -> Ordering {
    b.most.total_cmp(&a.most).then(a_place.cmp(b_place))
}

impl<'c> Largest<'c> {
    /// Adds a surface, in any order.
    pub(super) fn add(&mut self, place: Place, surface: Placed<'c>) {
        if surface.most < self.least {
            return;
        }
        self.kept.push((place, surface));
        if self.kept.len() == 2 * MOST_SURFACES {
            let (_, last, _) = self
                .kept
                .select_nth_unstable_by(MOST_SURFACES - 1, by_bound);
            self.least = last.1.most;
            self.kept.truncate(MOST_SURFACES);
        }
    }

    /// Returns them, the largest bounds first.
    pub(super) fn sorted(mut self) -> Vec<Placed<'c>> {
        self.kept.sort_unstable_by(by_bound);
        self.kept.truncate(MOST_SURFACES);
        self.kept.into_iter().map(|(_, surface)| surface).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::resolution::bound::Extent;
    use crate::shape::{Solid, Sphere};
    use glam::DVec3;

    #[test]
    fn largest_bounds_are_kept_in_bounded_memory_and_ties_in_order() {
        let bound = |number: usize| (number * 7_919 % 1_000) as f64;
        let count = 50_000;
        let mut largest = Largest::default();
        for number in 0..count {
            let solid = Solid::Sphere(Sphere {
                center: DVec3::splat(number as f64),
                radius: 1.0,
            });
            let surface = Placed {
                most: bound(number),
                extent: Extent::of(&solid),
                solid,
                map: None,
            };
            largest.add((0, number), surface);
            assert!(largest.kept.len() < 2 * MOST_SURFACES);
        }
        let mut expected: Vec<usize> = (0..count).collect();
        expected.sort_by(|&a, &b| bound(b).total_cmp(&bound(a)));
        expected.truncate(MOST_SURFACES);
        let found = largest.sorted();
        let found = found.iter().map(|it| (it.extent.lowest.x + 1.0) as usize);
        assert_eq!(found.collect::<Vec<_>>(), expected);
    }
}
