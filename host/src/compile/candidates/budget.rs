//! The budget of a table of lists.

use crate::compile::error::CompileError;
use crate::table::counted;
use gridel_core::Structure;

/// The limits of a table, and the callback for progress.
#[derive(Clone, Copy)]
pub struct Budget<'t> {
    /// Gridels per side, if given.
    pub gridels: Option<u32>,
    /// Most bytes of a table.
    pub bytes: u64,
    pub on_progress: OnProgress<'t>,
}

/// Called now and then, from any thread, with the number of finished cells and of all cells.
pub type OnProgress<'t> = &'t (dyn Fn(u64, u64) + Sync);

/// Most bytes of memory that a build takes besides its table, where the budget of the table is smaller.
const MOST_MEMORY: u64 = 2 << 30;

/// The bytes that exceed a limit.
#[derive(Clone, Copy, Debug)]
pub enum Needed {
    /// The bytes of the table.
    Table(u64),
    /// The bytes of a part of the table, the rest of which was not counted.
    AtLeast(u64),
    /// The bytes of memory that the build takes.
    Memory(u64),
}

/// A table that does not fit its budget, or takes too much memory to build.
#[derive(Clone, Copy, Debug)]
pub struct OverBudget {
    structure: Structure,
    /// Gridels per side, for tables of pairs of them.
    gridels: Option<u32>,
    needed: Needed,
    /// The limit that is exceeded.
    most: u64,
}

impl Budget<'_> {
    /// Returns the most bytes of memory that a build can take besides its table.
    pub fn memory(&self) -> u64 {
        self.bytes.max(MOST_MEMORY)
    }

    /// Returns the error of a table that exceeds one of the limits.
    pub fn exceeded(
        &self,
        structure: Structure,
        gridels: Option<u32>,
        needed: Needed,
    ) -> OverBudget {
        OverBudget {
            structure,
            gridels,
            needed,
            most: match needed {
                Needed::Table(_) | Needed::AtLeast(_) => self.bytes,
                Needed::Memory(_) => self.memory(),
            },
        }
    }
}

impl From<OverBudget> for CompileError {
    fn from(over: OverBudget) -> Self {
        let structure = over.structure.name();
        let size = over.gridels.map_or_else(String::new, |count| {
            format!(" with {} per side", counted(count as usize, "gridel"))
        });
        let (needed, at_least) = match over.needed {
            Needed::Table(bytes) => (bytes, ""),
            Needed::AtLeast(bytes) => (bytes, "at least "),
            Needed::Memory(needed) => {
                return CompileError::OverMemory {
                    structure,
                    size,
                    needed,
                    most: over.most,
                };
            }
        };
        CompileError::OverBudget {
            structure,
            size,
            needed,
            at_least,
            budget: over.most,
            remedy: match over.gridels {
                Some(_) => {
                    "raise `--budget`, or ask for fewer gridels with `--gridels`, or leave both out"
                }
                None => "raise `--budget`, or leave it out",
            },
        }
    }
}
