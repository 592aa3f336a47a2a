//! What hierarchies of pairs share: the walk, and the proof that it is sound.

use crate::accel::cull::{Culling, PairCulling};
use crate::accel::cull_axis::Interval;
use crate::accel::hierarchy::order::Order;
use crate::accel::number::Number;
use crate::accel::records::Records;
use crate::accel::space::Space;
use crate::accel::stack::{Entry, StackView};
use crate::format::limits::MAX_LEVELS;
use crate::format::link::Node;
use crate::format::record::UnitBox;
use crate::format::{BlobError, Leaf, SectionKind, Sections};
use crate::geometry::Shapes;
use crate::observe::count::Observer;
use crate::observe::event::{Event, NodeId, Sides};
use heapless::Vec;

impl Node {
    /// The node as observers know it.
    pub(in crate::accel) const fn id(self) -> NodeId {
        NodeId {
            what: if self.is_leaf() { "leaf" } else { "pair" },
            number: self.number(),
        }
    }
}

/// A record of two children.
pub(in crate::accel) trait PairRecord: Copy {
    /// The section that holds these records.
    const SECTION: SectionKind;

    /// Planes that are tested for this record.
    fn planes(&self) -> u32;

    /// The left (0) or right (1) child of this record, whose number is given.
    fn child(&self, number: u32, side: u32) -> Node;

    /// The planes that are tested for the left and the right child, as far as they are boxes'.
    fn sides(&self) -> [Sides; 2] {
        [Sides::default(); 2]
    }

    /// The test of a child, as events tell it.
    fn tested(&self, number: u32, side: u32, span: [f64; 2]) -> Event {
        Event::Tested {
            place: self.child(number, side).id(),
            sides: self.sides()[(side & 1) as usize],
            span,
        }
    }
}

/// A record of two children that are boxes.
pub(in crate::accel) trait BoxPair: bytemuck::Pod {
    /// The section that holds these records.
    const SECTION: SectionKind;
    /// Planes that are tested for a record.
    const PLANES: u32;

    /// The left (0) or right (1) child of this record, whose number is given.
    fn child(&self, number: u32, side: u32) -> Node;

    /// The planes that are tested for the left and the right child.
    fn sides(&self) -> [Sides; 2];

    /// The children's boxes, given their parent's.
    fn boxes(&self, parent: &UnitBox) -> [UnitBox; 2];
}

impl<P: BoxPair> PairRecord for &P {
    const SECTION: SectionKind = P::SECTION;

    #[inline(always)]
    fn planes(&self) -> u32 {
        P::PLANES
    }

    #[inline(always)]
    fn child(&self, number: u32, side: u32) -> Node {
        P::child(self, number, side)
    }

    fn sides(&self) -> [Sides; 2] {
        P::sides(self)
    }
}

/// The pairs of a hierarchy, by number.
pub(in crate::accel) trait PairArray: Copy {
    /// One of them.
    type Pair: PairRecord;

    /// How many there are.
    fn len(self) -> usize;

    /// One of them.
    fn pair(self, number: usize) -> Option<Self::Pair>;
}

/// The pairs of a hierarchy of boxes.
#[derive(Clone, Copy, Debug)]
pub struct Pairs<'a, P>(pub(in crate::accel) &'a [P]);

impl<'a, P: BoxPair> PairArray for Pairs<'a, P> {
    type Pair = &'a P;

    fn len(self) -> usize {
        self.0.len()
    }

    #[inline(always)]
    fn pair(self, number: usize) -> Option<&'a P> {
        self.0.get(number)
    }
}

impl<'a, P: BoxPair> Records<'a> for Pairs<'a, P> {
    const SECTIONS: &'static [SectionKind] = &[P::SECTION];
    const USES_LEAVES: bool = true;

    fn read(sections: &Sections<'a>) -> Result<Self, BlobError> {
        Ok(Self(sections.records(P::SECTION)?))
    }

    fn check(&self, space: &Space<'a>) -> Result<usize, BlobError> {
        check_pairs(*self, space.leaves, &space.shapes, space.bounds())
    }
}

/// A walk through a hierarchy: what the ray brings to it.
pub(in crate::accel) struct Walk<'w, 'a, A, R, F> {
    pub(in crate::accel) space: &'w Space<'a>,
    pub(in crate::accel) pairs: A,
    /// The scene's interval, given the limit.
    pub(in crate::accel) root: R,
    /// Planes that are tested for it.
    pub(in crate::accel) root_planes: u32,
    /// The children's intervals, given the pair, their parent's and the limit.
    pub(in crate::accel) narrow: F,
}

/// From where to where in units, as events tell it.
fn span<N: Number, K: Culling<N>>(interval: Interval) -> [f64; 2] {
    [interval.near, interval.far].map(K::units)
}

impl<A, R, F> Walk<'_, '_, A, R, F>
where
    A: PairArray,
    R: Fn(i32) -> Interval,
    F: Fn(A::Pair, Interval, i32) -> [Interval; 2],
{
    /// Visits the leaves whose boxes the ray can meet, the nearer child first. Intervals are those
    /// of a culling form.
    #[inline(always)]
    pub(in crate::accel) fn run<N: Number, K: PairCulling<N>, C: Observer>(
        &self,
        tmax: N,
        stack: &mut StackView,
        count: &mut C,
        leaf: impl FnMut(Leaf, &mut C) -> Option<N>,
    ) {
        count.planes(self.root_planes);
        count.boxes(1);
        let limit = K::limit(tmax);
        let interval = (self.root)(limit);
        if C::ENABLED {
            count.event(Event::Tested {
                place: root(self.pairs).id(),
                sides: self.space.bounds().0.map(|axis| axis.map(Some)),
                span: span::<N, K>(interval),
            });
        }
        if interval.near <= interval.far {
            self.descend::<N, K, C>(root(self.pairs), interval, limit, stack, count, leaf);
        }
    }

    /// The same from a node on, whose box is not tested. For records whose children do not depend on
    /// their parent's interval.
    #[inline(always)]
    pub(in crate::accel) fn enter<N: Number, K: PairCulling<N>, C: Observer>(
        &self,
        node: Node,
        tmax: N,
        stack: &mut StackView,
        count: &mut C,
        leaf: impl FnMut(Leaf, &mut C) -> Option<N>,
    ) {
        let limit = K::limit(tmax);
        let interval = Interval {
            near: 0,
            far: limit,
        };
        self.descend::<N, K, C>(node, interval, limit, stack, count, leaf);
    }

    #[inline(always)]
    fn descend<N: Number, K: PairCulling<N>, C: Observer>(
        &self,
        mut node: Node,
        mut interval: Interval,
        mut limit: i32,
        stack: &mut StackView,
        count: &mut C,
        mut leaf: impl FnMut(Leaf, &mut C) -> Option<N>,
    ) {
        stack.clear();
        loop {
            if C::ENABLED {
                count.event(Event::Opened(node.id()));
            }
            if node.is_leaf() {
                let Some(range) = self.space.leaf(node.number()) else {
                    return;
                };
                let Some(tmax) = leaf(range, count) else {
                    return;
                };
                limit = K::limit(tmax);
            } else {
                let Some(pair) = self.pairs.pair(node.number() as usize) else {
                    return;
                };
                let [left, right] = (self.narrow)(pair, interval, limit);
                count.planes(pair.planes());
                count.boxes(2);
                let number = node.number();
                if C::ENABLED {
                    count.event(pair.tested(number, 0, span::<N, K>(left)));
                }
                if C::ENABLED {
                    count.event(pair.tested(number, 1, span::<N, K>(right)));
                }
                let meets_left = left.near <= left.far;
                let meets_right = right.near <= right.far;
                if meets_left && meets_right {
                    let right_first = right.near < left.near;
                    let (first, second) = if right_first {
                        (right, left)
                    } else {
                        (left, right)
                    };
                    let later = Entry {
                        node: pair.child(number, u32::from(!right_first)).0,
                        near: second.near,
                        far: second.far,
                    };
                    if stack.push(later).is_err() {
                        return;
                    }
                    node = pair.child(number, u32::from(right_first));
                    interval = first;
                    continue;
                } else if meets_left {
                    (interval, node) = (left, pair.child(number, 0));
                    continue;
                } else if meets_right {
                    (interval, node) = (right, pair.child(number, 1));
                    continue;
                }
            }
            loop {
                let Some(entry) = stack.pop() else { return };
                if entry.near <= limit {
                    node = Node(entry.node);
                    interval = Interval {
                        near: entry.near,
                        far: entry.far.min(limit),
                    };
                    break;
                }
                if C::ENABLED {
                    count.event(Event::GivenUp {
                        place: Node(entry.node).id(),
                        enters: K::units(entry.near),
                    });
                }
            }
        }
    }
}

/// The root of a hierarchy: its first pair, or its only leaf.
fn root(pairs: impl PairArray) -> Node {
    if pairs.len() == 0 {
        Node::leaf(0)
    } else {
        Node::pair(0)
    }
}

/// Proves a hierarchy: pairs in breadth-first order (so that children come after their parents and
/// every node is reached once), boxes inside their parents', primitives inside their leaves, and
/// every leaf used. Returns the stack that a walk needs.
///
/// Costs the depth of each leaf, and [`MAX_LEVELS`] words of stack.
#[inline(never)]
fn check_pairs<P: BoxPair>(
    array: Pairs<'_, P>,
    leaves: &[u32],
    shapes: &Shapes<'_>,
    bounds: &UnitBox,
) -> Result<usize, BlobError> {
    let section = P::SECTION;
    let pairs = array.0;
    let depth = check_order(array, leaves.len())?;
    if leaves.is_empty() {
        return Ok(depth);
    }

    // The pairs above the current node: twice their number, and 1 where it is the right child's.
    let mut path: Vec<u32, MAX_LEVELS> = Vec::new();
    let (mut node, mut parent) = (root(array), *bounds);
    loop {
        let number = node.number() as usize;
        if node.is_leaf() {
            let leaf = leaves.get(number).and_then(|&word| Leaf::from_word(word));
            let inside = leaf.is_some_and(|leaf| shapes.leaf_inside(leaf, &parent));
            if !inside {
                return Err(BlobError::Record {
                    section: SectionKind::Leaves,
                    index: number,
                    what: "leaf, or a primitive of it, lies outside its box: excess",
                    found: 1,
                    expected: 0,
                });
            }
        } else if let Some(pair) = pairs.get(number) {
            let [left, right] = pair.boxes(&parent);
            for (child, bounds) in [left, right].iter().enumerate() {
                if !parent.contains(bounds) {
                    return Err(BlobError::Record {
                        section,
                        index: number,
                        what: "box lies outside its parent's: the number of the child",
                        found: child as i64,
                        expected: -1,
                    });
                }
            }
            // The depth was proved to fit.
            let _ = path.push(node.number() << 1);
            (node, parent) = (pair.child(node.number(), 0), left);
            continue;
        }
        while path.last().is_some_and(|step| step & 1 == 1) {
            path.pop();
        }
        let Some(step) = path.last_mut() else {
            return Ok(depth);
        };
        *step |= 1;
        // Boxes on the way are computed again, which takes less room than to keep them.
        parent = *bounds;
        for &step in &path {
            if let Some(pair) = pairs.get((step >> 1) as usize) {
                let side = step & 1;
                node = pair.child(step >> 1, side);
                parent = pair.boxes(&parent)[(side & 1) as usize];
            }
        }
    }
}

/// Proves a hierarchy of volumes other than boxes in the same way: volumes as `children` asks, and
/// primitives in their leaves as `holds` asks. Returns the stack that a walk needs.
///
/// `children` gives the volumes of a pair's children from their parent's, or the number of a child
/// that is not as it must be; `holds` is given a leaf and the volumes from the root to it.
///
/// Linear in pairs and primitives. Takes a volume and 8 bytes of stack for each of
/// [`MAX_LEVELS`] levels.
#[inline(never)]
pub(in crate::accel) fn check_tree<A: PairArray, V>(
    pairs: A,
    leaves: &[u32],
    root_volume: V,
    children: impl Fn(&A::Pair, &V) -> Result<[V; 2], usize>,
    holds: impl Fn(Leaf, &[V]) -> bool,
) -> Result<usize, BlobError> {
    let section = A::Pair::SECTION;
    let depth = check_order(pairs, leaves.len())?;
    if leaves.is_empty() {
        return Ok(depth);
    }

    let mut path: Vec<V, { MAX_LEVELS + 1 }> = Vec::new();
    // Pairs whose right child waits, and the length of the path to them. All pushes fit: the depth
    // was proved.
    let mut waiting: Vec<(usize, usize), MAX_LEVELS> = Vec::new();
    let mut node = root(pairs);
    let _ = path.push(root_volume);
    loop {
        let number = node.number() as usize;
        if node.is_leaf() {
            let leaf = leaves.get(number).and_then(|&word| Leaf::from_word(word));
            if !leaf.is_some_and(|leaf| holds(leaf, &path)) {
                return Err(BlobError::Record {
                    section: SectionKind::Leaves,
                    index: number,
                    what: "leaf, or a primitive of it, lies outside its box: excess",
                    found: 1,
                    expected: 0,
                });
            }
        } else if let (Some(pair), Some(parent)) = (pairs.pair(number), path.last()) {
            let [left, _] = children(&pair, parent).map_err(|child| BlobError::Record {
                section,
                index: number,
                what: "box lies outside its parent's: the number of the child",
                found: child as i64,
                expected: -1,
            })?;
            let _ = waiting.push((number, path.len()));
            let _ = path.push(left);
            node = pair.child(number as u32, 0);
            continue;
        }
        let Some((number, length)) = waiting.pop() else {
            return Ok(depth);
        };
        path.truncate(length);
        if let (Some(pair), Some(parent)) = (pairs.pair(number), path.last()) {
            if let Ok([_, right]) = children(&pair, parent) {
                let _ = path.push(right);
            }
            node = pair.child(number as u32, 1);
        }
    }
}

/// Proves that there are as many pairs as the leaves call for, in breadth-first order, and returns
/// the number of levels of pairs.
fn check_order<A: PairArray>(pairs: A, leaves: usize) -> Result<usize, BlobError> {
    let section = A::Pair::SECTION;
    let expected = leaves.saturating_sub(1);
    if pairs.len() != expected {
        return Err(BlobError::Count {
            section,
            found: pairs.len(),
            expected,
        });
    }
    let mut order = Order::new(section, pairs.len());
    for index in 0..pairs.len() {
        let Some(pair) = pairs.pair(index) else {
            break;
        };
        order.pair([0, 1].map(|side| pair.child(index as u32, side)))?;
    }
    order.levels()
}
