//! The box of an instance.

use crate::axis::dot;
use crate::format::Reason;
use crate::format::instance::{Instance, MATRIX_BITS};
use crate::format::record::UnitBox;

/// Tolerance for the squares of a matrix' rows and the products of two rows. It is 2^-20 of the largest, with twice the
/// fraction bits of an entry.
const TOLERANCE: i64 = 1 << (2 * MATRIX_BITS - 20);

/// Units by which a box is widened. The tolerance of the matrix costs up to 1.2. The transposed matrix is the inverse
/// except for 2.8 * 2^-18 of the way from the center. That way is at most 2^16 * 3^(1/2) units long. Rounding costs
/// less than one unit. The rest is for a hit that lies outside its part's box.
const MARGIN: i64 = 3;

/// Returns an error unless a matrix is a rotation times a factor from 1/2 to 1, within a [tolerance](TOLERANCE).
pub(crate) fn check_rotation(matrix: &[[i32; 3]; 3]) -> Result<(), Reason> {
    let &[x, y, z] = matrix;
    let square = dot(x, x);
    let largest = 1_i64 << (2 * MATRIX_BITS);
    let is_small = |difference: i64| difference.wrapping_abs() <= TOLERANCE;
    let scaled = square >= largest / 4 - TOLERANCE && square <= largest + TOLERANCE;
    let even = is_small(dot(y, y).wrapping_sub(square)) && is_small(dot(z, z).wrapping_sub(square));
    let upright = is_small(dot(x, y)) && is_small(dot(y, z)) && is_small(dot(z, x));
    // Near enough to a rotation or a reflection that the rounded product decides between them.
    let wedge = |i: usize, j: usize| {
        let product = |a: i32, b: i32| i64::from(a).wrapping_mul(b.into());
        (product(x[i], y[j]).wrapping_sub(product(x[j], y[i])) >> MATRIX_BITS) as i32
    };
    let cross = [wedge(1, 2), wedge(2, 0), wedge(0, 1)];
    if scaled && even && upright && dot(cross, z) > 0 {
        Ok(())
    } else {
        Err(Reason::NotRotation)
    }
}

/// 2^60 over a number from 2^28 to 2^30, within 2^-29 of itself. Boards have no division of 64 bits.
fn quotient_of_2_to_60(number: u32) -> Option<i64> {
    // Within 2^-13, and twice as many bits with each step of Newton's method.
    let first = (1_u32 << 31).checked_div(number >> 15)?;
    let mut inverse = i64::from(first) << 14;
    for _ in 0..2 {
        let left = (1_i64 << 60).wrapping_sub(i64::from(number).wrapping_mul(inverse));
        inverse = inverse.wrapping_add((inverse >> 4).wrapping_mul(left >> 28) >> 28);
    }
    Some(inverse)
}

/// The box in the scene around the box of a part; `None` where it would leave the scene's lattice. The matrix is a
/// [rotation](check_rotation).
pub(crate) fn around(instance: &Instance, part: &UnitBox) -> Option<UnitBox> {
    let [x, y, z] = instance.matrix;
    // The inverse is the transposed matrix, divided by the square: from 2^28 to 2^30, so over 2^60 up to 2^32.
    let inverse = quotient_of_2_to_60((dot(x, x) >> 16) as u32)?;
    // In 1/256 unit, from half units: sums have up to 43 bits, of which 13 are far below that.
    let shift = (33 + i32::from(instance.exponent)).unsigned_abs() & 63;
    let back = |sum: i64, rounded: i64| {
        let scaled = (sum >> 13).wrapping_mul(inverse) >> shift;
        scaled.wrapping_add(rounded)
    };
    let [middle, half] = [
        part.0
            .map(|[low, high]| i32::from(low).wrapping_add(high.into())),
        part.0
            .map(|[low, high]| i32::from(high).wrapping_sub(low.into())),
    ];
    let mut bounds = UnitBox([[0; 2]; 3]);
    for (axis, sides) in bounds.0.iter_mut().enumerate() {
        let column = [x[axis], y[axis], z[axis]];
        let middle = back(dot(column, middle), i64::from(instance.center[axis]));
        let half = back(dot(column.map(i32::wrapping_abs), half), 2);
        let [low, high] = [
            middle.wrapping_sub(half) >> 8,
            middle.wrapping_add(half) >> 8,
        ];
        let low = i16::try_from(low.wrapping_sub(MARGIN)).ok()?;
        let high = i16::try_from(high.wrapping_add(1).wrapping_add(MARGIN)).ok()?;
        if low == i16::MIN {
            return None;
        }
        *sides = [low, high];
    }
    Some(bounds)
}

impl Instance {
    /// Returns a box around the placed box of a part, in units of the scene. Returns `None` where it would leave the
    /// scene's lattice, or the matrix is not a rotation times a factor from 1/2 to 1. Loading proves that the
    /// box of an instance's node holds this one.
    ///
    /// ```
    /// use gridel_core::format::instance::{Instance, MATRIX_BITS};
    /// use gridel_core::format::record::UnitBox;
    ///
    /// let one = 1 << MATRIX_BITS;
    /// let instance = Instance {
    ///     matrix: [[one, 0, 0], [0, one, 0], [0, 0, one]],
    ///     center: [256_000, 0, 0],
    ///     exponent: 0,
    ///     part: 0,
    ///     number: 0,
    /// };
    /// let bounds = instance.around(&UnitBox([[-10, 10]; 3]));
    /// let [low, high] = bounds.ok_or("no room")?.0[0];
    /// assert!(low < 990 && high > 1010);
    /// # Ok::<(), &str>(())
    /// ```
    pub fn around(&self, part: &UnitBox) -> Option<UnitBox> {
        check_rotation(&self.matrix).ok()?;
        around(self, part)
    }

    /// Returns whether the matrix is a rotation times a factor from 1/2 to 1, as loading proves.
    pub fn is_rotation(&self) -> bool {
        check_rotation(&self.matrix).is_ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reciprocals_are_within_their_bound() {
        let ends = [1 << 28, (1 << 28) + 1, 3 << 27, (1 << 30) - 1, 1 << 30];
        let between = (0..10_000).map(|k| (1_u32 << 28) + k * 80_521);
        for number in ends.into_iter().chain(between) {
            let exact = f64::powi(2.0, 60) / f64::from(number);
            let found = quotient_of_2_to_60(number).expect("a number");
            assert!(
                (found as f64 / exact - 1.0).abs() < f64::powi(2.0, -29),
                "{number}"
            );
        }
        assert_eq!(quotient_of_2_to_60(0), None);
    }
}
