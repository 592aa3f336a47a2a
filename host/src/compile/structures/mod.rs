//! The sections that each structure adds to a blob: the one place on the host that names all structures.
//!
//! | file | what it holds |
//! |---|---|
//! | `hierarchies.rs` | the hierarchies that structures are laid out from |
//! | `context.rs` | the input of the layout |
//! | `layout.rs` | its result: sections, stack and lists of one structure |

pub mod context;
pub mod hierarchies;
pub mod layout;

use super::candidates::budget::{self, Budget};
use super::candidates::cylinder_cube::{self, Cylinders, Form, Hulls};
use super::candidates::entry::EntryNodes;
use super::candidates::own_rays::own_rays;
use super::candidates::target::Targets;
use super::candidates::{apex, ray_classes};
use super::cells::{Cells, grid, octree, slot_boxes};
use super::error::CompileError;
use super::section::section;
use context::BuildContext;
use gridel_core::Structure;
use gridel_core::format::SectionKind;
use gridel_core::shared::{self, ListSections};
use layout::Layout;

/// Lays a structure out.
///
/// # Errors
/// If it would exceed its budget.
pub fn lay_out(structure: Structure, context: &BuildContext<'_>) -> Result<Layout, CompileError> {
    let flat = context.flat;
    let on_progress = |done, of| (context.on_progress)(structure, done, of);
    let budget = budget(context, structure, &on_progress);
    Ok(match structure {
        Structure::List => Layout::apart(
            structure,
            Cells {
                longest_list: context.order.len(),
                ..Cells::default()
            },
        ),
        Structure::Bvh => Layout::over_leaves(
            structure,
            vec![section(SectionKind::Pairs, &flat.pairs)],
            flat,
        ),
        Structure::Flagged => Layout::flagged(flat),
        Structure::DualSplit => Layout::over_leaves(
            structure,
            vec![section(SectionKind::DualNodes, &flat.dual)],
            flat,
        ),
        Structure::Slabs | Structure::FlaggedSlabs => {
            let directions = context.options.slab_directions;
            let flagged = structure == Structure::FlaggedSlabs;
            let tree = context.tree();
            let slabs = tree.map(|tree| tree.slabs(directions, flagged));
            Layout::over_leaves(structure, slabs.unwrap_or_default(), flat)
        }
        Structure::Spheres => {
            let spheres = context.tree().map(|tree| vec![tree.spheres()]);
            Layout::over_leaves(structure, spheres.unwrap_or_default(), flat)
        }
        Structure::Grid => {
            let boxes = slot_boxes(flat, context.order);
            let grid = grid::build(&context.bounds, &boxes, context.options.grid)?;
            Layout::apart(structure, grid)
        }
        Structure::Octree => {
            let boxes = slot_boxes(flat, context.order);
            Layout::apart(structure, octree::build(&context.bounds, &boxes)?)
        }
        Structure::CylinderCube => {
            use shared::cylinder_cube::{GRIDELS, LISTS};
            let targets = context.targets();
            cube(&Cylinders::new(&targets), &targets, budget, GRIDELS, LISTS)?
        }
        Structure::CylinderCubeTight => {
            use shared::cylinder_cube_tight::{GRIDELS, LISTS};
            let targets = context.targets();
            cube(&Hulls(&targets), &targets, budget, GRIDELS, LISTS)?
        }
        Structure::CylinderCubeEntry => {
            use shared::cylinder_cube_entry::{GRIDELS, LISTS};
            let targets = context.targets();
            cube(&EntryNodes(&targets), &targets, budget, GRIDELS, LISTS)?
        }
        Structure::RayClasses => {
            let rays = own_rays(context)?;
            let classes = ray_classes::build(&context.targets(), &rays, budget)?;
            let figures = classes.lists.figures;
            Layout::of_table(structure, classes.sections(), figures)
        }
        Structure::Apex => {
            let (view, lights) = (&context.shading.view, context.shading.lights());
            let apexes = apex::build(&context.targets(), view, lights, budget);
            let figures = apexes.lists.figures;
            Layout::of_table(structure, apexes.sections(), figures)
        }
        Structure::Wide => {
            let wide = context.wide;
            Layout {
                structure,
                sections: wide.sections(context.primitives, context.lattice.bits),
                uses_leaves: false,
                stack_depth: wide.stack_depth,
                longest_list: wide.longest_list(),
                table: None,
            }
        }
    })
}

/// Lays out a table over pairs of gridels, in the sections of gridels and lists.
fn cube<F: Form>(
    form: &F,
    targets: &Targets<'_>,
    budget: Budget<'_>,
    gridels: SectionKind,
    lists: ListSections,
) -> Result<Layout, CompileError> {
    let cube = cylinder_cube::build(form, targets, budget)?;
    let figures = cube.lists.figures;
    let mut sections = vec![section(gridels, &[cube.gridels])];
    sections.extend(cube.lists.sections(lists));
    Ok(Layout::of_table(F::STRUCTURE, sections, figures))
}

/// The budget of a structure's table.
fn budget<'t>(
    context: &BuildContext<'_>,
    structure: Structure,
    on_progress: budget::OnProgress<'t>,
) -> Budget<'t> {
    let options = context.options;
    Budget {
        gridels: options.gridels,
        bytes: context.share(options.budget.unwrap_or(usual_budget(structure))),
        on_progress,
    }
}

/// Returns whether a structure is laid out over the hierarchy; the others leave primitives as they are.
pub fn takes_hierarchy(structure: Structure) -> bool {
    !matches!(
        structure,
        Structure::List | Structure::Wide | Structure::Grid | Structure::Octree
    )
}

/// Returns the structure that another one leads on to.
pub const fn leads_to(structure: Structure) -> Option<Structure> {
    match structure {
        Structure::CylinderCubeEntry | Structure::Apex | Structure::RayClasses => {
            Some(Structure::Bvh)
        }
        _ => None,
    }
}

/// Most bytes of a structure's table, where no budget is given.
pub const fn usual_budget(structure: Structure) -> u64 {
    const MEGABYTE: u64 = 1 << 20;
    match structure {
        // The memory of the paper's machine.
        Structure::CylinderCube => 48 * MEGABYTE,
        Structure::CylinderCubeEntry => 2 * MEGABYTE,
        // For each point and each direction.
        Structure::Apex => MEGABYTE,
        _ => 4 * MEGABYTE,
    }
}
