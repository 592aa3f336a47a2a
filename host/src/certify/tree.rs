//! A hierarchy of boxes, and rays that walk through it.
//!
//! Lengths are in steps of the storage lattice, 1/256 unit.

use super::number::Enclosure;
use gridel_core::format::record::UnitBox;

/// A box in lattice steps, low and high on every axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    pub low: [f64; 3],
    pub high: [f64; 3],
}

/// Margin of boxes around their contents, in steps: far more than the rounding of the walk.
const MARGIN: f64 = 1.0;

impl Bounds {
    pub(super) fn of(units: &UnitBox) -> Self {
        Self {
            low: units.0.map(|[low, _]| f64::from(low) * 256.0 - MARGIN),
            high: units.0.map(|[_, high]| f64::from(high) * 256.0 + MARGIN),
        }
    }

    pub(super) fn with(self, other: Self) -> Self {
        Self {
            low: [0, 1, 2].map(|k| self.low[k].min(other.low[k])),
            high: [0, 1, 2].map(|k| self.high[k].max(other.high[k])),
        }
    }
}

/// A hierarchy of boxes: halves along the longest side.
#[derive(Clone, Debug)]
pub struct Tree<Item> {
    nodes: Vec<Node>,
    items: Vec<Item>,
}

#[derive(Clone, Debug)]
struct Node {
    bounds: Bounds,
    /// The first child, or the first item.
    first: u32,
    /// The number of items; 0 for a node with two children side by side.
    count: u32,
}

/// Most items of a leaf.
const LEAF: usize = 2;

impl<Item> Default for Tree<Item> {
    fn default() -> Self {
        Self {
            nodes: Vec::new(),
            items: Vec::new(),
        }
    }
}

impl<Item: Copy> Tree<Item> {
    pub(super) fn of(mut boxes: Vec<(Bounds, Item)>) -> Self {
        let mut tree = Self::default();
        if boxes.is_empty() {
            return tree;
        }
        tree.nodes.push(Node {
            bounds: around(&boxes),
            first: 0,
            count: 0,
        });
        tree.split(0, &mut boxes);
        tree
    }

    fn split(&mut self, node: usize, boxes: &mut [(Bounds, Item)]) {
        if boxes.len() <= LEAF {
            self.nodes[node].first = self.items.len() as u32;
            self.nodes[node].count = boxes.len() as u32;
            self.items.extend(boxes.iter().map(|&(_, item)| item));
            return;
        }
        let middle = |it: &Bounds, k: usize| it.low[k] + it.high[k];
        let spread = |k: usize| {
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            for (it, _) in boxes.iter() {
                (low, high) = (low.min(middle(it, k)), high.max(middle(it, k)));
            }
            high - low
        };
        let spreads = [spread(0), spread(1), spread(2)];
        let axis = if spreads[0] >= spreads[1] && spreads[0] >= spreads[2] {
            0
        } else if spreads[1] >= spreads[2] {
            1
        } else {
            2
        };
        let half = boxes.len() / 2;
        boxes.select_nth_unstable_by(half, |(a, _), (b, _)| {
            middle(a, axis).total_cmp(&middle(b, axis))
        });
        let (left, right) = boxes.split_at_mut(half);
        let first = self.nodes.len();
        for side in [&*left, &*right] {
            self.nodes.push(Node {
                bounds: around(side),
                first: 0,
                count: 0,
            });
        }
        self.nodes[node].first = first as u32;
        self.split(first, left);
        self.split(first + 1, right);
    }

    /// Calls a function with every item whose box a ray may meet before an end. The function may move the end nearer.
    pub fn walk(&self, ray: &Slabs, mut end: f64, mut visit: impl FnMut(Item, f64) -> f64) {
        let mut stack = Vec::with_capacity(64);
        if let Some(root) = self.nodes.first()
            && let Some(near) = ray.enters(&root.bounds, end)
        {
            stack.push((0_u32, near));
        }
        while let Some((index, near)) = stack.pop() {
            if near > end {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.count > 0 {
                let first = node.first as usize;
                for &item in &self.items[first..first + node.count as usize] {
                    end = visit(item, end);
                }
                continue;
            }
            let child = |child: u32| {
                let near = ray.enters(&self.nodes[child as usize].bounds, end);
                near.map(|near| (child, near))
            };
            let (left, right) = (child(node.first), child(node.first + 1));
            match (left, right) {
                (Some(left), Some(right)) if left.1 <= right.1 => stack.extend([right, left]),
                (left, right) => stack.extend(left.into_iter().chain(right)),
            }
        }
    }
}

fn around<Item>(boxes: &[(Bounds, Item)]) -> Bounds {
    let first = boxes[0].0;
    boxes.iter().fold(first, |all, (it, _)| all.with(*it))
}

/// A ray for tests of boxes: floats that enclose its numbers.
#[derive(Clone, Copy, Debug)]
pub struct Slabs {
    origin: [[f64; 2]; 3],
    /// The inverse of the direction where that has a sign, which comes with it.
    inverse: [Option<[f64; 2]>; 3],
}

/// Upper bound of the rounding of one test of a box, relative to t.
const SLACK: f64 = 1e-14;

impl Slabs {
    pub fn of<N: Enclosure>(origin: [N; 3], direction: [N; 3]) -> Self {
        Self {
            origin: origin.map(N::bounds),
            inverse: direction.map(|x| {
                let [low, high] = x.bounds();
                (low > 0.0 || high < 0.0).then(|| [1.0 / high, 1.0 / low])
            }),
        }
    }

    /// Returns a lower bound of the distance at which the ray enters a box; `None` if it misses it, or enters it beyond
    /// the end.
    fn enters(&self, bounds: &Bounds, end: f64) -> Option<f64> {
        let (mut near, mut far) = (0.0_f64, end);
        for k in 0..3 {
            let Some([low, high]) = self.inverse[k] else {
                continue;
            };
            let [first, last] = self.origin[k];
            // Distances to the nearer side and to the farther one, at least and at most.
            let (to_near, to_far, low, high) = if low > 0.0 {
                (bounds.low[k] - last, bounds.high[k] - first, low, high)
            } else {
                (first - bounds.high[k], last - bounds.low[k], -high, -low)
            };
            let enter = to_near * if to_near >= 0.0 { low } else { high };
            let leave = to_far * if to_far >= 0.0 { high } else { low };
            near = near.max(enter - enter.abs() * SLACK);
            far = far.min(leave + leave.abs() * SLACK);
        }
        (near <= far).then_some(near)
    }
}
