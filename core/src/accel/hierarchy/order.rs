//! Breadth-first order, which guarantees that every walk through a hierarchy ends.

use crate::format::NodeWord;
use crate::format::limits::MAX_LEVELS;
use crate::format::link::Link;
use crate::format::link::Node;
use crate::format::record::{DualNode, FlaggedPair, Pair};
use crate::format::{BlobError, Field, Location, Reason, SectionKind};
use core::mem::offset_of;

// The words that lead to children are at the end of a record: see `Order::record`.
const _: () = {
    assert!(offset_of!(Pair, children) + 8 == size_of::<Pair>());
    assert!(offset_of!(FlaggedPair, link) + 4 == size_of::<FlaggedPair>());
    assert!(offset_of!(DualNode, word) + 4 == size_of::<DualNode>());
};

/// The proof that the nodes of a hierarchy lie breadth first, made node by node, with the children
/// of each. So children come after their parents, every node and every leaf is reached once, and a
/// walk visits each at most once.
///
/// The proof can be made at compile time: see [`Prevalidated`](crate::Prevalidated).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Order {
    section: SectionKind,
    /// Number of nodes.
    nodes: usize,
    /// The node whose children come next.
    index: usize,
    next_node: usize,
    next_leaf: usize,
    /// The end of the current node's level.
    level_end: usize,
    /// Levels above the current one on which nodes have two children.
    levels: usize,
    /// True if a node on the current level has two children, so far.
    branches: bool,
}

impl Order {
    /// Begins with the root of this many nodes.
    pub(crate) const fn new(section: SectionKind, nodes: usize) -> Self {
        Self {
            section,
            nodes,
            index: 0,
            next_node: 1,
            next_leaf: 0,
            level_end: 1,
            levels: 0,
            branches: false,
        }
    }

    /// The size of the records of a section whose order [`Self::record`] can prove. `None` for
    /// other sections, and for structures without code in this build.
    pub(crate) const fn record_size(section: SectionKind) -> Option<usize> {
        match section {
            SectionKind::Pairs if cfg!(feature = "bvh") => Some(size_of::<Pair>()),
            SectionKind::FlaggedPairs if cfg!(feature = "flagged") => {
                Some(size_of::<FlaggedPair>())
            }
            SectionKind::DualNodes if cfg!(feature = "dual-split") => Some(size_of::<DualNode>()),
            _ => None,
        }
    }

    /// Processes the whole current node, given the last two words of its record.
    pub(crate) const fn record(&mut self, words: [u32; 2]) -> Result<(), BlobError> {
        match (self.section, words) {
            (SectionKind::Pairs, [left, right]) => self.pair([Node(left), Node(right)]),
            (SectionKind::FlaggedPairs, [_, link]) => {
                let (link, number) = (Link(link), self.index as u32);
                self.pair([link.child(number, 0), link.child(number, 1)])
            }
            (SectionKind::DualNodes, [_, way]) => self.dual(NodeWord(way)),
            _ => Ok(()),
        }
    }

    /// Processes the current node, a pair.
    #[inline(always)]
    pub(crate) const fn pair(&mut self, [left, right]: [Node; 2]) -> Result<(), BlobError> {
        if let Err(error) = self.child(left.is_leaf(), left.number()) {
            return Err(error);
        }
        if let Err(error) = self.child(right.is_leaf(), right.number()) {
            return Err(error);
        }
        self.end(true)
    }

    /// Processes the current node, which has a split or is a leaf.
    #[inline(always)]
    pub(in crate::accel) const fn dual(&mut self, word: NodeWord) -> Result<(), BlobError> {
        let is_leaf = word.split() == NodeWord::NONE as usize;
        if let Err(error) = self.child(is_leaf, word.number()) {
            return Err(error);
        }
        if !is_leaf && let Err(error) = self.child(false, word.number().wrapping_add(1)) {
            return Err(error);
        }
        self.end(!is_leaf)
    }

    /// Processes a child of the current node, by its number among those of its sort.
    #[inline(always)]
    const fn child(&mut self, is_leaf: bool, number: u32) -> Result<(), BlobError> {
        let next = if is_leaf {
            &mut self.next_leaf
        } else {
            &mut self.next_node
        };
        let expected = *next;
        // Below twice the number of nodes.
        *next = expected.wrapping_add(1);
        if number as usize == expected {
            return Ok(());
        }
        let field = if is_leaf { Field::Leaf } else { Field::Child };
        let node = Location::Record(self.section, self.index);
        Err(node.out_of_range(field, number as i64, [expected as i64; 2]))
    }

    /// Ends a node, which has two children or is itself a leaf, and moves on to the next.
    #[inline(always)]
    const fn end(&mut self, branches: bool) -> Result<(), BlobError> {
        self.branches |= branches;
        let index = self.index;
        let next = index.wrapping_add(1);
        if self.next_node <= next && next < self.nodes {
            return Err(Location::Record(self.section, next).invalid(Reason::NotReached));
        }
        if self.next_node > self.nodes {
            return Err(Location::Record(self.section, index).invalid(Reason::BeyondLast));
        }
        if next == self.level_end {
            self.levels = self.levels.wrapping_add(self.branches as usize);
            self.branches = false;
            self.level_end = self.next_node;
        }
        self.index = next;
        Ok(())
    }

    /// The number of levels on which nodes have two children, which is the stack that a walk needs.
    pub(crate) const fn levels(self) -> Result<usize, BlobError> {
        if self.levels > MAX_LEVELS {
            let section = Location::Section(self.section);
            let range = [0, MAX_LEVELS as i64];
            return Err(section.out_of_range(Field::Levels, self.levels as i64, range));
        }
        Ok(self.levels)
    }
}
