//! The scene's shapes on a lattice.
//!
//! | file | what it holds |
//! |---|---|
//! | `extent.rs` | the extent of a scene: its shapes where they are placed |
//! | `support.rs` | the farthest point of many shapes in a direction |
//! | `lattice.rs` | the choice of the lattice |
//! | `primitives.rs` | shapes as primitives on the lattice, and what it leaves out |
//! | `records.rs` | the records of all shapes |
//! | `vertices.rs` | the distinct vertices of meshes, with their attributes |
//! | `cuts.rs` | cuts that keep closed meshes closed where triangles collapse |
//! | `flattened.rs` | closed meshes that have no inside on the lattice |

mod cuts;
pub mod extent;
mod flattened;
pub mod lattice;
pub mod primitives;
pub mod records;
mod support;
pub mod vertices;
