//! Errors of invalid blobs. Each says what to do.

use crate::format::section::SectionKind;
use crate::format::{Effects, Field, Reason, Structure};
use core::fmt;

/// The reason for which [`Scene::from_bytes`](crate::scene::Scene::from_bytes) rejects a blob.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
// A plain tag, because a tag that shares a word with a field costs boards two to six percent of
// their code.
#[repr(u32)]
pub enum BlobError {
    /// The slice does not start at a multiple of 4 bytes.
    Misaligned,
    /// The blob is shorter or longer than its header states.
    Truncated {
        /// Bytes that the blob needs.
        needed: usize,
        /// Bytes of the slice.
        found: usize,
    },
    /// The first bytes are not a blob's.
    Magic,
    /// Blob and machine differ in byte order.
    Endianness {
        /// The word that shows the byte order.
        found: u32,
    },
    /// The blob was written in another version of the format.
    Version {
        /// The blob's version.
        found: u16,
    },
    /// The bytes were changed since the blob was written.
    Checksum {
        /// The checksum of the bytes.
        found: u32,
        /// The checksum in the header.
        expected: u32,
    },
    /// The scene requires effects that this build was compiled without.
    MissingEffects {
        /// The effects.
        missing: Effects,
    },
    /// The scene holds primitives of a kind, primitives in a stored form, or colors that this build
    /// was compiled without.
    MissingPart {
        /// The Cargo feature that is missing.
        missing: &'static str,
    },
    /// The blob holds a structure without another one that it needs.
    MissingStructure {
        /// The missing structure.
        missing: Structure,
        /// The structure that needs it.
        needed_by: Structure,
    },
    /// The blob has other parts than those that it was loaded with.
    Parts {
        /// Parts that were given.
        found: usize,
        /// Parts that the blob has.
        expected: usize,
    },
    /// The program's own memory has room for fewer records than the blob has, or passes more of them.
    Memory {
        /// The section whose records the memory is for.
        section: SectionKind,
        /// Records that the program passed.
        found: usize,
        /// Records of the blob.
        needed: usize,
    },
    /// There is no instance of this number.
    NoInstance {
        /// The number.
        number: usize,
        /// Instances of the scene, counted from 0.
        count: usize,
    },
    /// The records of a section have a size that no record of its kind has.
    Stride {
        /// The section.
        section: SectionKind,
        /// Bytes per record.
        found: usize,
        /// Bytes that a record has (the largest where there are several forms).
        expected: usize,
    },
    /// A section has more records than the format, or another section, allows.
    TooMany {
        /// The section.
        section: SectionKind,
        /// Records that there are.
        found: usize,
        /// The most records.
        most: usize,
    },
    /// A section has too few or too many records.
    Count {
        /// The section.
        section: SectionKind,
        /// Records in the section.
        found: usize,
        /// Records that are required.
        expected: usize,
    },
    /// A number is out of its range.
    OutOfRange {
        /// The location of the number.
        location: Location,
        /// The field.
        field: Field,
        /// The number.
        found: i64,
        /// The least and the greatest valid number.
        range: [i64; 2],
    },
    /// A part of the blob is invalid.
    Invalid {
        /// The part.
        location: Location,
        /// The reason.
        reason: Reason,
    },
}

/// A part of a blob.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u32)]
pub enum Location {
    /// The header.
    Header,
    /// A line of the section table, counted from 0.
    Table(usize),
    /// A section as a whole.
    Section(SectionKind),
    /// A record of a section, counted from 0.
    Record(SectionKind, usize),
}

impl Location {
    /// The error for a number that is out of its range.
    #[inline(always)]
    pub(crate) const fn out_of_range(self, field: Field, found: i64, range: [i64; 2]) -> BlobError {
        BlobError::OutOfRange {
            location: self,
            field,
            found,
            range,
        }
    }

    /// The error for an invalid part.
    #[inline(always)]
    pub(crate) const fn invalid(self, reason: Reason) -> BlobError {
        BlobError::Invalid {
            location: self,
            reason,
        }
    }
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Location::Header => f.write_str("header"),
            Location::Table(index) => write!(f, "line {index} of the section table"),
            Location::Section(section) => write!(f, "section {}", section.name()),
            Location::Record(section, index) => match section.record_name() {
                ("", _) => Location::Section(section).fmt(f),
                (record, "") => write!(f, "{record} {index}"),
                (record, owner) => write!(f, "{record} {index} of {owner}"),
            },
        }
    }
}

impl fmt::Display for BlobError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            BlobError::Misaligned => write!(
                f,
                "the blob does not start at a multiple of 4 bytes: embed it with include_blob!, or \
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
                "the scene requires the effects {missing}, which this build was compiled without: \
                 enable the Cargo features of the same names in gridel-core"
            ),
            BlobError::MissingPart { missing } => write!(
                f,
                "the scene requires `{missing}`, which this build was compiled without: \
                 enable the Cargo feature of the same name in gridel-core"
            ),
            BlobError::MissingStructure { missing, needed_by } => write!(
                f,
                "the blob holds the structure {} without {}, to which it leads: build it again with \
                 `gridel build`",
                needed_by.name(),
                missing.name()
            ),
            BlobError::Parts { found, expected } => write!(
                f,
                "the blob was loaded with {found} parts, and needs {expected}: load them by \
                 `Parts::load`, and the scene by `Scene::with_parts`"
            ),
            BlobError::Memory {
                section,
                found,
                needed,
            } => write!(
                f,
                "the program passed {found} records for section {} of the blob, which has {needed}",
                section.name()
            ),
            BlobError::NoInstance { number, count } => write!(
                f,
                "there is no instance {number}: the scene has {count}, counted from 0"
            ),
            BlobError::Stride {
                section,
                found,
                expected,
            } => write!(
                f,
                "section {}: a record has {found} bytes; it must have {expected}",
                section.name()
            ),
            BlobError::TooMany {
                section,
                found,
                most,
            } => write!(
                f,
                "section {}: it has {found} records; it can have at most {most}",
                section.name()
            ),
            BlobError::Count {
                section,
                found,
                expected,
            } => write!(
                f,
                "section {}: it has {found} records; it must have {expected}",
                section.name()
            ),
            BlobError::OutOfRange {
                location,
                field,
                found,
                range: [low, high],
            } => {
                write!(f, "{location}: its {field} is {found}; it must be ")?;
                if low == high {
                    write!(f, "{low}")
                } else {
                    write!(f, "from {low} to {high}")
                }
            }
            BlobError::Invalid { location, reason } => write!(f, "{location}: {reason}"),
        }
    }
}

impl core::error::Error for BlobError {}
