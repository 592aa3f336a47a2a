//! The cylinder cube in the paper's form (section 3.1).
//!
//! Each of the six sides of the scene's box is cut into n by n gridels. The volume between two
//! gridels of different sides is approximated by a cylinder about the line through their midpoints.
//! The cylinder is wide enough to hold all eight corners. Its list holds the primitives whose
//! bounding spheres reach into it, in no particular order. A ray tests the whole list of the two
//! gridels by which it enters and leaves.
//!
//! Memory: 15 n^4 cells, and a list for each. Cost: the whole list, which is why the paper's
//! cylinder cube lost against a grid. [`CylinderCubeTight`](crate::accel::CylinderCubeTight) and
//! [`CylinderCubeEntry`](crate::accel::CylinderCubeEntry) improve on it.

use crate::accel::candidates::gridel_table::Table;
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

/// The cylinder cube: one list of primitives for each cylinder between two gridels. It needs no
/// stack.
#[derive(Clone, Copy, Debug)]
pub enum CylinderCube {}

impl Traverse for CylinderCube {
    const STRUCTURE: Structure = Structure::CylinderCube;
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
        let Some(passage) = table.gridels.and_then(|gridels| gridels.passage(ray)) else {
            return;
        };
        look_up(passage.cell, count);
        for index in table.lists.list(passage.cell) {
            let Some(slot) = table.lists.entry(index) else {
                return;
            };
            if leaf(geometry.shapes.single(slot), count).is_none() {
                return;
            }
        }
    }
}

/// The lists of a scene.
#[derive(Clone, Copy, Debug)]
pub struct Views<'a>(Table<'a>);

/// The section of the gridels.
pub const GRIDELS: SectionKind = SectionKind::CylinderGridels;
/// The sections of the lists.
pub const LISTS: ListSections = ListSections {
    cells: SectionKind::CylinderCells,
    starts: SectionKind::CylinderStarts,
    entries: SectionKind::CylinderEntries,
    keys: None,
};

impl<'a> Records<'a> for Views<'a> {
    const SECTIONS: &'static [SectionKind] = &[GRIDELS, LISTS.cells, LISTS.starts, LISTS.entries];
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
