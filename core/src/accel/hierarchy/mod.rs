//! Hierarchies of two children per node.
//!
//! | structure | node | per node tested |
//! |---|---|---|
//! | [`bvh`] | both children's boxes, 32 bytes | 12 planes |
//! | [`flagged`] | the sides that differ from the parent's, 16 bytes | 6 planes |
//! | [`dual_split`] | a split and up to two carves, 16 bytes | 2 to 6 planes |
//! | [`slabs`] | planes of 3, 7 or 13 directions, 32 to 112 bytes | 4 planes per direction |
//! | [`flagged_slabs`] | the planes that differ from the parent's | 2 planes per direction |
//! | [`spheres`] | both children's bounding spheres, 24 bytes | 2 spheres |
//!
//! A walk takes logarithmic time for most scenes, and its stack needs one entry per level. Loading
//! proves that a hierarchy loses no hit. Use `dual-split` on boards; the others serve comparisons
//! (Kay and Kajiya 1986; Stuerzlinger and Tobler 1993).
//!
//! Nodes lie breadth first, which `order` proves. The walk through pairs is in `pairs` and the check of
//! all of them in `check`, once for every kind of volume.

pub mod bvh;
mod check;
pub(crate) mod direction;
pub mod dual_split;
pub mod flagged;
pub mod flagged_slabs;
pub(crate) mod order;
pub(in crate::accel) mod pairs;
pub(crate) mod reach;
#[cfg(all(feature = "bvh", feature = "triangle"))]
pub(crate) mod refit;
pub mod slabs;
pub mod spheres;
