//! The top level: which instances a ray can meet.

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

/// A node of the hierarchy as observers know it.
fn id(node: Node) -> NodeId {
    NodeId {
        what: if node.is_leaf() {
            "instance"
        } else {
            "pair of instances"
        },
        number: node.number(),
    }
}

impl Top<'_> {
    /// Calls `visit` for every instance whose box the ray can meet, the nearer child of a pair first. `visit` returns
    /// the t beyond which nothing counts any more, or `None` to end the walk.
    ///
    /// Nodes that wait take a word each, so their boxes are not known again: an instance's own box is tested when its
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
        let mut node = Node(0);
        loop {
            if node.is_leaf() {
                let Some(instance) = self.instances.get(node.number() as usize) else {
                    return;
                };
                count.planes(6);
                count.boxes(1);
                let span = cull.root(&instance.bounds, limit);
                if span.near <= span.far {
                    if C::ENABLED {
                        count.event(Event::Opened(id(node)));
                    }
                    let Some(tmax) = visit(node.number(), instance, count) else {
                        return;
                    };
                    limit = <N::Cull as PairCulling<N>>::limit(tmax);
                }
            } else {
                let Some(pair) = self.pairs.get(node.number() as usize) else {
                    return;
                };
                let [left, right] = cull.children(pair, limit);
                count.planes(12);
                count.boxes(2);
                let (meets_left, meets_right) = (left.near <= left.far, right.near <= right.far);
                let right_first = meets_right && (!meets_left || right.near < left.near);
                let child = |right: bool| Node(pair.children[usize::from(right)]);
                if meets_left && meets_right && waiting.push(child(!right_first).0).is_err() {
                    return;
                }
                if meets_left || meets_right {
                    node = child(right_first);
                    continue;
                }
            }
            let Some(next) = waiting.pop() else { return };
            node = Node(next);
        }
    }
}
