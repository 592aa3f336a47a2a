//! Builders of candidate lists: what the rays of a bundle can meet, found before any ray is cast.
//!
//! | file | what it holds |
//! |---|---|
//! | `shaft.rs` | a bundle of rays as a volume, and what it meets |
//! | `target.rs` | primitives as shafts see them, and the search through the hierarchy |
//! | `budget.rs` | what a table may take |
//! | `lists.rs` | tables of lists: counted first, equal ones once, in parallel |
//! | `cylinder_cube.rs` | lists for pairs of gridels |
//! | `census.rs` | what the paper's table takes, without building it |
//! | `entry.rs` | nodes of the hierarchy for pairs of gridels |
//! | `apex.rs` | lists for the rays of the eye and of lights |
//! | `bundle.rs` | these rays, and what they are sorted by |
//! | `ray_classes.rs` | lists for classes of rays by origin and direction |
//! | `own_rays.rs` | the rays of the scene's own picture, where classes are fine |

pub mod apex;
pub mod budget;
mod bundle;
pub mod census;
pub mod cylinder_cube;
pub mod entry;
pub mod lists;
pub mod own_rays;
pub mod ray_classes;
mod shaft;
pub mod target;

use super::layout::Layout;
use super::section::{Section, section};
use apex::Apexes;
use cylinder_cube::Cube;
use gridel_core::Structure;
use gridel_core::format::SectionKind;
use lists::{Array, Lists};
use ray_classes::Classes;

/// The sections of a table of lists.
struct ListSections {
    cells: SectionKind,
    starts: SectionKind,
    entries: SectionKind,
    keys: Option<SectionKind>,
}

impl ListSections {
    fn of(self, lists: Lists) -> Vec<Section> {
        let array = |kind, Array { width, bytes }| Section {
            kind,
            stride: width,
            bytes,
        };
        let mut sections = vec![
            array(self.cells, lists.cells),
            array(self.starts, lists.starts),
            array(self.entries, lists.entries),
        ];
        sections.extend(self.keys.map(|kind| Section {
            kind,
            stride: 1,
            bytes: lists.keys,
        }));
        sections
    }
}

impl Layout {
    /// The tree over rays and its lists.
    pub fn of_classes(classes: Classes) -> Self {
        let kinds = ListSections {
            cells: SectionKind::ClassCells,
            starts: SectionKind::ClassStarts,
            entries: SectionKind::ClassEntries,
            keys: Some(SectionKind::ClassKeys),
        };
        let figures = classes.lists.figures;
        let mut sections = vec![section(SectionKind::ClassNodes, &classes.nodes)];
        sections.extend(kinds.of(classes.lists));
        Self {
            structure: Structure::RayClasses,
            sections,
            uses_leaves: false,
            stack_depth: 0,
            longest_list: figures.longest as usize,
            table: Some(figures),
        }
    }

    /// The lists of apexes.
    pub fn of_apexes(apexes: Apexes) -> Self {
        let kinds = ListSections {
            cells: SectionKind::ApexCells,
            starts: SectionKind::ApexStarts,
            entries: SectionKind::ApexEntries,
            keys: Some(SectionKind::ApexKeys),
        };
        let figures = apexes.lists.figures;
        let mut sections = vec![
            section(SectionKind::ApexPoints, &apexes.points),
            section(SectionKind::ApexWindows, &apexes.windows),
        ];
        sections.extend(kinds.of(apexes.lists));
        sections.push(section(SectionKind::ApexDirections, &apexes.directions));
        Self {
            structure: Structure::Apex,
            sections,
            uses_leaves: false,
            stack_depth: 0,
            longest_list: figures.longest as usize,
            table: Some(figures),
        }
    }

    /// A table over pairs of gridels.
    pub fn of_cube(structure: Structure, cube: Cube) -> Self {
        let (gridels, kinds) = match structure {
            Structure::CylinderCubeTight => (
                SectionKind::TightGridels,
                ListSections {
                    cells: SectionKind::TightCells,
                    starts: SectionKind::TightStarts,
                    entries: SectionKind::TightEntries,
                    keys: Some(SectionKind::TightKeys),
                },
            ),
            Structure::CylinderCubeEntry => (
                SectionKind::EntryGridels,
                ListSections {
                    cells: SectionKind::EntryCells,
                    starts: SectionKind::EntryStarts,
                    entries: SectionKind::EntryNodes,
                    keys: Some(SectionKind::EntryKeys),
                },
            ),
            _ => (
                SectionKind::CylinderGridels,
                ListSections {
                    cells: SectionKind::CylinderCells,
                    starts: SectionKind::CylinderStarts,
                    entries: SectionKind::CylinderEntries,
                    keys: None,
                },
            ),
        };
        let figures = cube.lists.figures;
        let holds_nodes = structure == Structure::CylinderCubeEntry;
        let mut sections = vec![section(gridels, &[cube.gridels])];
        sections.extend(kinds.of(cube.lists));
        Self {
            structure,
            sections,
            uses_leaves: holds_nodes,
            stack_depth: 0,
            // Nodes are not primitives: they lead to the hierarchy's leaves.
            longest_list: if holds_nodes {
                0
            } else {
                figures.longest as usize
            },
            table: Some(figures),
        }
    }
}
