//! The records of a structure in a blob.

use crate::accel::scene_geometry::SceneGeometry;
use crate::format::{BlobError, SectionKind, Sections};

/// The records of a structure in a blob, and the proof that they are valid.
pub(in crate::accel) trait Records<'a>: Copy {
    /// The sections that only this structure has.
    const SECTIONS: &'static [SectionKind];
    /// True if the structure refers to the leaves that hierarchies share.
    const USES_LEAVES: bool;

    /// Finds the records.
    fn read(sections: &Sections<'a>) -> Result<Self, BlobError>;

    /// Proves all that a walk relies on, and returns the entries that its stack needs. The rest of the scene is already
    /// proved. Takes time linear in the number of records and in the [depth](super::hierarchy) of a hierarchy.
    fn check(&self, geometry: &SceneGeometry<'a>) -> Result<usize, BlobError>;
}
