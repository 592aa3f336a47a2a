//! Gridels: the rectangles of the partitioned scene box, and the two of them between which a ray passes (the paper,
//! section 3.1).
//!
//! A pair of gridels of *different* faces is a cell of a table with 15 n^4 cells. The paper counts 3 n^4, which are the
//! pairs of *opposite* faces. A ray that leaves by one of the four other faces has no list there. No ray enters and
//! leaves by one face, because the partitioned box is the scene's box widened by [`Gridels::MARGIN`]. So a ray in a
//! side of the scene's box is a ray inside, and a flat scene has gridels of some height. Corners and edges need no
//! special case.
//!
//! **No candidate is lost.** Let a primitive be hit at `t`. Hits lie in the culling interval of the primitive's box
//! (see [`cull`](crate::accel::cull)). So the ray's point at `t` lies in that box widened by 17 units. On an axis with
//! a slope of at least 2^-12, 1/4 unit and at most six steps of half a unit suffice. An axis with a smaller slope adds
//! 16 units. That point lies at least 47 units inside the partitioned box. So the line passes through the box. It
//! enters and leaves by different faces, at least 47 units away from the point.
//!
//! [`Gridels::passage`] computes with the line in integers, which is off by less than 2^-11 unit. A line can enter by a
//! face that is not across its major axis. It then comes from outside of the face and goes 47 units deep. So its slope
//! there is at least 2^-11, and the place of entry is off by less than one unit. If the line reaches two faces nearly
//! together, the wrong one can be chosen. The line then passes the plane of that face less than two units beyond the
//! face's edge.
//!
//! So the line passes the plane of each chosen face within [`Gridels::REACH`] of the chosen gridel. The point at `t`
//! lies in the convex hull of the two gridels, each widened by that. A list that holds all primitives whose boxes,
//! widened by [`Gridels::SPARE`], intersect that hull is complete, in every number format.

use crate::accel::candidates::line::{BoxCrossing, Line};
use crate::accel::number::Number;
use crate::axis::pick;
use crate::format::record::{Gridels, UnitBox};
use crate::ray::Ray;

impl Gridels {
    /// Units by which the partitioned box is larger than the scene's, on all sides.
    pub const MARGIN: i32 = 64;
    /// Units by which gridels are widened in their plane, so that they hold every rounded place.
    pub const REACH: f64 = 4.0;
    /// Units by which boxes of primitives are widened to hold their hits.
    pub const SPARE: f64 = 18.0;
    /// Maximum number of gridels along a side.
    pub const MOST: u32 = 64;
    /// Pairs of faces.
    pub const FACE_PAIRS: u32 = 15;

    /// Returns the partition of a scene's box, `count` by `count` gridels per face.
    pub fn new(bounds: &UnitBox, count: u32) -> Self {
        let side = |end: usize, outward: i32| {
            let axis = |k: usize| (i32::from(bounds.0[k][end]) + outward) << 13;
            [axis(0), axis(1), axis(2)]
        };
        let (low, high) = (side(0, -Self::MARGIN), side(1, Self::MARGIN));
        let count = count.clamp(1, Self::MOST);
        let scale = |k: usize| {
            let width = u64::from(high[k].abs_diff(low[k])).max(1 << 20);
            ((u64::from(count) << 44) / width) as u32
        };
        Self {
            count,
            low,
            high,
            scale: [scale(0), scale(1), scale(2)],
        }
    }

    /// Cells of the table: unordered pairs of gridels of different faces.
    pub const fn pairs(count: u32) -> u64 {
        let square = count as u64 * count as u64;
        Self::FACE_PAIRS as u64 * square * square
    }

    /// Returns the first and the last place of a gridel along an axis, as lengths with 13 fraction bits. They are
    /// exactly those of the rays that are assigned to it.
    pub fn extent(&self, axis: usize, column: u32) -> [i32; 2] {
        let scale = u64::from(pick(self.scale, axis)).max(1);
        let first = |column: u32| (u64::from(column) << 44).div_ceil(scale) as i32;
        let (low, high) = (pick(self.low, axis), pick(self.high, axis));
        [column, column + 1].map(|column| low.saturating_add(first(column)).min(high))
    }

    /// Returns the two axes of a face across an axis, in the order in which its gridels are numbered.
    pub const fn across(axis: usize) -> [usize; 2] {
        [axis.wrapping_add(1) % 3, axis.wrapping_add(2) % 3]
    }

    /// The column of a place along an axis.
    #[inline(always)]
    fn column(&self, axis: usize, place: i64) -> u32 {
        let (low, high) = (
            i64::from(pick(self.low, axis)),
            i64::from(pick(self.high, axis)),
        );
        let inside = (place - low).clamp(0, high - low - 1) as u64;
        ((inside * u64::from(pick(self.scale, axis))) >> 44) as u32
    }

    /// Returns the cell of two gridels, each given by its face and its number on it. Face `2 k` is the lower
    /// one across axis `k`, `2 k + 1` the upper one; the lower face comes first.
    #[inline(always)]
    pub fn cell(&self, from: (u32, u32), to: (u32, u32)) -> u32 {
        let square = self.count * self.count;
        // The faces before this one have 5, 4, ... later ones.
        let faces = from.0 * (11 - from.0) / 2 + (to.0 - from.0 - 1);
        (faces * square + from.1) * square + to.1
    }

    /// Returns where a ray's line enters and leaves the partitioned box; `None` if it misses the box.
    ///
    /// Costs four multiplications and a division for each end that does not lie on a face across
    /// the major axis.
    #[inline(always)]
    pub fn passage<N: Number>(&self, ray: &Ray<N>) -> Option<Passage> {
        let line = Line::of(ray);
        let BoxCrossing {
            enter,
            leave,
            from,
            to,
        } = line.through(self.low, self.high)?;
        let face = |axis: usize, upper: bool| 2 * axis as u32 + u32::from(upper);
        let gridel = |axis: usize, t: i32| {
            let [a, b] = Self::across(axis);
            self.column(a, line.at(a, t)) * self.count + self.column(b, line.at(b, t))
        };
        let from = (face(from, !line.ascends(from)), gridel(from, enter));
        let to = (face(to, line.ascends(to)), gridel(to, leave));
        let backward = from.0 > to.0;
        let cell = if backward {
            self.cell(to, from)
        } else {
            self.cell(from, to)
        };
        Some(Passage {
            cell,
            backward,
            enter,
            leave,
        })
    }
}

/// The way of a ray's line between two gridels.
#[derive(Clone, Copy, Debug)]
pub struct Passage {
    /// The cell of the pair.
    pub cell: u32,
    /// True if the ray runs from the pair's second gridel to its first.
    pub backward: bool,
    /// The lengths along the major axis at which it enters and leaves, with 13 fraction bits.
    enter: i32,
    leave: i32,
}

impl Passage {
    /// The scale of the keys.
    #[inline(always)]
    pub(in crate::accel) fn levels(&self) -> Levels {
        let (enter, leave) = (self.enter >> 12, self.leave >> 12);
        let length = leave.saturating_sub(enter).max(1) as u32;
        Levels {
            enter,
            levels_per_step: (Levels::COUNT << 24) / length,
        }
    }
}

/// Sixteen equal parts of the way between two gridels, counted from the first of a pair.
///
/// A rectangle that moves evenly from one gridel to the other sweeps the hull of the two. A ray's point at a part of
/// its way lies in the rectangle at the same part. So a primitive whose box the rectangle meets from level `a` to level
/// `b` is hit between these levels.
///
/// A key holds two levels. Bits 4 to 7 are the least `a` of this and all later entries. Bits 0 to 3 are the greatest
/// `b` of this and all earlier ones. Both ascend, so a list can be walked from either end. Entries before the ray's
/// start are skipped, and the first entry with nothing but later hits ends the walk.
///
/// Rounding moves a ray's t by less than a step of half a unit, its ends by two units and its length by four. Together
/// these move a place by less than [`Levels::SLACK`] steps.
#[derive(Clone, Copy, Debug)]
pub(in crate::accel) struct Levels {
    /// The step at which the ray enters.
    enter: i32,
    /// Levels per step, with 24 fraction bits, rounded down.
    levels_per_step: u32,
}

impl Levels {
    /// Levels from one gridel to the other.
    pub(in crate::accel) const COUNT: u32 = 16;
    /// Maximum error of a place, in culling steps.
    const SLACK: i32 = 16;

    /// Returns a level that is not above that of a step.
    #[inline(always)]
    pub(in crate::accel) fn at_least(&self, step: i32) -> u32 {
        self.level(step.saturating_sub(Self::SLACK), self.levels_per_step)
    }

    /// Returns a level that is not below that of a step.
    #[inline(always)]
    pub(in crate::accel) fn at_most(&self, step: i32) -> u32 {
        self.level(step.saturating_add(Self::SLACK), self.levels_per_step + 1)
    }

    #[inline(always)]
    fn level(&self, step: i32, levels_per_step: u32) -> u32 {
        let way = step.saturating_sub(self.enter).max(0) as u64;
        ((way * u64::from(levels_per_step)) >> 24).min(u64::from(Self::COUNT) - 1) as u32
    }
}
