//! Ray classification (J. Arvo and D. Kirk, "Fast Ray Tracing by Ray Classification", 1987), made
//! offline.
//!
//! A ray is a point in five dimensions: where it begins, and its two slopes on one of the six faces
//! of a cube of directions. A binary tree for each face halves that space, one dimension at a time,
//! and is finer where the scene's own rays fall. Its leaves hold lists of what the rays of a class
//! can meet, sorted by where on their way that may begin. Classes that were not worth a list, or for
//! which the budget had no room, lead to the hierarchy ([`Bvh`]).
//!
//! **No candidate is lost.** A ray's place is its point at its start, or where it enters the scene's
//! box made larger (see [`gridels`](crate::accel::candidates::gridels)), which comes before every hit. In integers it
//! is off by less than two units. So the points at which anything is hit lie in the volume that the
//! class's box of places, widened by [`Gridels::REACH`], sweeps while it moves along the major axis
//! and its sides move by the class's least and greatest slopes. The builder lists what meets that.
//!
//! Memory: four bytes a node, and the lists. Cost: a comparison a level, then the list.

use crate::accel::candidates::line::Line;
use crate::accel::candidates::lists::{Candidates, ListSections, look_up};
use crate::accel::cull::{Culling, Deferred};
use crate::accel::hierarchy::bvh::Bvh;
use crate::accel::{Accel, Leaf, Records, StackView, Structure};
use crate::format::record::{Gridels, UnitBox};
use crate::format::{BlobError, SectionKind, Sections};
use crate::number::{Number, pick};
use crate::observe::count::Count;
use crate::ray::Ray;
use crate::scene::Scene;

/// A tree over origin and direction with lists of candidates, and the hierarchy where it has none.
#[derive(Clone, Copy, Debug)]
pub enum RayClasses {}

/// A node of the tree over rays, as a word.
///
/// Bits 0 to 2 are the dimension that is halved: 0 to 2 a coordinate of the place, 3 and 4 the slope
/// on the first and the second axis after the major one. Bits 3 to 31 are then the number of the
/// first of two children, the lower half. A dimension of 7 means a leaf; bits 3 to 31 are its cell,
/// or [`ClassNode::NONE`] for the hierarchy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClassNode(pub u32);

impl ClassNode {
    /// The cell of a leaf that has no list.
    pub const NONE: u32 = u32::MAX >> 3;
    /// What stands for the dimension of a leaf.
    const LEAF: u32 = 7;
    /// Dimensions of the space of rays.
    pub const DIMENSIONS: usize = 5;

    /// A node whose children are `first` and the next one.
    pub const fn split(dimension: usize, first: u32) -> Self {
        Self(dimension as u32 | first << 3)
    }

    /// A leaf with the list of a cell.
    pub const fn leaf(cell: u32) -> Self {
        Self(Self::LEAF | cell << 3)
    }

    /// The dimension that is halved; `None` for a leaf.
    #[inline(always)]
    const fn dimension(self) -> Option<usize> {
        match self.0 & 7 {
            Self::LEAF => None,
            dimension => Some(dimension as usize),
        }
    }

    #[inline(always)]
    const fn number(self) -> u32 {
        self.0 >> 3
    }
}

/// A range of rays: for each dimension from where to where. Places are lengths with 13 fraction
/// bits, slopes ratios with 30.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClassRange(pub [[i64; 2]; ClassNode::DIMENSIONS]);

impl ClassRange {
    /// All rays of a face.
    pub fn whole(bounds: &UnitBox) -> Self {
        let side = |axis: usize| {
            let [low, high] = bounds.0[axis].map(i64::from);
            let margin = i64::from(Gridels::MARGIN);
            [(low - margin) << 13, (high + margin) << 13]
        };
        const SLOPES: [i64; 2] = [-(1 << 30), 1 << 30];
        Self([side(0), side(1), side(2), SLOPES, SLOPES])
    }

    /// Where a dimension is halved.
    #[inline(always)]
    pub fn middle(&self, dimension: usize) -> i64 {
        let [low, high] = self.0.get(dimension).copied().unwrap_or_default();
        low + (high - low) / 2
    }

    /// The lower or the upper half.
    #[inline(always)]
    pub fn half(mut self, dimension: usize, upper: bool) -> Self {
        let middle = self.middle(dimension);
        if let Some([low, high]) = self.0.get_mut(dimension) {
            *(if upper { low } else { high }) = middle;
        }
        self
    }

    /// Levels of keys a culling step along an axis, with 24 fraction bits.
    #[inline(always)]
    pub fn levels_a_step(bounds: &UnitBox, axis: usize) -> u32 {
        let [low, high] = pick(bounds.0, axis).map(i32::from);
        let steps = 2 * (high - low + 2 * Gridels::MARGIN);
        (u32::from(u8::MAX) << 24) / steps.max(1) as u32
    }

    /// The key of a place, in culling steps from where a ray of the class begins.
    #[inline(always)]
    pub fn key(step: i32, levels_a_step: u32) -> u8 {
        let way = step.max(0) as u64;
        ((way * u64::from(levels_a_step)) >> 24).min(u8::MAX.into()) as u8
    }
}

/// A ray in the space of rays.
#[derive(Clone, Copy, Debug)]
pub struct ClassPoint {
    /// The face of the cube of directions: `2 k` down axis `k`, `2 k + 1` up it.
    pub face: usize,
    /// As a [`ClassRange`] counts them.
    pub coordinates: [i64; ClassNode::DIMENSIONS],
    /// The parameter of the place, in culling steps.
    start: i32,
}

impl ClassPoint {
    /// The point of a ray; `None` for one that passes the scene by.
    #[inline(always)]
    pub fn of<N: Number>(bounds: &UnitBox, ray: &Ray<N>) -> Option<Self> {
        let line = Line::of(ray);
        let corner = |end: usize, outward: i32| {
            let axis = |k: usize| (i32::from(bounds.0[k][end]) + outward) << 13;
            [axis(0), axis(1), axis(2)]
        };
        let (low, high) = (corner(0, -Gridels::MARGIN), corner(1, Gridels::MARGIN));
        let through = line.through(low, high)?;
        let start = ray.tmin.to_q13().max(through.enter);
        let [first, second] = Gridels::across(line.major);
        Some(Self {
            face: 2 * line.major + usize::from(line.ascends(line.major)),
            coordinates: [
                line.at(0, start),
                line.at(1, start),
                line.at(2, start),
                pick(line.slope, first).into(),
                pick(line.slope, second).into(),
            ],
            start: start >> 12,
        })
    }
}

impl Accel for RayClasses {
    const STRUCTURE: Structure = Structure::RayClasses;
    type Cull<N: Number> = Deferred;

    // Once, and not for every set of effects that the ray loop is compiled for.
    #[inline(never)]
    fn walk<N: Number, C: Count>(
        scene: &Scene<'_>,
        ray: &Ray<N>,
        _: &Deferred,
        stack: &mut StackView,
        count: &mut C,
        mut leaf: impl FnMut(Leaf, &mut C) -> Option<N>,
    ) {
        /// Culling steps that a place may be off by.
        const SLACK: i32 = 4;
        let held = &scene.held.ray_classes;
        let Some(point) = ClassPoint::of(scene.bounds(), ray) else {
            return;
        };
        let Some(cell) = held.cell(&point, scene.bounds()) else {
            let cull = Culling::new(ray);
            return Bvh::walk(scene, ray, &cull, stack, count, leaf);
        };
        look_up(cell, count);
        let a_step = ClassRange::levels_a_step(scene.bounds(), point.face / 2);
        let level = |t: N| {
            let step = t.to_cull().saturating_sub(point.start);
            ClassRange::key(step.saturating_add(SLACK), a_step)
        };
        let mut tmax = ray.tmax;
        let mut end = level(tmax);
        held.lists.ascend(cell, end, |slot| {
            let limit = leaf(scene.shapes.single(slot), count)?;
            if limit < tmax {
                tmax = limit;
                end = level(tmax);
            }
            Some(end)
        });
    }
}

/// The tree of a scene, and its lists.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Held<'a> {
    nodes: &'a [u32],
    lists: Candidates<'a>,
}

impl Held<'_> {
    /// The cell of a ray's class; `None` for one that has no list.
    #[inline(always)]
    fn cell(&self, point: &ClassPoint, bounds: &UnitBox) -> Option<u32> {
        let mut range = ClassRange::whole(bounds);
        let mut number = point.face as u32;
        loop {
            let node = ClassNode(*self.nodes.get(number as usize)?);
            let Some(dimension) = node.dimension() else {
                return (node.number() != ClassNode::NONE).then_some(node.number());
            };
            let upper = *point.coordinates.get(dimension)? >= range.middle(dimension);
            range = range.half(dimension, upper);
            number = node.number() + u32::from(upper);
        }
    }
}

const LISTS: ListSections = ListSections {
    cells: SectionKind::ClassCells,
    starts: SectionKind::ClassStarts,
    entries: SectionKind::ClassEntries,
    keys: Some(SectionKind::ClassKeys),
};

impl<'a> Records<'a> for Held<'a> {
    const SECTIONS: &'static [SectionKind] = &[
        SectionKind::ClassNodes,
        LISTS.cells,
        LISTS.starts,
        LISTS.entries,
        SectionKind::ClassKeys,
    ];
    const USES_LEAVES: bool = false;

    fn read(sections: &Sections<'a>) -> Result<Self, BlobError> {
        Ok(Self {
            nodes: sections.records(SectionKind::ClassNodes)?,
            lists: Candidates::read(sections, &LISTS)?,
        })
    }

    /// Proves that there are six roots, that children come after their parents, so that every walk
    /// ends, and that leaves take the cells in order.
    fn check(&self, scene: &Scene<'a>) -> Result<usize, BlobError> {
        Structure::Bvh.needed_by(Structure::RayClasses, scene)?;
        let section = SectionKind::ClassNodes;
        if self.nodes.len() < 6 {
            return Err(BlobError::Count {
                section,
                found: self.nodes.len(),
                expected: 6,
            });
        }
        let mut cells = 0;
        let mut next = 6;
        for (index, &word) in self.nodes.iter().enumerate() {
            let node = ClassNode(word);
            let wrong = |what, expected: u32| BlobError::Record {
                section,
                index,
                what,
                found: node.number().into(),
                expected: expected.into(),
            };
            match node.dimension() {
                Some(dimension) if dimension >= ClassNode::DIMENSIONS => {
                    return Err(BlobError::Record {
                        section,
                        index,
                        what: "dimension",
                        found: dimension as i64,
                        expected: ClassNode::DIMENSIONS as i64 - 1,
                    });
                }
                Some(_) if node.number() != next => {
                    return Err(wrong("first child, which must follow in order,", next));
                }
                Some(_) => next += 2,
                None if node.number() == ClassNode::NONE => {}
                None if node.number() != cells => {
                    return Err(wrong("cell of a leaf", cells));
                }
                None => cells += 1,
            }
            // The next node must be one that something leads to.
            if next as usize <= index {
                return Err(wrong("number of nodes that are reached up to here", next));
            }
        }
        if next as usize != self.nodes.len() {
            return Err(BlobError::Count {
                section,
                found: self.nodes.len(),
                expected: next as usize,
            });
        }
        let ascend = |before: u8, after: u8| before <= after;
        self.lists
            .check(&LISTS, cells.into(), scene.shapes.total(), ascend)?;
        Ok(0)
    }
}
