//! The shaft of a bundle of rays: the volume that a box sweeps while it moves and grows evenly.

/// A box from `low + λ low_rate` to `high + λ high_rate`, for λ from 0 to `last`.
///
/// The convex hull of two boxes is such a volume, with λ from one to the other. So is a bundle of
/// rays from a box of origins in a range of slopes, with λ the length along their major axis.
/// Another box meets the volume if it meets the box at one λ. That is six linear inequalities in λ
/// alone: an exact test. It is the shaft of E. Haines and J. Wallace ("Shaft Culling for Efficient
/// Ray-Cast Radiosity", 1991), and also yields where along the shaft the box is met.
#[derive(Clone, Copy, Debug)]
pub struct Shaft {
    pub low: [f64; 3],
    pub high: [f64; 3],
    pub low_rate: [f64; 3],
    pub high_rate: [f64; 3],
    pub last: f64,
}

impl Shaft {
    /// Returns the convex hull of two boxes, λ being 0 in the first and 1 in the second.
    pub fn between(first: [[f64; 2]; 3], second: [[f64; 2]; 3]) -> Self {
        let rate = |side: usize| [0, 1, 2].map(|k| second[k][side] - first[k][side]);
        Self {
            low: first.map(|axis| axis[0]),
            high: first.map(|axis| axis[1]),
            low_rate: rate(0),
            high_rate: rate(1),
            last: 1.0,
        }
    }

    /// Returns the first and the last λ at which a box is met.
    #[inline]
    pub fn meets(&self, bounds: &[[f64; 2]; 3]) -> Option<[f64; 2]> {
        let (mut from, mut to) = (0.0, self.last);
        for (k, &[low, high]) in bounds.iter().enumerate() {
            // low(λ) <= high and high(λ) >= low, each as rate λ <= room.
            let limits = [
                (self.low_rate[k], high - self.low[k]),
                (-self.high_rate[k], self.high[k] - low),
            ];
            for (rate, room) in limits {
                if rate > 0.0 {
                    to = f64::min(to, room / rate);
                } else if rate < 0.0 {
                    from = f64::max(from, room / rate);
                } else if room < 0.0 {
                    return None;
                }
            }
        }
        (from <= to).then_some([from, to])
    }

    /// Returns the square of the least distance of a point from the volume between two λ.
    pub fn distance2(&self, point: [f64; 3], [from, to]: [f64; 2]) -> f64 {
        // A point is outside of the box by `low(λ) - point` or `point - high(λ)`, if positive.
        // These are linear, so the square of the distance is quadratic between the λ where one of
        // them becomes positive.
        let sides = [0, 1, 2].map(|k| {
            [
                (self.low[k] - point[k], self.low_rate[k]),
                (point[k] - self.high[k], -self.high_rate[k]),
            ]
        });
        let sides = sides.as_flattened();
        let mut places = [to; 8];
        places[0] = from;
        for (place, &(start, rate)) in places[1..7].iter_mut().zip(sides) {
            if rate != 0.0 {
                *place = (-start / rate).clamp(from, to);
            }
        }
        places.sort_unstable_by(f64::total_cmp);
        let pieces = places.windows(2).map(|ends| {
            let middle = 0.5 * (ends[0] + ends[1]);
            // a + 2 b λ + c λ^2
            let (mut a, mut b, mut c) = (0.0, 0.0, 0.0);
            for &(start, rate) in sides {
                if start + rate * middle > 0.0 {
                    a += start * start;
                    b += start * rate;
                    c += rate * rate;
                }
            }
            let place = if c > 0.0 { -b / c } else { ends[0] };
            let place = place.clamp(ends[0], ends[1]);
            a + place * (2.0 * b + place * c)
        });
        pieces.fold(f64::INFINITY, f64::min).max(0.0)
    }

    /// Returns the least and the largest value of `normal . x` over the volume.
    pub fn along(&self, normal: [f64; 3]) -> [f64; 2] {
        let end = |place: f64| {
            let mut reach = [0.0; 2];
            for (k, &n) in normal.iter().enumerate() {
                let a = n * (self.low[k] + self.low_rate[k] * place);
                let b = n * (self.high[k] + self.high_rate[k] * place);
                reach[0] += f64::min(a, b);
                reach[1] += f64::max(a, b);
            }
            reach
        };
        let (first, second) = (end(0.0), end(self.last));
        [first[0].min(second[0]), first[1].max(second[1])]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The hull of a unit square at z = 0 and one at z = 10 that lies 10 farther along x.
    fn slanted() -> Shaft {
        Shaft::between(
            [[0.0, 1.0], [0.0, 1.0], [0.0, 0.0]],
            [[10.0, 11.0], [0.0, 1.0], [10.0, 10.0]],
        )
    }

    #[test]
    fn a_box_is_met_where_the_slice_reaches_it() {
        let at = |x: f64, z: f64| [[x - 0.5, x + 0.5], [0.0, 1.0], [z - 0.5, z + 0.5]];
        // The slice at height z covers x from z to z + 1.
        let span = slanted().meets(&at(5.5, 5.0)).expect("met");
        assert!((span[0] - 0.45).abs() < 1e-12 && (span[1] - 0.55).abs() < 1e-12);
        assert!(slanted().meets(&at(8.0, 5.0)).is_none());
        assert!(slanted().meets(&at(2.0, 5.0)).is_none());
        // Beside the volume, though inside the box around it.
        assert!(slanted().meets(&at(0.5, 9.0)).is_none());
    }

    #[test]
    fn distances_are_those_of_the_nearest_slice() {
        let shaft = slanted();
        let least = |point: [f64; 3]| {
            let slices = (0..=100_000).map(|i| {
                let place = f64::from(i) / 1e5;
                let gap = |k: usize| {
                    let low = shaft.low[k] + place * shaft.low_rate[k];
                    let high = shaft.high[k] + place * shaft.high_rate[k];
                    (low - point[k]).max(point[k] - high).max(0.0)
                };
                (0..3).map(|k| gap(k) * gap(k)).sum::<f64>()
            });
            slices.fold(f64::INFINITY, f64::min)
        };
        for point in [
            [8.0, 3.0, 2.0],
            [5.5, 0.5, 5.0],
            [-3.0, -1.0, -2.0],
            [12.0, 0.0, 30.0],
        ] {
            let found = shaft.distance2(point, [0.0, 1.0]);
            assert!((found - least(point)).abs() < 1e-3, "{point:?}: {found}");
            assert!(found <= least(point) + 1e-9);
        }
    }
}
