//! What each structure adds to a blob: the one place on the host that names them all.

use super::candidates::cylinder_cube::{self, Cylinders, Hulls};
use super::candidates::entry::EntryNodes;
use super::candidates::lists::Figures;
use super::candidates::own_rays::own_rays;
use super::candidates::target::Targets;
use super::candidates::{self, Budget, apex, ray_classes};
use super::cells::{self, Cells, slot_boxes};
use super::hierarchy::{Node, Primitive};
use super::lattice::Lattice;
use super::octree;
use super::pairs::Flat;
use super::primitives::Primitives;
use super::surroundings::Surroundings;
use super::volumes::Tree;
use super::wide::Wide;
use super::writer::{self, Section, section};
use super::{CompileError, Options, Tell};
use crate::scene::Scene;
use gridel_core::Structure;
use gridel_core::accel::candidates::ray_classes::ClassPoint;
use gridel_core::format::SectionKind;
use gridel_core::format::record::UnitBox;

/// What one structure adds to a blob.
#[derive(Clone, Debug)]
pub struct Layout {
    pub structure: Structure,
    /// The sections that are this structure's alone.
    pub sections: Vec<Section>,
    /// Whether it leads to the leaves that hierarchies share.
    pub uses_leaves: bool,
    /// Entries that a walk's stack must hold.
    pub stack_depth: usize,
    /// Primitives of the longest list that it leads to.
    pub longest_list: usize,
    /// What its lists of candidates came to, if it has such.
    pub table: Option<Figures>,
}

/// What structures are built from.
#[derive(Clone, Copy)]
pub struct Ground<'g> {
    pub scene: &'g Scene,
    pub lattice: &'g Lattice,
    /// The hierarchy, if a structure takes it.
    pub root: Option<&'g Node>,
    pub flat: &'g Flat,
    /// Empty unless it is asked for.
    pub wide: &'g Wide,
    /// In the order of the hierarchy's leaves.
    pub order: &'g [Primitive],
    pub primitives: &'g Primitives,
    /// The box of all primitives; a point without any.
    pub bounds: UnitBox,
    pub surroundings: &'g Surroundings,
    pub options: &'g Options,
    pub tell: Tell<'g>,
}

impl<'g> Ground<'g> {
    fn tree(&self) -> Option<Tree<'g>> {
        let root = self.root?;
        Some(Tree::new(root, self.flat, self.order, self.primitives))
    }

    fn targets(&self) -> Targets<'g> {
        Targets::new(self.primitives, self.flat, self.bounds)
    }

    /// The rays of the scene's own picture, through a blob with nothing but the hierarchy.
    fn own_rays(&self) -> Result<Vec<ClassPoint>, CompileError> {
        let hierarchy = Layout::of(Structure::Flagged, self)?;
        let blob = writer::write(writer::parts(self, vec![hierarchy]))?;
        // What the writer writes, the core reads: the tests hold them to it.
        Ok(blob
            .scene()
            .map_or_else(|_| Vec::new(), |scene| own_rays(&scene)))
    }

    /// The budget of a structure's table.
    fn budget<'t>(&self, structure: Structure, tell: candidates::Tell<'t>) -> Budget<'t> {
        let options = self.options;
        Budget {
            gridels: options.gridels,
            bytes: options.budget.unwrap_or(usual_budget(structure)),
            tell,
        }
    }
}

/// Whether a structure is laid out over the hierarchy; the others leave primitives as they are.
pub fn takes_hierarchy(structure: Structure) -> bool {
    !matches!(
        structure,
        Structure::List | Structure::Wide | Structure::Grid | Structure::Octree
    )
}

impl Layout {
    /// Lays a structure out.
    ///
    /// # Errors
    /// If it would exceed its budget.
    pub fn of(structure: Structure, ground: &Ground<'_>) -> Result<Self, CompileError> {
        let flat = ground.flat;
        let tell = |done, of| (ground.tell)(structure, done, of);
        let budget = ground.budget(structure, &tell);
        Ok(match structure {
            Structure::List => Self::apart(
                structure,
                Cells {
                    longest_list: ground.order.len(),
                    ..Cells::default()
                },
            ),
            Structure::Bvh => Self::over_leaves(
                structure,
                vec![section(SectionKind::Pairs, &flat.pairs)],
                flat,
            ),
            Structure::Flagged => Self::over_leaves(
                structure,
                vec![section(SectionKind::FlaggedPairs, &flat.flagged)],
                flat,
            ),
            Structure::DualSplit => Self::over_leaves(
                structure,
                vec![section(SectionKind::DualNodes, &flat.dual)],
                flat,
            ),
            Structure::Slabs | Structure::FlaggedSlabs => {
                let directions = ground.options.slab_directions;
                let flagged = structure == Structure::FlaggedSlabs;
                let tree = ground.tree();
                let slabs = tree.map(|tree| tree.slabs(directions, flagged));
                Self::over_leaves(structure, slabs.unwrap_or_default(), flat)
            }
            Structure::Spheres => {
                let balls = ground.tree().map(|tree| vec![tree.balls()]);
                Self::over_leaves(structure, balls.unwrap_or_default(), flat)
            }
            Structure::Grid => {
                let boxes = slot_boxes(flat, ground.order);
                let grid = cells::grid(&ground.bounds, &boxes, ground.options.grid)?;
                Self::apart(structure, grid)
            }
            Structure::Octree => {
                let boxes = slot_boxes(flat, ground.order);
                Self::apart(structure, octree::build(&ground.bounds, &boxes)?)
            }
            Structure::CylinderCube => {
                let targets = ground.targets();
                let form = Cylinders::new(&targets);
                Self::of_cube(structure, cylinder_cube::build(&form, &targets, budget)?)
            }
            Structure::CylinderCubeTight => {
                let targets = ground.targets();
                let cube = cylinder_cube::build(&Hulls(&targets), &targets, budget)?;
                Self::of_cube(structure, cube)
            }
            Structure::CylinderCubeEntry => {
                let targets = ground.targets();
                let cube = cylinder_cube::build(&EntryNodes(&targets), &targets, budget)?;
                Self::of_cube(structure, cube)
            }
            Structure::RayClasses => {
                let rays = ground.own_rays()?;
                Self::of_classes(ray_classes::build(&ground.targets(), &rays, budget)?)
            }
            Structure::Apex => {
                let Surroundings { view, lights, .. } = ground.surroundings;
                Self::of_apexes(apex::build(&ground.targets(), view, lights, budget))
            }
            Structure::Wide => {
                let wide = ground.wide;
                Self {
                    structure,
                    sections: wide.sections(ground.primitives, ground.lattice.bits),
                    uses_leaves: false,
                    stack_depth: wide.stack_depth,
                    longest_list: wide.longest_list(),
                    table: None,
                }
            }
        })
    }

    /// A structure over the leaves that hierarchies share, as deep as their pairs.
    fn over_leaves(structure: Structure, sections: Vec<Section>, flat: &Flat) -> Self {
        Self {
            structure,
            sections,
            uses_leaves: true,
            stack_depth: flat.depth,
            longest_list: flat.longest_leaf,
            table: None,
        }
    }

    /// A structure that leads to primitives by itself.
    fn apart(structure: Structure, cells: Cells) -> Self {
        Self {
            structure,
            sections: cells.sections,
            uses_leaves: false,
            stack_depth: cells.stack_depth,
            longest_list: cells.longest_list,
            table: None,
        }
    }
}

/// The structure that another one leads on to.
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
        // What the paper's machine had.
        Structure::CylinderCube => 48 * MEGABYTE,
        Structure::CylinderCubeEntry => 2 * MEGABYTE,
        // For each point and each direction.
        Structure::Apex => MEGABYTE,
        _ => 4 * MEGABYTE,
    }
}
