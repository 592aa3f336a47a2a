//! Binary logarithms of integers, with 8 fraction bits. A value is an interval where it is open to which integer a
//! number is rounded.

use super::number::Enclosure;
use gridel_core::number::log2::{log2, log2_of_power, log2_of_sum};
use gridel_core::scene::Footprint;

/// The most footprints that are looked up for a point.
const MOST: i32 = 8;

/// The ends of the interval of a binary logarithm.
#[derive(Clone, Copy, Debug)]
pub struct Log2([i32; 2]);

impl Log2 {
    pub fn plus(self, other: Self) -> Self {
        Self([self.0[0] + other.0[0], self.0[1] + other.0[1]])
    }

    /// Adds a number that is known.
    pub fn and(self, known: i32) -> Self {
        Self(self.0.map(|it| it + known))
    }

    pub fn negative(self) -> Self {
        Self([-self.0[1], -self.0[0]])
    }

    pub fn half(self) -> Self {
        Self(self.0.map(|it| it >> 1))
    }

    /// Returns the logarithm of the sum of two numbers.
    pub fn sum(self, other: Self) -> Self {
        Self([0, 1].map(|end: usize| log2_of_sum(self.0[end], other.0[end])))
    }

    pub fn at_least(self, least: i32) -> Self {
        Self(self.0.map(|it| it.max(least)))
    }

    /// Returns the logarithm of a number as an integer. The number plus `more` is rounded down.
    pub fn of<N: Enclosure>(number: N, more: f64) -> Self {
        Self(number.bounds().map(|it| log2((it + more).max(0.0) as u64)))
    }

    /// Returns the logarithm of a ratio.
    pub fn of_ratio<N: Enclosure>(ratio: N) -> Self {
        Self::of(ratio * N::int(1 << 30), 0.0).and(-log2_of_power(30))
    }

    /// Returns the footprints that it may be; `None` if there are too many.
    pub fn footprints(self) -> Option<impl Iterator<Item = Footprint>> {
        let [low, high] = self.0;
        (high - low < MOST).then(|| (low..=high).map(Footprint::of_log2))
    }
}
