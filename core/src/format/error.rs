//! Why a blob was refused, in words that say what to do.

use crate::format::section::SectionKind;
use crate::format::{Effects, Structure};
use core::fmt;

/// Why [`Scene::from_bytes`](crate::scene::Scene::from_bytes) refused a blob.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum BlobError {
    /// The slice does not start at a multiple of 16 bytes.
    Misaligned,
    /// The blob is shorter, or longer, than it says.
    Truncated {
        /// Bytes that the blob needs.
        needed: usize,
        /// Bytes that there are.
        found: usize,
    },
    /// The first bytes are not a blob's.
    Magic,
    /// Blob and machine differ in byte order.
    Endianness {
        /// The word that says so.
        found: u32,
    },
    /// The blob was written in another version of the format.
    Version {
        /// The blob's version.
        found: u16,
    },
    /// The bytes were changed since the blob was written.
    Checksum {
        /// The checksum of what there is.
        found: u32,
        /// The checksum in the header.
        expected: u32,
    },
    /// The scene calls for effects that this build was compiled without.
    MissingEffects {
        /// The effects.
        missing: Effects,
    },
    /// The scene holds primitives of a kind, or stored in a way, or colours, that this build was
    /// compiled without.
    MissingPart {
        /// The Cargo feature that is missing.
        missing: &'static str,
    },
    /// The blob holds a structure without another one that it leads to.
    MissingStructure {
        /// The structure that is not there.
        missing: Structure,
        /// The structure that leads to it.
        needed_by: Structure,
    },
    /// A field of the header is out of its range.
    Header {
        /// The field.
        field: &'static str,
        /// Its value.
        found: u64,
        /// The largest value that it can have, or the only one.
        expected: u64,
    },
    /// A line of the section table is wrong.
    Table {
        /// Which line, counted from 0.
        index: usize,
        /// Which of its fields.
        what: &'static str,
        /// The field's value.
        found: u64,
        /// The value that it must have, or must not exceed.
        expected: u64,
    },
    /// The records of a section have a size that no record of its kind has.
    Stride {
        /// The section.
        section: SectionKind,
        /// Bytes a record.
        found: usize,
        /// Bytes that a record has (the largest where there are several forms).
        expected: usize,
    },
    /// A section has too few or too many records.
    Count {
        /// The section.
        section: SectionKind,
        /// Records that there are.
        found: usize,
        /// Records that there must be.
        expected: usize,
    },
    /// A record of a section holds a value that it cannot have.
    Record {
        /// The section.
        section: SectionKind,
        /// Which record, counted from 0.
        index: usize,
        /// What is wrong with it.
        what: &'static str,
        /// The value.
        found: i64,
        /// The value that it must have, or must not exceed.
        expected: i64,
    },
}

impl fmt::Display for BlobError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            BlobError::Misaligned => write!(
                f,
                "the blob does not start at a multiple of 16 bytes: embed it with include_blob!, or \
                 copy it into aligned memory"
            ),
            BlobError::Truncated { needed, found } => write!(
                f,
                "the blob has {found} bytes and says that it needs {needed}: was it cut off, or was \
                 something added to it?"
            ),
            BlobError::Magic => write!(
                f,
                "these bytes are not a Gridel blob: it would begin with \"GRIDEL\". Compile the scene \
                 with `gridel build`"
            ),
            BlobError::Endianness { found } => write!(
                f,
                "the blob's byte order is not this machine's (the word reads {found:#010x}): blobs are \
                 little-endian and this machine must be too"
            ),
            BlobError::Version { found } => write!(
                f,
                "the blob has version {found} of the format and this build reads version {}: compile \
                 the scene again with the matching `gridel build`",
                crate::format::record::VERSION
            ),
            BlobError::Checksum { found, expected } => write!(
                f,
                "the blob's checksum is {found:#010x} and should be {expected:#010x}: its bytes were \
                 changed after it was written"
            ),
            BlobError::MissingEffects { missing } => write!(
                f,
                "the scene calls for the effects {missing}, which this build was compiled without: \
                 enable the Cargo features of the same names in gridel-core"
            ),
            BlobError::MissingPart { missing } => write!(
                f,
                "the scene calls for `{missing}`, which this build was compiled without: \
                 enable the Cargo feature of the same name in gridel-core"
            ),
            BlobError::MissingStructure { missing, needed_by } => write!(
                f,
                "the blob holds the structure {} without {}, to which it leads: build it again with \
                 `gridel build`",
                needed_by.name(),
                missing.name()
            ),
            BlobError::Header {
                field,
                found,
                expected,
            } => write!(
                f,
                "the header's {field} is {found} and must be (at most) {expected}"
            ),
            BlobError::Table {
                index,
                what,
                found,
                expected,
            } => write!(
                f,
                "line {index} of the section table: the {what} is {found} and must be (at most) \
                 {expected}"
            ),
            BlobError::Stride {
                section,
                found,
                expected,
            } => write!(
                f,
                "section {}: a record has {found} bytes and should have {expected}",
                section.name()
            ),
            BlobError::Count {
                section,
                found,
                expected,
            } => write!(
                f,
                "section {}: there are {found} records and should be {expected}",
                section.name()
            ),
            BlobError::Record {
                section,
                index,
                what,
                found,
                expected,
            } => write!(
                f,
                "section {}, record {index}: the {what} is {found} and must be (at most) {expected}",
                section.name()
            ),
        }
    }
}

impl core::error::Error for BlobError {}
