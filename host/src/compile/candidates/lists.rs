//! Builds the lists of a table: in parallel, equal ones once, and no table beyond a budget.
//!
//! Every list is computed twice. The first pass keeps a fingerprint of each list, which shows how many differ and how
//! many bytes they take. Only if these fit the budget is the table allocated, at its exact size. Then the lists that
//! differ are computed again, straight into their places. Besides the table itself a build takes up to
//! [`BYTES_PER_CELL`], and nothing that grows with the lists' length.

use super::budget::OnProgress;
use crate::compile::section::Section;
use gridel_core::shared::ListSections;
use rayon::prelude::*;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::atomic::{AtomicU64, Ordering};

/// Lists for the cells of a table, each array as narrow as its values allow.
#[derive(Clone, Debug, Default)]
pub struct Lists {
    /// For each cell, its list.
    pub cells: Array,
    /// For each list, its first entry; then the number of all entries.
    pub starts: Array,
    pub entries: Array,
    /// A key for each entry; none for lists whose order means nothing.
    pub keys: Vec<u8>,
    pub figures: Figures,
}

impl Lists {
    /// Returns the sections, of these kinds.
    pub fn sections(self, kinds: ListSections) -> Vec<Section> {
        let array = |kind, Array { width, bytes }| Section {
            kind,
            stride: width,
            bytes,
        };
        let mut sections = vec![
            array(kinds.cells, self.cells),
            array(kinds.starts, self.starts),
            array(kinds.entries, self.entries),
        ];
        sections.extend(kinds.keys.map(|kind| Section {
            kind,
            stride: 1,
            bytes: self.keys,
        }));
        sections
    }
}

/// Figures of a finished table of lists.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Figures {
    /// Cells of the table.
    pub cells: u64,
    /// Lists that differ.
    pub lists: u64,
    /// Entries of the lists that differ.
    pub entries: u64,
    /// Entries of the lists of all cells.
    pub candidates: u64,
    /// Entries of the longest list.
    pub longest: u32,
    /// Bytes of the table.
    pub bytes: u64,
}

/// Integers of 1 to 4 bytes each, little-endian.
#[derive(Clone, Debug, Default)]
pub struct Array {
    pub width: usize,
    pub bytes: Vec<u8>,
}

impl Array {
    fn zeros(width: usize, count: usize) -> Self {
        Self {
            width,
            bytes: vec![0; width * count],
        }
    }

    fn set(&mut self, index: usize, value: u32) {
        let width = self.width;
        let place = &mut self.bytes[index * width..(index + 1) * width];
        place.copy_from_slice(&value.to_le_bytes()[..width]);
    }
}

/// Bytes of the narrowest integer that holds a value.
const fn width(largest: u64) -> usize {
    match largest {
        0..=0xff => 1,
        0x100..=0xffff => 2,
        0x1_0000..=0xff_ffff => 3,
        _ => 4,
    }
}

/// A list while it is made: candidates, and a key for each.
pub type List = Vec<(u32, u8)>;

/// A table to be built.
pub struct Plan<'p> {
    pub cells: u64,
    /// The number beyond the largest candidate.
    pub end: u32,
    /// True if entries have keys.
    pub keyed: bool,
    /// Fills the list of a cell.
    pub list: &'p (dyn Fn(u64, &mut List) + Sync),
}

/// A table that was counted and not built yet.
pub struct Counted {
    figures: Figures,
    /// Equal lists one behind the other, each by cells.
    order: Vec<Print>,
}

/// The fingerprint of a cell's list. Lists with the same fingerprint count as equal; two different ones have it with a
/// chance of 2^-128.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Print {
    hash: [u64; 2],
    cell: u32,
    length: u32,
}

/// Most bytes of memory per cell that a build takes besides the table.
pub const BYTES_PER_CELL: u64 = 72;

/// Cells that a thread takes at once.
const CHUNK: usize = 256;

impl Plan<'_> {
    /// Computes every list and counts: what the table would take.
    pub fn count(&self, on_progress: OnProgress<'_>) -> Counted {
        let done = AtomicU64::new(0);
        let mut order = vec![
            Print {
                hash: [0; 2],
                cell: 0,
                length: 0
            };
            self.cells as usize
        ];
        order
            .par_chunks_mut(CHUNK)
            .enumerate()
            .for_each(|(chunk, prints)| {
                let mut list = List::new();
                for (place, print) in prints.iter_mut().enumerate() {
                    let cell = (chunk * CHUNK + place) as u64;
                    list.clear();
                    (self.list)(cell, &mut list);
                    *print = Print {
                        hash: [1_u8, 2].map(|seed| {
                            let mut hasher = DefaultHasher::new();
                            (seed, &list).hash(&mut hasher);
                            hasher.finish()
                        }),
                        cell: cell as u32,
                        length: list.len() as u32,
                    };
                }
                let cells = prints.len() as u64;
                on_progress(done.fetch_add(cells, Ordering::Relaxed) + cells, self.cells);
            });
        let sum = |prints: &[Print]| {
            prints
                .iter()
                .map(|print| u64::from(print.length))
                .sum::<u64>()
        };
        let candidates = sum(&order);
        order.par_sort_unstable();
        let mut lists = 0;
        let mut entries = 0;
        let mut last = None;
        for print in &order {
            if last != Some(print.hash) {
                last = Some(print.hash);
                lists += 1;
                entries += u64::from(print.length);
            }
        }
        let longest = order.iter().map(|print| print.length).max().unwrap_or(0);
        let entry = width(u64::from(self.end.saturating_sub(1))) + usize::from(self.keyed);
        let bytes = self.cells * width(lists) as u64
            + (lists + 1) * width(entries) as u64
            + entries * entry as u64;
        Counted {
            figures: Figures {
                cells: self.cells,
                lists,
                entries,
                candidates,
                longest,
                bytes,
            },
            order,
        }
    }

    /// Builds a table that was counted.
    pub fn build(&self, counted: Counted) -> Lists {
        let Counted { figures, order } = counted;
        // The first cell of each list; of cells with one list the first is the first in order.
        let mut lists: Vec<Print> = Vec::with_capacity(figures.lists as usize);
        let mut group_of = vec![0_u32; order.len()];
        for &print in &order {
            if lists.last().is_none_or(|last| last.hash != print.hash) {
                lists.push(print);
            }
            group_of[print.cell as usize] = lists.len() as u32 - 1;
        }
        drop(order);
        // Lists are numbered in the order of the cells in which they appear first.
        let mut groups: Vec<u32> = (0..lists.len() as u32).collect();
        groups.sort_unstable_by_key(|&group| lists[group as usize].cell);
        let mut number_of = vec![0_u32; lists.len()];
        for (number, &group) in groups.iter().enumerate() {
            number_of[group as usize] = number as u32;
        }
        lists.sort_unstable_by_key(|print| print.cell);
        let mut cells = Array::zeros(width(figures.lists), group_of.len());
        for (cell, &group) in group_of.iter().enumerate() {
            cells.set(cell, number_of[group as usize]);
        }
        drop((group_of, groups, number_of));

        let mut starts = Array::zeros(width(figures.entries), lists.len() + 1);
        let mut start = 0;
        for (number, print) in lists.iter().enumerate() {
            starts.set(number, start);
            start += print.length;
        }
        starts.set(lists.len(), start);
        let (entries, keys) = self.fill(&lists, figures.entries as usize);
        Lists {
            cells,
            starts,
            entries,
            keys,
            figures,
        }
    }

    /// Computes lists into their places.
    fn fill(&self, lists: &[Print], count: usize) -> (Array, Vec<u8>) {
        let mut entries = Array::zeros(width(u64::from(self.end.saturating_sub(1))), count);
        let width = entries.width;
        let mut keys = vec![0_u8; if self.keyed { count } else { 0 }];
        let mut rest = (&mut entries.bytes[..], &mut keys[..]);
        let mut parts = Vec::with_capacity(lists.len().div_ceil(CHUNK));
        for lists in lists.chunks(CHUNK) {
            let length: usize = lists.iter().map(|list| list.length as usize).sum();
            let (entries, later_entries) = rest.0.split_at_mut(length * width);
            let (keys, later_keys) = rest.1.split_at_mut(if self.keyed { length } else { 0 });
            rest = (later_entries, later_keys);
            parts.push((lists, entries, keys));
        }
        parts.into_par_iter().for_each(|(lists, entries, keys)| {
            let mut list = List::new();
            let mut at = 0;
            for print in lists {
                list.clear();
                (self.list)(print.cell.into(), &mut list);
                for &(candidate, key) in &list {
                    entries[at * width..(at + 1) * width]
                        .copy_from_slice(&candidate.to_le_bytes()[..width]);
                    if self.keyed {
                        keys[at] = key;
                    }
                    at += 1;
                }
            }
        });
        (entries, keys)
    }
}

impl Counted {
    pub fn figures(&self) -> Figures {
        self.figures
    }
}
