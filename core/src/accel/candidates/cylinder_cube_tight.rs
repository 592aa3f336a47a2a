//! The cylinder cube with tight lists: what can be done for the paper's idea without a hierarchy.
//!
//! Instead of a cylinder each list stands for the convex hull of its two gridels, tested against
//! the primitive itself instead of its bounding sphere. Lists are sorted along the way from one
//! gridel to the other and walked from whichever end the ray enters; entries behind the ray's
//! origin are passed over, and the walk ends when nothing later can beat the best hit (see `Levels`
//! in `gridels.rs`).
//!
//! Memory: 15 n^4 cells, a list for each that differs from all others, and a byte more an entry
//! than in the paper's form.

use crate::accel::candidates::gridel_table::{Table, along};
use crate::accel::candidates::lists::{ListSections, look_up};
use crate::accel::cull::Deferred;
use crate::accel::{Accel, Leaf, Records, StackView, Structure};
use crate::format::{BlobError, SectionKind, Sections};
use crate::number::Number;
use crate::observe::count::Count;
use crate::ray::Ray;
use crate::scene::Scene;

/// The cylinder cube with tight, sorted lists; needs no stack.
#[derive(Clone, Copy, Debug)]
pub enum CylinderCubeTight {}

impl Accel for CylinderCubeTight {
    const STRUCTURE: Structure = Structure::CylinderCubeTight;
    type Cull<N: Number> = Deferred;

    // Once, and not for every set of effects that the ray loop is compiled for.
    #[inline(never)]
    fn walk<N: Number, C: Count>(
        scene: &Scene<'_>,
        ray: &Ray<N>,
        _: &Deferred,
        _: &mut StackView,
        count: &mut C,
        mut leaf: impl FnMut(Leaf, &mut C) -> Option<N>,
    ) {
        let Held(table) = scene.held.cylinder_cube_tight;
        if let Some(passage) = table.gridels.and_then(|gridels| gridels.passage(ray)) {
            look_up(passage.cell, count);
            along(&table.lists, &passage, ray, |slot| {
                leaf(scene.shapes.single(slot), count)
            });
        }
    }
}

/// The lists of a scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Held<'a>(Table<'a>);

const GRIDELS: SectionKind = SectionKind::TightGridels;
const LISTS: ListSections = ListSections {
    cells: SectionKind::TightCells,
    starts: SectionKind::TightStarts,
    entries: SectionKind::TightEntries,
    keys: Some(SectionKind::TightKeys),
};

impl<'a> Records<'a> for Held<'a> {
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

    fn check(&self, scene: &Scene<'a>) -> Result<usize, BlobError> {
        self.0.check(scene, GRIDELS, &LISTS, scene.shapes.total())?;
        Ok(0)
    }
}
