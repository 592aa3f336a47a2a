//! Hierarchies of pairs: their walk, and their part of the check.

use crate::accel::cull::{Culling, PairCulling};
use crate::accel::cull_axis::Interval;
use crate::accel::hierarchy::check::{Path, Tree, check_tree};
use crate::accel::hierarchy::order::Order;
use crate::accel::number::Number;
use crate::accel::records::Records;
use crate::accel::scene_geometry::SceneGeometry;
use crate::accel::stack::{Entry, StackView, pop};
use crate::format::layout::Stored;
use crate::format::link::Node;
use crate::format::record::UnitBox;
use crate::format::{BlobError, Leaf, Reason, SectionKind, Sections};
use crate::observe::count::Observer;
use crate::observe::event::{Event, NodeId, Sides};

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

    /// The planes that are tested for the left and the right child, as far as they are planes of
    /// boxes.
    fn sides(&self) -> [Sides; 2] {
        [Sides::default(); 2]
    }

    /// The test of a child, as events report it.
    fn tested(&self, number: u32, side: u32, span: [f64; 2]) -> Event {
        Event::Tested {
            node: self.child(number, side).id(),
            sides: self.sides()[(side & 1) as usize],
            span,
        }
    }
}

/// A record of two children that are boxes.
pub(in crate::accel) trait BoxPair: bytemuck::Pod + Stored {
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
    /// The record of a pair.
    type Pair: PairRecord;
    /// The volume around everything below a pair: see [`Tree`].
    type Volume: Copy;

    /// Number of pairs.
    fn len(self) -> usize;

    /// Returns a pair by its number.
    fn pair(self, number: usize) -> Option<Self::Pair>;

    /// The volumes of a pair's children, given the pair's own.
    fn volumes(self, pair: Self::Pair, parent: &Self::Volume) -> [Self::Volume; 2];

    /// Returns true if a child's volume lies in its parent's, where a walk relies on that.
    fn child_inside(self, _child: &Self::Volume, _parent: &Self::Volume) -> bool {
        true
    }

    /// See [`Tree::contains_leaf`].
    fn contains_leaf(
        self,
        geometry: &SceneGeometry<'_>,
        leaf: Leaf,
        volume: &Self::Volume,
        path: &Path,
    ) -> bool;
}

impl<A: PairArray> Tree for A {
    const SECTION: SectionKind = A::Pair::SECTION;
    type Volume = A::Volume;

    /// Proves that there are as many pairs as the leaves require, in breadth-first order.
    fn order(self, leaves: usize) -> Result<usize, BlobError> {
        let expected = leaves.saturating_sub(1);
        if self.len() != expected {
            return Err(BlobError::Count {
                section: Self::SECTION,
                found: self.len(),
                expected,
            });
        }
        let mut order = Order::new(Self::SECTION, self.len());
        for index in 0..self.len() {
            let Some(pair) = self.pair(index) else {
                break;
            };
            order.pair([0, 1].map(|side| pair.child(index as u32, side)))?;
        }
        order.levels()
    }

    /// The first pair, or the only leaf.
    #[inline(always)]
    fn root(self) -> Node {
        if self.len() == 0 {
            Node::leaf(0)
        } else {
            Node::pair(0)
        }
    }

    fn leaf(self, node: Node) -> Option<u32> {
        node.is_leaf().then_some(node.number())
    }

    fn child(self, number: u32, side: u32) -> Node {
        let pair = self.pair(number as usize);
        // Its existence is proved.
        pair.map_or(Node::leaf(u32::MAX), |pair| pair.child(number, side))
    }

    fn enter_child(self, number: u32, side: u32, volume: &mut Self::Volume) {
        if let Some(pair) = self.pair(number as usize) {
            *volume = self.volumes(pair, volume)[(side & 1) as usize];
        }
    }

    fn children_inside(self, number: u32, parent: &Self::Volume) -> Result<(), Reason> {
        let Some(pair) = self.pair(number as usize) else {
            return Ok(());
        };
        let children = self.volumes(pair, parent);
        for (child, reason) in children
            .iter()
            .zip([Reason::LeftOutside, Reason::RightOutside])
        {
            if !PairArray::child_inside(self, child, parent) {
                return Err(reason);
            }
        }
        Ok(())
    }

    fn contains_leaf(
        self,
        geometry: &SceneGeometry<'_>,
        leaf: Leaf,
        _: Node,
        volume: &Self::Volume,
        path: &Path,
    ) -> bool {
        PairArray::contains_leaf(self, geometry, leaf, volume, path)
    }
}

/// The pairs of a hierarchy of boxes.
#[derive(Clone, Copy, Debug)]
pub struct Pairs<'a, P>(pub(in crate::accel) &'a [P]);

impl<'a, P: BoxPair> PairArray for Pairs<'a, P> {
    type Pair = &'a P;
    type Volume = UnitBox;

    fn len(self) -> usize {
        self.0.len()
    }

    #[inline(always)]
    fn pair(self, number: usize) -> Option<&'a P> {
        self.0.get(number)
    }

    fn volumes(self, pair: &'a P, parent: &UnitBox) -> [UnitBox; 2] {
        pair.boxes(parent)
    }

    fn child_inside(self, child: &UnitBox, parent: &UnitBox) -> bool {
        parent.contains(child)
    }

    fn contains_leaf(
        self,
        geometry: &SceneGeometry<'_>,
        leaf: Leaf,
        volume: &UnitBox,
        _: &Path,
    ) -> bool {
        geometry.shapes.leaf_inside(leaf, volume)
    }
}

impl<'a, P: BoxPair> Records<'a> for Pairs<'a, P> {
    const SECTIONS: &'static [SectionKind] = &[P::SECTION];
    const USES_LEAVES: bool = true;

    fn read(sections: &Sections<'a>) -> Result<Self, BlobError> {
        Ok(Self(sections.records(P::SECTION)?))
    }

    fn check(&self, geometry: &SceneGeometry<'a>) -> Result<usize, BlobError> {
        check_tree(*self, geometry, geometry.bounds())
    }
}

/// The part of a ray in a walk through a hierarchy.
pub(in crate::accel) struct Walk<'w, 'a, A, R, F> {
    pub(in crate::accel) geometry: &'w SceneGeometry<'a>,
    pub(in crate::accel) pairs: A,
    /// The scene's interval, given the limit.
    pub(in crate::accel) root: R,
    /// Planes that are tested for it.
    pub(in crate::accel) root_planes: u32,
    /// The children's intervals, given the pair, their parent's and the limit.
    pub(in crate::accel) narrow: F,
}

/// The first and the last place in units, as events report them.
fn span<N: Number, K: Culling<N>>(interval: Interval) -> [f64; 2] {
    [interval.near, interval.far].map(K::units)
}

impl<A, R, F> Walk<'_, '_, A, R, F>
where
    A: PairArray,
    R: Fn(i32) -> Interval,
    F: Fn(A::Pair, Interval, i32) -> [Interval; 2],
{
    /// Visits the leaves whose boxes the ray can hit, the nearer child first. Intervals are those
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
                node: self.pairs.root().id(),
                sides: self.geometry.bounds().0.map(|axis| axis.map(Some)),
                span: span::<N, K>(interval),
            });
        }
        if interval.near <= interval.far {
            self.descend::<N, K, C>(self.pairs.root(), interval, limit, stack, count, leaf);
        }
    }

    /// Walks from a node whose box is not tested. For records whose children do not depend on their
    /// parent's interval.
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

    #[expect(clippy::too_many_arguments, reason = "its arguments stay in registers")]
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
                let Some(range) = self.geometry.leaf(node.number()) else {
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
            let next = pop(stack, limit, count, |entry| {
                (Node(entry.node).id(), K::units(entry.near))
            });
            let Some(entry) = next else { return };
            node = Node(entry.node);
            interval = Interval {
                near: entry.near,
                far: entry.far.min(limit),
            };
        }
    }
}
