//! The mesh whose vertices move, and the memory that this takes.

use crate::scene::{MOVING_NORMALS, PAIRS, STACK_DEPTH, VERTICES};
use gridel_core::format::record;
use gridel_core::{Deformation, Stack};

#[cfg(feature = "wide-lattice")]
type Vertex = record::Vertex24;
#[cfg(not(feature = "wide-lattice"))]
type Vertex = record::Vertex16;

pub type Mesh = Deformation<Vertex, VERTICES, PAIRS, MOVING_NORMALS>;

pub struct Memory {
    pub stack: Stack<STACK_DEPTH>,
    pub mesh: Mesh,
}

impl Memory {
    pub const fn new() -> Self {
        Self {
            stack: Stack::new(),
            mesh: Mesh::new(),
        }
    }
}

impl Default for Memory {
    fn default() -> Self {
        Self::new()
    }
}
