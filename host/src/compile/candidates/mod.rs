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

use super::section::{Section, section};
use super::structures::layout::Layout;
use apex::Apexes;
use cylinder_cube::Cube;
use gridel_core::Structure;
use gridel_core::format::SectionKind;
use gridel_core::shared::{self, ListSections};
use lists::{Array, Lists};
use ray_classes::Classes;

/// The sections of a table of lists.
fn sections_of(kinds: ListSections, lists: Lists) -> Vec<Section> {
    let array = |kind, Array { width, bytes }| Section {
        kind,
        stride: width,
        bytes,
    };
    let mut sections = vec![
        array(kinds.cells, lists.cells),
        array(kinds.starts, lists.starts),
        array(kinds.entries, lists.entries),
    ];
    sections.extend(kinds.keys.map(|kind| Section {
        kind,
        stride: 1,
        bytes: lists.keys,
    }));
    sections
}

impl Layout {
    /// Returns the tree over rays and its lists.
    pub fn of_classes(classes: Classes) -> Self {
        let figures = classes.lists.figures;
        let mut sections = vec![section(SectionKind::ClassNodes, &classes.nodes)];
        sections.extend(sections_of(shared::ray_classes::LISTS, classes.lists));
        Self {
            structure: Structure::RayClasses,
            sections,
            uses_leaves: false,
            stack_depth: 0,
            longest_list: figures.longest as usize,
            table: Some(figures),
        }
    }

    /// Returns the lists of apexes.
    pub fn of_apexes(apexes: Apexes) -> Self {
        let figures = apexes.lists.figures;
        let mut sections = vec![
            section(SectionKind::ApexPoints, &apexes.points),
            section(SectionKind::ApexWindows, &apexes.windows),
        ];
        sections.extend(sections_of(shared::apex::LISTS, apexes.lists));
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

    /// Returns a table over pairs of gridels, in the sections of gridels and lists.
    pub fn of_cube(
        structure: Structure,
        (gridels, lists): (SectionKind, ListSections),
        cube: Cube,
    ) -> Self {
        let figures = cube.lists.figures;
        let holds_nodes = structure == Structure::CylinderCubeEntry;
        let mut sections = vec![section(gridels, &[cube.gridels])];
        sections.extend(sections_of(lists, cube.lists));
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
