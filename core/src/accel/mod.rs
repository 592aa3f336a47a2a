//! Acceleration structures: they find the primitives that a ray can hit.
//!
//! The answer to a query is defined without them. It is the least `t` over the exact test of every
//! primitive; ties go to the primitive that comes first in the scene file. A structure only leaves
//! out primitives that the ray cannot hit, so it cannot change a bit of the answer. Three facts
//! prove this:
//!
//! - A primitive's `t` lies in the culling interval of the primitive's own box, or is clamped to
//!   it.
//! - [`Scene::from_bytes`](crate::Scene::from_bytes) proves that this box lies in the leaf's and
//!   every box in its parent's.
//! - Culling is monotone (see `cull`).
//!
//! So a primitive that is hit lies in boxes that are hit, whatever was rounded on the way.

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
pub(crate) mod scene_geometry;
mod single;
pub(crate) mod stack;
pub(crate) mod traverse;
pub(crate) mod types;
pub mod wide;

#[cfg(feature = "all-structures")]
pub use dynamic::DynAccel;
pub use number::Number;
pub use registry::{Accel, StructureViews, StructureVisitor};
pub use scene_geometry::SceneGeometry;
pub use stack::{Entry, Stack, StackView};
pub use traverse::Traverse;
pub use types::*;
