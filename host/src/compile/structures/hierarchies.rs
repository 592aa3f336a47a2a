//! The hierarchies that structures are laid out from.

use super::takes_hierarchy;
use crate::compile::error::CompileError;
use crate::compile::geometry::primitives::Primitives;
use crate::compile::hierarchy::node::{Node, Primitive};
use crate::compile::hierarchy::pairs::{self, Flat};
use crate::compile::hierarchy::{builder, dual_split};
use crate::compile::options::{LARGEST_LEAF, Options};
use crate::compile::wide::Wide;
use crate::scene::Scene;
use gridel_core::{Kind, Structure};

/// The input of the layout of structures.
pub struct Hierarchies {
    /// Shared by all structures that need one.
    pub root: Option<Node>,
    /// Primitives in the order of its leaves.
    pub order: Vec<Primitive>,
    pub flat: Flat,
    pub wide: Wide,
}

impl Hierarchies {
    /// Builds what some structures take.
    pub fn build(
        scene: &Scene,
        snapped: &Primitives,
        structures: &[Structure],
        options: &Options,
    ) -> Result<Self, CompileError> {
        let mut order: Vec<Primitive> = snapped.boxes();
        let mut root = if structures.iter().copied().any(takes_hierarchy) {
            builder::build(
                options.builder,
                &mut order,
                options.leaf_size.min(LARGEST_LEAF),
                |primitive| snapped.object(scene, primitive),
            )
        } else {
            None
        };
        // First, because it decides which child is the first.
        let dual = match &mut root {
            Some(root) if structures.contains(&Structure::DualSplit) => dual_split::lay_out(root),
            _ => Vec::new(),
        };
        // The eight-wide hierarchy holds triangles and spheres itself; alone it needs no slots of them.
        let has_wide = structures.contains(&Structure::Wide);
        // The attributes of vertices are found by slots.
        let wide_alone = has_wide
            && snapped.corners.is_empty()
            && structures
                .iter()
                .all(|it| [Structure::Wide, Structure::List].contains(it));
        let mut flat = match &root {
            Some(root) => pairs::flatten(root, &order),
            None if wide_alone => Flat::default(),
            None => Flat::in_file_order(&order),
        };
        flat.dual = dual;
        let wide = if has_wide {
            let shared = (!wide_alone).then_some(&flat);
            Wide::build(snapped, &order, options.quality, shared)?
        } else {
            Wide::default()
        };
        if wide_alone {
            flat.slots.clone_from(&wide.slots);
        }
        // Shapes without a box are in no structure, and stay in the order of the scene file.
        for kind in Kind::ALL.into_iter().filter(|kind| !kind.is_bounded()) {
            let count = snapped.numbers[kind as usize].len() as u32;
            flat.slots[kind as usize] = (0..count).collect();
        }
        Ok(Self {
            root,
            order,
            flat,
            wide,
        })
    }
}
