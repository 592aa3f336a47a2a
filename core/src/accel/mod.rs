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
mod list;
pub(crate) mod number;
mod records;
mod registry;
mod single;
pub(crate) mod space;
pub(crate) mod stack;
pub(crate) mod traverse;
pub mod wide;

pub use candidates::apex::Apex;
pub use candidates::cylinder_cube::CylinderCube;
pub use candidates::cylinder_cube_entry::CylinderCubeEntry;
pub use candidates::cylinder_cube_tight::CylinderCubeTight;
pub use candidates::ray_classes::RayClasses;
pub use cells::grid::Grid;
pub use cells::octree::Octree;
#[cfg(feature = "all-structures")]
pub use dynamic::DynAccel;
pub use hierarchy::bvh::Bvh;
pub use hierarchy::dual_split::DualSplit;
pub use hierarchy::flagged::Flagged;
pub use hierarchy::flagged_slabs::FlaggedSlabs;
pub use hierarchy::slabs::Slabs;
pub use hierarchy::spheres::Spheres;
pub use list::List;
pub use number::Number;
pub use registry::{Accel, StructureViews, StructureVisitor};
pub use space::Space;
pub use stack::{Entry, Stack, StackView};
pub use traverse::Traverse;
pub use wide::Wide;
