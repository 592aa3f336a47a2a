//! Lists of candidates: one flat array holds, for each cell of a table, the primitives that a ray of that cell can hit.
//!
//! Equal lists are stored once: a cell holds the number of its list, and the lists lie one behind the other. All three
//! arrays are as narrow as their values allow. A sorted list has a *key* for every entry. The key says where along the
//! way of the ray the entry and its neighbors lie: see [`Levels`](crate::accel::candidates::gridels::Levels).

use crate::format::range::At;
use crate::format::{BlobError, Field, Indices, Location, Reason, SectionKind, Sections};
use crate::observe::count::Observer;
use crate::observe::event::{Event, NodeId};
use core::ops::Range;

/// The sections of one table of lists.
#[derive(Clone, Copy, Debug)]
pub struct ListSections {
    /// For each cell, its list.
    pub cells: SectionKind,
    /// For each list, its first entry; then the number of all entries.
    pub starts: SectionKind,
    /// The candidates of all lists.
    pub entries: SectionKind,
    /// A key for each entry.
    pub keys: Option<SectionKind>,
}

/// Counts and reports a cell whose list a ray walks.
#[inline(always)]
pub(in crate::accel) fn look_up<C: Observer>(cell: u32, count: &mut C) {
    count.cells(1);
    if C::ENABLED {
        count.event(Event::Opened(NodeId {
            what: "cell",
            number: cell,
        }));
    }
}

/// Proves that lists follow each other without a gap and fill their array of entries. `starts` holds the first entry of
/// each list, and behind the last one the number of entries.
pub(in crate::accel) fn check_starts(
    starts: &Indices<'_>,
    section: SectionKind,
    entries: usize,
) -> Result<(), BlobError> {
    let entries = entries as i64;
    let lists = starts.len().saturating_sub(1);
    let mut last = 0;
    for index in 0..=lists {
        let start = starts.get(index).unwrap_or(0).into();
        let low = if index == lists { entries } else { last };
        let high = if index == 0 { low } else { entries };
        At { section, index }.within(Field::FirstEntry, start, low, high)?;
        last = start;
    }
    Ok(())
}

/// The lists of one table.
#[derive(Clone, Copy, Debug)]
pub(in crate::accel) struct Candidates<'a> {
    cells: Indices<'a>,
    starts: Indices<'a>,
    entries: Indices<'a>,
    keys: &'a [u8],
}

impl<'a> Candidates<'a> {
    pub(in crate::accel) fn read(
        sections: &Sections<'a>,
        kinds: &ListSections,
    ) -> Result<Self, BlobError> {
        Ok(Self {
            cells: Indices::read(sections, kinds.cells)?,
            starts: Indices::read(sections, kinds.starts)?,
            entries: Indices::read(sections, kinds.entries)?,
            keys: match kinds.keys {
                Some(kind) => sections.records(kind)?,
                None => &[],
            },
        })
    }

    /// Proves that every cell has a list, that every list has its entries, and that every entry lies below `end`.
    /// Proves also that every entry has a key where there are keys. Linear in all of these.
    pub(in crate::accel) fn check(
        &self,
        kinds: &ListSections,
        cells: u64,
        end: usize,
        keys_ascend: fn(u8, u8) -> bool,
    ) -> Result<(), BlobError> {
        let count = |section, found: usize, expected: usize| match found == expected {
            true => Ok(()),
            false => Err(BlobError::Count {
                section,
                found,
                expected,
            }),
        };
        count(
            kinds.cells,
            self.cells.len(),
            usize::try_from(cells).unwrap_or(usize::MAX),
        )?;
        let lists = self.starts.len().saturating_sub(1);
        for index in 0..self.cells.len() {
            let list = self.cells.get(index).unwrap_or(u32::MAX).into();
            let section = kinds.cells;
            At { section, index }.within(Field::List, list, 0, lists as i64 - 1)?;
        }
        check_starts(&self.starts, kinds.starts, self.entries.len())?;
        for index in 0..self.entries.len() {
            let entry = self.entries.get(index).unwrap_or(u32::MAX).into();
            let section = kinds.entries;
            At { section, index }.within(Field::Candidate, entry, 0, end as i64 - 1)?;
        }
        let Some(section) = kinds.keys else {
            return Ok(());
        };
        count(section, self.keys.len(), self.entries.len())?;
        for list in 0..lists {
            let range = self.range(list as u32);
            let keys = self.keys.get(range.start..range.end).unwrap_or_default();
            let wrong = keys.windows(2).position(|pair| match *pair {
                [before, after] => !keys_ascend(before, after),
                _ => false,
            });
            if let Some(place) = wrong {
                let index = range.start.wrapping_add(place).wrapping_add(1);
                return Err(Location::Record(section, index).invalid(Reason::KeyOrder));
            }
        }
        Ok(())
    }

    /// The entries of a list.
    #[inline(always)]
    fn range(&self, list: u32) -> Range<usize> {
        let start = |list: usize| self.starts.get(list).unwrap_or(0) as usize;
        let list = list as usize;
        start(list)..start(list.wrapping_add(1))
    }

    /// The entries of a cell's list, by number; none for a cell that does not exist.
    #[inline(always)]
    pub(in crate::accel) fn list(&self, cell: u32) -> Range<usize> {
        match self.cells.get(cell as usize) {
            Some(list) => self.range(list),
            None => 0..0,
        }
    }

    /// Visits the entries of a cell's list in order, as long as their keys, which ascend, lie at or below an end.
    /// `visit` returns the new end, or `None` to end the walk.
    #[inline(always)]
    pub(in crate::accel) fn ascend(
        &self,
        cell: u32,
        mut end: u8,
        mut visit: impl FnMut(u32) -> Option<u8>,
    ) {
        for index in self.list(cell) {
            if self.key(index) > end {
                return;
            }
            match self.entry(index).and_then(&mut visit) {
                Some(new_end) => end = new_end,
                None => return,
            }
        }
    }

    /// An entry by number.
    #[inline(always)]
    pub(in crate::accel) fn entry(&self, index: usize) -> Option<u32> {
        self.entries.get(index)
    }

    /// The key of an entry.
    #[inline(always)]
    pub(in crate::accel) fn key(&self, index: usize) -> u8 {
        self.keys.get(index).copied().unwrap_or(0)
    }
}
