//! The input of structures' builders.

use crate::compile::candidates::target::Targets;
use crate::compile::error::CompileError;
use crate::compile::geometry::primitives::Primitives;
use crate::compile::hierarchy::node::{Node, Primitive};
use crate::compile::hierarchy::pairs::Flat;
use crate::compile::hierarchy::volumes::Tree;
use crate::compile::instances::{CompiledInstances, Parts, Role};
use crate::compile::options::{OnProgress, Options};
use crate::compile::shading::ShadingData;
use crate::compile::wide::Wide;
use crate::scene::Scene;
use crate::shape::Lattice;
use gridel_core::format::record::UnitBox;

/// The input of structures' builders.
#[derive(Clone, Copy)]
pub struct BuildContext<'g> {
    pub scene: &'g Scene,
    pub lattice: &'g Lattice,
    /// The hierarchy, if a structure takes it.
    pub root: Option<&'g Node>,
    pub flat: &'g Flat,
    /// Empty unless it is requested.
    pub wide: &'g Wide,
    /// In the order of the hierarchy's leaves.
    pub order: &'g [Primitive],
    pub primitives: &'g Primitives,
    /// The box of all primitives; a point without any.
    pub bounds: UnitBox,
    pub shading: &'g ShadingData,
    pub role: Role<'g>,
    pub placed: &'g CompiledInstances,
    /// The scene's parts, compiled with other options.
    pub parts_with: &'g dyn Fn(&Options) -> Result<Parts, CompileError>,
    pub options: &'g Options,
    pub on_progress: OnProgress<'g>,
}

impl<'g> BuildContext<'g> {
    pub fn tree(&self) -> Option<Tree<'g>> {
        let root = self.root?;
        Some(Tree::new(root, self.flat, self.order, self.primitives))
    }

    /// Returns the share of a table's bytes that is for this blob: scene and parts share them by their primitives.
    pub fn share(&self, bytes: u64) -> u64 {
        /// Enough for the table of a part of few primitives.
        const LEAST: u64 = 4096;
        let own = u64::from(self.primitives.total);
        let all = match self.role {
            Role::Whole(parts) => own + u64::from(parts.primitives()),
            Role::Part { all } => all,
        };
        if own >= all {
            return bytes;
        }
        let share = u128::from(bytes) * u128::from(own) / u128::from(all);
        (share as u64).max(LEAST.min(bytes))
    }

    pub fn targets(&self) -> Targets<'g> {
        Targets::new(self.primitives, self.flat, self.bounds)
    }
}
