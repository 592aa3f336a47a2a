//! Bottom up: two nodes become one until there is one (the paper, section 2.1).

use super::tree::Tree;
use crate::compile::hierarchy::node::{Primitive, area};
use rayon::prelude::*;

/// Pairs any two: what the paper warns of.
pub fn random(primitives: &[Primitive]) -> Tree {
    let mut tree = Tree::default();
    let mut clusters = leaves(&mut tree, primitives);
    // A multiplicative shuffle of the places, equal on every machine.
    clusters.sort_by_key(|&leaf| (leaf as u32).wrapping_mul(0x9e37_79b1) ^ 0x2545_f491);
    while clusters.len() > 1 {
        clusters = clusters
            .chunks(2)
            .map(|pair| match *pair {
                [a, b] => tree.join([a, b]),
                _ => pair[0],
            })
            .collect();
    }
    tree.root = clusters[0];
    tree
}

/// Number of neighbors on either side along the curve among which the nearest is sought.
const NEIGHBORS: usize = 16;

/// Pairs the nearest two: those whose common box has the least surface.
///
/// To search all would take n^2 steps. Instead, nodes lie along a space-filling curve. Each looks
/// for the nearest among sixteen to either side, and all mutual nearest pairs are joined at once.
/// Source: Meister and Bittner, "Parallel locally-ordered clustering for bounding volume hierarchy
/// construction", 2018.
pub fn nearest(primitives: &[Primitive]) -> Tree {
    let mut tree = Tree::default();
    let mut clusters = leaves(&mut tree, primitives);
    clusters.sort_by_key(|&leaf| (morton(&primitives[leaf]), leaf));
    while clusters.len() > 1 {
        let partner: Vec<usize> = (0..clusters.len())
            .into_par_iter()
            .map(|place| {
                let first = place.saturating_sub(NEIGHBORS);
                let end = (place + NEIGHBORS + 1).min(clusters.len());
                let bounds = tree.nodes[clusters[place]].bounds;
                let apart =
                    |other: &usize| area(&bounds.union(&tree.nodes[clusters[*other]].bounds));
                let others = (first..end).filter(|&other| other != place);
                // Ties are decided by place, so that two always find each other.
                let key = |other: &usize| (apart(other), place.min(*other), place.max(*other));
                others
                    .min_by(|a, b| {
                        let (a, b) = (key(a), key(b));
                        a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2)))
                    })
                    .unwrap_or(place)
            })
            .collect();
        let mut next = Vec::with_capacity(clusters.len());
        for (place, &cluster) in clusters.iter().enumerate() {
            let other = partner[place];
            if partner[other] != place {
                next.push(cluster);
            } else if place < other {
                next.push(tree.join([cluster, clusters[other]]));
            }
        }
        clusters = next;
    }
    tree.root = clusters[0];
    tree
}

fn leaves(tree: &mut Tree, primitives: &[Primitive]) -> Vec<usize> {
    let leaf = |(place, primitive): (usize, &Primitive)| tree.leaf(primitive.bounds, vec![place]);
    primitives.iter().enumerate().map(leaf).collect()
}

/// The place of a box's center on the Z-order curve.
fn morton(primitive: &Primitive) -> u64 {
    let mut code = 0;
    for axis in 0..3 {
        let coordinate = (primitive.centroid(axis) + (1 << 16)) as u64;
        for bit in 0..17 {
            code |= (coordinate >> bit & 1) << (3 * bit + axis);
        }
    }
    code
}
