//! The cylinder cube with tight lists: the best form of the paper's idea without a hierarchy.
//!
//! In place of a cylinder, each list covers the convex hull of its two gridels. The hull is tested
//! against the primitive itself and not against its bounding sphere. Lists are sorted along the way
//! from one gridel to the other. A ray walks a list from the end at which it enters. It skips
//! entries behind its origin. The walk ends when no later entry can be nearer than the best hit
//! (see `Levels` in `gridels.rs`).
//!
//! Memory: 15 n^4 cells, a list for each that differs from all others, and a byte more per entry
//! than in the paper's form.

use crate::accel::candidates::gridel_table::{Table, along};
use crate::accel::candidates::lists::{ListSections, look_up};
use crate::accel::cull::NoBoxCulling;
use crate::accel::number::Number;
use crate::accel::records::Records;
use crate::accel::scene_geometry::SceneGeometry;
use crate::accel::stack::StackView;
use crate::accel::traverse::Traverse;
use crate::format::{BlobError, Leaf, SectionKind, Sections, Structure};
use crate::observe::count::Observer;
use crate::ray::Ray;

/// The cylinder cube with tight, sorted lists. It needs no stack.
#[derive(Clone, Copy, Debug)]
pub enum CylinderCubeTight {}

impl Traverse for CylinderCubeTight {
    const STRUCTURE: Structure = Structure::CylinderCubeTight;
    type Views<'a> = Views<'a>;
    type Cull<N: Number> = NoBoxCulling;

    // Compiled once, and not for every set of effects of the ray loop.
    #[inline(never)]
    fn walk<N: Number, C: Observer>(
        geometry: &SceneGeometry<'_>,
        views: &Self::Views<'_>,
        ray: &Ray<N>,
        _: &NoBoxCulling,
        _: &mut StackView,
        count: &mut C,
        mut leaf: impl FnMut(Leaf, &mut C) -> Option<N>,
    ) {
        let Views(table) = *views;
        if let Some(passage) = table.gridels.and_then(|gridels| gridels.passage(ray)) {
            look_up(passage.cell, count);
            along(&table.lists, &passage, ray, |slot| {
                leaf(geometry.shapes.single(slot), count)
            });
        }
    }
}

/// The lists of a scene.
#[derive(Clone, Copy, Debug)]
pub struct Views<'a>(Table<'a>);

/// The section of the gridels.
pub const GRIDELS: SectionKind = SectionKind::TightGridels;
/// The sections of the lists.
pub const LISTS: ListSections = ListSections {
    cells: SectionKind::TightCells,
    starts: SectionKind::TightStarts,
    entries: SectionKind::TightEntries,
    keys: Some(SectionKind::TightKeys),
};

impl<'a> Records<'a> for Views<'a> {
    const SECTIONS: &'static [SectionKind] = &[
        GRIDELS,
        LISTS.cells,
        LISTS.starts,
        LISTS.entries,
        SectionKind::TightKeys,
    ];
    const USES_LEAVES: bool = false;

    fn read(sections: &Sections<'a>) -> Result<Self, BlobError> {
        Table::read(sections, GRIDELS, &LISTS).map(Self)
    }

    fn check(&self, geometry: &SceneGeometry<'a>) -> Result<usize, BlobError> {
        self.0
            .check(geometry, GRIDELS, &LISTS, geometry.shapes.bounded())?;
        Ok(0)
    }
}
