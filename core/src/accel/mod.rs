//! Acceleration structures: which primitives a ray might meet.
//!
//! The answer to a query is defined without them: the least `t` over the exact test of every
//! primitive, a tie going to the primitive that comes first in the scene file. A structure only
//! leaves primitives out that cannot be met, so it cannot change a bit of the answer. What makes
//! this certain, and not only likely: a primitive's `t` is clamped to the culling interval of the
//! primitive's own box, [`Scene::from_bytes`](crate::Scene::from_bytes) proves that this box lies
//! in the leaf's and every box in its parent's, and culling is monotone (see [`cull`]). Whatever
//! was rounded on the way, a primitive that is met lies in boxes that are met.

pub mod bvh;
pub mod cull;
pub mod flagged;
#[cfg(any(
    target_arch = "x86_64",
    target_arch = "aarch64",
    all(target_arch = "wasm32", target_feature = "simd128")
))]
mod lanes;
pub mod list;
mod pairs;

pub use bvh::Bvh;
pub use flagged::Flagged;
pub use list::List;
pub(crate) use pairs::check_pairs;

use crate::blob::Scene;
use crate::count::Count;
use crate::number::Number;
use crate::ray::Ray;
use crate::shape::Kind;
use cull::Culling;
use heapless::{Vec, VecView};

/// The name of a structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u32)]
pub enum Structure {
    /// Every primitive, one after the other.
    List,
    /// A bounding volume hierarchy of pairs, 32 bytes each, traversed in the ordinary way.
    Bvh,
    /// The same hierarchy without the sides that coincide with the parent's, 16 bytes a pair.
    Flagged,
}

impl Structure {
    /// All structures.
    pub const ALL: [Structure; 3] = [Structure::List, Structure::Bvh, Structure::Flagged];

    /// The name that command lines and tables use.
    pub const fn name(self) -> &'static str {
        match self {
            Structure::List => "list",
            Structure::Bvh => "bvh",
            Structure::Flagged => "flagged",
        }
    }

    /// The structure's bit in the header.
    pub const fn bit(self) -> u32 {
        1 << self as u32
    }
}

/// A structure, as a type: the code of those that are not named is not in the program.
pub trait Accel: Send + Sync {
    /// Its name.
    const STRUCTURE: Structure;
    /// The form in which its rays cull.
    type Cull<N: Number>: Culling<N>;

    /// Calls `leaf` for every leaf whose box the ray can meet, nearer ones first where the
    /// structure knows. `leaf` returns the t beyond which nothing counts any more, or `None` to
    /// end the walk.
    fn walk<N: Number, C: Count>(
        scene: &Scene<'_>,
        ray: &Ray<N>,
        cull: &Self::Cull<N>,
        stack: &mut StackView,
        count: &mut C,
        leaf: impl FnMut(Leaf, &mut C) -> Option<N>,
    );
}

/// A child that waits for its turn: 12 bytes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Entry {
    node: u32,
    near: i32,
    far: i32,
}

/// The traversal stack, owned by the caller: 12 bytes an entry and one word.
///
/// `DEPTH` must be at least the blob's [`stack_depth`](crate::Scene::stack_depth), which
/// [`Scene::from_bytes`](crate::Scene::from_bytes) proves. A smaller stack is never overrun:
/// queries on it have no hit, and
/// [`Renderer::check_workspace`](crate::Renderer::check_workspace) refuses it.
#[derive(Debug, Default)]
pub struct Stack<const DEPTH: usize>(Vec<Entry, DEPTH>);

/// A [`Stack`] whose depth is not part of its type.
pub type StackView = VecView<Entry>;

impl<const DEPTH: usize> Stack<DEPTH> {
    /// An empty stack.
    pub const fn new() -> Self {
        Self(Vec::new())
    }

    /// The stack as queries take it.
    pub fn as_view(&mut self) -> &mut StackView {
        &mut self.0
    }
}

/// The largest stack depth that a blob may need.
pub const MAX_STACK_DEPTH: usize = 48;

/// A range of slots, all of one kind of primitive: one word.
///
/// Bits 0 to 23 are the first slot of that kind, 24 to 28 the number of slots (1 to 31), 29 to 31
/// the kind.
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
    /// Most primitives that a leaf can hold.
    pub const MAX_COUNT: u32 = 31;
    /// Number of slots of one kind that leaves can tell apart.
    pub const SLOTS: u32 = 1 << 24;

    /// The leaf as a word.
    pub const fn to_word(self) -> u32 {
        self.first | self.count << 24 | (self.kind as u32) << 29
    }

    /// The leaf of a word; `None` for a kind that does not exist.
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

/// What the two children of a pair are: one word.
///
/// Bits 0 to 23 are the number of the first child that is a pair; if both are, the right one
/// follows the left. Bits 24 and 25 say that the left and the right child is a leaf. Bits 26 to 31
/// are the owners of a [flagged pair](crate::blob::record::FlaggedPair)'s planes.
///
/// Leaves need no number of their own, because pairs lie in breadth-first order: of the `2 j + 1`
/// nodes that were numbered before the children of pair `j`, all that are not pairs are leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Link(pub u32);

impl Link {
    /// Number of pairs that a link can tell apart.
    pub const PAIRS: u32 = 1 << 24;

    /// A link without owners.
    pub const fn new(first_pair: u32, left_is_leaf: bool, right_is_leaf: bool) -> Self {
        Self(first_pair | (left_is_leaf as u32) << 24 | (right_is_leaf as u32) << 25)
    }

    /// The same link with owners: bits 0 to 2 for the lower planes of x, y and z, bits 3 to 5 for
    /// the upper ones; a set bit means the right child.
    pub const fn with_owners(self, owners: u32) -> Self {
        Self(self.0 & 0x03ff_ffff | owners << 26)
    }

    /// Number of the first child that is a pair.
    #[inline(always)]
    pub const fn first_pair(self) -> u32 {
        self.0 & 0xff_ffff
    }

    /// The owners of the planes.
    #[inline(always)]
    pub const fn owners(self) -> u32 {
        self.0 >> 26
    }

    /// The left (0) or right (1) child of pair `pair` as a node.
    #[inline(always)]
    const fn child(self, pair: u32, side: u32) -> Node {
        // Pairs or leaves among the children before this one.
        let left_leaf = self.0 >> 24 & side;
        if self.0 & 1 << (24 + side) != 0 {
            Node::leaf((2 * pair + 1 + left_leaf).wrapping_sub(self.first_pair()))
        } else {
            Node::pair(self.first_pair() + side - left_leaf)
        }
    }
}

/// A pair or a leaf, by number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Node(u32);

impl Node {
    const fn pair(number: u32) -> Self {
        Self(number)
    }

    const fn leaf(number: u32) -> Self {
        Self(number | 1 << 31)
    }

    #[inline(always)]
    const fn is_leaf(self) -> bool {
        self.0 >> 31 != 0
    }

    #[inline(always)]
    const fn number(self) -> u32 {
        self.0 & 0x7fff_ffff
    }
}
