//! Nodes of hierarchies, and the shape of a grid.

use crate::format::layout::records;
use crate::format::record::UnitBox;
use bytemuck::{Pod, Zeroable};

records! {
    /// A pair of children with all their planes, for the ordinary traversal.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(32)]
    pub struct Pair {
        /// `[axis][side][child]`, in units: the lower sides of the left and the right child, then the upper ones.
        pub planes: [[[i16; 2]; 2]; 3],
        /// The left and the right child: the number of a pair, or that of a leaf with bit 31 set.
        pub children: [u32; 2],
    }

    /// A pair of children without the sides that coincide with their parent's.
    ///
    /// At least one of two children touches each side of their parent, so six of the twelve sides need not be stored.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(16)]
    pub struct FlaggedPair {
        /// `[axis]`: the inner of the two children's lower sides in the low half, the inner of their
        /// upper sides in the high half. Both halves are `i16`.
        pub planes: [u32; 3],
        /// The children, and which child owns each plane: see [`Link`](crate::format::Link).
        pub link: u32,
    }

    /// A dual-split node.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(16)]
    pub struct DualNode {
        /// On the split's axis: the second child's lower side in the low half (`i16`), the first child's upper
        /// side in the high half, in the order in which a ray up the axis enters the one and leaves the
        /// other if they overlap. Zero in a leaf.
        pub split: u32,
        /// The node's lower side in the low half and its upper side in the high half, on the axis of the first
        /// and of the second carve; zero where there is no carve.
        pub carves: [u32; 2],
        /// Axes, and the children or the leaf: see [`NodeWord`](crate::format::NodeWord).
        pub word: u32,
    }

    /// A node of the eight-wide hierarchy.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(128)]
    pub struct WideNode {
        /// `[axis][side][child]`, in units: the children's lower sides, then their upper ones. Missing children
        /// come last. Their lower sides are 32767 and their upper ones -32768, which no ray meets.
        pub planes: [[[i16; 8]; 2]; 3],
        /// The children: see [`Child`](crate::format::Child).
        pub children: [u32; 8],
    }

    /// A bounding sphere.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(8)]
    pub struct BoundingSphere {
        /// Center in units.
        pub center: [i16; 3],
        /// Radius in units.
        pub radius: u16,
    }

    /// A pair of children in bounding spheres.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(24)]
    pub struct SpherePair {
        /// The left and the right child's.
        pub spheres: [BoundingSphere; 2],
        /// The left and the right child: the number of a pair, or that of a leaf with bit 31 set.
        pub children: [u32; 2],
    }

    /// The shape of a grid.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(8)]
    pub struct GridShape {
        /// Divisions of each axis: 1 to 1024, and 1 where the scene's box has no extent.
        pub divisions: [u16; 3],
        /// Zero.
        pub spare: u16,
    }
}

impl Pair {
    /// The box of the left (0) or right (1) child.
    #[inline(always)]
    pub(crate) fn child_box(&self, child: usize) -> UnitBox {
        UnitBox(
            self.planes
                .map(|[low, high]| [low[child & 1], high[child & 1]]),
        )
    }

    /// The box around both children.
    #[inline(always)]
    pub(crate) fn bounds(&self) -> UnitBox {
        UnitBox(
            self.planes
                .map(|[low, high]| [low[0].min(low[1]), high[0].max(high[1])]),
        )
    }
}

impl WideNode {
    /// The box of a missing child. No ray hits it, because its sides are swapped by more than the margins of culling.
    pub const EMPTY: UnitBox = UnitBox([[i16::MAX, i16::MIN]; 3]);

    /// The box of a child.
    #[inline(always)]
    pub fn child_box(&self, lane: usize) -> UnitBox {
        UnitBox(
            self.planes
                .map(|[low, high]| [low[lane & 7], high[lane & 7]]),
        )
    }

    /// A child.
    #[inline(always)]
    pub fn child(&self, lane: usize) -> crate::format::Child {
        crate::format::Child(self.children[lane & 7])
    }
}

impl GridShape {
    /// The divisions as numbers.
    pub fn counts(&self) -> [u32; 3] {
        self.divisions.map(u32::from)
    }
}

/// Two 16-bit planes as one word, in the form that pairs use.
pub const fn plane_word(planes: [i16; 2]) -> u32 {
    planes[0] as u16 as u32 | (planes[1] as u16 as u32) << 16
}
