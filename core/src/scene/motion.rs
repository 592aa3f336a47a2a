//! Motions: they move an instance away from its place in the blob.

use crate::axis::dot;
use crate::format::instance::{Instance, MATRIX_BITS};
use crate::format::limits::{MAX_COORDINATE_SHIFT, SCALES};
use crate::format::record::Header;
use crate::number::Angle;
use crate::number::rotation::{about, columns};
use crate::scene::Position;

/// Fraction bits of offsets, in coordinate steps.
const OFFSET_BITS: u32 = 16;

/// Fraction bits of scales.
const SCALE_BITS: u32 = 24;

/// A rotation, a uniform scale and a shift in scene coordinates. It moves an instance from its place at rest to its new
/// one.
///
/// In integers only, with the same bits in every number format and on every machine. Coordinates are multiples of the
/// scene's step, as in a [`Position`]. Each composition rounds the numbers of a rotation's matrix to 30 fraction bits.
///
/// ```
/// use gridel_core::{Angle, Motion, Position};
///
/// // An arm of two links along x, with joints at 0 and at 1000, each bent by a quarter of a turn about z.
/// let z = [0, 0, 1];
/// let shoulder = Motion::turn(Position([0; 3]), z, Angle::QUARTER).expect("an axis");
/// let elbow = Motion::turn(Position([1000, 0, 0]), z, Angle::QUARTER).expect("an axis");
/// // The hand at 2000 is moved by the elbow first, and then by what the elbow hangs on.
/// let hand = elbow.then(&shoulder).position(Position([2000, 0, 0]));
/// assert_eq!(hand, Position([-1000, 1000, 0]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Motion {
    /// Row by row, with 30 fraction bits.
    rotation: [[i32; 3]; 3],
    /// The scale with [`SCALE_BITS`] fraction bits.
    scale: i32,
    /// The place to which the origin is moved: coordinate steps with [`OFFSET_BITS`].
    offset: [i64; 3],
}

impl Motion {
    /// No motion.
    pub const REST: Self = Self {
        rotation: [[1 << 30, 0, 0], [0, 1 << 30, 0], [0, 0, 1 << 30]],
        scale: 1 << SCALE_BITS,
        offset: [0; 3],
    };

    /// The least and the greatest scale, with 24 fraction bits: 1/16384 and 64.
    pub const SCALES: [i32; 2] = SCALES;

    /// Returns a turn about an axis of any length through a place, counterclockwise as seen from the axis' tip; `None`
    /// if the axis has no length. Each number of its matrix is within 2^-25.
    pub fn turn(pivot: Position, axis: [i32; 3], angle: Angle) -> Option<Self> {
        Self::rotation(pivot, about(axis, angle)?)
    }

    /// Returns a turn about a place by a quaternion of any length, x, y, z and w; `None` if it has no length.
    pub fn rotation(pivot: Position, rotation: [i32; 4]) -> Option<Self> {
        let [x, y, z] = columns(rotation)?;
        let row = |axis: usize| [x[axis].0, y[axis].0, z[axis].0];
        let turned = Self {
            rotation: [row(0), row(1), row(2)],
            ..Self::REST
        };
        Some(turned.about(pivot))
    }

    /// Returns a shift by this many coordinate steps.
    pub fn shift(steps: [i32; 3]) -> Self {
        Self {
            offset: steps.map(fine),
            ..Self::REST
        }
    }

    /// Returns a scale about a place, with 24 fraction bits; a scale out of [its range](Self::SCALES) is moved to its
    /// end.
    pub fn scale(pivot: Position, scale: i32) -> Self {
        let [least, greatest] = Self::SCALES;
        let scaled = Self {
            scale: scale.clamp(least, greatest),
            ..Self::REST
        };
        scaled.about(pivot)
    }

    /// Returns this motion, followed by another one. A scale that would leave [its range](Self::SCALES) stays at its
    /// end.
    pub fn then(&self, next: &Self) -> Self {
        let [x, y, z] = self.rotation;
        let column = |axis: usize| [x[axis], y[axis], z[axis]];
        let columns = [column(0), column(1), column(2)];
        let scale = i64::from(self.scale).wrapping_mul(next.scale.into());
        let scale = scale.wrapping_add(1 << (SCALE_BITS - 1)) >> SCALE_BITS;
        let [least, greatest] = Self::SCALES.map(i64::from);
        Self {
            rotation: next
                .rotation
                .map(|row| columns.map(|column| product(row, column))),
            scale: scale.clamp(least, greatest) as i32,
            offset: next.apply(self.offset),
        }
    }

    /// Returns a place, moved; a place out of the range of coordinates is moved to its end.
    pub fn position(&self, place: Position) -> Position {
        let coordinate = |fine: i64| {
            let steps = fine.wrapping_add(1 << (OFFSET_BITS - 1)) >> OFFSET_BITS;
            steps.clamp(i32::MIN.into(), i32::MAX.into()) as i32
        };
        Position(self.apply(place.0.map(fine)).map(coordinate))
    }

    /// Returns a direction, turned. It keeps its length, or has half of it if a component would leave its range.
    pub fn direction(&self, direction: [i32; 3]) -> [i32; 3] {
        let turned = self
            .rotation
            .map(|row| dot(direction, row).wrapping_add(1 << 29) >> 30);
        let halve = turned.iter().any(|&it| i64::from(it as i32) != it);
        turned.map(|it| (it >> u32::from(halve)) as i32)
    }

    /// Returns this rotation and scale about a place, which stays where it is.
    fn about(self, pivot: Position) -> Self {
        let pivot = pivot.0.map(fine);
        let moved = self.apply(pivot);
        let offset = |axis: usize| pivot[axis].wrapping_sub(moved[axis]);
        Self {
            offset: [offset(0), offset(1), offset(2)],
            ..self
        }
    }

    /// A place with [`OFFSET_BITS`], moved. Far away it is moved to the end of its range.
    fn apply(&self, place: [i64; 3]) -> [i64; 3] {
        let moved = |axis: usize| {
            let [a, b, c] = self.rotation[axis];
            let [x, y, z] = place;
            let turned = times(x, a, 30)
                .wrapping_add(times(y, b, 30))
                .wrapping_add(times(z, c, 30));
            let scaled = if self.scale == Self::REST.scale {
                turned
            } else {
                times(turned, self.scale, SCALE_BITS)
            };
            let far = scaled.wrapping_add(self.offset[axis]);
            far.clamp(-LARGEST_OFFSET, LARGEST_OFFSET)
        };
        [moved(0), moved(1), moved(2)]
    }

    /// Returns an instance, moved; its numbers can be out of their range.
    pub(in crate::scene) fn place(&self, header: &Header, rest: &Instance) -> Instance {
        let (matrix, exponent) = self.matrix(&rest.matrix);
        let shift = header.coordinate_shift.min(MAX_COORDINATE_SHIFT);
        let up = (OFFSET_BITS as i32).wrapping_sub(shift.into());
        let [x, y, z] = rest.center;
        let [origin_x, origin_y, origin_z] = header.lattice_origin();
        let place = |center: i32, origin: i64| {
            let q13 = (i64::from(center) << 5).saturating_add(origin);
            shifted(q13, up)
        };
        let [x, y, z] = self.apply([place(x, origin_x), place(y, origin_y), place(z, origin_z)]);
        let center = |place: i64, origin: i64| {
            let q13 = shifted(place, up.wrapping_neg()).saturating_sub(origin);
            (q13.saturating_add(16) >> 5).clamp(i32::MIN.into(), i32::MAX.into()) as i32
        };
        Instance {
            matrix,
            center: [
                center(x, origin_x),
                center(y, origin_y),
                center(z, origin_z),
            ],
            exponent: rest.exponent.wrapping_add(exponent),
            ..*rest
        }
    }

    /// Like [`place`](Self::place), with the matrix kept in its range, which rounding can leave.
    ///
    /// The rounding of compositions adds up, and in chains of some twenty it leaves the range. Rounded rows of the
    /// instance can also be longer than 1, which shows after a turn along an axis.
    #[cold]
    #[inline(never)]
    pub(in crate::scene) fn place_rounded(&self, header: &Header, rest: &Instance) -> Instance {
        let placed = self.without_drift().place(header, rest);
        let one = 1 << MATRIX_BITS;
        Instance {
            matrix: placed
                .matrix
                .map(|row| row.map(|entry| entry.clamp(-one, one))),
            ..placed
        }
    }

    /// Returns this motion with the rotation nearest to its matrix: one step of Newton's method, which leaves the
    /// square of an error.
    fn without_drift(&self) -> Self {
        let rows = self.rotation;
        let [x, y, z] = rows;
        let columns = [0, 1, 2].map(|axis: usize| [x[axis], y[axis], z[axis]]);
        // The difference of 1 and the matrix times its transpose, halved. The rotation's error is far below 2^-14.
        let lack = |i: usize, j: usize| {
            let one = i64::from(i == j) << 60;
            (one.wrapping_sub(dot(rows[i], rows[j])) >> 31) as i32
        };
        let row = |i: usize| {
            let lacks = [lack(i, 0), lack(i, 1), lack(i, 2)];
            let [a, b, c] = columns.map(|column| product(column, lacks));
            let [x, y, z] = rows[i];
            [x.wrapping_add(a), y.wrapping_add(b), z.wrapping_add(c)]
        };
        Self {
            rotation: [row(0), row(1), row(2)],
            ..*self
        }
    }

    /// Returns the matrix from the scene to a part, after the inverse of this rotation and scale, and its power of two.
    fn matrix(&self, rest: &[[i32; 3]; 3]) -> ([[i32; 3]; 3], i16) {
        // 53 fraction bits, rounded once: an error would be doubled with the matrix.
        let turned = rest.map(|row| self.rotation.map(|turned| dot(row, turned)));
        let rounded = |entry: i64| (entry.wrapping_add(1 << 29) >> 30) as i32;
        if self.scale == Self::REST.scale {
            return (turned.map(|row| row.map(rounded)), 0);
        }
        // 1/scale is 2^(up - 6) over a number from 1 to 2.
        let up = self.scale.leading_zeros().wrapping_sub(1);
        let mantissa = i64::from(self.scale).wrapping_shl(up);
        // 29 fraction bits, from 1/2 to 1.
        let inverse = (1_i64 << 59).checked_div(mantissa).unwrap_or(0);
        let [first, _, _] = turned;
        // 46 fraction bits. Below 1/4 the matrix is doubled.
        let over = |square: i64| (square >> 17).wrapping_mul(inverse) >> 12;
        let first = first.map(rounded);
        let doubled = u32::from(over(over(dot(first, first))) < 1 << (2 * MATRIX_BITS - 2));
        let down = 39_u32.wrapping_sub(doubled);
        let scaled = |entry: i64| {
            let product = (entry >> 20).wrapping_mul(inverse);
            (product.wrapping_add(1 << 38 >> doubled) >> down) as i32
        };
        let exponent = (up as i16).wrapping_sub(6).wrapping_sub(doubled as i16);
        (turned.map(|row| row.map(scaled)), exponent)
    }
}

/// The largest magnitude of a moved place: 64 times the range of coordinates, which is also the limit of what can be
/// scaled.
const LARGEST_OFFSET: i64 = 1 << 54;

/// A coordinate with [`OFFSET_BITS`].
fn fine(steps: i32) -> i64 {
    i64::from(steps) << OFFSET_BITS
}

/// The product of two vectors, the second of which has 30 fraction bits, rounded to nearest.
fn product(vector: [i32; 3], ratios: [i32; 3]) -> i32 {
    (dot(vector, ratios).wrapping_add(1 << 29) >> 30) as i32
}

/// Multiplies a number by a ratio with this many fraction bits, rounded to nearest.
fn times(number: i64, ratio: i32, fraction: u32) -> i64 {
    let high = (number >> fraction).wrapping_mul(ratio.into());
    let low = (number & ((1 << fraction) - 1)).wrapping_mul(ratio.into());
    high.wrapping_add(low.wrapping_add(1 << (fraction - 1)) >> fraction)
}

/// Multiplies a number by a power of two, rounded to nearest and limited to the range.
fn shifted(number: i64, up: i32) -> i64 {
    if up >= 0 {
        number.saturating_mul(1 << up.min(62))
    } else {
        let down = up.unsigned_abs().min(62);
        number.saturating_add(1 << (down - 1)) >> down
    }
}

#[cfg(test)]
mod tests;
