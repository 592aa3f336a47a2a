//! Ray casts between given points, without a camera or a picture.

use gridel_core::{Accel, NoCount, Number, Ray, Scene, StackView, closest_primitive};

/// Rays that are cast.
pub const RAYS: u32 = 4096;

/// The results of casts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Casts {
    /// Number of rays that hit something.
    pub hits: u32,
    /// The length and the primitive of each hit, all in one word that depends on their order, too.
    pub sum: u32,
}

impl Casts {
    /// Casts rays from points around and inside of the scene's box to points inside, and beyond.
    pub fn run<N: Number, A: Accel>(&mut self, scene: &Scene<'_>, stack: &mut StackView) {
        let mut points = Points::default();
        for _ in 0..RAYS {
            let (from, to) = (points.next(scene, 3), points.next(scene, 1));
            let way = [0, 1, 2].map(|axis| N::far(to[axis].wrapping_sub(from[axis])));
            let (start, end) = (N::Wide::default(), N::far(1 << 60));
            let Ok(ray) = Ray::<N>::new(scene.bounds(), from.map(N::far), way, start, end) else {
                continue;
            };
            if let Some(found) = closest_primitive::<N, A, _>(scene, &ray, stack, &mut NoCount) {
                self.hits = self.hits.wrapping_add(1);
                let length = N::narrow(found.t).to_q13() as u32;
                self.sum = self.sum.rotate_left(5) ^ length ^ found.primitive.rotate_right(12);
            }
        }
    }
}

/// Points that are the same on every machine.
#[derive(Default)]
struct Points(u32);

impl Points {
    /// The next one in a box an odd number of times as wide as the scene's, with 13 fraction bits.
    fn next(&mut self, scene: &Scene<'_>, times: i64) -> [i64; 3] {
        scene.bounds().0.map(|[low, high]| {
            // Numerical Recipes' quick generator: its upper half is random enough.
            self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let share = i64::from(self.0 >> 16);
            let [low, high] = [i64::from(low), i64::from(high)];
            let size = high.wrapping_sub(low).wrapping_mul(times);
            // The sum of the sides is twice the middle.
            let first = low.wrapping_add(high).wrapping_sub(size) << 12;
            first.wrapping_add(size.wrapping_mul(share) >> 3)
        })
    }
}
