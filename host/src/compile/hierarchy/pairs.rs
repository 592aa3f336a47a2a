//! Lays a hierarchy out as pairs in breadth-first order, plain and flagged.

use super::node::{Node, Primitive};
use gridel_core::Kind;
use gridel_core::format::record::{DualNode, FlaggedPair, Pair, UnitBox, plane_word};
use gridel_core::format::{Leaf, Link};

/// A hierarchy as a blob holds it.
#[derive(Debug, Default)]
pub struct Flat {
    pub pairs: Vec<Pair>,
    pub flagged: Vec<FlaggedPair>,
    /// The hierarchy as dual-split nodes, if it was laid out as such.
    pub dual: Vec<DualNode>,
    pub leaves: Vec<u32>,
    /// The primitives in the order of their slots, kind by kind.
    pub slots: [Vec<u32>; Kind::ALL.len()],
    /// Levels of pairs. The stack of a walk must hold as many entries.
    pub depth: usize,
    /// Primitives of the longest leaf.
    pub longest_leaf: usize,
}

/// Flattens a hierarchy over `primitives` in the order of its leaves.
pub fn flatten(root: &Node, primitives: &[Primitive]) -> Flat {
    let mut flat = Flat::default();
    // Nodes by level; leaves take their slots in the order in which they are reached.
    let mut level = vec![root];
    let mut pairs_before = 0;
    while !level.is_empty() {
        let pairs_here = level
            .iter()
            .filter(|node| matches!(node, Node::Inner { .. }))
            .count();
        let mut next_pair = pairs_before + pairs_here;
        let mut next_level = Vec::new();
        for node in &level {
            match node {
                Node::Leaf { first, count, .. } => flat.leaf(&primitives[*first..first + count]),
                Node::Inner { bounds, children } => {
                    flat.pair(bounds, children, next_pair as u32);
                    next_pair += children
                        .iter()
                        .filter(|c| matches!(c, Node::Inner { .. }))
                        .count();
                    next_level.extend(children.iter());
                }
            }
        }
        flat.depth += usize::from(pairs_here > 0);
        pairs_before += pairs_here;
        level = next_level;
    }
    flat
}

impl Flat {
    /// No hierarchy: the slots of each kind in scene-file order.
    pub fn in_file_order(primitives: &[Primitive]) -> Self {
        let mut flat = Self::default();
        for primitive in primitives {
            flat.slots[primitive.kind as usize].push(primitive.index);
        }
        flat
    }

    fn leaf(&mut self, primitives: &[Primitive]) {
        let kind = primitives[0].kind;
        let slots = &mut self.slots[kind as usize];
        let leaf = Leaf {
            kind,
            first: slots.len() as u32,
            count: primitives.len() as u32,
        };
        slots.extend(primitives.iter().map(|p| p.index));
        self.leaves.push(leaf.to_word());
        self.longest_leaf = self.longest_leaf.max(primitives.len());
    }

    fn pair(&mut self, parent: &UnitBox, children: &[Node; 2], first_pair: u32) {
        let is_leaf = |node: &Node| matches!(node, Node::Leaf { .. });
        let [left, right] = children;
        let link = Link::new(first_pair, is_leaf(left), is_leaf(right));
        let boxes = [left.bounds(), right.bounds()];
        // All nodes with lower numbers that are not pairs are leaves.
        let mut next_pair = first_pair;
        let mut next_leaf = 2 * self.pairs.len() as u32 + 1 - first_pair;
        self.pairs.push(Pair {
            planes: [0, 1, 2].map(|k| [0, 1].map(|side| boxes.map(|b| b.0[k][side]))),
            children: [left, right].map(|node| {
                if is_leaf(node) {
                    next_leaf += 1;
                    1 << 31 | (next_leaf - 1)
                } else {
                    next_pair += 1;
                    next_pair - 1
                }
            }),
        });

        // On each side of the parent, the plane of the child that does not touch it.
        let mut owners = 0;
        let mut planes = [0; 3];
        for (axis, word) in planes.iter_mut().enumerate() {
            let mut inner = parent.0[axis];
            for (side, plane) in inner.iter_mut().enumerate() {
                let flagged = |child: usize| boxes[child].0[axis][side] == parent.0[axis][side];
                let owner = usize::from(flagged(0));
                // If both touch it, the left one owns it, at no loss.
                let owner = if owner == 1 && flagged(1) { 0 } else { owner };
                *plane = boxes[owner].0[axis][side];
                owners |= (owner as u32) << (axis + 3 * side);
            }
            *word = plane_word(inner);
        }
        self.flagged.push(FlaggedPair {
            planes,
            link: link.with_owners(owners).0,
        });
    }
}
