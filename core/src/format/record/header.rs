//! The header and the section table.

use crate::format::layout::records;
use crate::format::limits::{MAX_COORDINATE_SHIFT, MAX_STACK_DEPTH};
use crate::format::record::UnitBox;
use bytemuck::{Pod, Zeroable};

records! {
    /// The blob's first record: version, requirements and sizes.
    #[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
    #[repr(C, packed(4))]
    #[bytes(96)]
    pub struct Header {
        /// [`MAGIC`](crate::format::record::MAGIC): the bytes `47 52 49 44 45 4c 1a 0a`, which are "GRIDEL", end of
        /// file and line feed.
        pub magic: [u8; 8],
        /// [`ENDIANNESS`](crate::format::record::ENDIANNESS): 0x01020304, the bytes `04 03 02 01`.
        pub endianness: u32,
        /// [`VERSION`](crate::format::record::VERSION): 1.
        pub version: u16,
        /// Number of entries in the section table: at most one for each kind, because kinds ascend.
        pub section_count: u16,
        /// Length of the blob in bytes, the header included.
        pub blob_bytes: u32,
        /// [`checksum`](fn@crate::format::checksum) of the blob with this field as 0.
        pub checksum: u32,
        /// Acceleration structures that the blob holds: a bit for each [`Structure`](crate::format::Structure).
        /// Bit 0 is 1, bits without a structure are 0.
        pub structures: u32,
        /// Effects that the scene requires: see [`Effects`](crate::format::Effects). Bits without an effect are 0.
        pub effects: u32,
        /// Entries that the deepest walk pushes on the traversal stack. For pairs these are the levels of the
        /// hierarchy, at most 48. For an octree of *n* levels of inner nodes they are 7 *n* + 1, or 0 where the root
        /// is a leaf.
        #[valid(StackDepth: 0..=MAX_STACK_DEPTH as i64)]
        pub stack_depth: u16,
        /// Most primitives in a leaf: 0 to 31, 0 without leaves.
        pub longest_leaf: u16,
        /// Number of primitives that the scene file has. Those that collapse on the lattice keep their
        /// number and have no slot; triangles beside them may be cut into pieces, a slot each.
        pub primitives: u32,
        /// Number of objects.
        pub objects: u32,
        /// Bits of the lattice that the scene was snapped to. The compiler writes 10 to 24.
        #[valid(LatticeBits: 0..=24)]
        pub lattice_bits: u8,
        /// Bits of a stored coordinate: 16 if the lattice has at most 16 bits, else 24.
        pub storage_bits: u8,
        /// One unit (a step of the 16-bit box lattice) is 2 to this power scene units.
        #[valid(UnitExponent: -1000..=1000)]
        pub unit_exponent: i16,
        /// Scene coordinates of the lattice's origin, a multiple of its step. They are finite.
        pub origin: [f64; 3],
        /// The scene's box: smallest and largest unit on each axis. No side is inverted, and no lower side is -32768.
        /// The box is larger than the scene where an octree divides a thin one, and where vertices have room to move.
        pub bounds: UnitBox,
        /// Bytes of the traversal stack: 12 times `stack_depth`.
        pub stack_bytes: u32,
        /// A coordinate step (see [`Position`](crate::Position)) is a unit times 2 to the power of
        /// this less 13.
        #[valid(CoordinateShift: 0..=MAX_COORDINATE_SHIFT as i64)]
        pub coordinate_shift: u8,
        /// The origin of scene coordinates: 0 for the lattice's, 1 for the scene's.
        #[valid(CoordinateOrigin: 0..=1)]
        pub counted_from: u8,
        /// Zero.
        pub spare: [u16; 3],
    }

    /// One entry of the section table.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(16)]
    pub struct SectionEntry {
        /// A [`SectionKind`](crate::format::SectionKind), above the kind of the entry before.
        pub kind: u16,
        /// Bytes of a record, as the kind says. Loading does not test it where `count` is 0.
        pub stride: u16,
        /// Number of records.
        pub count: u32,
        /// Start of the first record, in bytes from the blob's start: exactly where the layout puts it, a
        /// multiple of [`SECTION_ALIGNMENT`](crate::format::record::SECTION_ALIGNMENT).
        pub offset: u32,
        /// Zero.
        pub spare: u32,
    }
}

/// Fraction bits of lengths in units.
pub(crate) const LENGTH_BITS: i32 = 13;

/// Returns the exponent of a coordinate step, from two fields of the header.
pub(crate) const fn exponent_of_step(unit_exponent: i16, coordinate_shift: u8) -> i32 {
    unit_exponent as i32 - LENGTH_BITS + coordinate_shift as i32
}
