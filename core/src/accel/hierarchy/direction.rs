//! Directions of slabs.

use crate::accel::number::Number;

/// A direction of slabs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Direction {
    /// Each -1, 0 or 1.
    pub signs: [i8; 3],
    /// The number of times that the sum of the coordinates is halved, so that it fits 16 bits.
    pub halvings: u32,
}

impl Direction {
    const fn new(signs: [i8; 3], halvings: u32) -> Self {
        Self { signs, halvings }
    }

    /// Returns the sum of coordinates with the direction's signs, not halved.
    pub fn dot(self, point: [i64; 3]) -> i64 {
        let terms = point.iter().zip(self.signs);
        terms.map(|(&x, sign)| x * i64::from(sign)).sum()
    }

    /// The component of a vector.
    #[inline(always)]
    pub(in crate::accel) fn along<N: Number>(self, v: [N; 3]) -> N {
        let mut sum = N::ZERO;
        for (x, sign) in v.into_iter().zip(self.signs) {
            // Halved before they are added, so that the sum stays in range.
            let x = match self.halvings {
                0 => x,
                1 => x.half(),
                _ => x.half().half(),
            };
            match sign {
                0 => {}
                1 => sum = sum + x,
                _ => sum = sum - x,
            }
        }
        sum
    }
}

/// All directions; volumes have the first 3, 7 or 13.
pub const DIRECTIONS: [Direction; 13] = [
    Direction::new([1, 0, 0], 0),
    Direction::new([0, 1, 0], 0),
    Direction::new([0, 0, 1], 0),
    Direction::new([1, 1, 1], 2),
    Direction::new([1, 1, -1], 2),
    Direction::new([1, -1, 1], 2),
    Direction::new([1, -1, -1], 2),
    Direction::new([1, 1, 0], 1),
    Direction::new([1, -1, 0], 1),
    Direction::new([1, 0, 1], 1),
    Direction::new([1, 0, -1], 1),
    Direction::new([0, 1, 1], 1),
    Direction::new([0, 1, -1], 1),
];

/// Numbers of directions that volumes can have.
pub const DIRECTION_COUNTS: [usize; 3] = [3, 7, 13];
