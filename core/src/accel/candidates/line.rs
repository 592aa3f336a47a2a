//! The line of a ray in integers. With it, the cell of a table that a ray belongs to does not
//! depend on the number format.

use crate::accel::number::Number;
use crate::axis::pick;
use crate::ray::Ray;

/// A ray's line. Its parameter is a length along the major axis with 13 fraction bits.
///
/// Origins lie within 2^17 units. Rounding moves a point of the line by less than 2^-11 unit on
/// each axis. The origin adds 2^-13, the slope over 2^17 units adds 2^-13, and the product adds
/// 2^-13.
#[derive(Clone, Copy, Debug)]
pub(in crate::accel) struct Line {
    /// Lengths with 13 fraction bits.
    pub(in crate::accel) origin: [i32; 3],
    /// Ratios with 30 fraction bits; 2^30 or its negative on the major axis.
    pub(in crate::accel) slope: [i32; 3],
    pub(in crate::accel) major: usize,
}

impl Line {
    #[inline(always)]
    pub(in crate::accel) fn of<N: Number>(ray: &Ray<N>) -> Self {
        Self {
            origin: ray.origin.map(N::to_q13),
            slope: ray.slope.map(N::to_q30),
            major: ray.major,
        }
    }

    /// The coordinate on an axis at a parameter.
    #[inline(always)]
    pub(in crate::accel) fn at(&self, axis: usize, t: i32) -> i64 {
        let rise = (i64::from(pick(self.slope, axis)) * i64::from(t)) >> 30;
        i64::from(pick(self.origin, axis)) + rise
    }

    /// Returns true if the line runs up an axis.
    #[inline(always)]
    pub(in crate::accel) fn ascends(&self, axis: usize) -> bool {
        pick(self.slope, axis) > 0
    }

    /// The parameter at which the line reaches a plane across the major axis.
    #[inline(always)]
    pub(in crate::accel) fn reach(&self, plane: i32) -> i32 {
        let way = plane.saturating_sub(pick(self.origin, self.major));
        if self.ascends(self.major) {
            way
        } else {
            way.saturating_neg()
        }
    }

    /// Returns where the line enters and leaves a box, given by two corners; `None` if it misses
    /// the box.
    #[inline(always)]
    pub(in crate::accel) fn through(&self, low: [i32; 3], high: [i32; 3]) -> Option<BoxCrossing> {
        let major = self.major;
        let (first, last) = if self.ascends(major) {
            (pick(low, major), pick(high, major))
        } else {
            (pick(high, major), pick(low, major))
        };
        let (at_first, at_last) = (self.reach(first), self.reach(last));
        let length = at_last.saturating_sub(at_first);
        let mut crossing = BoxCrossing {
            enter: at_first,
            leave: at_last,
            from: major,
            to: major,
        };
        for axis in [(major + 1) % 3, (major + 2) % 3] {
            let (low, high) = (i64::from(pick(low, axis)), i64::from(pick(high, axis)));
            let (before, after) = (self.at(axis, at_first), self.at(axis, at_last));
            // The distance from the line to the box, where it would enter and leave across the
            // major axis.
            let (before, after) = if self.ascends(axis) {
                (low - before, after - high)
            } else {
                (before - high, low - after)
            };
            let slope = i64::from(pick(self.slope, axis).unsigned_abs());
            if before > 0 {
                let later = at_first.saturating_add(advance(before, slope, length)?);
                if later > crossing.enter {
                    (crossing.enter, crossing.from) = (later, axis);
                }
            }
            if after > 0 {
                let sooner = at_last.saturating_sub(advance(after, slope, length)?);
                if sooner < crossing.leave {
                    (crossing.leave, crossing.to) = (sooner, axis);
                }
            }
        }
        (crossing.enter < crossing.leave).then_some(crossing)
    }
}

/// The way of a line through a box.
#[derive(Clone, Copy, Debug)]
pub(in crate::accel) struct BoxCrossing {
    /// The parameters at which it enters and leaves.
    pub(in crate::accel) enter: i32,
    pub(in crate::accel) leave: i32,
    /// The axes across which the faces lie by which it enters and leaves.
    pub(in crate::accel) from: usize,
    pub(in crate::accel) to: usize,
}

/// Returns how far along the major axis a line moves by `aside`; `None` if that is more than
/// `most`.
#[inline(always)]
fn advance(aside: i64, slope: i64, most: i32) -> Option<i32> {
    let scaled = aside << 30;
    if scaled > slope.saturating_mul(most.into()) {
        return None;
    }
    scaled.checked_div(slope).map(|steps| steps as i32)
}
