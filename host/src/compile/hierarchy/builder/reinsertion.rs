//! Improves a hierarchy by taking subtrees out and putting each back where it costs least.
//!
//! Bittner, Hapala and Havran, "Fast insertion-based optimization of bounding volume hierarchies",
//! 2013. The cost is the sum of all nodes' surfaces, and the best place is found exactly, by branch
//! and bound.

use super::tree::{Below, Tree};
use crate::compile::hierarchy::node::{Node, area};
use gridel_core::format::record::UnitBox;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Passes over the tree at most; fewer where a pass gains little.
const PASSES: usize = 12;
/// A pass that gains less is the last.
const LEAST_GAIN: f64 = 0.001;

/// Returns the improved tree.
pub fn improve(root: &Node) -> Tree {
    let mut tree = Tree::default();
    tree.root = copy(root, &mut tree);
    let mut before = cost(&tree);
    for _ in 0..PASSES {
        pass(&mut tree);
        let after = cost(&tree);
        if after > before * (1.0 - LEAST_GAIN) {
            break;
        }
        before = after;
    }
    tree
}

fn copy(node: &Node, tree: &mut Tree) -> usize {
    match node {
        Node::Leaf {
            bounds,
            first,
            count,
            ..
        } => tree.leaf(*bounds, (*first..first + count).collect()),
        Node::Inner { children, .. } => {
            let children = [copy(&children[0], tree), copy(&children[1], tree)];
            tree.join(children)
        }
    }
}

fn cost(tree: &Tree) -> f64 {
    let all = tree.parents_first().into_iter();
    all.map(|number| area(&tree.nodes[number].bounds)).sum()
}

/// Takes every node out once, the largest first.
fn pass(tree: &mut Tree) {
    let mut order = tree.parents_first();
    order.retain(|&number| number != tree.root);
    let size = |number: usize| area(&tree.nodes[number].bounds);
    order.sort_by(|&a, &b| size(b).total_cmp(&size(a)).then(a.cmp(&b)));
    for number in order {
        reinsert(tree, number);
    }
}

fn reinsert(tree: &mut Tree, number: usize) {
    let parent = tree.nodes[number].parent;
    // Whatever hangs from the root stays there.
    if number == tree.root || parent == tree.root {
        return;
    }
    let Below::Children(children) = tree.nodes[parent].below else {
        return;
    };
    let sibling = if children[0] == number {
        children[1]
    } else {
        children[0]
    };
    let above = tree.nodes[parent].parent;
    replace(tree, above, parent, sibling);
    refit(tree, above);
    let bounds = tree.nodes[number].bounds;
    let beside = best_place(tree, &bounds);
    // The parent that was taken out goes above the node and its new sibling.
    let above = tree.nodes[beside].parent;
    tree.nodes[parent].below = Below::Children([beside, number]);
    if beside == tree.root {
        tree.root = parent;
        tree.nodes[parent].parent = usize::MAX;
    } else {
        replace(tree, above, beside, parent);
    }
    tree.nodes[beside].parent = parent;
    tree.nodes[number].parent = parent;
    refit(tree, parent);
}

fn replace(tree: &mut Tree, parent: usize, old: usize, new: usize) {
    if let Below::Children(children) = &mut tree.nodes[parent].below {
        for child in children.iter_mut().filter(|child| **child == old) {
            *child = new;
        }
    }
    tree.nodes[new].parent = parent;
}

/// Fits the boxes from a node up to the root.
fn refit(tree: &mut Tree, mut number: usize) {
    while let Some(node) = tree.nodes.get(number) {
        if let Below::Children([left, right]) = node.below {
            tree.nodes[number].bounds = tree.nodes[left].bounds.union(&tree.nodes[right].bounds);
        }
        number = tree.nodes[number].parent;
    }
}

/// A node that waits to be examined, the cheapest first.
struct Candidate {
    /// The growth of all nodes above.
    growth: f64,
    number: usize,
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Candidate {}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        // The heap's greatest is the one that grows least.
        let growth = other.growth.total_cmp(&self.growth);
        growth.then(other.number.cmp(&self.number))
    }
}

/// Returns the node next to which a box adds least surface.
fn best_place(tree: &Tree, bounds: &UnitBox) -> usize {
    let own = area(bounds);
    let mut best = (f64::INFINITY, tree.root);
    let mut waiting = BinaryHeap::from([Candidate {
        growth: 0.0,
        number: tree.root,
    }]);
    while let Some(Candidate { growth, number }) = waiting.pop() {
        if growth + own >= best.0 {
            break;
        }
        let node = &tree.nodes[number];
        let joined = area(&node.bounds.union(bounds));
        if growth + joined < best.0 {
            best = (growth + joined, number);
        }
        let growth = growth + joined - area(&node.bounds);
        if let Below::Children(children) = node.below
            && growth + own < best.0
        {
            waiting.extend(children.map(|number| Candidate { growth, number }));
        }
    }
    best.1
}
