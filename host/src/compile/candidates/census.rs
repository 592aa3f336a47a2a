//! The size of the paper's cylinder cube, and why its last scene did not fit.

use super::cylinder_cube::{Cylinders, FACES, Form, Hulls, Pair};
use super::lists::List;
use super::target::Targets;
use gridel_core::format::record::Gridels;
use rayon::prelude::*;

/// The lists of one table, counted without building any.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Census {
    /// Lists: one for each pair of gridels.
    pub lists: u64,
    /// Lists without an entry.
    pub empty: u64,
    pub entries: u64,
    pub longest: u64,
}

impl Census {
    /// Objects that a list holds on average.
    pub fn objects_per_list(&self) -> f64 {
        self.entries as f64 / self.lists.max(1) as f64
    }

    /// Returns the bytes of the entries alone, for a size of entry. The size is 2 for short
    /// numbers, 4 for numbers or pointers of the paper's time, 8 for the cells of linked lists.
    pub fn bytes(&self, entry: u64) -> u64 {
        self.entries * entry
    }

    fn with(self, other: Self) -> Self {
        Self {
            lists: self.lists + other.lists,
            empty: self.empty + other.empty,
            entries: self.entries + other.entries,
            longest: self.longest.max(other.longest),
        }
    }
}

/// The cylinder cube of a scene, counted in the paper's form and in the tight one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub struct CubeCensus {
    pub gridels: u32,
    pub objects: u64,
    /// Cylinders between opposite faces alone, 3 n^4: what the paper counts.
    pub opposite: Census,
    /// Cylinders between all different faces, 15 n^4, as every ray needs.
    pub all: Census,
    /// Counts with hulls in place of cylinders, tested against the objects themselves.
    pub tight: Census,
}

impl CubeCensus {
    pub(crate) fn of(targets: &Targets<'_>, gridels: u32) -> Self {
        let partition = Gridels::new(&targets.bounds, gridels);
        let square = u64::from(gridels) * u64::from(gridels);
        let opposite = |cell: u64| {
            let [first, second] = FACES[(cell / (square * square)) as usize];
            first / 2 == second / 2
        };
        let cylinders = Cylinders::new(targets);
        Self {
            gridels,
            objects: targets.all().len() as u64,
            opposite: count(&cylinders, &partition, opposite),
            all: count(&cylinders, &partition, |_| true),
            tight: count(&Hulls(targets), &partition, |_| true),
        }
    }
}

/// Counts the lists of chosen cells.
fn count(form: &impl Form, gridels: &Gridels, chosen: impl Fn(u64) -> bool + Sync) -> Census {
    let cells = (0..Gridels::pairs(gridels.count)).into_par_iter();
    let of_cell = |list: &mut List, cell: u64| {
        list.clear();
        form.list(&Pair::of(gridels, cell), list);
        let length = list.len() as u64;
        Census {
            lists: 1,
            empty: u64::from(length == 0),
            entries: length,
            longest: length,
        }
    };
    cells
        .filter(|&cell| chosen(cell))
        .map_init(List::new, of_cell)
        .reduce(Census::default, Census::with)
}
