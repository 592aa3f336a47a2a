//! Where bytes and work go, as data and as tables and pictures for people.

pub mod chart;
mod heat_map;
mod ledger;
mod memory;
pub mod programs;
mod table;

pub use heat_map::HeatMap;
pub use ledger::{Account, Fit, Item, Ledger, NotMeasured, Sizes, Target};
pub use memory::{MemoryMap, Part, WorkingMemory, working_memory, working_memory_at};
pub use table::{Align, Table, counted, grouped, power_of_two, significant};
