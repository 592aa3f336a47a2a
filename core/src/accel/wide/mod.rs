//! The eight-wide hierarchy, for hosts: nodes of eight children, leaves of one cluster.
//!
//! A node is 128 bytes. It holds the children's planes on the box lattice in rows of eight ([`WideNode`]), and a word
//! for each child. So one instruction of a machine with SIMD registers tests a side of eight (or four) children. A leaf
//! is one [cluster](crate::format::cluster), tested in eight lanes too, or a single primitive of the kinds that have no
//! clusters.
//!
//! The answers are the list's, bit for bit. Culling is conservative, lane by lane (see `cull`). A primitive that a
//! cluster's lanes do not reject is tested by the scalar code of all structures. Or the lanes have already made the
//! operations of that code. Children that the ray hits are pushed in no order, but the nearest is visited at once,
//! because sorting costs more than it saves. An any-hit query visits children in stored order, and those of a node wait
//! in one entry.

mod check;
pub(crate) mod cull;

pub(super) use check::check_records;

use crate::accel::cull::Culling;
use crate::accel::number::Number;
use crate::accel::records::Records;
use crate::accel::scene_geometry::SceneGeometry;
use crate::accel::stack::{Entry, StackView, pop};
use crate::accel::traverse::Traverse;
use crate::format::cluster::LANES;
use crate::format::record::WideNode;
use crate::format::{BlobError, Child, Kind, Leaf, SectionKind, Sections, Structure};
use crate::number::Format;
use crate::observe::count::Observer;
use crate::observe::event::{Event, NodeId};
use crate::ray::Ray;
use crate::simd::{Simd, SimdLevel, with_simd};
use cull::WideCulling;

/// The hierarchy of eight children per node, for machines with SIMD registers.
#[derive(Clone, Copy, Debug)]
pub enum Wide {}

impl Child {
    /// The child as observers know it.
    fn id(self) -> NodeId {
        let (what, number) = match (self.as_node(), Leaf::from_word(self.0)) {
            (Some(number), _) => ("node", number),
            (None, Some(leaf)) if leaf.count > 0 => (leaf.kind.name(), leaf.first),
            (None, Some(leaf)) if leaf.kind == Kind::Triangle => ("strip", leaf.first),
            (None, leaf) => ("pack", leaf.map_or(0, |leaf| leaf.first)),
        };
        NodeId { what, number }
    }
}

/// The nodes of a scene.
#[derive(Clone, Copy, Debug)]
pub struct Views<'a> {
    nodes: &'a [WideNode],
}

impl<'a> Records<'a> for Views<'a> {
    const SECTIONS: &'static [SectionKind] = &[
        SectionKind::WideNodes,
        SectionKind::Strips,
        SectionKind::Packs,
        SectionKind::Members,
        SectionKind::SlotLocations,
        SectionKind::Radii,
    ];
    const USES_LEAVES: bool = false;

    fn read(sections: &Sections<'a>) -> Result<Self, BlobError> {
        Ok(Self {
            nodes: sections.records(SectionKind::WideNodes)?,
        })
    }

    fn check(&self, geometry: &SceneGeometry<'a>) -> Result<usize, BlobError> {
        check::check(self.nodes, geometry)
    }
}

impl Traverse for Wide {
    const STRUCTURE: Structure = Structure::Wide;
    type Views<'a> = Views<'a>;
    const HAS_CLUSTERS: bool = true;
    type Cull<N: Number> = N::WideCull;

    #[inline(always)]
    fn walk<N: Number, C: Observer>(
        geometry: &SceneGeometry<'_>,
        views: &Self::Views<'_>,
        ray: &Ray<N>,
        cull: &N::WideCull,
        stack: &mut StackView,
        count: &mut C,
        mut leaf: impl FnMut(Leaf, &mut C) -> Option<N>,
    ) {
        let nodes = views.nodes;
        let level = level::<N>(geometry);
        let mut limit = N::WideCull::limit(ray.tmax);
        let mut current = Child::node(0);
        stack.clear();
        loop {
            if current.as_node().is_some() {
                let arguments = (nodes, cull, (current, limit), &mut *stack, &mut *count);
                current = with_simd!(level, |simd| simd.call(descend::<_, N, C>, arguments));
            }
            if current == Child::NONE {
                return;
            }
            if C::ENABLED {
                count.event(Event::Opened(current.id()));
            }
            let Some(tmax) = Leaf::from_word(current.0).and_then(|it| leaf(it, count)) else {
                return;
            };
            limit = N::WideCull::limit(tmax);
            let Some(next) = pop_closest::<N, C>(stack, limit, count) else {
                return;
            };
            current = next;
        }
    }

    #[inline(always)]
    fn walk_any<N: Number, C: Observer>(
        geometry: &SceneGeometry<'_>,
        views: &Self::Views<'_>,
        ray: &Ray<N>,
        cull: &N::WideCull,
        stack: &mut StackView,
        count: &mut C,
        mut hits: impl FnMut(Leaf, &mut C) -> bool,
    ) {
        let nodes = views.nodes;
        let level = level::<N>(geometry);
        let limit = N::WideCull::limit(ray.tmax);
        let mut current = Child::node(0);
        stack.clear();
        loop {
            if current.as_node().is_some() {
                let arguments = (nodes, cull, (current, limit), &mut *stack, &mut *count);
                current = with_simd!(level, |simd| simd.call(descend_any::<_, N, C>, arguments));
            }
            if current == Child::NONE {
                return;
            }
            if C::ENABLED {
                count.event(Event::Opened(current.id()));
            }
            if Leaf::from_word(current.0).is_none_or(|it| hits(it, count)) {
                return;
            }
            let Some(next) = pop_any(nodes, stack) else {
                return;
            };
            current = next;
        }
    }
}

/// Returns the level for rays of a format: integers have no lanes.
#[inline(always)]
fn level<N: Number>(geometry: &SceneGeometry<'_>) -> SimdLevel {
    match N::FORMAT {
        Format::Fixed => SimdLevel::Portable,
        _ => geometry.simd(),
    }
}

/// Returns the next waiting child that the ray enters before the limit.
#[inline(always)]
fn pop_closest<N: Number, C: Observer>(
    stack: &mut StackView,
    limit: i32,
    count: &mut C,
) -> Option<Child> {
    let entry = pop(stack, limit, count, |entry| {
        (Child(entry.node).id(), N::WideCull::units(entry.near))
    })?;
    Some(Child(entry.node))
}

/// Returns the next waiting child, of those that wait together.
#[inline(always)]
fn pop_any(nodes: &[WideNode], stack: &mut StackView) -> Option<Child> {
    let Entry { node, near, .. } = stack.pop()?;
    next_child(nodes.get(node as usize)?, node, near as u32, stack)
}

/// Goes down from a node, each time to the child that the ray enters first, while the others wait. Where the ray hits
/// no child, continues with the next that waits. Returns a leaf, or none.
///
/// Out of line, because the ray's constants for nodes and those for leaves do not fit the registers together.
#[inline(always)]
fn descend<S: Simd, N: Number, C: Observer>(
    simd: S,
    nodes: &[WideNode],
    cull: &N::WideCull,
    (mut current, limit): (Child, i32),
    stack: &mut StackView,
    count: &mut C,
) -> Child {
    while let Some(number) = current.as_node() {
        let opened = open::<S, N, C>(simd, nodes, number, cull, limit, count);
        let Some((node, mut met, near)) = opened else {
            let Some(next) = pop_closest::<N, C>(stack, limit, count) else {
                return Child::NONE;
            };
            current = next;
            continue;
        };
        let first = take_lowest(&mut met);
        if met == 0 {
            // Every second node: no need to wait for its entry.
            current = node.child(first);
            continue;
        }
        let mut nearest = entered(first, &near);
        while met != 0 {
            let other = entered(take_lowest(&mut met), &near);
            // No branches, because they would be mispredicted half of the time.
            let later = nearest.max(other);
            nearest = nearest.min(other);
            let entry = Entry {
                node: node.child(lane(later)).0,
                near: (later >> 32) as i32,
                far: 0,
            };
            if stack.push(entry).is_err() {
                // Only a forged blob is deeper than it states: the walk ends.
                stack.clear();
                return Child::NONE;
            }
        }
        current = node.child(lane(nearest));
    }
    current
}

/// Goes down from a node, each time to any of the children that the ray hits, and returns a leaf or none. A cheaper
/// [`descend`] for walks in any order.
#[inline(always)]
fn descend_any<S: Simd, N: Number, C: Observer>(
    simd: S,
    nodes: &[WideNode],
    cull: &N::WideCull,
    (mut current, limit): (Child, i32),
    stack: &mut StackView,
    count: &mut C,
) -> Child {
    while let Some(number) = current.as_node() {
        let opened = open::<S, N, C>(simd, nodes, number, cull, limit, count);
        let Some((node, met, _)) = opened else {
            let Some(next) = pop_any(nodes, stack) else {
                return Child::NONE;
            };
            current = next;
            continue;
        };
        let Some(first) = next_child(node, number, met, stack) else {
            // Only a forged blob is deeper than it states: the walk ends.
            stack.clear();
            return Child::NONE;
        };
        current = first;
    }
    current
}

/// Opens a node and [tests](WideCulling::children) its children. Returns the node, the children that the ray hits and
/// where it enters them; `None` if it hits none.
#[inline(always)]
fn open<'n, S: Simd, N: Number, C: Observer>(
    simd: S,
    nodes: &'n [WideNode],
    number: u32,
    cull: &N::WideCull,
    limit: i32,
    count: &mut C,
) -> Option<(&'n WideNode, u32, [i32; LANES])> {
    let node = nodes.get(number as usize)?;
    let children = children(node).count() as u32;
    count.planes(6 * children);
    count.boxes(children);
    if C::ENABLED {
        count.event(Event::Opened(Child::node(number).id()));
        observe_tested::<N, C>(node, cull, limit, count);
    }
    let (met, near) = cull.children(simd, node, limit, !C::COUNTS);
    (met != 0).then_some((node, met, near))
}

/// Returns one of the children of a node that the ray hits, while the others wait together: the node, with one bit per
/// child. Returns `None` if there is no room.
#[inline(always)]
fn next_child(node: &WideNode, number: u32, mut met: u32, stack: &mut StackView) -> Option<Child> {
    let first = take_lowest(&mut met);
    if met != 0 {
        let rest = Entry {
            node: number,
            near: met as i32,
            far: 0,
        };
        stack.push(rest).ok()?;
    }
    Some(node.child(first))
}

/// The lanes of a node that hold children.
fn children(node: &WideNode) -> impl Iterator<Item = usize> + '_ {
    (0..LANES).filter(|&lane| node.child(lane) != Child::NONE)
}

/// Reports the tests of a node's children.
fn observe_tested<N: Number, C: Observer>(
    node: &WideNode,
    cull: &N::WideCull,
    limit: i32,
    count: &mut C,
) {
    for lane in children(node) {
        let bounds = node.child_box(lane);
        count.event(Event::Tested {
            node: node.child(lane).id(),
            sides: bounds.0.map(|axis| axis.map(Some)),
            span: cull.span(&bounds, limit),
        });
    }
}

/// Removes and returns the lowest lane of a set that is not empty.
#[inline(always)]
fn take_lowest(lanes: &mut u32) -> usize {
    let lowest = lanes.trailing_zeros();
    *lanes &= lanes.wrapping_sub(1);
    (lowest & 7) as usize
}

/// The place where the ray enters a lane, which is not negative, in the high half, and the lane's number in the low
/// half.
#[inline(always)]
fn entered(lane: usize, near: &[i32; LANES]) -> u64 {
    (near[lane & 7] as u64) << 32 | lane as u64
}

/// The lane of [`entered`].
#[inline(always)]
fn lane(entered: u64) -> usize {
    (entered & 7) as usize
}
