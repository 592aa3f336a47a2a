//! The bytes that each structure takes in a blob.

use super::section::taken;
use super::structures::layout::Layout;
use gridel_core::Structure;

/// The bytes of structures in a blob, and in its parts.
#[derive(Clone, Debug, Default)]
pub struct Sizes {
    pub structures: Vec<Size>,
    /// Bytes of the leaves that hierarchies share.
    pub leaves: usize,
}

/// The bytes of a structure.
#[derive(Clone, Copy, Debug)]
pub struct Size {
    pub structure: Structure,
    /// Bytes of its own sections.
    pub bytes: usize,
    pub uses_leaves: bool,
}

impl Sizes {
    /// Returns the bytes of structures, and of leaves.
    pub fn of(layouts: &[Layout], leaves: usize) -> Self {
        let size = |layout: &Layout| {
            let sections = layout.sections.iter();
            Size {
                structure: layout.structure,
                bytes: sections.map(|section| taken(section.bytes.len())).sum(),
                uses_leaves: layout.uses_leaves,
            }
        };
        Self {
            structures: layouts.iter().map(size).collect(),
            leaves: taken(leaves),
        }
    }

    /// Adds the bytes of a part, which has the same structures.
    pub fn add(&mut self, part: &Self) {
        self.leaves += part.leaves;
        for size in &part.structures {
            let mut sizes = self.structures.iter_mut();
            match sizes.find(|it| it.structure == size.structure) {
                Some(own) => {
                    own.bytes += size.bytes;
                    own.uses_leaves |= size.uses_leaves;
                }
                None => self.structures.push(*size),
            }
        }
    }
}
