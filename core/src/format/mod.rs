//! The format of a scene blob: sections of flat records, little-endian, read in place.
//!
//! This module says what a blob is made of, and nothing else. `FORMAT.md` beside the crate's manifest specifies
//! every byte.

#[cfg(feature = "wide")]
pub mod cluster;
mod error;
mod index;
pub(crate) mod range;
pub mod record;
mod requirements;
pub(crate) mod section;

pub use error::BlobError;
pub use index::Indices;
pub use requirements::Demand;
pub use section::SectionKind;
pub(crate) use section::Sections;
