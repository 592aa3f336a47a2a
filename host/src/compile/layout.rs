//! What each structure adds to a blob: the one place on the host that names them all.

use super::pairs::Flat;
use super::writer::{Section, section};
use gridel_core::Structure;
use gridel_core::blob::SectionKind;

/// What one structure adds to a blob.
#[derive(Clone, Debug)]
pub struct Layout {
    pub structure: Structure,
    /// The sections that are this structure's alone.
    pub sections: Vec<Section>,
    /// Whether it leads to the leaves that hierarchies share.
    pub uses_leaves: bool,
    /// Entries that a walk's stack must hold.
    pub stack_depth: usize,
}

/// Whether a structure is laid out over the hierarchy; the others leave primitives as they are.
pub fn takes_hierarchy(structure: Structure) -> bool {
    structure != Structure::List
}

impl Layout {
    /// Lays a structure out over the shared hierarchy.
    pub fn of(structure: Structure, flat: &Flat) -> Self {
        match structure {
            Structure::List => Self {
                structure,
                sections: Vec::new(),
                uses_leaves: false,
                stack_depth: 0,
            },
            Structure::Bvh => Self {
                structure,
                sections: vec![section(SectionKind::Pairs, &flat.pairs)],
                uses_leaves: true,
                stack_depth: flat.depth,
            },
            Structure::Flagged => Self {
                structure,
                sections: vec![section(SectionKind::FlaggedPairs, &flat.flagged)],
                uses_leaves: true,
                stack_depth: flat.depth,
            },
            Structure::DualSplit => Self {
                structure,
                sections: vec![section(SectionKind::DualNodes, &flat.dual)],
                uses_leaves: true,
                stack_depth: flat.depth,
            },
        }
    }

    /// Bytes of its own sections.
    pub fn bytes(&self) -> usize {
        self.sections
            .iter()
            .map(|section| section.bytes.len())
            .sum()
    }
}
