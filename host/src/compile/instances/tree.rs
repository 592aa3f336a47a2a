//! The hierarchy above instances: top down, by the surface area heuristic, with one instance per leaf.

use gridel_core::format::limits::MAX_INSTANCE_LEVELS;
use gridel_core::format::record::{Pair, UnitBox};
use std::collections::VecDeque;

/// The bit that makes a child a leaf.
const LEAF: u32 = 1 << 31;

/// Pairs in breadth-first order, and the instances in the order of their leaves.
#[derive(Debug, Default)]
pub struct Tree {
    pub pairs: Vec<Pair>,
    pub order: Vec<u32>,
}

/// Builds the hierarchy above instances, whose boxes are given.
pub fn build(instances: &[UnitBox]) -> Tree {
    let mut numbers: Vec<u32> = (0..instances.len() as u32).collect();
    let mut tree = Tree {
        pairs: Vec::new(),
        order: Vec::with_capacity(numbers.len()),
    };
    if let [only] = numbers[..] {
        tree.order.push(only);
        return tree;
    }
    // Ranges of numbers that have two children each, and the levels that are left below.
    let mut waiting = VecDeque::new();
    if !numbers.is_empty() {
        waiting.push_back((0..numbers.len(), MAX_INSTANCE_LEVELS));
    }
    let mut next_pair = 1;
    while let Some((range, levels)) = waiting.pop_front() {
        let middle = range.start + split(instances, &mut numbers[range.clone()], levels);
        let halves = [range.start..middle, middle..range.end];
        let boxes = halves.clone().map(|half| around(instances, &numbers[half]));
        let children = halves.map(|half| match numbers[half.clone()] {
            [only] => {
                tree.order.push(only);
                LEAF | (tree.order.len() as u32 - 1)
            }
            _ => {
                waiting.push_back((half, levels - 1));
                next_pair += 1;
                next_pair - 1
            }
        });
        let [left, right] = boxes.map(|it| it.0);
        let planes = [0, 1, 2].map(|axis| [0, 1].map(|side| [left[axis][side], right[axis][side]]));
        tree.pairs.push(Pair { planes, children });
    }
    tree
}

/// Divides two or more instances in two, neither empty, by the cheapest split along any axis. Divides them in halves
/// where the remaining levels require it. Returns how many come first.
fn split(instances: &[UnitBox], numbers: &mut [u32], levels: usize) -> usize {
    let count = numbers.len();
    let bounds = |number: &u32| instances[*number as usize];
    let middle = |number: &u32, axis: usize| {
        let [low, high] = bounds(number).0[axis];
        (i32::from(low) + i32::from(high), *number)
    };
    let mut best = (f64::INFINITY, 0, count / 2);
    // A level below must hold each side, so the number of instances is limited.
    let most = 1_usize << (levels - 1).min(30);
    let mut areas = vec![0.0; count];
    for axis in 0..3 {
        numbers.sort_by_key(|number| middle(number, axis));
        let mut sum = bounds(&numbers[count - 1]);
        for index in (1..count).rev() {
            sum = sum.union(&bounds(&numbers[index]));
            areas[index] = area(&sum);
        }
        let mut sum = bounds(&numbers[0]);
        for first in 1..count {
            let cost = area(&sum) * first as f64 + areas[first] * (count - first) as f64;
            if cost < best.0 && first <= most && count - first <= most {
                best = (cost, axis, first);
            }
            sum = sum.union(&bounds(&numbers[first]));
        }
    }
    let (_, axis, first) = best;
    numbers.sort_by_key(|number| middle(number, axis));
    first
}

fn around(instances: &[UnitBox], numbers: &[u32]) -> UnitBox {
    let boxes = numbers.iter().map(|&number| instances[number as usize]);
    let none = UnitBox([[0; 2]; 3]);
    boxes.reduce(|a, b| a.union(&b)).unwrap_or(none)
}

fn area(bounds: &UnitBox) -> f64 {
    let [x, y, z] = bounds.0.map(|[low, high]| f64::from(high) - f64::from(low));
    x * y + y * z + z * x
}
