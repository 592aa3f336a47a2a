//! Parts, and the instances that place them.
//!
//! A part is a blob of its own, with its own lattice, primitives and structures. An instance places it in the scene by
//! a map from the scene's units to the part's: a rotation and a uniform scale. A place `p` of the scene, in units, is
//! the place `2^exponent * matrix * (p - center)` of the part, in the part's units. `matrix` has 23 fraction bits and
//! `center` has 8. These integers are the geometry: every number format holds them exactly.

use crate::format::layout::records;
use crate::format::limits::INSTANCE_EXPONENT;
use bytemuck::{Pod, Zeroable};

/// Fraction bits of an instance's matrix.
pub const MATRIX_BITS: u32 = 23;

/// The largest magnitude of an instance's center, in 1/256 unit: that of the lattice's coordinates.
pub const LARGEST_CENTER: i64 = 1 << 23;

records! {
    /// A part.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(16)]
    pub struct Part {
        /// Start of its blob in the section part-blobs, in words of 16 bytes: the end of the blob before.
        pub start: u32,
        /// Length of its blob in words of 16 bytes.
        pub length: u32,
        /// The number of its first primitive. Primitives of parts come after the scene's own ones, part by part.
        pub first_primitive: u32,
        /// Zero.
        pub spare: u32,
    }

    /// A placed part.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(56)]
    pub struct Instance {
        /// A rotation times a factor from 1/2 to 1, row by row, with 23 fraction bits. The squares of the rows' lengths
        /// differ by at most 2^-19, and rows are at right angles up to that.
        #[valid(MatrixEntry: -(1 << MATRIX_BITS)..=1 << MATRIX_BITS)]
        pub matrix: [[i32; 3]; 3],
        /// The place in the scene where the middle of the part's lattice lies, in 1/256 unit.
        #[valid(Center: -LARGEST_CENTER..=LARGEST_CENTER)]
        pub center: [i32; 3],
        /// The matrix is multiplied by 2 to this power.
        #[valid(InstanceExponent: INSTANCE_EXPONENT[0]..=INSTANCE_EXPONENT[1])]
        pub exponent: i16,
        /// The part.
        pub part: u16,
        /// The instance's number in scene-file order.
        pub number: u32,
    }
}
