//! Builds the bounding volume hierarchy: top down, by the surface area heuristic over bins.
//!
//! The heuristic is MacDonald and Booth's ("Heuristics for ray tracing using space subdivision",
//! 1990). Bins are Wald's ("On fast construction of SAH-based bounding volume hierarchies", 2007).
//! A node with few primitives is swept exactly instead.
//!
//! The builder always ends. A node is cut in two halves of equal count where all centroids are
//! equal, or where the remaining depth would otherwise not suffice. So the depth never exceeds
//! [`MAX_LEVELS`], and the time is at most `O(n log n)` per level.

use super::node::{Node, Primitive, area, union};
use gridel_core::Kind;
use gridel_core::format::Leaf;
use gridel_core::format::limits::MAX_LEVELS;
use gridel_core::format::record::UnitBox;

/// The cost of a step down the hierarchy; that of a triangle's test is 1.
pub const STEP_COST: f64 = 1.5;
/// Most primitives in a leaf, unless their boxes coincide.
pub const LEAF_SIZE: usize = 4;
/// Nodes with at most this many primitives are swept, others binned.
const SWEEP_SIZE: usize = 4096;
const BINS: usize = 32;
/// Least number of primitives whose two halves are built in parallel.
const PARALLEL_SIZE: usize = 4096;

/// The splits of a node that are tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Splits {
    /// All of them where there are few primitives, those between bins where there are many.
    Swept,
    /// Those between bins.
    Binned,
}

/// Builds a hierarchy and puts the primitives in the order of its leaves. `None` without primitives.
///
/// With `leaf_size` not 0, up to that many primitives of one kind make a leaf, whatever the cost.
/// The heuristic decides about more than that.
pub fn build(primitives: &mut [Primitive], splits: Splits, leaf_size: usize) -> Option<Node> {
    if primitives.is_empty() {
        return None;
    }
    // A leaf is reached after at most this many pairs.
    Some(build_node(primitives, 0, MAX_LEVELS, splits, leaf_size))
}

/// Returns the surface area heuristic's cost of a hierarchy, the root's area being 1.
pub fn sah_cost(root: &Node) -> f64 {
    fn sum(node: &Node) -> f64 {
        match node {
            Node::Leaf { bounds, tests, .. } => area(bounds) * tests,
            Node::Inner { bounds, children } => {
                area(bounds) * STEP_COST + sum(&children[0]) + sum(&children[1])
            }
        }
    }
    sum(root) / area(root.bounds()).max(1.0)
}

/// Levels that halving needs: as many as the count has bits, and below those kinds may
/// have to be separated.
pub fn halvings(count: usize) -> usize {
    usize::BITS as usize - count.leading_zeros() as usize + Kind::ALL.len()
}

/// Returns a hierarchy of halves of equal count over primitives that lie from `first` on.
pub fn build_halved(primitives: &mut [Primitive], first: usize, levels: usize) -> Node {
    let levels = levels.min(halvings(primitives.len()));
    build_node(primitives, first, levels, Splits::Binned, 0)
}

fn build_node(
    primitives: &mut [Primitive],
    first: usize,
    levels: usize,
    splits: Splits,
    leaf_size: usize,
) -> Node {
    let bounds = union(primitives);
    let count = primitives.len();
    let tests = primitives.iter().map(Primitive::test_cost).sum();
    let leaf = Node::Leaf {
        bounds,
        first,
        count,
        tests,
    };
    let one_kind = primitives.iter().all(|p| p.kind == primitives[0].kind);
    if count == 1 || one_kind && count <= leaf_size {
        return leaf;
    }
    let split = if levels <= halvings(count) {
        None
    } else {
        best_split(primitives, &bounds, splits)
    };
    let worth_it = split.as_ref().is_some_and(|split| split.cost < tests);
    if one_kind && count <= LEAF_SIZE && !worth_it {
        return leaf;
    }
    let middle = match split {
        Some(split) => split.apply(primitives),
        None if one_kind && same_box(primitives) && count <= Leaf::MAX_COUNT as usize => {
            return leaf;
        }
        None if !one_kind && same_box(primitives) => {
            // They differ in their kinds alone.
            primitives.sort_by_key(|p| p.kind);
            let kind = primitives[0].kind;
            primitives.partition_point(|p| p.kind == kind)
        }
        None => halve(primitives, &bounds),
    };
    let (left, right) = primitives.split_at_mut(middle);
    let build_left = |left| build_node(left, first, levels - 1, splits, leaf_size);
    let build_right = |right| build_node(right, first + middle, levels - 1, splits, leaf_size);
    let children = if count >= PARALLEL_SIZE {
        rayon::join(|| build_left(left), || build_right(right))
    } else {
        (build_left(left), build_right(right))
    };
    Node::Inner {
        bounds,
        children: Box::new([children.0, children.1]),
    }
}

/// A split: the primitives whose key is below a limit go left.
struct Split {
    cost: f64,
    axis: usize,
    /// Centroids below this (or, for a sweep, this many in order) go left.
    rule: Rule,
}

enum Rule {
    Below(i32),
    First(usize),
}

impl Split {
    fn apply(&self, primitives: &mut [Primitive]) -> usize {
        match self.rule {
            Rule::First(count) => {
                sort(primitives, self.axis);
                count
            }
            Rule::Below(limit) => partition(primitives, |p| p.centroid(self.axis) < limit),
        }
    }
}

/// The cheapest split, or `None` where no plane separates the centroids.
fn best_split(primitives: &mut [Primitive], bounds: &UnitBox, splits: Splits) -> Option<Split> {
    let scale = 1.0 / area(bounds).max(1.0);
    let swept = splits == Splits::Swept && primitives.len() <= SWEEP_SIZE;
    let best_of_axes = (0..3).filter_map(|axis| {
        let centroids = || primitives.iter().map(|p| p.centroid(axis));
        let (low, high) = (centroids().min()?, centroids().max()?);
        if low == high {
            return None;
        }
        if swept {
            sweep(primitives, axis, scale)
        } else {
            bin(primitives, axis, low, high, scale)
        }
    });
    best_of_axes.min_by(|a, b| a.cost.total_cmp(&b.cost))
}

/// Tries every split of the primitives in order of their centroids.
fn sweep(primitives: &[Primitive], axis: usize, scale: f64) -> Option<Split> {
    let mut ordered = primitives.to_vec();
    sort(&mut ordered, axis);
    let mut right_costs = vec![0.0; ordered.len()];
    let (mut right, mut tests) = (None, 0.0);
    for (place, primitive) in ordered.iter().enumerate().rev() {
        let bounds = grow(right, &primitive.bounds);
        (right, tests) = (Some(bounds), tests + primitive.test_cost());
        right_costs[place] = area(&bounds) * tests;
    }
    let (mut left, mut tests) = (None, 0.0);
    let costs = ordered.iter().enumerate().skip(1).map(|(place, _)| {
        let before = &ordered[place - 1];
        let bounds = grow(left, &before.bounds);
        (left, tests) = (Some(bounds), tests + before.test_cost());
        (area(&bounds) * tests + right_costs[place], place)
    });
    let (cost, place) = costs.min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(Split {
        cost: STEP_COST + cost * scale,
        axis,
        rule: Rule::First(place),
    })
}

/// Tries the limits of equal bins.
fn bin(primitives: &[Primitive], axis: usize, low: i32, high: i32, scale: f64) -> Option<Split> {
    let width = i64::from(high - low) + 1;
    let bin_of = |centroid: i32| (i64::from(centroid - low) * BINS as i64 / width) as usize;
    let mut bins: [Option<UnitBox>; BINS] = [None; BINS];
    let mut tests = [0.0; BINS];
    for primitive in primitives {
        let bin = bin_of(primitive.centroid(axis));
        bins[bin] = Some(grow(bins[bin], &primitive.bounds));
        tests[bin] += primitive.test_cost();
    }
    let mut rights = [(None, 0.0); BINS];
    let mut right = (None, 0.0);
    for place in (1..BINS).rev() {
        right = (join(right.0, bins[place]), right.1 + tests[place]);
        rights[place] = right;
    }
    let (mut left, mut left_tests, mut best) = (None, 0.0, None);
    for place in 1..BINS {
        left = join(left, bins[place - 1]);
        left_tests += tests[place - 1];
        let (Some(below), (Some(above), right_tests)) = (left, rights[place]) else {
            continue;
        };
        let cost = area(&below) * left_tests + area(&above) * right_tests;
        if best.is_none_or(|(least, _)| cost < least) {
            best = Some((cost, place));
        }
    }
    let (cost, place) = best?;
    // The least centroid of the bin: ceil(place * width / BINS) from the low end.
    let limit = low + ((place as i64 * width + BINS as i64 - 1) / BINS as i64) as i32;
    Some(Split {
        cost: STEP_COST + cost * scale,
        axis,
        rule: Rule::Below(limit),
    })
}

/// Cuts in two halves of equal count along the longest side.
fn halve(primitives: &mut [Primitive], bounds: &UnitBox) -> usize {
    let side = |axis: usize| i32::from(bounds.0[axis][1]) - i32::from(bounds.0[axis][0]);
    let axis = (0..3).max_by_key(|&axis| side(axis)).unwrap_or(0);
    sort(primitives, axis);
    primitives.len() / 2
}

/// Sorts by centroid; the index makes the order one and the same on every machine.
fn sort(primitives: &mut [Primitive], axis: usize) {
    primitives.sort_unstable_by_key(|p| (p.centroid(axis), p.index));
}

/// Moves what satisfies a condition to the front, keeping the order, and returns its count.
fn partition(primitives: &mut [Primitive], condition: impl Fn(&Primitive) -> bool) -> usize {
    let (front, back): (Vec<_>, Vec<_>) = primitives.iter().partition(|p| condition(p));
    primitives[..front.len()].copy_from_slice(&front);
    primitives[front.len()..].copy_from_slice(&back);
    front.len()
}

fn same_box(primitives: &[Primitive]) -> bool {
    primitives.iter().all(|p| p.bounds == primitives[0].bounds)
}

fn grow(bounds: Option<UnitBox>, other: &UnitBox) -> UnitBox {
    bounds.map_or(*other, |bounds| bounds.union(other))
}

fn join(a: Option<UnitBox>, b: Option<UnitBox>) -> Option<UnitBox> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.union(&b)),
        (a, b) => a.or(b),
    }
}
