//! Node words: they say whether a node is a leaf, and where its children lie.

use crate::format::kind::Kind;
use crate::format::leaf::Leaf;

/// The kind and the children of a node: the last word of its record.
///
/// Bits 0 to 23 are the number of its first child, which the second follows, or that of its leaf. Bits 24 and 25 are
/// the split's axis, 26 and 27 the first carve's, 28 and 29 the second's. An axis of 3 means none, and a node without a
/// split is a leaf. Bits 30 and 31 are 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NodeWord(pub u32);

impl NodeWord {
    /// Number of distinct nodes or leaves.
    pub const NODES: u32 = 1 << 24;
    /// The axis of an absent split or carve.
    pub const NONE: u32 = 3;

    /// Returns a node's last word.
    pub const fn new(number: u32, split: u32, carves: [u32; 2]) -> Self {
        Self(number | split << 24 | carves[0] << 26 | carves[1] << 28)
    }

    /// Number of the first child or the leaf.
    #[inline(always)]
    pub const fn number(self) -> u32 {
        self.0 & 0xff_ffff
    }

    /// Returns the axis of the split, or 3 in a leaf.
    #[inline(always)]
    pub const fn split(self) -> usize {
        (self.0 >> 24 & 3) as usize
    }

    /// The axes of the split and the first carve, four times the latter.
    #[inline(always)]
    pub(crate) const fn kind(self) -> u32 {
        self.0 >> 24 & 15
    }

    /// The axis of the first carve, or 3.
    #[inline(always)]
    pub(crate) const fn first_carve(self) -> usize {
        (self.0 >> 26 & 3) as usize
    }

    /// The axis of the second carve, or 3.
    #[inline(always)]
    pub(crate) const fn second_carve(self) -> usize {
        (self.0 >> 28) as usize
    }

    /// Returns the axes of the carves, or 3.
    #[inline(always)]
    pub const fn carves(self) -> [usize; 2] {
        [(self.0 >> 26 & 3) as usize, (self.0 >> 28 & 3) as usize]
    }
}

/// A node of the tree over rays, as a word.
///
/// Bits 0 to 2 are the dimension that is halved. Dimensions 0 to 2 are a coordinate of the place. Dimensions 3 and 4
/// are the slope on the first and the second axis after the major one. Bits 3 to 31 are then the number of the first of
/// two children, the lower half. A dimension of 7 means a leaf; bits 3 to 31 are its cell, or [`ClassNode::NONE`] for
/// the hierarchy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClassNode(pub u32);

impl ClassNode {
    /// The cell of a leaf that has no list.
    pub const NONE: u32 = u32::MAX >> 3;
    /// The dimension that marks a leaf.
    const LEAF: u32 = 7;
    /// Dimensions of the space of rays.
    pub const DIMENSIONS: usize = 5;

    /// Returns a node whose children are `first` and the next one.
    pub const fn split(dimension: usize, first: u32) -> Self {
        Self(dimension as u32 | first << 3)
    }

    /// Returns a leaf with the list of a cell.
    pub const fn leaf(cell: u32) -> Self {
        Self(Self::LEAF | cell << 3)
    }

    /// The dimension that is halved; `None` for a leaf.
    #[inline(always)]
    pub(crate) const fn dimension(self) -> Option<usize> {
        match self.0 & 7 {
            Self::LEAF => None,
            dimension => Some(dimension as usize),
        }
    }

    #[inline(always)]
    pub(crate) const fn number(self) -> u32 {
        self.0 >> 3
    }
}

/// A node: one word.
///
/// An inner node is the number of the first of its eight children, which lie together. The child with bit 0 set is on
/// the upper side of x, bit 1 of y, bit 2 of z. A leaf has bit 31 set and is the number of its list, or all bits for
/// one without primitives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OctreeNode(pub u32);

impl OctreeNode {
    /// A leaf without primitives.
    pub const EMPTY: Self = Self(u32::MAX);

    /// Returns a leaf with a list.
    pub const fn leaf(list: u32) -> Self {
        Self(list | 1 << 31)
    }

    #[inline(always)]
    pub(crate) const fn is_leaf(self) -> bool {
        self.0 >> 31 != 0
    }

    #[inline(always)]
    pub(crate) const fn list(self) -> u32 {
        self.0 & 0x7fff_ffff
    }
}

/// A child of a node, in one word.
///
/// Bits 29 to 31 are 7 for a node, whose number is in bits 0 to 23. Any other word is a [`Leaf`]. A leaf of no slots is
/// the cluster of that number: a strip where its kind is triangles, a pack where it is spheres.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Child(pub u32);

impl Child {
    /// The word in the lanes behind a node's last child.
    pub const NONE: Self = Self(u32::MAX);
    /// Number of nodes that a word can address.
    pub const NODES: u32 = (1 << 24) - 1;

    /// A kind would need the same bits if there were eight.
    const NODE: u32 = (Kind::MOST as u32) << 29;

    /// Returns a node.
    pub const fn node(number: u32) -> Self {
        Self(Self::NODE | number)
    }

    /// Returns a leaf.
    pub const fn leaf(leaf: Leaf) -> Self {
        Self(leaf.to_word())
    }

    /// The node's number, if it is a node.
    #[inline(always)]
    pub(crate) const fn as_node(self) -> Option<u32> {
        if self.0 >= Self::NODE {
            Some(self.0 & 0xff_ffff)
        } else {
            None
        }
    }
}
