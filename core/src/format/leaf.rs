//! Leaves: ranges of primitives.

use crate::format::kind::Kind;
use core::ops::Range;

/// A range of slots, all of one kind of primitive: one word.
///
/// Bits 0 to 23 are the first slot of that kind. Bits 24 to 28 are the number of slots (1 to 31),
/// and 29 to 31 are the kind. A number of 0 slots marks a [cluster](crate::format::cluster) of the
/// kind, by its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Leaf {
    /// The kind of its primitives.
    pub kind: Kind,
    /// Its first slot among those of the kind.
    pub first: u32,
    /// Number of slots.
    pub count: u32,
}

impl Leaf {
    /// Maximum number of primitives of a leaf.
    pub const MAX_COUNT: u32 = 31;
    /// Number of slots of one kind that leaves can address.
    pub const SLOTS: u32 = 1 << 24;

    /// Its slots among those of the kind.
    #[inline(always)]
    pub(crate) const fn slots(self) -> Range<usize> {
        // Below 2^24 and 31.
        self.first as usize..self.first.wrapping_add(self.count) as usize
    }

    /// Returns the leaf as a word.
    pub const fn to_word(self) -> u32 {
        self.first | self.count << 24 | (self.kind as u32) << 29
    }

    /// Returns the leaf of a word; `None` for a kind that does not exist.
    #[inline(always)]
    pub fn from_word(word: u32) -> Option<Self> {
        let kind = Kind::from_number(word >> 29)?;
        Some(Self {
            kind,
            first: word & 0xff_ffff,
            count: word >> 24 & 31,
        })
    }
}
