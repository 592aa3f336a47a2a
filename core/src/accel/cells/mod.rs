//! Subdivisions of space: a regular grid and an octree.
//!
//! Each cell lists the primitives that reach into it. A ray visits cells in order, tests the primitives of each, and
//! ends behind its first hit. A primitive in several cells is tested again in each of them, so large primitives cost
//! most.
//!
//! A [`grid`] suits primitives of one size that fill the scene's box evenly; an [`octree`] follows
//! their density. Both take more memory than a hierarchy and are rarely faster; loading proves that
//! every primitive is in every cell that it reaches.

pub mod grid;
pub(crate) mod lists;
pub mod octree;
