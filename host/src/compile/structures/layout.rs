//! The sections that one structure adds to a blob.

use crate::compile::candidates::lists::Figures;
use crate::compile::cells::Cells;
use crate::compile::hierarchy::pairs::Flat;
use crate::compile::section::{Section, section};
use gridel_core::Structure;
use gridel_core::format::SectionKind;

/// The sections that one structure adds to a blob.
#[derive(Clone, Debug)]
pub struct Layout {
    pub structure: Structure,
    /// The sections that are this structure's alone.
    pub sections: Vec<Section>,
    /// `true` if it leads to the leaves that hierarchies share.
    pub uses_leaves: bool,
    /// Entries that a walk's stack must hold.
    pub stack_depth: usize,
    /// Primitives of the longest list that it leads to.
    pub longest_list: usize,
    /// Figures of its lists of candidates, if it has any.
    pub table: Option<Figures>,
}

/// A structure with tables of candidate lists, and what they came to.
#[derive(Clone, Copy, Debug, serde::Serialize)]
pub struct TableStats {
    pub structure: &'static str,
    #[serde(flatten)]
    pub figures: Figures,
}

impl Layout {
    /// Returns a structure over the leaves that hierarchies share, as deep as their pairs.
    pub fn over_leaves(structure: Structure, sections: Vec<Section>, flat: &Flat) -> Self {
        Self {
            structure,
            sections,
            uses_leaves: true,
            stack_depth: flat.depth,
            longest_list: flat.longest_leaf,
            table: None,
        }
    }

    /// Returns the flagged hierarchy.
    pub fn flagged(flat: &Flat) -> Self {
        let pairs = section(SectionKind::FlaggedPairs, &flat.flagged);
        Self::over_leaves(Structure::Flagged, vec![pairs], flat)
    }

    /// Returns a structure with lists of primitives of its own.
    pub fn apart(structure: Structure, cells: Cells) -> Self {
        Self {
            structure,
            sections: cells.sections,
            uses_leaves: false,
            stack_depth: cells.stack_depth,
            longest_list: cells.longest_list,
            table: None,
        }
    }

    /// Returns a table of lists of candidates with these figures.
    pub fn of_table(structure: Structure, sections: Vec<Section>, figures: Figures) -> Self {
        // Candidates that are nodes lead to the hierarchy's leaves.
        let holds_nodes = structure == Structure::CylinderCubeEntry;
        Self {
            structure,
            sections,
            uses_leaves: holds_nodes,
            stack_depth: 0,
            longest_list: if holds_nodes {
                0
            } else {
                figures.longest as usize
            },
            table: Some(figures),
        }
    }

    /// Returns the figures of its lists of candidates, if it has any.
    pub fn table_stats(&self) -> Option<TableStats> {
        Some(TableStats {
            structure: self.structure.name(),
            figures: self.table?,
        })
    }
}
