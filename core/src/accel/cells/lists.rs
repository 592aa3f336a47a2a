//! The scene's box divided into cells, and the cells' lists, for the grid and the octree.
//!
//! On every axis the box has equal divisions. Their planes are computed anew from their numbers, so no error
//! accumulates: `plane(i) = lowest + floor(i * pitch / 2^16)`. The pitch is the box's extent over the number of
//! divisions, in 1/2^16 unit, rounded up. Where the box is flat there is one division.

use crate::accel::candidates::lists::check_starts;
use crate::accel::scene_geometry::SceneGeometry;
use crate::format::range::At;
use crate::format::record::UnitBox;
use crate::format::{
    BlobError, Field, Indices, Kind, Leaf, Location, Reason, SectionKind, Sections,
};
use crate::geometry::Shapes;
use crate::observe::count::Observer;

/// The divisions of one axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Divisions {
    low: i32,
    high: i32,
    count: u32,
    pitch: u32,
}

impl Divisions {
    /// Maximum number of divisions of an axis.
    pub const MOST: u32 = 1 << 10;

    /// Divides an axis of a box; `count` is limited to 1 to [`MOST`](Self::MOST).
    #[inline]
    pub fn of([low, high]: [i16; 2], count: u32) -> Self {
        let (low, high) = (i32::from(low), i32::from(high));
        let extent = high.wrapping_sub(low).max(0) as u32;
        let count = count.clamp(1, Self::MOST);
        Self {
            low,
            high,
            count,
            // At most 2^16 - 2 units.
            pitch: (extent << 16).div_ceil(count),
        }
    }

    /// Number of divisions.
    #[inline(always)]
    pub fn count(&self) -> u32 {
        self.count
    }

    /// Returns the lower plane of a division, in units; beyond the last division, the upper side of the box.
    #[inline(always)]
    pub fn plane(&self, division: u32) -> i16 {
        let rise = (u64::from(division) * u64::from(self.pitch)) >> 16;
        self.low.wrapping_add(rise as i32).min(self.high) as i16
    }

    /// Returns the last division whose lower plane satisfies a condition that holds up to some division, or the first.
    #[inline(always)]
    pub(in crate::accel) fn last(&self, holds: impl Fn(i16) -> bool) -> u32 {
        let (mut low, mut high) = (0, self.count);
        while high.wrapping_sub(low) > 1 {
            let middle = low.wrapping_add(high.wrapping_sub(low) / 2);
            if holds(self.plane(middle)) {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }

    /// Returns the divisions that a closed interval meets, with its ends. The first is the last one that begins at or
    /// below the interval's lower end. The last is the last one that begins at or below its upper end.
    pub fn met_by(&self, low: i32, high: i32) -> [u32; 2] {
        [low, high].map(|end| {
            if end < self.low {
                return 0;
            }
            // `floor(i * pitch / 2^16) <= rise` where `i * pitch <= (rise + 1) * 2^16 - 1`.
            let rise = end.min(self.high).wrapping_sub(self.low) as u32;
            let most = rise.wrapping_shl(16) | 0xffff;
            let last = self.count.wrapping_sub(1);
            most.checked_div(self.pitch)
                .map_or(0, |division| division.min(last))
        })
    }
}

/// Returns the divisions of all axes.
pub fn divide(bounds: &UnitBox, counts: [u32; 3]) -> [Divisions; 3] {
    let axis = |k: usize| Divisions::of(bounds.0[k], counts[k]);
    [axis(0), axis(1), axis(2)]
}

/// Cells along each axis, the first and the last.
pub type Range = [[u32; 2]; 3];

/// Number of cells of a range.
fn volume(range: &Range) -> u64 {
    range
        .iter()
        .map(|&[first, last]| u64::from(last.wrapping_sub(first)).wrapping_add(1))
        .fold(1, u64::wrapping_mul)
}

/// Lists of slots, one after the other in one array.
#[derive(Clone, Copy, Debug)]
pub(in crate::accel) struct Lists<'a> {
    /// The start of each list, then the end of the last one.
    starts: Indices<'a>,
    /// Slots, counted over all kinds.
    slots: Indices<'a>,
}

impl<'a> Lists<'a> {
    pub(in crate::accel) fn read(
        sections: &Sections<'a>,
        [starts, slots]: [SectionKind; 2],
    ) -> Result<Self, BlobError> {
        Ok(Self {
            starts: Indices::read(sections, starts)?,
            slots: Indices::read(sections, slots)?,
        })
    }

    /// Number of lists.
    pub(in crate::accel) fn len(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    fn range(&self, list: usize) -> core::ops::Range<usize> {
        let start = self.starts.get(list).unwrap_or(0) as usize;
        let end = self.starts.get(list.wrapping_add(1)).unwrap_or(0) as usize;
        start..end
    }

    /// Number of entries of all lists.
    pub(in crate::accel) fn entries(&self) -> usize {
        self.slots.len()
    }

    /// Returns true if a list, whose slots ascend, holds a slot.
    pub(in crate::accel) fn holds(&self, list: usize, slot: u32) -> bool {
        self.slots.hold(self.range(list), slot)
    }

    /// Proves that lists follow each other without a gap and fill the array.
    pub(in crate::accel) fn check(&self, section: SectionKind) -> Result<(), BlobError> {
        check_starts(&self.starts, section, self.slots.len())
    }

    /// Proves a list: its slots exist, ascend, and hold primitives that reach into the list's cells. Returns the number
    /// of listed pairs of a cell and a primitive.
    pub(in crate::accel) fn check_list(
        &self,
        list: usize,
        cells: &Range,
        reach: &impl Fn(usize) -> Option<Range>,
        section: SectionKind,
    ) -> Result<u64, BlobError> {
        let mut pairs = 0_u64;
        let mut next = 0;
        for index in self.range(list) {
            let slot = self.slots.get(index).unwrap_or(u32::MAX);
            let at = At { section, index };
            at.ensure(slot >= next, Reason::SlotOrder)?;
            next = slot.saturating_add(1);
            let common = reach(slot as usize).map(|range| {
                [0, 1, 2].map(|k| {
                    let ([a, b], [c, d]) = (range[k], cells[k]);
                    [a.max(c), b.min(d)]
                })
            });
            let common = common.filter(|cells| cells.iter().all(|[first, last]| first <= last));
            at.ensure(common.is_some(), Reason::OutsideCell)?;
            pairs = pairs.saturating_add(common.as_ref().map_or(0, volume));
        }
        Ok(pairs)
    }
}

/// Proves that lists are complete: the number of listed pairs of a cell and a primitive is the number of pairs that
/// exist. Lists hold no pair twice and no invalid pair, so they then hold all.
pub(in crate::accel) fn check_complete(
    listed: u64,
    slots: usize,
    reach: &impl Fn(usize) -> Option<Range>,
    section: SectionKind,
) -> Result<(), BlobError> {
    let needed = (0..slots)
        .filter_map(reach)
        .fold(0_u64, |sum, range| sum.saturating_add(volume(&range)));
    if listed != needed {
        let (found, needed) = (listed as i64, [needed as i64; 2]);
        return Err(Location::Section(section).out_of_range(Field::Entries, found, needed));
    }
    Ok(())
}

/// Returns the cells that list a primitive, given its slot over all kinds. These are the cells that its box meets,
/// widened by a margin.
pub(in crate::accel) fn reach(
    geometry: &SceneGeometry<'_>,
    divisions: [Divisions; 3],
    margin: i32,
) -> impl Fn(usize) -> Option<Range> {
    let shapes = geometry.shapes;
    let ends = kind_ends(&shapes);
    move |slot| {
        let leaf = locate(&ends, slot as u32)?;
        let bounds = shapes.bounds(leaf.kind, leaf.first as usize)?;
        Some(cells_of(&divisions, &bounds, margin))
    }
}

/// Returns the cells that a box meets, widened by a margin.
pub fn cells_of(divisions: &[Divisions; 3], bounds: &UnitBox, margin: i32) -> Range {
    [0, 1, 2].map(|k: usize| {
        let [low, high] = bounds.0[k].map(i32::from);
        divisions[k].met_by(low.saturating_sub(margin), high.saturating_add(margin))
    })
}

/// Returns the end of each kind's slots, counted over all kinds.
#[inline(always)]
fn kind_ends(shapes: &Shapes<'_>) -> [u32; Kind::ALL.len()] {
    let mut ends = [0; Kind::ALL.len()];
    let mut sum = 0_u32;
    for (end, kind) in ends.iter_mut().zip(Kind::ALL) {
        sum = sum.saturating_add(shapes.count(kind) as u32);
        *end = sum;
    }
    ends
}

/// Returns one slot as a leaf of its kind.
#[inline(always)]
fn locate(ends: &[u32; Kind::ALL.len()], slot: u32) -> Option<Leaf> {
    let mut first = 0;
    for (&end, kind) in ends.iter().zip(Kind::ALL) {
        if slot < end {
            return Some(Leaf {
                kind,
                first: slot.wrapping_sub(first),
                count: 1,
            });
        }
        first = end;
    }
    None
}

/// Tests primitives of lists, and avoids repeated tests in a row of cells. A mailbox of eight places, 32 bytes,
/// remembers primitives that reach into many cells. Slots share its places by their last digits.
pub(in crate::accel) struct Tester<'a, L> {
    lists: Lists<'a>,
    ends: [u32; Kind::ALL.len()],
    mailbox: [u32; 8],
    leaf: L,
}

impl<'a, L> Tester<'a, L> {
    #[inline(always)]
    pub(in crate::accel) fn new(geometry: &SceneGeometry<'a>, lists: Lists<'a>, leaf: L) -> Self {
        Self {
            lists,
            ends: kind_ends(&geometry.shapes),
            mailbox: [u32::MAX; 8],
            leaf,
        }
    }

    /// Tests a list. Returns the t beyond which hits are ignored, if the list was not empty; `Err` to end the walk.
    #[inline(always)]
    pub(in crate::accel) fn list<N, C: Observer>(
        &mut self,
        list: usize,
        count: &mut C,
    ) -> Result<Option<N>, ()>
    where
        L: FnMut(Leaf, &mut C) -> Option<N>,
    {
        let mut tmax = None;
        for index in self.lists.range(list) {
            let slot = self.lists.slots.get(index).unwrap_or(u32::MAX);
            let place = &mut self.mailbox[(slot & 7) as usize];
            if *place == slot {
                continue;
            }
            *place = slot;
            let leaf = locate(&self.ends, slot).ok_or(())?;
            tmax = Some((self.leaf)(leaf, count).ok_or(())?);
        }
        Ok(tmax)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn divisions_fill_their_axis() {
        for (sides, count) in [
            ([-32767, 32767], 1),
            ([-32767, 32767], 1024),
            ([-5, 5], 7),
            ([3, 3], 1),
            ([-100, 900], 333),
        ] {
            let divisions = Divisions::of(sides, count);
            assert_eq!(divisions.plane(0), sides[0]);
            assert_eq!(divisions.plane(count), sides[1]);
            for division in 0..count {
                let (low, high) = (divisions.plane(division), divisions.plane(division + 1));
                assert!(low <= high && sides[0] <= low && high <= sides[1]);
                let [first, last] = divisions.met_by(low.into(), high.into());
                assert!(
                    first >= division && last > division || division + 1 == count || low == high
                );
                assert!(divisions.plane(first) <= low && divisions.plane(last + 1) >= high);
            }
        }
    }

    /// The quotient equals the result of a search of all planes.
    #[test]
    fn the_divisions_that_are_met_are_those_whose_planes_say_so() {
        for (sides, count) in [
            ([-32767, 32767], 1024),
            ([-32767, 32767], 1),
            ([-5, 5], 7),
            ([-5, 5], 64),
            ([3, 3], 1),
            ([-100, 900], 333),
            ([0, 1023], 1024),
        ] {
            let divisions = Divisions::of(sides, count);
            for end in (i32::from(sides[0]) - 3..=i32::from(sides[1]) + 3).step_by(7) {
                let searched = divisions.last(|plane| i32::from(plane) <= end);
                assert_eq!(
                    divisions.met_by(end, end),
                    [searched; 2],
                    "{sides:?} {count} {end}"
                );
            }
        }
    }

    #[test]
    fn intervals_beyond_the_axis_meet_its_ends() {
        let divisions = Divisions::of([-100, 100], 10);
        assert_eq!(divisions.met_by(-500, -400), [0, 0]);
        assert_eq!(divisions.met_by(400, 500), [9, 9]);
        assert_eq!(divisions.met_by(-20, 20), [4, 6]);
        assert_eq!(divisions.met_by(-500, 500), [0, 9]);
    }
}
