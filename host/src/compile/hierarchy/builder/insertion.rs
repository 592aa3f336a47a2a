//! The paper's builder (section 2.1): each primitive enters at the root and goes down to where it
//! increases the volume least.

use super::tree::{Below, Tree};
use crate::compile::hierarchy::node::{Primitive, area};
use gridel_core::format::limits::MAX_LEVELS;
use gridel_core::format::record::UnitBox;

/// Inserts all primitives in scene-file order of their kinds. Below the deepest level that a
/// hierarchy can have, they are gathered in leaves, which are halved afterwards.
pub fn build(primitives: &[Primitive]) -> Tree {
    let mut tree = Tree::default();
    for (place, primitive) in primitives.iter().enumerate() {
        if place == 0 {
            tree.root = tree.leaf(primitive.bounds, vec![place]);
        } else {
            insert(&mut tree, place, primitive.bounds);
        }
    }
    tree
}

fn insert(tree: &mut Tree, place: usize, bounds: UnitBox) {
    let (mut number, mut depth) = (tree.root, 0);
    loop {
        let node = &mut tree.nodes[number];
        match &mut node.below {
            Below::Children(children) => {
                node.bounds = node.bounds.union(&bounds);
                let [left, right] = *children;
                let (a, b) = (
                    increase(tree, left, &bounds),
                    increase(tree, right, &bounds),
                );
                number = if b < a { right } else { left };
                depth += 1;
            }
            Below::Primitives(places) if depth + 1 >= MAX_LEVELS => {
                places.push(place);
                node.bounds = node.bounds.union(&bounds);
                return;
            }
            Below::Primitives(_) => {
                let parent = node.parent;
                let leaf = tree.leaf(bounds, vec![place]);
                let joined = tree.join([number, leaf]);
                tree.nodes[joined].parent = parent;
                match tree.nodes.get_mut(parent).map(|parent| &mut parent.below) {
                    Some(Below::Children(children)) => {
                        for child in children.iter_mut().filter(|child| **child == number) {
                            *child = joined;
                        }
                    }
                    _ => tree.root = joined,
                }
                return;
            }
        }
    }
}

/// Returns the growth of a node's volume and of its surface, which decides if volumes are equal.
fn increase(tree: &Tree, number: usize, bounds: &UnitBox) -> (f64, f64) {
    let before = tree.nodes[number].bounds;
    let after = before.union(bounds);
    (
        volume(&after) - volume(&before),
        area(&after) - area(&before),
    )
}

fn volume(bounds: &UnitBox) -> f64 {
    let sides = bounds
        .0
        .map(|[low, high]| f64::from(i32::from(high) - i32::from(low)));
    sides[0] * sides[1] * sides[2]
}
