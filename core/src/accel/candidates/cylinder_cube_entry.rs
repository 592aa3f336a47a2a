//! The cylinder cube with entry nodes. For every pair of gridels it holds a few nodes of the hierarchy. Together they
//! contain every primitive that a ray between the two gridels can hit.
//!
//! A ray enters the hierarchy ([`Bvh`](crate::accel::Bvh)) at these nodes and skips the top of the tree. Where nothing
//! lies between two gridels it stops at once. The table's size depends little on the scene: a pair has at most
//! [`CylinderCubeEntry::MOST_NODES`] nodes, and most have one to four. Nodes are sorted along the way from one gridel
//! to the other, like the primitives of the [tight cube](crate::accel::candidates::cylinder_cube_tight).

use crate::accel::candidates::gridel_table::{Table, along};
use crate::accel::candidates::lists::{ListSections, look_up};
use crate::accel::cull::PairCulling;
use crate::accel::hierarchy::pairs::{PairArray, Pairs, Walk};
use crate::accel::number::Number;
use crate::accel::records::Records;
use crate::accel::scene_geometry::SceneGeometry;
use crate::accel::stack::StackView;
use crate::accel::traverse::Traverse;
use crate::format::link::Node;
use crate::format::record::Pair;
use crate::format::{BlobError, Leaf, SectionKind, Sections, Structure};
use crate::observe::count::Observer;
use crate::ray::Ray;

/// The cylinder cube whose lists hold nodes of the hierarchy.
#[derive(Clone, Copy, Debug)]
pub enum CylinderCubeEntry {}

impl CylinderCubeEntry {
    /// Maximum number of nodes of a pair of gridels.
    pub const MOST_NODES: usize = 8;
}

impl Traverse for CylinderCubeEntry {
    const STRUCTURE: Structure = Structure::CylinderCubeEntry;
    type Views<'a> = Views<'a>;
    type Cull<N: Number> = N::Cull;

    // Compiled once, and not for every set of effects of the ray loop.
    #[inline(never)]
    fn walk<N: Number, C: Observer>(
        geometry: &SceneGeometry<'_>,
        views: &Self::Views<'_>,
        ray: &Ray<N>,
        cull: &N::Cull,
        stack: &mut StackView,
        count: &mut C,
        mut leaf: impl FnMut(Leaf, &mut C) -> Option<N>,
    ) {
        let Views { table, pairs } = *views;
        let Some(passage) = table.gridels.and_then(|gridels| gridels.passage(ray)) else {
            return;
        };
        look_up(passage.cell, count);
        let walk = Walk {
            geometry,
            pairs,
            root: |limit| cull.root(geometry.bounds(), limit),
            root_planes: 6,
            narrow: |pair: &Pair, _, limit| cull.children(pair, limit),
        };
        let mut tmax = ray.tmax;
        along(&table.lists, &passage, ray, |number| {
            let node = match number.checked_sub(pairs.len() as u32) {
                Some(leaf) => Node::leaf(leaf),
                None => Node::pair(number),
            };
            let mut limit = Some(tmax);
            walk.enter::<N, N::Cull, C>(node, tmax, stack, count, |range, count| {
                limit = leaf(range, count);
                limit
            });
            tmax = limit?;
            limit
        });
    }
}

/// The lists of a scene.
#[derive(Clone, Copy, Debug)]
pub struct Views<'a> {
    table: Table<'a>,
    /// The hierarchy that rays enter.
    pairs: Pairs<'a, Pair>,
}

/// The section of the gridels.
pub const GRIDELS: SectionKind = SectionKind::EntryGridels;
/// The sections of the lists.
pub const LISTS: ListSections = ListSections {
    cells: SectionKind::EntryCells,
    starts: SectionKind::EntryStarts,
    entries: SectionKind::EntryNodes,
    keys: Some(SectionKind::EntryKeys),
};

impl<'a> Records<'a> for Views<'a> {
    const SECTIONS: &'static [SectionKind] = &[
        GRIDELS,
        LISTS.cells,
        LISTS.starts,
        LISTS.entries,
        SectionKind::EntryKeys,
    ];
    const USES_LEAVES: bool = true;

    fn read(sections: &Sections<'a>) -> Result<Self, BlobError> {
        Ok(Self {
            table: Table::read(sections, GRIDELS, &LISTS)?,
            pairs: Pairs::read(sections)?,
        })
    }

    fn check(&self, geometry: &SceneGeometry<'a>) -> Result<usize, BlobError> {
        geometry.require(Structure::Bvh, Structure::CylinderCubeEntry)?;
        let nodes = self.pairs.0.len() + geometry.leaves.len();
        self.table.check(geometry, GRIDELS, &LISTS, nodes)?;
        Ok(0)
    }
}
