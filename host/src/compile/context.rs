//! What structures are built from.

use super::candidates::target::Targets;
use super::hierarchy::{Node, Primitive};
use super::options::{Options, Tell};
use super::pairs::Flat;
use super::primitives::Primitives;
use super::surroundings::Surroundings;
use super::volumes::Tree;
use super::wide::Wide;
use crate::scene::Scene;
use crate::shape::Lattice;
use gridel_core::format::record::UnitBox;

/// What structures are built from.
#[derive(Clone, Copy)]
pub struct BuildContext<'g> {
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

impl<'g> BuildContext<'g> {
    pub fn tree(&self) -> Option<Tree<'g>> {
        let root = self.root?;
        Some(Tree::new(root, self.flat, self.order, self.primitives))
    }

    pub fn targets(&self) -> Targets<'g> {
        Targets::new(self.primitives, self.flat, self.bounds)
    }
}
