//! Builders of cells: a grid and an octree, whose cells list the primitives that reach into them.
//!
//! | file | what it holds |
//! |---|---|
//! | `grid.rs` | the regular grid, and the choice of its divisions |
//! | `octree.rs` | the octree, and the box that it divides |
//! | `estimate.rs` | how many primitives rays test in cells |

pub mod estimate;
pub mod grid;
pub mod octree;

use super::hierarchy::node::Primitive;
use super::hierarchy::pairs::Flat;
use super::section::Section;
use gridel_core::Kind;
use gridel_core::format::record::UnitBox;

/// Most bytes that a grid or an octree may take while it is built, its part of the blob included.
pub const MOST_BYTES: u64 = 256 << 20;

/// A grid or an octree as a blob holds it.
#[derive(Debug, Default)]
pub struct Cells {
    pub sections: Vec<Section>,
    /// Entries that a walk's stack must hold.
    pub stack_depth: usize,
    /// Primitives of the fullest cell.
    pub longest_list: usize,
}

/// Returns the longest of the lists that begin where one's start is and end where the next one begins.
pub fn longest(starts: &[u32]) -> usize {
    let lengths = starts.windows(2).map(|pair| pair[1] - pair[0]);
    lengths.max().unwrap_or(0) as usize
}

/// Returns the boxes of the primitives that have one, in the order of their slots.
pub fn slot_boxes(flat: &Flat, boxes: &[Primitive]) -> Vec<UnitBox> {
    let mut of_kind = [const { Vec::new() }; Kind::ALL.len()];
    for primitive in boxes {
        let known: &mut Vec<UnitBox> = &mut of_kind[primitive.kind as usize];
        let place = primitive.index as usize;
        if known.len() <= place {
            known.resize(place + 1, primitive.bounds);
        }
        known[place] = primitive.bounds;
    }
    let slots = Kind::ALL.into_iter().zip(flat.slots.iter().zip(&of_kind));
    slots
        .filter(|(kind, _)| kind.is_bounded())
        .map(|(_, slots)| slots)
        .flat_map(|(slots, boxes)| slots.iter().map(|&index| boxes[index as usize]))
        .collect()
}

/// Cells along each axis, the first and the last.
pub type Range = [[u32; 2]; 3];

pub fn volume(range: &Range) -> u64 {
    range
        .iter()
        .map(|[first, last]| u64::from(last - first) + 1)
        .product()
}
