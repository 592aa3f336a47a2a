//! The names of a pair's children.

/// The two children of a pair, in one word.
///
/// Bits 0 to 23 are the number of the first child that is a pair; if both are, the right one
/// follows the left. Bits 24 and 25 are set if the left and the right child is a leaf. Bits 26 to
/// 31 are the owners of a [flagged pair](crate::format::record::FlaggedPair)'s planes.
///
/// Leaves need no number of their own, because pairs lie in breadth-first order. `2 j + 1` nodes
/// are numbered before the children of pair `j`. All of these that are not pairs are leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Link(pub u32);

impl Link {
    /// Number of pairs that a link can address.
    pub const PAIRS: u32 = 1 << 24;

    /// Returns a link without owners.
    pub const fn new(first_pair: u32, left_is_leaf: bool, right_is_leaf: bool) -> Self {
        Self(first_pair | (left_is_leaf as u32) << 24 | (right_is_leaf as u32) << 25)
    }

    /// Returns the link with owners. Bits 0 to 2 are for the lower planes of x, y and z, bits 3 to 5 for
    /// the upper ones. A set bit means the right child.
    pub const fn with_owners(self, owners: u32) -> Self {
        Self(self.0 & 0x03ff_ffff | owners << 26)
    }

    /// Number of the first child that is a pair.
    #[inline(always)]
    pub const fn first_pair(self) -> u32 {
        self.0 & 0xff_ffff
    }

    /// Returns the owners of the planes.
    #[inline(always)]
    pub const fn owners(self) -> u32 {
        self.0 >> 26
    }

    /// The left (0) or right (1) child of pair `pair` as a node.
    #[inline(always)]
    pub(crate) const fn child(self, pair: u32, side: u32) -> Node {
        // Pairs or leaves among the children before this one.
        let left_leaf = self.0 >> 24 & side;
        if self.0 >> 24 >> (side & 1) & 1 != 0 {
            let before = pair.wrapping_mul(2).wrapping_add(1).wrapping_add(left_leaf);
            Node::leaf(before.wrapping_sub(self.first_pair()))
        } else {
            Node::pair(self.first_pair().wrapping_add(side).wrapping_sub(left_leaf))
        }
    }
}

/// A pair or a leaf, by number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Node(pub(crate) u32);

impl Node {
    pub(crate) const fn pair(number: u32) -> Self {
        Self(number)
    }

    pub(crate) const fn leaf(number: u32) -> Self {
        Self(number | 1 << 31)
    }

    #[inline(always)]
    pub(crate) const fn is_leaf(self) -> bool {
        self.0 >> 31 != 0
    }

    #[inline(always)]
    pub(crate) const fn number(self) -> u32 {
        self.0 & 0x7fff_ffff
    }
}
