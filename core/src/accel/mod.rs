//! Acceleration structures: which primitives a ray might meet.
//!
//! The answer to a query is defined without them: the least `t` over the exact test of every
//! primitive, a tie going to the primitive that comes first in the scene file. A structure only
//! leaves primitives out that cannot be met, so it cannot change a bit of the answer. What makes
//! this certain, and not only likely: a primitive's `t` lies in the culling interval of the
//! primitive's own box, or is clamped to it, [`Scene::from_bytes`](crate::Scene::from_bytes) proves
//! that this box lies in the leaf's and every box in its parent's, and culling is monotone (see
//! `cull`). Whatever was rounded on the way, a primitive that is met lies in boxes that are met.

pub mod candidates;
pub mod cells;
pub(crate) mod clamp;
pub(crate) mod cull;
pub(crate) mod cull_axis;
#[cfg(feature = "all-structures")]
mod dynamic;
pub mod hierarchy;
mod lanes;
pub(crate) mod list;
pub(crate) mod number;
mod records;
mod registry;
mod single;
pub(crate) mod space;
pub(crate) mod stack;
pub(crate) mod traverse;
pub(crate) mod types;
pub mod wide;

#[cfg(feature = "all-structures")]
pub use dynamic::DynAccel;
pub use number::Number;
pub use registry::{Accel, StructureViews, StructureVisitor};
pub use space::Space;
pub use stack::{Entry, Stack, StackView};
pub use traverse::Traverse;
pub use types::*;
