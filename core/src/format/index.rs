//! Arrays of integers, as narrow as their values allow.

use crate::format::Sections;
use crate::format::error::BlobError;
use crate::format::section::SectionKind;

/// A read-only array of integers in one to four bytes each, or none at all.
#[derive(Clone, Copy, Debug)]
pub enum Indices<'a> {
    /// No array: the caller defines the meaning of an index.
    Absent,
    /// One byte each.
    U8(&'a [u8]),
    /// Two bytes each.
    U16(&'a [u16]),
    /// Three bytes each, little-endian.
    U24(&'a [[u8; 3]]),
    /// Four bytes each.
    U32(&'a [u32]),
}

impl<'a> Indices<'a> {
    pub(crate) fn read(sections: &Sections<'a>, kind: SectionKind) -> Result<Self, BlobError> {
        let section = sections.get(kind);
        Ok(match (section.bytes.is_empty(), section.stride) {
            (true, _) => Indices::Absent,
            (_, 1) => Indices::U8(section.bytes),
            (_, 2) => Indices::U16(sections.records(kind)?),
            (_, 3) => Indices::U24(sections.records(kind)?),
            (_, 4) => Indices::U32(sections.records(kind)?),
            (_, found) => {
                return Err(BlobError::Stride {
                    section: kind,
                    found,
                    expected: 4,
                });
            }
        })
    }

    /// Number of integers; 0 for an absent array.
    pub fn len(&self) -> usize {
        match self {
            Indices::Absent => 0,
            Indices::U8(array) => array.len(),
            Indices::U16(array) => array.len(),
            Indices::U24(array) => array.len(),
            Indices::U32(array) => array.len(),
        }
    }

    /// Returns true if there is no array.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns true if integers that ascend from one place to another hold `value`; false if there are no such places.
    pub(crate) fn hold(&self, places: core::ops::Range<usize>, value: u32) -> bool {
        fn search<T: Copy>(
            array: &[T],
            places: core::ops::Range<usize>,
            value: u32,
            read: impl Fn(T) -> u32,
        ) -> bool {
            let part = array.get(places).unwrap_or_default();
            part.binary_search_by(|&it| read(it).cmp(&value)).is_ok()
        }
        match self {
            Indices::Absent => false,
            Indices::U8(array) => search(array, places, value, u32::from),
            Indices::U16(array) => search(array, places, value, u32::from),
            Indices::U24(array) => search(array, places, value, from_three),
            Indices::U32(array) => search(array, places, value, |it| it),
        }
    }

    /// Returns the integer at `index`; `None` beyond the end and for an absent array.
    #[inline]
    pub fn get(&self, index: usize) -> Option<u32> {
        match self {
            Indices::Absent => None,
            Indices::U8(array) => array.get(index).map(|&value| value.into()),
            Indices::U16(array) => array.get(index).map(|&value| value.into()),
            Indices::U24(array) => array.get(index).copied().map(from_three),
            Indices::U32(array) => array.get(index).copied(),
        }
    }
}

#[inline]
fn from_three([low, middle, high]: [u8; 3]) -> u32 {
    u32::from_le_bytes([low, middle, high, 0])
}
