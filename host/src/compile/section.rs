//! Sections of a blob before they have places.

use gridel_core::format::SectionKind;
use gridel_core::format::layout::Stored;
use gridel_core::format::record::{SECTION_ALIGNMENT, SectionEntry};

/// A section before it has a place.
#[derive(Clone, Debug)]
pub struct Section {
    pub kind: SectionKind,
    pub stride: usize,
    pub bytes: Vec<u8>,
}

/// Returns a section of records.
pub fn section<T: bytemuck::NoUninit + Stored>(kind: SectionKind, records: &[T]) -> Section {
    Section {
        kind,
        stride: size_of::<T>(),
        bytes: bytemuck::cast_slice(records).to_vec(),
    }
}

/// Returns a section of integers, in as few bytes each as the largest needs, but at least `narrowest`.
pub fn indices(kind: SectionKind, values: &[u32], narrowest: usize) -> Section {
    let largest = values.iter().copied().max().unwrap_or(0);
    if narrowest == 1 && largest <= u8::MAX.into() {
        section(
            kind,
            &values.iter().map(|&value| value as u8).collect::<Vec<_>>(),
        )
    } else if largest <= u16::MAX.into() {
        let narrow: Vec<_> = values.iter().map(|&value| value as u16).collect();
        section(kind, &narrow)
    } else if largest < 1 << 24 {
        let narrow: Vec<_> = values.iter().map(|&value| three_bytes(value)).collect();
        section(kind, &narrow)
    } else {
        section(kind, values)
    }
}

/// Returns the low three bytes.
pub fn three_bytes(value: u32) -> [u8; 3] {
    let [low, middle, high, _] = value.to_le_bytes();
    [low, middle, high]
}

/// Returns the bytes of a blob that a section takes: its place in the table, and its records, padded to the next
/// section's alignment.
pub fn taken(bytes: usize) -> usize {
    match bytes {
        0 => 0,
        _ => size_of::<SectionEntry>() + bytes.next_multiple_of(SECTION_ALIGNMENT),
    }
}
