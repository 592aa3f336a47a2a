//! Builds the octree, and bounds how often rays test the same primitives in it.

use super::estimate::{Rays, ordinary_tests};
use super::{Cells, MOST_BYTES, Range, longest, volume};
use crate::compile::CompileError;
use crate::compile::section::{Section, indices, section};
use gridel_core::Structure;
use gridel_core::format::record::UnitBox;
use gridel_core::format::{OctreeNode, SectionKind};
use gridel_core::shared::MOST_LEVELS;
use gridel_core::shared::{cells_of, divide};

/// Largest number of primitives in a cell of an octree that is not split.
const FEW: usize = 6;

/// Most bytes that an octree's build needs per entry of its finest cells. An inner node has more than [`FEW`] entries,
/// so a level has hardly more children than entries. Arrays that grow may be twice as long as they are full.
const OCTREE_ENTRY_BYTES: u64 = 192;

/// Units by which the margins of culling widen a cell on both sides: rays visit it earlier and leave it later.
const CULLING: f64 = 5.0;
/// Least units of a cell of the finest level, along each axis with an extent. A smaller cell would be lost in the
/// margins of culling.
const THINNEST_CELL: i32 = 8;

/// Levels of an octree that is twice as fine as one of even leaves.
fn usual_levels(primitives: usize) -> u32 {
    MOST_LEVELS.min(primitives.max(1).ilog2() / 3 + 2)
}

/// Returns the scene's box as an octree divides it. It is larger along axes on which a thin scene would make cells
/// thinner than the margins of culling. It is larger only if rays would otherwise test the same primitives too often
/// there.
pub fn bounds(bounds: &UnitBox, boxes: &[UnitBox]) -> UnitBox {
    let count = boxes.len();
    let divisions = [1 << usual_levels(count); 3];
    let wide = UnitBox(bounds.0.map(|[low, high]| {
        let extent = THINNEST_CELL << usual_levels(count);
        let (least, most) = (i32::from(low), i32::from(high));
        if least == most || most - least >= extent {
            [low, high]
        } else if least + extent <= i16::MAX.into() {
            // The scene lies in the first cell, not about the plane between two.
            [low, (least + extent) as i16]
        } else {
            [(most - extent) as i16, high]
        }
    }));
    if wide == *bounds {
        return wide;
    }
    let axes = divide(bounds, divisions);
    let ranges = boxes.iter().map(|it| cells_of(&axes, it, 0));
    let entries: u64 = ranges.map(|range| volume(&range)).sum();
    let tests = entries as f64 * Rays::new(boxes, bounds, CULLING).share(divisions);
    if tests > ordinary_tests(count) {
        wide
    } else {
        *bounds
    }
}

/// Builds an octree.
///
/// # Errors
/// If even an octree of one cell exceeds [`MOST_BYTES`].
pub fn build(bounds: &UnitBox, boxes: &[UnitBox]) -> Result<Cells, CompileError> {
    // No finer than memory allows.
    let mut levels = usual_levels(boxes.len());
    loop {
        let axes = divide(bounds, [1 << levels; 3]);
        let ranges: Vec<_> = boxes
            .iter()
            .map(|bounds| cells_of(&axes, bounds, 0))
            .collect();
        let entries: u64 = ranges.iter().map(volume).sum();
        let needed = size_of_val(&ranges[..]) as u64 + OCTREE_ENTRY_BYTES * entries;
        if needed > MOST_BYTES {
            if levels > 0 {
                levels -= 1;
                continue;
            }
            return Err(CompileError::OverBudget {
                structure: Structure::Octree.name(),
                size: String::new(),
                needed,
                at_least: "at least ",
                budget: MOST_BYTES,
                remedy: "ask for another structure",
            });
        }
        let mut octree = Nodes::build(&ranges, levels);
        let rays = Rays::new(boxes, bounds, CULLING);
        let share = |level: u32| rays.share([1 << level; 3]);
        if octree.tests(share) > ordinary_tests(boxes.len()) {
            octree = octree.without_worthless_splits(share);
        }
        // The planes depend on the number of levels, so the deepest leaf decides it.
        if octree.levels < levels {
            levels = octree.levels;
            continue;
        }
        return Ok(Cells {
            sections: octree.sections(),
            stack_depth: 7 * levels as usize + usize::from(levels > 0),
            longest_list: longest(&octree.starts),
        });
    }
}

/// An octree, level by level.
#[derive(Default)]
struct Nodes {
    nodes: Vec<u32>,
    /// For each node its level, from the root's 0, and how many primitives reach into it.
    contents: Vec<(u32, u32)>,
    starts: Vec<u32>,
    slots: Vec<u32>,
    levels: u32,
}

impl Nodes {
    /// Builds an octree of at most `most_levels` levels over primitives that reach into ranges of the finest cells.
    fn build(ranges: &[Range], most_levels: u32) -> Self {
        let mut octree = Self::default();
        octree.starts.push(0);
        if ranges.is_empty() {
            return octree;
        }
        let all: Vec<u32> = (0..ranges.len() as u32).collect();
        let mut level = vec![([0; 3], all)];
        let mut size = 1 << most_levels;
        let mut depth = 0;
        while !level.is_empty() {
            let mut below = Vec::new();
            let next_level = octree.nodes.len() + level.len();
            for (corner, slots) in level {
                octree.contents.push((depth, slots.len() as u32));
                let word = if slots.is_empty() {
                    OctreeNode::EMPTY.0
                } else if slots.len() <= FEW || size == 1 {
                    octree.add_list(&slots).0
                } else {
                    let first = next_level + below.len();
                    below.extend(split(corner, size / 2, &slots, ranges));
                    first as u32
                };
                octree.nodes.push(word);
            }
            octree.levels += u32::from(!below.is_empty());
            level = below;
            size /= 2;
            depth += 1;
        }
        octree
    }

    fn add_list(&mut self, slots: &[u32]) -> OctreeNode {
        self.slots.extend(slots);
        self.starts.push(self.slots.len() as u32);
        OctreeNode::leaf(self.starts.len() as u32 - 2)
    }

    /// The first child of an inner node.
    fn first_child(&self, node: usize) -> Option<usize> {
        let word = self.nodes[node];
        (word >> 31 == 0).then_some(word as usize)
    }

    /// Tests per ray, where the share of rays that visit a node depends on its level.
    fn tests(&self, share: impl Fn(u32) -> f64) -> f64 {
        let leaves = (0..self.nodes.len()).filter(|&node| self.first_child(node).is_none());
        let tests = leaves.map(|leaf| {
            let (level, primitives) = self.contents[leaf];
            share(level) * f64::from(primitives)
        });
        tests.sum()
    }

    /// Returns the octree with leaves in place of nodes in whose children rays test no fewer primitives than in the
    /// node.
    fn without_worthless_splits(&self, share: impl Fn(u32) -> f64) -> Self {
        let mut tests: Vec<f64> = self
            .contents
            .iter()
            .map(|&(level, primitives)| share(level) * f64::from(primitives))
            .collect();
        let mut is_split = vec![false; self.nodes.len()];
        // Children follow their parents.
        for node in (0..self.nodes.len()).rev() {
            let Some(first) = self.first_child(node) else {
                continue;
            };
            let below: f64 = tests[first..first + 8].iter().sum();
            is_split[node] = below < tests[node];
            tests[node] = tests[node].min(below);
        }
        let mut octree = Self::default();
        octree.starts.push(0);
        let mut level = vec![0];
        while !level.is_empty() {
            let mut below = Vec::new();
            let next_level = octree.nodes.len() + level.len();
            for node in level {
                octree.contents.push(self.contents[node]);
                let word = match self.first_child(node) {
                    Some(first) if is_split[node] => {
                        let word = next_level + below.len();
                        below.extend(first..first + 8);
                        word as u32
                    }
                    _ if self.contents[node].1 == 0 => OctreeNode::EMPTY.0,
                    _ => octree.add_list(&self.slots_below(node)).0,
                };
                octree.nodes.push(word);
            }
            octree.levels += u32::from(!below.is_empty());
            level = below;
        }
        octree
    }

    /// The slots of all primitives that reach into a node, ascending.
    fn slots_below(&self, node: usize) -> Vec<u32> {
        let mut slots = Vec::new();
        let mut nodes = vec![node];
        while let Some(node) = nodes.pop() {
            if let Some(first) = self.first_child(node) {
                nodes.extend(first..first + 8);
            } else if self.nodes[node] != OctreeNode::EMPTY.0 {
                let list = (self.nodes[node] & !(1 << 31)) as usize;
                slots.extend(
                    &self.slots[self.starts[list] as usize..self.starts[list + 1] as usize],
                );
            }
        }
        slots.sort_unstable();
        slots.dedup();
        slots
    }

    fn sections(&self) -> Vec<Section> {
        let some = !self.nodes.is_empty();
        let starts = if some { &self.starts[..] } else { &[] };
        vec![
            section(SectionKind::OctreeNodes, &self.nodes),
            indices(SectionKind::OctreeStarts, starts, 1),
            indices(SectionKind::OctreeSlots, &self.slots, 1),
        ]
    }
}

/// The eight children of a node: their corners, and what reaches into them.
fn split(
    corner: [u32; 3],
    half: u32,
    slots: &[u32],
    ranges: &[Range],
) -> [([u32; 3], Vec<u32>); 8] {
    std::array::from_fn(|sides| {
        let corner = [0, 1, 2].map(|axis: usize| corner[axis] + half * (sides as u32 >> axis & 1));
        let reaches = |slot: &&u32| {
            let range = &ranges[**slot as usize];
            let sides = range.iter().zip(corner);
            sides
                .into_iter()
                .all(|([first, last], corner)| *first < corner + half && *last >= corner)
        };
        (corner, slots.iter().filter(reaches).copied().collect())
    })
}
