//! The format of a scene blob: sections of flat records, little-endian, read in place.
//!
//! This module only defines the content of a blob. `FORMAT.md`, next to the crate's manifest, specifies every byte.

pub(crate) mod checksum;
pub mod cluster;
pub(crate) mod effects;
pub mod environment;
mod error;
mod index;
pub mod instance;
pub(crate) mod kind;
pub mod layout;
mod leaf;
pub mod lens;
pub mod light_form;
pub mod limits;
pub(crate) mod link;
mod node;
pub(crate) mod range;
mod reason;
pub mod record;
mod requirements;
pub(crate) mod section;
pub(crate) mod sections;
pub(crate) mod structure;
pub mod track;
pub mod width;
pub(crate) mod word;

pub use checksum::{Aligned, checksum};
pub use effects::Effects;
pub use error::{BlobError, Location};
pub use index::Indices;
pub use kind::Kind;
pub use leaf::Leaf;
pub use link::Link;
pub use node::Child;
pub use node::{ClassNode, NodeWord, OctreeNode};
pub use reason::{Field, Reason};
pub use requirements::Requirements;
pub use section::SectionKind;
pub(crate) use sections::Sections;
pub use structure::Structure;
