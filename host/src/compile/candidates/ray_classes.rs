//! Builds the tree over rays: refined where the scene's own rays fall, within a budget.

use super::budget::{Budget, Needed, OnProgress, OverBudget};
use super::lists::{List, Lists, Plan};
use super::shaft::Shaft;
use super::target::Targets;
use crate::compile::section::{Section, section};
use gridel_core::Structure;
use gridel_core::format::record::Gridels;
use gridel_core::format::{ClassNode, SectionKind};
use gridel_core::shared::{ClassPoint, ClassRange, ray_classes};
use rayon::prelude::*;
use std::collections::BinaryHeap;

/// Everything that the structure keeps.
#[derive(Debug)]
pub struct Classes {
    nodes: Vec<u32>,
    pub lists: Lists,
}

impl Classes {
    /// Returns the tree over rays and its lists.
    pub fn sections(self) -> Vec<Section> {
        let mut sections = vec![section(SectionKind::ClassNodes, &self.nodes)];
        sections.extend(self.lists.sections(ray_classes::LISTS));
        sections
    }
}

/// Lists of at most this length are not halved.
const SHORT: usize = 3;
/// Classes with fewer of the scene's rays are not halved.
const FEW_RAYS: usize = 4;
/// Lists of at least this length are no better than the hierarchy.
const LONG: usize = 64;
/// Tests of primitives against classes, at the most: a few seconds. Where many things lie in one
/// place, classes could be halved for ever and no list would become short.
const MOST_TESTS: usize = 1 << 26;
/// Halvings from a root to a leaf, at the most.
const MOST_LEVELS: u32 = 60;
/// Bytes of a leaf besides its entries: its share of nodes, its cell and its list's start.
const LEAF_BYTES: u64 = 8 + 3 + 3;

/// A class that may be halved.
struct Class {
    /// Its node.
    node: usize,
    face: usize,
    level: u32,
    range: ClassRange,
    /// The scene's rays in it.
    rays: Vec<u32>,
    /// The slots that its rays can hit, and where along the rays.
    met: Vec<(u32, f64)>,
}

impl Class {
    /// Returns the cost of the tests for all the scene's rays in the class.
    fn cost(&self) -> u64 {
        self.rays.len() as u64 * self.met.len() as u64
    }

    /// Returns whether it gets a list.
    fn is_listed(&self) -> bool {
        !self.rays.is_empty() && self.met.len() <= LONG
    }

    fn bytes(&self, entry: u64) -> u64 {
        match self.is_listed() {
            true => LEAF_BYTES + self.met.len() as u64 * entry,
            false => 4,
        }
    }
}

impl PartialEq for Class {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Class {}

impl PartialOrd for Class {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Class {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        let by = |class: &Self| (class.cost(), std::cmp::Reverse(class.node));
        by(self).cmp(&by(other))
    }
}

/// Builds the classes for a scene whose own rays are given.
pub fn build(
    targets: &Targets<'_>,
    rays: &[ClassPoint],
    budget: Budget<'_>,
) -> Result<Classes, OverBudget> {
    let entry = if targets.all().len() <= 256 { 2 } else { 3 };
    let mut nodes = vec![ClassNode::leaf(ClassNode::NONE).0; 6];
    let roots = (0..6_usize).into_par_iter().map(|face| {
        let range = ClassRange::whole(&targets.bounds);
        let of_face = (0..rays.len() as u32).filter(|&ray| rays[ray as usize].face == face);
        let all: Vec<u32> = (0..targets.all().len() as u32).collect();
        Class {
            node: face,
            face,
            level: 0,
            range,
            rays: of_face.collect(),
            met: met(targets, face, &range, &all),
        }
    });
    let mut waiting: BinaryHeap<Class> = roots.collect::<Vec<_>>().into();
    let mut bytes: u64 = waiting.iter().map(|class| class.bytes(entry)).sum();
    if bytes > budget.bytes {
        return Err(budget.exceeded(Structure::RayClasses, None, Needed::AtLeast(bytes)));
    }
    let mut done = Vec::new();
    let mut tests = 0;
    while let Some(class) = waiting.pop() {
        tests += 2 * ClassNode::DIMENSIONS * class.met.len();
        if tests > MOST_TESTS {
            done.push(class);
            break;
        }
        let halves = best_halves(targets, rays, &class);
        let Some((dimension, halves)) = halves else {
            done.push(class);
            continue;
        };
        let of_halves: u64 = halves.iter().map(|half| half.bytes(entry)).sum();
        if bytes - class.bytes(entry) + of_halves > budget.bytes {
            done.push(class);
            break;
        }
        bytes = bytes - class.bytes(entry) + of_halves;
        nodes[class.node] = ClassNode::split(dimension, nodes.len() as u32).0;
        for half in halves {
            let node = nodes.len();
            nodes.push(ClassNode::leaf(ClassNode::NONE).0);
            waiting.push(Class { node, ..half });
        }
    }
    done.extend(waiting);
    Ok(Classes::new(targets, nodes, done, budget.on_progress))
}

impl Classes {
    /// Numbers nodes in the order of their parents, and gives lists to the classes that get one.
    fn new(
        targets: &Targets<'_>,
        nodes: Vec<u32>,
        classes: Vec<Class>,
        on_progress: OnProgress<'_>,
    ) -> Self {
        let mut class_of: Vec<Option<&Class>> = vec![None; nodes.len()];
        for class in classes.iter().filter(|class| class.is_listed()) {
            class_of[class.node] = Some(class);
        }
        // Children follow in the order in which their parents come.
        let mut order: Vec<usize> = (0..6).collect();
        let mut ordered = Vec::with_capacity(nodes.len());
        let mut listed = Vec::new();
        let mut place = 0;
        while let Some(&node) = order.get(place) {
            let word = nodes[node];
            ordered.push(match (word & 7 == 7, class_of[node]) {
                (true, Some(class)) => {
                    listed.push(class);
                    ClassNode::leaf(listed.len() as u32 - 1).0
                }
                (true, None) => word,
                (false, _) => {
                    let first = (word >> 3) as usize;
                    let moved = ClassNode::split((word & 7) as usize, order.len() as u32);
                    order.extend([first, first + 1]);
                    moved.0
                }
            });
            place += 1;
        }
        let list = |cell: u64, list: &mut List| {
            let class = listed[cell as usize];
            let levels_per_step = ClassRange::levels_per_step(&targets.bounds, class.face / 2);
            let mut met = class.met.clone();
            met.sort_unstable_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
            list.extend(met.iter().map(|&(slot, from)| {
                // Half units, rounded down by more than arithmetic can be off.
                let step = (2.0 * from - 1e-3).floor();
                (slot, ClassRange::key(step as i32, levels_per_step))
            }));
        };
        let plan = Plan {
            cells: listed.len() as u64,
            end: targets.all().len() as u32,
            keyed: true,
            list: &list,
        };
        Self {
            lists: plan.build(plan.count(on_progress)),
            nodes: ordered,
        }
    }
}

/// Returns the dimension that is best halved, and the halves; `None` where no halving saves enough.
fn best_halves(
    targets: &Targets<'_>,
    rays: &[ClassPoint],
    class: &Class,
) -> Option<(usize, [Class; 2])> {
    if class.met.len() <= SHORT || class.rays.len() < FEW_RAYS || class.level >= MOST_LEVELS {
        return None;
    }
    let slots: Vec<u32> = class.met.iter().map(|&(slot, _)| slot).collect();
    let tries = (0..ClassNode::DIMENSIONS).into_par_iter().map(|dimension| {
        let middle = class.range.middle(dimension);
        let (upper, lower): (Vec<u32>, Vec<u32>) = class
            .rays
            .iter()
            .partition(|&&ray| rays[ray as usize].coordinates[dimension] >= middle);
        let half = |is_upper: bool, rays: Vec<u32>| {
            let range = class.range.half(dimension, is_upper);
            Class {
                node: 0,
                face: class.face,
                level: class.level + 1,
                range,
                met: met(targets, class.face, &range, &slots),
                rays,
            }
        };
        let halves = [half(false, lower), half(true, upper)];
        let cost: u64 = halves.iter().map(Class::cost).sum();
        (cost, dimension, halves)
    });
    let (_, dimension, halves) = tries.min_by_key(|(cost, dimension, _)| (*cost, *dimension))?;
    Some((dimension, halves))
}

/// Returns the targets that rays of a class can hit, and where along the rays that may begin.
fn met(targets: &Targets<'_>, face: usize, range: &ClassRange, slots: &[u32]) -> Vec<(u32, f64)> {
    let (axis, up) = (face / 2, face % 2 == 1);
    let units = |q13: i64| q13 as f64 / 8192.0;
    // A ray's slope as an integer is off by less than one.
    let ratio = |q30: i64, outward: i64| (q30 + outward) as f64 / 1_073_741_824.0;
    let place = |side: usize| [0, 1, 2].map(|k| units(range.0[k][side]));
    let mut shaft = Shaft {
        low: place(0).map(|x| x - Gridels::REACH),
        high: place(1).map(|x| x + Gridels::REACH),
        low_rate: [0.0; 3],
        high_rate: [0.0; 3],
        // Beyond the box that is partitioned there is nothing.
        last: f64::from(1 << 17),
    };
    let sign = if up { 1.0 } else { -1.0 };
    (shaft.low_rate[axis], shaft.high_rate[axis]) = (sign, sign);
    for (across, side) in Gridels::across(axis).into_iter().zip(3..) {
        let [low, high] = range.0[side];
        (shaft.low_rate[across], shaft.high_rate[across]) = (ratio(low, -1), ratio(high, 1));
    }
    let all = targets.all();
    let met = |&slot: &u32| Some((slot, all[slot as usize].met_by(&shaft)?[0]));
    slots.iter().filter_map(met).collect()
}
