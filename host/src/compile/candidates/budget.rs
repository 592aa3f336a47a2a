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

/// A table that does not fit its budget.
#[derive(Clone, Copy, Debug)]
pub struct OverBudget {
    structure: Structure,
    /// Gridels per side, for tables of pairs of them.
    gridels: Option<u32>,
    needed: u64,
    at_least: bool,
    bytes: u64,
}

impl Budget<'_> {
    pub fn exceeded(
        &self,
        structure: Structure,
        gridels: Option<u32>,
        needed: u64,
        at_least: bool,
    ) -> OverBudget {
        OverBudget {
            structure,
            gridels,
            needed,
            at_least,
            bytes: self.bytes,
        }
    }
}

impl From<OverBudget> for CompileError {
    fn from(over: OverBudget) -> Self {
        CompileError::OverBudget {
            structure: over.structure.name(),
            size: over.gridels.map_or_else(String::new, |count| {
                format!(" with {} per side", counted(count as usize, "gridel"))
            }),
            needed: over.needed,
            at_least: if over.at_least { "at least " } else { "" },
            budget: over.bytes,
            remedy: match over.gridels {
                Some(_) => {
                    "raise `--budget`, or ask for fewer gridels with `--gridels`, or leave both out"
                }
                None => "raise `--budget`, or leave it out",
            },
        }
    }
}
