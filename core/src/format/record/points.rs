//! Boxes, vertices and spheres on the lattice.

use crate::format::layout::records;
use bytemuck::{Pod, Zeroable};

records! {
    /// An axis-aligned box on the 16-bit box lattice, closed.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(transparent)]
    #[bytes(12)]
    pub struct UnitBox(
        /// `[axis][smallest, largest]`, in units.
        pub [[i16; 2]; 3]
    );

    /// A vertex on the 16-bit lattice.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Pod, Zeroable)]
    #[repr(transparent)]
    #[bytes(6)]
    pub struct Vertex16(
        /// In units.
        pub [i16; 3]
    );

    /// A vertex on the 24-bit lattice. A word each, because rays read vertices more than anything else.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Pod, Zeroable)]
    #[repr(transparent)]
    #[bytes(12)]
    pub struct Vertex24(
        /// In 1/256 unit, of 24 bits.
        pub [i32; 3]
    );

    /// A sphere on the 16-bit lattice.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(8)]
    pub struct Sphere16 {
        /// Center in units. Center plus and minus radius lie in the header's bounds.
        pub center: Vertex16,
        /// Radius in units: 1 to 65534.
        pub radius: u16,
    }

    /// A sphere on the 24-bit lattice.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(12)]
    pub struct Sphere24 {
        /// Center in 1/256 unit: three little-endian integers of three bytes, `i24`. Center plus and minus radius lie
        /// in the header's bounds.
        pub center: [[u8; 3]; 3],
        /// Radius in 1/256 unit: an unsigned integer of three bytes, `u24`, from 1 to 16776704.
        pub radius: [u8; 3],
    }
}

impl UnitBox {
    /// The box around coordinates of the storage lattice (1/256 unit), rounded outward.
    #[inline(always)]
    pub fn around(lowest: [i32; 3], highest: [i32; 3]) -> Self {
        let axis = |k: usize| {
            [
                (lowest[k] >> 8) as i16,
                (highest[k].wrapping_add(255) >> 8) as i16,
            ]
        };
        Self([axis(0), axis(1), axis(2)])
    }

    /// Returns true if `other` lies in this box, faces included.
    pub fn contains(&self, other: &Self) -> bool {
        self.0.iter().zip(&other.0).all(|(outer, inner)| {
            outer[0] <= inner[0] && inner[0] <= inner[1] && inner[1] <= outer[1]
        })
    }

    /// The smallest box around both.
    pub fn union(&self, other: &Self) -> Self {
        let axis = |k: usize| {
            [
                self.0[k][0].min(other.0[k][0]),
                self.0[k][1].max(other.0[k][1]),
            ]
        };
        Self([axis(0), axis(1), axis(2)])
    }
}
