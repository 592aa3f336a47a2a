//! The section table: where each array of records lies.

use super::error::BlobError;
use super::record::{ALIGNMENT, Header, SectionEntry};
use core::mem::size_of;

macro_rules! kinds {
    ($($(#[doc = $doc:literal])* $kind:ident = $number:literal, $name:literal;)*) => {
        /// What a section holds. The order of the kinds is the order of the sections in a blob.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        #[repr(u16)]
        pub enum SectionKind {
            $($(#[doc = $doc])* $kind = $number,)*
        }

        impl SectionKind {
            /// All kinds, in order.
            pub const ALL: [SectionKind; [$($number),*].len()] = [$(SectionKind::$kind),*];

            /// The name that errors and memory maps use.
            pub const fn name(self) -> &'static str {
                match self {
                    $(SectionKind::$kind => $name,)*
                }
            }
        }
    };
}

kinds! {
    /// One [`View`](super::record::View).
    View = 1, "view";
    /// [`Light`](super::record::Light)s.
    Lights = 2, "lights";
    /// [`Material`](super::record::Material)s.
    Materials = 3, "materials";
    /// For each object, the number of its first primitive (2 to 4 bytes). Absent where every
    /// object is one primitive, or all primitives are one object.
    ObjectFirst = 4, "object-first";
    /// For each object, its material (1 to 4 bytes). Absent where there is one material.
    ObjectMaterial = 5, "object-material";
    /// For each slot, the primitive that lies in it, counted in scene-file order (2 to 4 bytes).
    /// Absent where slots and primitives agree.
    Order = 6, "order";
    /// [`Vertex16`](super::record::Vertex16) or [`Vertex24`](super::record::Vertex24).
    Vertices = 7, "vertices";
    /// Three vertex indices each, `u16` or `u32`.
    Triangles = 8, "triangles";
    /// [`Sphere16`](super::record::Sphere16) or [`Sphere24`](super::record::Sphere24).
    Spheres = 9, "spheres";
    /// [`Cuboid`](super::record::Cuboid)s.
    Boxes = 10, "boxes";
    /// [`Disc`](super::record::Disc)s.
    Discs = 11, "discs";
    /// [`Cone`](super::record::Cone)s: cylinders, cones and frusta.
    Cones = 12, "cones";
    /// [`Leaf`](crate::accel::Leaf)s, `u32` each.
    Leaves = 13, "leaves";
    /// [`Pair`](super::record::Pair)s of the ordinary hierarchy.
    Pairs = 14, "pairs";
    /// [`FlaggedPair`](super::record::FlaggedPair)s.
    FlaggedPairs = 15, "flagged-pairs";
    /// [`DualNode`](super::record::DualNode)s.
    DualNodes = 16, "dual-nodes";
}

impl SectionKind {
    fn from_number(number: u16) -> Option<Self> {
        Self::ALL.get(usize::from(number).checked_sub(1)?).copied()
    }
}

/// A section's place, proved to lie in the blob.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Section<'a> {
    pub(crate) bytes: &'a [u8],
    pub(crate) stride: usize,
}

/// All sections of a blob; absent ones are empty.
pub(crate) struct Sections<'a>([Section<'a>; SectionKind::ALL.len()]);

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
        let mut sections = Self([Section::default(); SectionKind::ALL.len()]);
        let mut end = size_of::<Header>() + table_bytes;
        let mut last = 0;
        for (index, entry) in entries.iter().enumerate() {
            let malformed = |what, found, expected| BlobError::Table {
                index,
                what,
                found,
                expected,
            };
            let kind = SectionKind::from_number(entry.kind).ok_or(malformed(
                "kind",
                entry.kind.into(),
                SectionKind::ALL.len() as u64,
            ))?;
            if entry.kind <= last {
                return Err(malformed(
                    "kind, which must ascend,",
                    entry.kind.into(),
                    u64::from(last) + 1,
                ));
            }
            last = entry.kind;
            if entry.spare != 0 {
                return Err(malformed("spare word", entry.spare.into(), 0));
            }
            let start = entry.offset as usize;
            let expected = end.next_multiple_of(ALIGNMENT);
            if start != expected {
                return Err(malformed("offset", entry.offset.into(), expected as u64));
            }
            let bytes = (entry.count as usize)
                .checked_mul(entry.stride.into())
                .and_then(|length| start.checked_add(length))
                .and_then(|stop| blob.get(start..stop))
                .ok_or(malformed(
                    "last byte",
                    u64::from(entry.offset) + u64::from(entry.count) * u64::from(entry.stride),
                    blob.len() as u64,
                ))?;
            end = start + bytes.len();
            if let Some(slot) = sections.0.get_mut(kind as usize - 1) {
                *slot = Section {
                    bytes,
                    stride: entry.stride.into(),
                };
            }
        }
        if end != blob.len() {
            return Err(BlobError::Truncated {
                needed: end,
                found: blob.len(),
            });
        }
        Ok(sections)
    }

    pub(crate) fn get(&self, kind: SectionKind) -> Section<'a> {
        self.0.get(kind as usize - 1).copied().unwrap_or_default()
    }

    /// Number of records of a section.
    pub(crate) fn len(&self, kind: SectionKind) -> usize {
        let section = self.get(kind);
        section.bytes.len() / section.stride.max(1)
    }

    /// The records of a section, which must have the stride of `T` unless it is empty.
    pub(crate) fn records<T: bytemuck::Pod>(
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
}
