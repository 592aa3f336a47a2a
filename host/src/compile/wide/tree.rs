//! A binary hierarchy over clusters: swept by the surface area heuristic, then improved by
//! reinsertion.
//!
//! Reinsertion is that of Meister and Bittner ("Parallel Reinsertion for Bounding Volume Hierarchy
//! Optimization", 2018), one node at a time. A node is removed and inserted where the sum of areas
//! is least, found by branch and bound.

use super::hull::Hull;
use gridel_core::format::record::UnitBox;
use std::cmp::Reverse;

/// A binary tree: nodes below the number of items are the items, the others have two children.
#[derive(Clone, Debug)]
pub struct Tree {
    items: usize,
    pub root: u32,
    bounds: Vec<Hull>,
    parents: Vec<u32>,
    /// Figures of the nodes that are no items.
    children: Vec<[u32; 2]>,
}

/// Least number of items whose two halves are built in parallel.
const PARALLEL_SIZE: usize = 2048;
/// Places that are looked at for one node at most. Meshes and molecules take up to 150; where all items overlap, it
/// would be all places for each node.
const MOST_LOOKED_AT: usize = 512;
/// Below this depth nodes are halved, so that no scene makes the builder recurse without end.
const DEEP: usize = 96;
const NOBODY: u32 = u32::MAX;

/// An inner node while the tree is built.
#[derive(Clone, Copy)]
struct Inner {
    children: [u32; 2],
    bounds: Hull,
}

impl Tree {
    /// Builds a tree over items, at most one of which may be missing.
    pub fn build(items: &[Hull], balanced: bool) -> Option<Self> {
        let first = *items.first()?;
        let places = [0, 1, 2].map(|axis| places(items, axis));
        let mut orders = places.each_ref().map(|places| inverse(places));
        let mut inner = vec![
            Inner {
                children: [0; 2],
                bounds: first
            };
            items.len() - 1
        ];
        let [x, y, z] = &mut orders;
        let builder = Builder {
            items,
            places: &places,
            balanced,
        };
        let root = builder.build([x, y, z], &mut inner, items.len() as u32, 0);
        let count = items.len();
        let mut bounds = items.to_vec();
        bounds.extend(inner.iter().map(|node| node.bounds));
        let mut parents = vec![NOBODY; bounds.len()];
        for (number, node) in (count as u32..).zip(&inner) {
            for child in node.children {
                parents[child as usize] = number;
            }
        }
        Some(Self {
            items: count,
            root,
            bounds,
            parents,
            children: inner.iter().map(|node| node.children).collect(),
        })
    }

    /// Returns the children of a node, unless it is an item.
    pub fn children(&self, node: u32) -> Option<[u32; 2]> {
        let inner = (node as usize).checked_sub(self.items)?;
        Some(self.children[inner])
    }

    pub fn bounds(&self, node: u32) -> UnitBox {
        self.hull(node).into()
    }

    /// Half the surface area of a node's box in units.
    pub fn area(&self, node: u32) -> i64 {
        self.hull(node).area()
    }

    fn hull(&self, node: u32) -> Hull {
        self.bounds[node as usize]
    }

    /// Returns all nodes, children before their parents.
    pub fn bottom_up(&self) -> Vec<u32> {
        let mut order = vec![self.root];
        let mut next = 0;
        while let Some(&node) = order.get(next) {
            order.extend(self.children(node).into_iter().flatten());
            next += 1;
        }
        order.reverse();
        order
    }

    /// Takes every node out once, large ones first, and inserts it where it costs least. Returns
    /// whether any was moved.
    pub fn reinsert(&mut self) -> bool {
        let mut nodes: Vec<u32> = (0..self.bounds.len() as u32).collect();
        nodes.retain(|&node| self.grandparent(node).is_some());
        nodes.sort_by_cached_key(|&node| (Reverse(self.area(node)), node));
        let mut stack = Vec::new();
        let mut moved = false;
        for node in nodes {
            if let Some(to) = self.best_place(node, &mut stack) {
                self.put(node, to);
                moved = true;
            }
        }
        moved
    }

    fn parent(&self, node: u32) -> Option<u32> {
        let parent = self.parents[node as usize];
        (parent != NOBODY).then_some(parent)
    }

    fn grandparent(&self, node: u32) -> Option<u32> {
        self.parent(self.parent(node)?)
    }

    fn sibling(&self, node: u32) -> Option<u32> {
        let [left, right] = self.children(self.parent(node)?)?;
        Some(if left == node { right } else { left })
    }

    /// Returns the node next to which another one would cost least, if that is better than its
    /// current place.
    fn best_place(&self, node: u32, stack: &mut Vec<(i64, u32)>) -> Option<u32> {
        let own = self.area(node);
        let parent = self.parent(node)?;
        self.parent(parent)?;
        let sibling = self.sibling(node)?;
        let mut best = (0, None);
        // The saving up to here of taking the node out.
        let mut saved = self.area(parent);
        let hull = self.hull(node);
        let mut without = self.hull(sibling);
        let (mut beside, mut pivot) = (sibling, parent);
        let mut looked_at = 0;
        loop {
            stack.push((saved, beside));
            while let Some((saved, place)) = stack.pop() {
                looked_at += 1;
                if looked_at > MOST_LOOKED_AT {
                    stack.clear();
                    break;
                }
                if saved - own <= best.0 {
                    continue;
                }
                let joined = self.hull(place).union(&hull).area();
                let gain = saved - joined;
                if gain > best.0 {
                    best = (gain, Some(place));
                }
                if let Some(children) = self.children(place) {
                    let saved = gain + self.area(place);
                    stack.extend(children.map(|child| (saved, child)));
                }
            }
            if pivot != parent {
                without = without.union(&self.hull(beside));
                saved += self.area(pivot) - without.area();
            }
            let Some(next) = self.parent(pivot).filter(|_| looked_at <= MOST_LOOKED_AT) else {
                break;
            };
            beside = self.sibling(pivot)?;
            pivot = next;
        }
        best.1.filter(|&place| place != sibling && place != parent)
    }

    /// Moves a node next to another one.
    fn put(&mut self, node: u32, to: u32) {
        let (Some(parent), Some(sibling)) = (self.parent(node), self.sibling(node)) else {
            return;
        };
        let Some(grandparent) = self.parent(parent) else {
            return;
        };
        self.replace(grandparent, parent, sibling);
        self.refit(grandparent);
        let above = self.parents[to as usize];
        if above == NOBODY {
            self.root = parent;
            self.parents[parent as usize] = NOBODY;
        } else {
            self.replace(above, to, parent);
        }
        self.children[parent as usize - self.items] = [to, node];
        self.parents[to as usize] = parent;
        self.parents[node as usize] = parent;
        // The nodes above do not include its box here, whatever its box was elsewhere.
        self.bounds[parent as usize] = self.hull(to).union(&self.hull(node));
        self.refit(above);
    }

    fn replace(&mut self, parent: u32, old: u32, new: u32) {
        for child in &mut self.children[parent as usize - self.items] {
            if *child == old {
                *child = new;
            }
        }
        self.parents[new as usize] = parent;
    }

    /// Makes the boxes from a node upwards fit their children's.
    fn refit(&mut self, node: u32) {
        let mut next = (node != NOBODY).then_some(node);
        while let Some(node) = next {
            let Some([left, right]) = self.children(node) else {
                return;
            };
            let bounds = self.hull(left).union(&self.hull(right));
            if bounds == self.hull(node) {
                return;
            }
            self.bounds[node as usize] = bounds;
            next = self.parent(node);
        }
    }
}

/// Returns the rank of each item along an axis.
fn places(items: &[Hull], axis: usize) -> Vec<u32> {
    let mut order: Vec<(i32, u32)> = (0..)
        .zip(items)
        .map(|(number, item)| (item.middle(axis), number))
        .collect();
    order.sort_unstable();
    let mut places = vec![0; items.len()];
    for (place, (_, item)) in (0..).zip(order) {
        places[item as usize] = place;
    }
    places
}

struct Builder<'b> {
    items: &'b [Hull],
    /// The rank of each item along each axis.
    places: &'b [Vec<u32>; 3],
    /// True if halves are of equal count at any cost, so that the tree is not deep.
    balanced: bool,
}

impl Builder<'_> {
    /// Builds a tree over items that are given in order along each axis, with its root in the first
    /// of `inner`, whose number is `number`. Returns the root.
    fn build(
        &self,
        orders: [&mut [u32]; 3],
        inner: &mut [Inner],
        number: u32,
        depth: usize,
    ) -> u32 {
        let [x, y, z] = orders;
        let Some((own, inner)) = inner.split_first_mut() else {
            return x[0];
        };
        let count = x.len();
        let (axis, left_count) = self.split([x, y, z], self.balanced || depth > DEEP);
        let places = &self.places[axis];
        let pivot = places[[&*x, &*y, &*z][axis][left_count] as usize];
        let is_left = |item: u32| places[item as usize] < pivot;
        let [(lx, rx), (ly, ry), (lz, rz)] =
            [x, y, z].map(|order| partition(order, left_count, is_left));
        let (left_inner, right_inner) = inner.split_at_mut(left_count - 1);
        let left_number = number + 1;
        let right_number = number + left_count as u32;
        let mut left = || self.build([lx, ly, lz], left_inner, left_number, depth + 1);
        let mut right = || self.build([rx, ry, rz], right_inner, right_number, depth + 1);
        let (left, right) = if count >= PARALLEL_SIZE {
            rayon::join(left, right)
        } else {
            (left(), right())
        };
        let bounds = |child: u32, inner: &[Inner], first: u32| match child.checked_sub(first) {
            Some(_) if child as usize >= self.items.len() => inner[0].bounds,
            _ => self.items[child as usize],
        };
        let bounds =
            bounds(left, left_inner, left_number).union(&bounds(right, right_inner, right_number));
        *own = Inner {
            children: [left, right],
            bounds,
        };
        number
    }

    /// The axis of the cheapest split and the number of items on its left.
    fn split(&self, orders: [&[u32]; 3], balanced: bool) -> (usize, usize) {
        let count = orders[0].len();
        let hull = |item: &u32| self.items[*item as usize];
        let mut best = (i64::MAX, 0, count / 2);
        let mut right_costs = vec![0; count];
        for (axis, order) in orders.iter().enumerate() {
            let mut bounds = hull(&order[count - 1]);
            for (place, (item, cost)) in order.iter().zip(&mut right_costs).enumerate().rev() {
                bounds = bounds.union(&hull(item));
                *cost = bounds.area() * (count - place) as i64;
            }
            let mut bounds = hull(&order[0]);
            for (before, (item, right)) in order.iter().zip(&right_costs[1..]).enumerate() {
                bounds = bounds.union(&hull(item));
                let place = before + 1;
                let cost = bounds.area() * place as i64 + right;
                if cost < best.0 && (!balanced || place == count / 2) {
                    best = (cost, axis, place);
                }
            }
        }
        (best.1, best.2)
    }
}

/// Moves the items on the left to the front, keeping the order on both sides.
fn partition(
    order: &mut [u32],
    left_count: usize,
    is_left: impl Fn(u32) -> bool,
) -> (&mut [u32], &mut [u32]) {
    let right: Vec<u32> = order
        .iter()
        .copied()
        .filter(|&item| !is_left(item))
        .collect();
    let mut next = 0;
    for place in 0..order.len() {
        let item = order[place];
        if is_left(item) {
            order[next] = item;
            next += 1;
        }
    }
    order[left_count..].copy_from_slice(&right);
    order.split_at_mut(left_count)
}

/// Returns the place of each value: the inverse of a permutation.
pub fn inverse(values: &[u32]) -> Vec<u32> {
    let mut places = vec![0; values.len()];
    for (place, &value) in (0..).zip(values) {
        places[value as usize] = place;
    }
    places
}
