//! The section table: where each array of records lies.

use crate::format::error::{BlobError, Location};
use crate::format::layout::Stored;
use crate::format::limits::INSTANCES;
use crate::format::reason::{Field, Reason};
use crate::format::record::{Header, SECTION_ALIGNMENT, SectionEntry};
use crate::format::section::SectionKind;
use core::mem::size_of;

/// A section's place, proved to lie in the blob.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Section<'a> {
    pub(crate) bytes: &'a [u8],
    pub(crate) stride: usize,
}

/// The bytes of a section; `None` if they do not lie in the blob.
fn bytes_of<'a>(blob: &'a [u8], entry: &SectionEntry) -> Option<&'a [u8]> {
    let length = (entry.count as usize).checked_mul(entry.stride.into())?;
    let start = entry.offset as usize;
    blob.get(start..start.checked_add(length)?)
}

/// The sections of a blob, looked up in its table at each use; absent ones are empty.
pub(crate) struct Sections<'a> {
    blob: &'a [u8],
    table: &'a [SectionEntry],
}

/// The kind with the largest number.
const LAST: SectionKind = SectionKind::ALL[SectionKind::ALL.len() - 1];

impl<'a> Sections<'a> {
    /// Reads the section table. Proves that kinds are known and ascend, and that sections are
    /// aligned, in order, disjoint and inside the blob.
    pub(crate) fn read(blob: &'a [u8], count: u16) -> Result<Self, BlobError> {
        let table_bytes = usize::from(count) * size_of::<SectionEntry>();
        let table = blob
            .get(size_of::<Header>()..size_of::<Header>() + table_bytes)
            .ok_or(BlobError::Truncated {
                needed: size_of::<Header>() + table_bytes,
                found: blob.len(),
            })?;
        let entries: &[SectionEntry] =
            bytemuck::try_cast_slice(table).map_err(|_| BlobError::Misaligned)?;
        let mut end = size_of::<Header>() + table_bytes;
        let mut last = 0;
        for (index, entry) in entries.iter().enumerate() {
            let line = Location::Table(index);
            let known = SectionKind::KNOWN.get(usize::from(entry.kind / 32));
            let is_known = known.is_some_and(|known| known >> (entry.kind % 32) & 1 == 1);
            if entry.kind <= last || !is_known {
                let kinds = [i64::from(last) + 1, LAST as i64];
                return Err(line.out_of_range(Field::Kind, entry.kind.into(), kinds));
            }
            last = entry.kind;
            if entry.spare != 0 {
                return Err(line.invalid(Reason::SpareNotZero));
            }
            let start = entry.offset as usize;
            let expected = end
                .checked_next_multiple_of(SECTION_ALIGNMENT)
                .unwrap_or(end);
            if start != expected {
                let range = [expected as i64; 2];
                return Err(line.out_of_range(Field::Offset, entry.offset.into(), range));
            }
            let Some(bytes) = bytes_of(blob, entry) else {
                let length = i64::from(entry.count) * i64::from(entry.stride);
                let range = [i64::from(entry.offset), blob.len() as i64];
                return Err(line.out_of_range(Field::End, range[0] + length, range));
            };
            end = start.saturating_add(bytes.len());
        }
        let placing = SectionKind::Parts as u16..=SectionKind::InstanceJoints as u16;
        if !INSTANCES && entries.iter().any(|entry| placing.contains(&entry.kind)) {
            let missing = "instances";
            return Err(BlobError::MissingPart { missing });
        }
        if end != blob.len() {
            return Err(BlobError::Truncated {
                needed: end,
                found: blob.len(),
            });
        }
        Ok(Self {
            blob,
            table: entries,
        })
    }

    /// The entry of a section, if the blob has it.
    fn entry(&self, kind: SectionKind) -> Option<&'a SectionEntry> {
        // Kinds ascend.
        let entry = self.table.iter().find(|entry| entry.kind >= kind as u16);
        entry.filter(|entry| entry.kind == kind as u16)
    }

    /// The place of a section; an empty one where the blob has none.
    pub(crate) fn get(&self, kind: SectionKind) -> Section<'a> {
        let section = self.entry(kind).and_then(|entry| {
            let bytes = bytes_of(self.blob, entry)?;
            let stride = entry.stride.into();
            Some(Section { bytes, stride })
        });
        section.unwrap_or_default()
    }

    /// Number of records of a section. No record is empty.
    pub(crate) fn len(&self, kind: SectionKind) -> usize {
        let entry = self.entry(kind).filter(|entry| entry.stride > 0);
        entry.map_or(0, |entry| entry.count as usize)
    }

    /// Returns the records of a section, which must have the stride of `T` unless the section is
    /// empty.
    pub(crate) fn records<T: bytemuck::Pod + Stored>(
        &self,
        kind: SectionKind,
    ) -> Result<&'a [T], BlobError> {
        let section = self.get(kind);
        if section.bytes.is_empty() {
            return Ok(&[]);
        }
        if section.stride != size_of::<T>() {
            return Err(BlobError::Stride {
                section: kind,
                found: section.stride,
                expected: size_of::<T>(),
            });
        }
        bytemuck::try_cast_slice(section.bytes).map_err(|_| BlobError::Misaligned)
    }

    /// Returns the words of a section whose records have this many each.
    pub(crate) fn words(&self, kind: SectionKind, width: usize) -> Result<&'a [u32], BlobError> {
        let section = self.get(kind);
        let expected = width * size_of::<u32>();
        if section.bytes.is_empty() {
            return Ok(&[]);
        }
        if section.stride != expected {
            return Err(BlobError::Stride {
                section: kind,
                found: section.stride,
                expected,
            });
        }
        bytemuck::try_cast_slice(section.bytes).map_err(|_| BlobError::Misaligned)
    }
}
