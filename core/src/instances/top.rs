//! The top level: it finds the instances that a ray can hit.

use crate::accel::Number;
use crate::accel::cull::{Culling, PairCulling};
use crate::format::instance::Instance;
use crate::format::limits::MAX_INSTANCE_LEVELS;
use crate::format::link::Node;
use crate::format::record::Pair;
use crate::observe::count::Observer;
use crate::observe::event::{Event, NodeId};
use crate::ray::Ray;
use heapless::Vec;

/// Instances, and the hierarchy above them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Top<'a> {
    pub(crate) instances: &'a [Instance],
    /// One fewer than instances; none above one instance.
    pub(crate) pairs: &'a [Pair],
}

/// A node as observers know it.
fn id(node: Node) -> NodeId {
    let what = match node.is_leaf() {
        true => NodeId::INSTANCE,
        false => NodeId::INSTANCE_PAIR,
    };
    NodeId {
        what,
        number: node.number(),
    }
}

impl Top<'_> {
    /// Returns true if there are neither instances nor pairs.
    pub(crate) fn is_empty(&self) -> bool {
        self.instances.is_empty() && self.pairs.is_empty()
    }

    /// The first node.
    #[inline(always)]
    pub(crate) fn root(&self) -> Node {
        if self.pairs.is_empty() {
            Node::leaf(0)
        } else {
            Node::pair(0)
        }
    }

    /// Calls `visit` for every instance whose box the ray can hit, the nearer child of a pair first. `visit` returns
    /// the t beyond which hits are ignored, or `None` to end the walk.
    ///
    /// A waiting child takes a word: its pair's number, and its number in the pair. So its box is tested again when its
    /// turn comes. A single instance is visited without a test, because the part's box is tested anyway.
    #[inline(always)]
    pub(crate) fn walk<N: Number, C: Observer>(
        &self,
        ray: &Ray<N>,
        tmax: N,
        count: &mut C,
        mut visit: impl FnMut(u32, &Instance, &mut C) -> Option<N>,
    ) {
        if let [instance] = self.instances {
            visit(0, instance, count);
            return;
        }
        let cull = N::Cull::new(ray);
        let mut limit = <N::Cull as PairCulling<N>>::limit(tmax);
        let mut waiting: Vec<u32, MAX_INSTANCE_LEVELS> = Vec::new();
        // The number of the pair, and the children to enter.
        let (mut number, mut wanted) = (0, [true; 2]);
        loop {
            let Some(pair) = self.pairs.get(number as usize) else {
                return;
            };
            let [left, right] = cull.children(pair, limit);
            count.planes(12);
            count.boxes(2);
            if C::ENABLED {
                if wanted == [true; 2] {
                    count.event(Event::Opened(id(Node::pair(number))));
                }
                let of_child = |child: usize| pair.child_box(child).0.map(|axis| axis.map(Some));
                for (child, interval) in [left, right].into_iter().enumerate() {
                    if wanted[child & 1] {
                        count.event(Event::Tested {
                            node: id(Node(pair.children[child & 1])),
                            sides: of_child(child),
                            span: [interval.near, interval.far].map(<N::Cull as Culling<N>>::units),
                        });
                    }
                }
            }
            let meets_left = wanted[0] && left.near <= left.far;
            let meets_right = wanted[1] && right.near <= right.far;
            let right_first = meets_right && (!meets_left || right.near < left.near);
            let other = number << 1 | u32::from(!right_first);
            if meets_left && meets_right && waiting.push(other).is_err() {
                return;
            }
            if meets_left || meets_right {
                let node = Node(pair.children[usize::from(right_first)]);
                if !node.is_leaf() {
                    (number, wanted) = (node.number(), [true; 2]);
                    continue;
                }
                let Some(instance) = self.instances.get(node.number() as usize) else {
                    return;
                };
                if C::ENABLED {
                    count.event(Event::Opened(id(node)));
                }
                let Some(tmax) = visit(node.number(), instance, count) else {
                    return;
                };
                limit = <N::Cull as PairCulling<N>>::limit(tmax);
            }
            let Some(next) = waiting.pop() else { return };
            number = next >> 1;
            wanted = [next & 1 == 0, next & 1 != 0];
        }
    }
}
