//! Ray classification (J. Arvo and D. Kirk, "Fast Ray Tracing by Ray Classification", 1987), made
//! offline.
//!
//! A ray is a point in five dimensions. Three are the place where it begins, and two are its slopes on one of the six
//! faces of a cube of directions. A binary tree per face halves that space, one dimension at a time, and is finer where
//! the scene's own rays fall. Its leaves hold lists of the primitives that the rays of a class can hit. A list is
//! sorted by where on the rays' way each primitive can begin. Some classes are not worth a list, or exceed the budget;
//! they lead to the hierarchy ([`Bvh`]).
//!
//! **No candidate is lost.** A ray's place is its point at its start, or where it enters the enlarged box of the scene
//! (see `accel::candidates::gridels`). That point comes before every hit. In integers it is off by less than two units.
//! The class's box of places, widened by [`Gridels::REACH`], sweeps a volume. It moves along the major axis while its
//! sides move by the class's least and greatest slopes. So every point at which the ray hits something lies in that
//! volume. The builder lists the primitives that intersect it.
//!
//! Memory: four bytes per node, and the lists. Cost: a comparison per level, then the list.

use crate::accel::candidates::line::Line;
use crate::accel::candidates::lists::{Candidates, ListSections, look_up};
use crate::accel::cull::{Culling, NoBoxCulling};
use crate::accel::hierarchy::bvh::Bvh;
use crate::accel::hierarchy::pairs::Pairs;
use crate::accel::number::Number;
use crate::accel::records::Records;
use crate::accel::scene_geometry::SceneGeometry;
use crate::accel::stack::StackView;
use crate::accel::traverse::Traverse;
use crate::axis::pick;
use crate::format::range::At;
use crate::format::record::{Gridels, Pair, UnitBox};
use crate::format::{BlobError, ClassNode, Field, Leaf, Reason, SectionKind, Sections, Structure};
use crate::observe::count::Observer;
use crate::ray::Ray;

/// A tree over origin and direction with lists of candidates, and the hierarchy where it has none.
#[derive(Clone, Copy, Debug)]
pub enum RayClasses {}

/// A range of rays: the limits of each dimension. Places are lengths with 13 fraction bits, slopes ratios with 30.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClassRange(pub [[i64; 2]; ClassNode::DIMENSIONS]);

impl ClassRange {
    /// Returns all rays of a face.
    pub fn whole(bounds: &UnitBox) -> Self {
        let side = |axis: usize| {
            let [low, high] = bounds.0[axis].map(i64::from);
            let margin = i64::from(Gridels::MARGIN);
            [(low - margin) << 13, (high + margin) << 13]
        };
        const SLOPES: [i64; 2] = [-(1 << 30), 1 << 30];
        Self([side(0), side(1), side(2), SLOPES, SLOPES])
    }

    /// Returns the value at which a dimension is halved.
    #[inline(always)]
    pub fn middle(&self, dimension: usize) -> i64 {
        let [low, high] = self.0.get(dimension).copied().unwrap_or_default();
        low + (high - low) / 2
    }

    /// Returns the lower or the upper half.
    #[inline(always)]
    pub fn half(mut self, dimension: usize, upper: bool) -> Self {
        let middle = self.middle(dimension);
        if let Some([low, high]) = self.0.get_mut(dimension) {
            *(if upper { low } else { high }) = middle;
        }
        self
    }

    /// Levels of keys per culling step along an axis, with 24 fraction bits.
    #[inline(always)]
    pub fn levels_per_step(bounds: &UnitBox, axis: usize) -> u32 {
        let [low, high] = pick(bounds.0, axis).map(i32::from);
        let steps = 2 * (high - low + 2 * Gridels::MARGIN);
        (u32::from(u8::MAX) << 24) / steps.max(1) as u32
    }

    /// Returns the key of a place, in culling steps from where a ray of the class begins.
    #[inline(always)]
    pub fn key(step: i32, levels_per_step: u32) -> u8 {
        let way = step.max(0) as u64;
        ((way * u64::from(levels_per_step)) >> 24).min(u8::MAX.into()) as u8
    }
}

/// A ray in the space of rays.
#[derive(Clone, Copy, Debug)]
pub struct ClassPoint {
    /// The face of the cube of directions: `2 k` down axis `k`, `2 k + 1` up it.
    pub face: usize,
    /// The place and the slopes, in the units of [`ClassRange`].
    pub coordinates: [i64; ClassNode::DIMENSIONS],
    /// The parameter of the place, in culling steps.
    start: i32,
}

impl ClassPoint {
    /// Returns the point of a ray; `None` if the ray misses the scene.
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

impl Traverse for RayClasses {
    const STRUCTURE: Structure = Structure::RayClasses;
    type Views<'a> = Views<'a>;
    type Cull<N: Number> = NoBoxCulling;

    // Compiled once, and not for every set of effects of the ray loop.
    #[inline(never)]
    fn walk<N: Number, C: Observer>(
        geometry: &SceneGeometry<'_>,
        views: &Self::Views<'_>,
        ray: &Ray<N>,
        _: &NoBoxCulling,
        stack: &mut StackView,
        count: &mut C,
        mut leaf: impl FnMut(Leaf, &mut C) -> Option<N>,
    ) {
        /// Maximum error of a place, in culling steps.
        const SLACK: i32 = 4;
        let Some(point) = ClassPoint::of(geometry.bounds(), ray) else {
            return;
        };
        let Some(cell) = views.cell(&point, geometry.bounds()) else {
            let cull = Culling::new(ray);
            return Bvh::walk(geometry, &views.fallback, ray, &cull, stack, count, leaf);
        };
        look_up(cell, count);
        let levels_per_step = ClassRange::levels_per_step(geometry.bounds(), point.face / 2);
        let level = |t: N| {
            let step = t.to_cull().saturating_sub(point.start);
            ClassRange::key(step.saturating_add(SLACK), levels_per_step)
        };
        let mut tmax = ray.tmax;
        let mut end = level(tmax);
        views.lists.ascend(cell, end, |slot| {
            let limit = leaf(geometry.shapes.single(slot), count)?;
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
pub struct Views<'a> {
    nodes: &'a [u32],
    lists: Candidates<'a>,
    /// The hierarchy for rays without a list.
    fallback: Pairs<'a, Pair>,
}

impl Views<'_> {
    /// Returns the cell of a ray's class; `None` for a class without a list.
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

/// The sections of the lists.
pub const LISTS: ListSections = ListSections {
    cells: SectionKind::ClassCells,
    starts: SectionKind::ClassStarts,
    entries: SectionKind::ClassEntries,
    keys: Some(SectionKind::ClassKeys),
};

impl<'a> Records<'a> for Views<'a> {
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
            fallback: Pairs::read(sections)?,
        })
    }

    /// Proves that there are six roots, that children come after their parents, so that every walk ends, and that
    /// leaves use the cells in order.
    fn check(&self, geometry: &SceneGeometry<'a>) -> Result<usize, BlobError> {
        geometry.require(Structure::Bvh, Structure::RayClasses)?;
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
            let at = At { section, index };
            at.ensure(next > index as i64, Reason::NotReached)?;
            let number = node.number().into();
            match node.dimension() {
                Some(dimension) => {
                    let most = ClassNode::DIMENSIONS as i64 - 1;
                    at.within(Field::Dimension, dimension as i64, 0, most)?;
                    at.within(Field::Child, number, next, next)?;
                    next += 2;
                }
                None if node.number() == ClassNode::NONE => {}
                None => {
                    at.within(Field::Cell, number, cells, cells)?;
                    cells += 1;
                }
            }
        }
        if next != self.nodes.len() as i64 {
            return Err(BlobError::Count {
                section,
                found: self.nodes.len(),
                expected: next as usize,
            });
        }
        let ascend = |before: u8, after: u8| before <= after;
        self.lists
            .check(&LISTS, cells as u64, geometry.shapes.bounded(), ascend)?;
        Ok(0)
    }
}
