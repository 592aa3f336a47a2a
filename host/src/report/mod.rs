//! Where bytes and work go, as data and as tables and pictures for people.

pub mod chart;
mod heat_map;
mod ledger;
mod memory;
mod table;

pub use heat_map::HeatMap;
pub use ledger::{Account, Footprint, Item, Ledger, NotMeasured, Target};
pub use memory::{MemoryMap, Part, WorkingMemory, working_memory, working_memory_at};
pub use table::{Align, Table, counted, grouped, power_of_two, significant};
