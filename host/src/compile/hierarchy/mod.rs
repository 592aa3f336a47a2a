//! Hierarchies of two children per node: builders, and how each kind of node is laid out.
//!
//! | file | what it holds |
//! |---|---|
//! | `node.rs` | primitives and nodes while a hierarchy is built |
//! | `sah.rs` | the builder by the surface area heuristic, and its costs |
//! | `builder/` | the choice of a builder, and the other builders |
//! | `pairs.rs` | the hierarchy as pairs, plain and flagged, and its leaves |
//! | `dual_split.rs` | the hierarchy as dual-split nodes |
//! | `volumes.rs` | the hierarchy with slabs and spheres in place of boxes |

pub mod builder;
pub mod dual_split;
pub mod node;
pub mod pairs;
pub mod sah;
pub mod volumes;
