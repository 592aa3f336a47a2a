//! The records of a structure in a blob.

use crate::accel::space::Space;
use crate::format::{BlobError, SectionKind, Sections};

/// The records of a structure in a blob, and the proof that they are valid.
pub(in crate::accel) trait Records<'a>: Copy {
    /// The sections that only this structure has.
    const SECTIONS: &'static [SectionKind];
    /// True if the structure refers to the leaves that hierarchies share.
    const USES_LEAVES: bool;

    /// Finds the records.
    fn read(sections: &Sections<'a>) -> Result<Self, BlobError>;

    /// Proves all that a walk relies on, in linear time, and returns the entries that its stack
    /// needs. The rest of the scene is already proved.
    fn check(&self, space: &Space<'a>) -> Result<usize, BlobError>;
}
