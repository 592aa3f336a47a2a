//! Lays a hierarchy out as dual-split nodes: chooses on which axes nodes are carved and split.
//!
//! A node's *region* is the part of the scene's box that the planes above the node leave. It is at
//! least as large as the node's own box, and how much larger depends on the choices above. The
//! surface area heuristic on regions weighs the cost of a plane against the visits that it saves.
//! Each choice looks ahead as far as the choices of the children.

use super::node::{Node, area};
use gridel_core::format::NodeWord;
use gridel_core::format::record::{DualNode, UnitBox, plane_word};
use rayon::prelude::*;

/// Costs of steps, in instructions of a Cortex-M4F.
const VISIT: f64 = 18.0;
const CARVE: f64 = 14.0;
const SPLIT: f64 = 26.0;
const LEAF: f64 = 40.0;
const TRIANGLE: f64 = 80.0;

/// All ways to carve a node: the axes, in the order in which they are tested.
static CARVES: [&[usize]; 10] = [
    &[],
    &[0],
    &[1],
    &[2],
    &[0, 1],
    &[1, 0],
    &[0, 2],
    &[2, 0],
    &[1, 2],
    &[2, 1],
];

/// The test at a node.
#[derive(Clone, Copy)]
struct Choice {
    cost: f64,
    carves: &'static [usize],
    /// The axis, and whether the second child is the lower one.
    split: Option<(usize, bool)>,
}

/// Lays a hierarchy out, breadth first. Swaps children so that the lower one comes first on the
/// axis on which they are split: leaves are numbered in the order that results.
pub fn lay_out(root: &mut Node) -> Vec<DualNode> {
    let mut nodes = Vec::new();
    let mut level = vec![(*root.bounds(), root)];
    let (mut next_node, mut next_leaf) = (1, 0);
    while !level.is_empty() {
        let choose = |(region, node): &(UnitBox, &mut Node)| choose(node, region, LOOK_AHEAD);
        let choices: Vec<Choice> = level.par_iter().map(choose).collect();
        let mut below = Vec::new();
        for ((region, node), choice) in level.into_iter().zip(choices) {
            let bounds = *node.bounds();
            let region = carved(&region, &bounds, choice.carves);
            let carve = |place: usize| choice.carves.get(place).copied();
            let planes = |place| carve(place).map_or(0, |axis| plane_word(bounds.0[axis]));
            let axis = |place| carve(place).map_or(NodeWord::NONE, |axis| axis as u32);
            let carves = [planes(0), planes(1)];
            let axes = [axis(0), axis(1)];
            nodes.push(match (node, choice.split) {
                (Node::Inner { children, .. }, Some((axis, swapped))) => {
                    if swapped {
                        children.swap(0, 1);
                    }
                    let boxes = children.each_ref().map(|child| *child.bounds());
                    let regions = split(&region, &boxes, axis);
                    below.extend(regions.into_iter().zip(&mut **children));
                    next_node += 2;
                    DualNode {
                        split: plane_word([boxes[1].0[axis][0], boxes[0].0[axis][1]]),
                        carves,
                        word: NodeWord::new(next_node - 2, axis as u32, axes).0,
                    }
                }
                _ => {
                    next_leaf += 1;
                    DualNode {
                        split: 0,
                        carves,
                        word: NodeWord::new(next_leaf - 1, NodeWord::NONE, axes).0,
                    }
                }
            });
        }
        level = below;
    }
    nodes
}

/// Levels below a node whose choices a choice takes into account.
const LOOK_AHEAD: u32 = 1;

/// Returns the cheapest treatment of a node whose region is given.
fn choose(node: &Node, region: &UnitBox, look_ahead: u32) -> Choice {
    // A plane that does not cut anything is not considered.
    let cuts = |carves: &&&[usize]| carves.iter().all(|&k| region.0[k] != node.bounds().0[k]);
    let choices = CARVES.iter().filter(cuts).flat_map(|&carves| {
        let mut left = *region;
        let mut cost = area(region) * VISIT;
        for &axis in carves {
            cost += area(&left) * CARVE;
            left = carved(&left, node.bounds(), &[axis]);
        }
        choices_of_split(node, left, look_ahead).map(move |(split, below)| Choice {
            cost: cost + below,
            carves,
            split,
        })
    });
    let cheapest = choices.min_by(|a, b| a.cost.total_cmp(&b.cost));
    cheapest.expect("there is always the choice to carve nothing")
}

/// Returns the choices after a node whose carved region is given, with their costs.
fn choices_of_split(
    node: &Node,
    region: UnitBox,
    look_ahead: u32,
) -> impl Iterator<Item = (Option<(usize, bool)>, f64)> {
    let (leaf, children) = match node {
        Node::Leaf { tests, .. } => (
            Some((None, area(&region) * (LEAF + TRIANGLE * tests))),
            None,
        ),
        Node::Inner { children, .. } => (None, Some(children)),
    };
    let splits = children.into_iter().flat_map(move |children| {
        (0..3).map(move |axis| {
            let middle = |child: &Node| child.bounds().0[axis].map(i32::from).iter().sum::<i32>();
            let swapped = middle(&children[0]) > middle(&children[1]);
            let ordered = if swapped {
                [&children[1], &children[0]]
            } else {
                [&children[0], &children[1]]
            };
            let boxes = ordered.map(|child| *child.bounds());
            let below = ordered.iter().zip(split(&region, &boxes, axis));
            let below: f64 = below
                .map(|(child, region)| {
                    if look_ahead == 0 {
                        area(&region) * (VISIT + SPLIT)
                    } else {
                        choose(child, &region, look_ahead - 1).cost
                    }
                })
                .sum();
            (Some((axis, swapped)), area(&region) * SPLIT + below)
        })
    });
    leaf.into_iter().chain(splits)
}

/// Returns the rest of a region after carves.
fn carved(region: &UnitBox, bounds: &UnitBox, carves: &[usize]) -> UnitBox {
    let mut left = *region;
    for &axis in carves {
        let ([low, high], [lower, upper]) = (region.0[axis], bounds.0[axis]);
        left.0[axis] = [low.max(lower), high.min(upper)];
    }
    left
}

/// Returns the parts of a region that a split leaves to the lower and the upper child.
fn split(region: &UnitBox, boxes: &[UnitBox; 2], axis: usize) -> [UnitBox; 2] {
    let [mut below, mut above] = [*region; 2];
    below.0[axis][1] = below.0[axis][1].min(boxes[0].0[axis][1]);
    above.0[axis][0] = above.0[axis][0].max(boxes[1].0[axis][0]);
    [below, above]
}
