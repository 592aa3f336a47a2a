//! The octree, walked on integer coordinates.
//!
//! A node is a cube of the finest divisions of the scene's box. Its place and its level are integers, and its planes
//! are computed from them. The walk enters a child if its culling interval is not empty.
//!
//! **No primitive is skipped.** On each axis the culling intervals of the finest divisions overlap, because a box is
//! entered no later than it is left. Let a hit be at step `t`, in the culling interval of its primitive's box. On every
//! axis there is then a division that the box meets and whose interval holds `t`. The cell of the three divisions lies
//! in a leaf that lists the primitive. Culling is monotone, so every node around that leaf is entered no later than at
//! `t`. (See `accel::cull`. No direction is special, no interval is reflected.)

use crate::accel::cells::lists::{Divisions, Lists, Range, Tester, check_complete, divide, reach};
use crate::accel::cull::{Cull, Culling, PairCulling};
use crate::accel::cull_axis::Interval;
use crate::accel::number::Number;
use crate::accel::records::Records;
use crate::accel::scene_geometry::SceneGeometry;
use crate::accel::stack::{Entry, StackView, pop};
use crate::accel::traverse::Traverse;
use crate::format::range::At;
use crate::format::{
    BlobError, Field, Leaf, Location, OctreeNode, Reason, SectionKind, Sections, Structure,
};
use crate::observe::count::Observer;
use crate::observe::event;
use crate::observe::event::{Event, Sides};
use crate::ray::Ray;
use heapless::Vec;

/// The octree: one word per node.
#[derive(Clone, Copy, Debug)]
pub enum Octree {}

/// Maximum number of levels of inner nodes; each level leaves at most seven children waiting.
pub const MOST_LEVELS: u32 = 6;

/// The place of a node: its first division on each axis, six bits each, and the level above the leaves of the finest
/// division.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct CellId(u32);

impl CellId {
    const fn root(levels: u32) -> Self {
        Self(levels << 24)
    }

    #[inline(always)]
    const fn level(self) -> u32 {
        self.0 >> 24
    }

    #[inline(always)]
    const fn first(self, axis: u32) -> u32 {
        self.0 >> (6 * axis) & 63
    }

    /// Returns the child on these sides, which is half as large.
    #[inline(always)]
    const fn child(self, sides: u32) -> Self {
        let half = self.level().saturating_sub(1);
        let shift = (sides & 1 | (sides & 2) << 5 | (sides & 4) << 10) << half;
        Self(self.0.wrapping_add(shift).wrapping_sub(1 << 24))
    }

    /// The divisions that it covers.
    fn cells(self) -> Range {
        let size = 1 << self.level();
        [0, 1, 2].map(|axis| [self.first(axis), self.first(axis) + size - 1])
    }

    /// Its planes, as events report them.
    fn planes(self, divisions: &[Divisions; 3]) -> Sides {
        let size = 1 << self.level();
        [0, 1, 2].map(|axis: usize| {
            let first = self.first(axis as u32);
            [first, first + size].map(|division| Some(divisions[axis].plane(division)))
        })
    }
}

/// The octree of a scene.
#[derive(Clone, Copy, Debug)]
pub struct Views<'a> {
    nodes: &'a [u32],
    lists: Lists<'a>,
    /// Levels of inner nodes.
    levels: u32,
}

impl Views<'_> {
    fn divisions(&self, geometry: &SceneGeometry<'_>) -> [Divisions; 3] {
        divide(geometry.bounds(), [1 << self.levels; 3])
    }
}

impl Traverse for Octree {
    const STRUCTURE: Structure = Structure::Octree;
    type Views<'a> = Views<'a>;
    type Cull<N: Number> = Cull;

    fn walk<N: Number, C: Observer>(
        geometry: &SceneGeometry<'_>,
        views: &Self::Views<'_>,
        ray: &Ray<N>,
        cull: &Cull,
        stack: &mut StackView,
        count: &mut C,
        leaf: impl FnMut(Leaf, &mut C) -> Option<N>,
    ) {
        let limit = <Cull as PairCulling<N>>::limit;
        let mut end = limit(ray.tmax);
        count.planes(6);
        count.boxes(1);
        let root = PairCulling::<N>::root(cull, geometry.bounds(), end);
        if C::ENABLED {
            count.event(Event::Tested {
                node: node_id(0),
                sides: geometry.bounds().0.map(|axis| axis.map(Some)),
                span: Cull::span(root),
            });
        }
        if root.near > root.far {
            return;
        }
        let divisions = views.divisions(geometry);
        let mut tester = Tester::new(geometry, views.lists, leaf);
        // The children's order along the ray: on every axis the side that it comes from first.
        let from = cull.descending();
        let (mut number, mut place) = (0_u32, CellId::root(views.levels));
        stack.clear();
        loop {
            if C::ENABLED {
                count.event(Event::Opened(node_id(number)));
            }
            let node = OctreeNode(
                views
                    .nodes
                    .get(number as usize)
                    .copied()
                    .unwrap_or(u32::MAX),
            );
            if node == OctreeNode::EMPTY {
            } else if node.is_leaf() {
                count.cells(1);
                match tester.list::<N, C>(node.list() as usize, count) {
                    Ok(None) => {}
                    Ok(Some(tmax)) => end = end.min(limit(tmax)),
                    Err(()) => return,
                }
            } else {
                count.planes(9);
                count.boxes(8);
                let halves = halves(
                    cull,
                    &divisions,
                    place,
                    Interval {
                        near: root.near,
                        far: end,
                    },
                );
                for order in (0..8).rev() {
                    let sides = order ^ from;
                    let [x, y, z] =
                        [0, 1, 2].map(|axis: usize| halves[axis][(sides >> axis & 1) as usize]);
                    let near = x.near.max(y.near).max(z.near);
                    let far = x.far.min(y.far).min(z.far);
                    let child = node.0.wrapping_add(sides);
                    let empty = views.nodes.get(child as usize) == Some(&OctreeNode::EMPTY.0);
                    if C::ENABLED {
                        count.event(Event::Tested {
                            node: node_id(child),
                            sides: place.child(sides).planes(&divisions),
                            span: Cull::span(Interval { near, far }),
                        });
                        if empty {
                            count.event(Event::Empty(node_id(child)));
                        }
                    }
                    if near > far || empty {
                        continue;
                    }
                    let later = Entry {
                        node: child,
                        near,
                        far: place.child(sides).0 as i32,
                    };
                    if stack.push(later).is_err() {
                        return;
                    }
                }
            }
            let next = pop(stack, end, count, |entry| {
                let enters = <Cull as Culling<N>>::units(entry.near);
                (node_id(entry.node), enters)
            });
            let Some(entry) = next else { return };
            number = entry.node;
            place = CellId(entry.far as u32);
        }
    }
}

/// A node as events report it.
fn node_id(number: u32) -> event::NodeId {
    event::NodeId {
        what: "node",
        number,
    }
}

/// The culling intervals of a node's lower and upper half on each axis, from the ray's own.
#[inline(always)]
fn halves(
    cull: &Cull,
    divisions: &[Divisions; 3],
    place: CellId,
    ray: Interval,
) -> [[Interval; 2]; 3] {
    let size = 1 << place.level();
    let mut halves = [[ray; 2]; 3];
    for (axis, (divisions, halves)) in divisions.iter().zip(&mut halves).enumerate() {
        let first = place.first(axis as u32);
        let low = divisions.plane(first);
        let middle = divisions.plane(first + size / 2);
        let high = divisions.plane(first + size);
        for (half, [low, high]) in halves.iter_mut().zip([[low, middle], [middle, high]]) {
            let (near, far) = if cull.descends(axis) {
                (high, low)
            } else {
                (low, high)
            };
            half.near = half.near.max(cull.enters(axis, near));
            half.far = half.far.min(cull.leaves(axis, far));
        }
    }
    halves
}

impl<'a> Records<'a> for Views<'a> {
    const SECTIONS: &'static [SectionKind] = &[
        SectionKind::OctreeNodes,
        SectionKind::OctreeStarts,
        SectionKind::OctreeSlots,
    ];
    const USES_LEAVES: bool = false;

    fn read(sections: &Sections<'a>) -> Result<Self, BlobError> {
        let nodes: &[u32] = sections.records(SectionKind::OctreeNodes)?;
        Ok(Self {
            nodes,
            lists: Lists::read(
                sections,
                [SectionKind::OctreeStarts, SectionKind::OctreeSlots],
            )?,
            levels: levels(nodes)?,
        })
    }

    /// Children follow their parents, so every node is reached once; leaves take the lists in order.
    fn check(&self, geometry: &SceneGeometry<'a>) -> Result<usize, BlobError> {
        let slots = geometry.shapes.bounded();
        if self.nodes.is_empty() != (slots == 0) {
            return Err(BlobError::Count {
                section: SectionKind::OctreeNodes,
                found: self.nodes.len(),
                expected: usize::from(slots > 0),
            });
        }
        self.lists.check(SectionKind::OctreeStarts)?;
        let reach = reach(geometry, self.divisions(geometry), 0);
        let section = SectionKind::OctreeSlots;
        let (mut pairs, mut lists) = (0, 0);
        let mut waiting: Vec<(u32, CellId), { 8 * MOST_LEVELS as usize }> = Vec::new();
        let mut current = (!self.nodes.is_empty()).then_some((0, CellId::root(self.levels)));
        while let Some((number, place)) = current {
            let node = OctreeNode(self.nodes.get(number as usize).copied().unwrap_or(u32::MAX));
            if !node.is_leaf() {
                for sides in 0..8 {
                    // Seven children wait at each of at most six levels.
                    let _ = waiting.push((node.0 + sides, place.child(sides)));
                }
            } else if node != OctreeNode::EMPTY {
                let list = node.list() as usize;
                pairs += self
                    .lists
                    .check_list(list, &place.cells(), &reach, section)?;
                lists += 1;
            }
            current = waiting.pop();
        }
        if lists != self.lists.len() {
            return Err(BlobError::Count {
                section: SectionKind::OctreeStarts,
                found: self.lists.len(),
                expected: lists,
            });
        }
        check_complete(pairs, slots, &reach, section)?;
        Ok(7 * self.levels as usize + usize::from(self.levels > 0))
    }
}

/// Proves that nodes lie breadth first and lists are numbered in their order, and returns the number
/// of levels of inner nodes.
fn levels(nodes: &[u32]) -> Result<u32, BlobError> {
    let section = SectionKind::OctreeNodes;
    let (mut levels, mut level_end) = (0, 0);
    let (mut next_node, mut next_list) = (1, 0);
    for (index, &word) in nodes.iter().enumerate() {
        let node = OctreeNode(word);
        let at = At { section, index };
        at.ensure(index < next_node, Reason::NotReached)?;
        if node == OctreeNode::EMPTY {
            continue;
        }
        if node.is_leaf() {
            at.within(Field::List, node.list().into(), next_list, next_list)?;
            next_list += 1;
            continue;
        }
        at.within(
            Field::Child,
            word.into(),
            next_node as i64,
            next_node as i64,
        )?;
        if index >= level_end {
            // The first inner node of a level; its children end no earlier than all nodes so far.
            levels += 1;
            level_end = next_node;
        }
        next_node += 8;
    }
    if next_node != nodes.len().max(1) {
        return Err(BlobError::Count {
            section,
            found: nodes.len(),
            expected: next_node,
        });
    }
    if levels > MOST_LEVELS {
        let range = [0, MOST_LEVELS.into()];
        return Err(Location::Section(section).out_of_range(Field::Levels, levels.into(), range));
    }
    Ok(levels)
}
