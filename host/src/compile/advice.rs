//! What to change where a blob is larger than it may be.

use super::layout::{self, Layout, takes_hierarchy};
use super::{Options, compile, writer};
use crate::blob::Blob;
use crate::report::{grouped, narrower_storage};
use crate::scene::Scene;
use gridel_core::Structure;

/// What a structure takes of a blob.
pub struct Size {
    structure: Structure,
    /// Of its own sections.
    bytes: usize,
    uses_leaves: bool,
}

impl Size {
    pub fn of(layout: &Layout) -> Self {
        let sections = layout.sections.iter();
        Self {
            structure: layout.structure,
            bytes: sections
                .map(|section| writer::taken(section.bytes.len()))
                .sum(),
            uses_leaves: layout.uses_leaves,
        }
    }
}

/// What makes a blob smaller, by its own figures and the bytes of the leaves that hierarchies share.
pub fn advice(
    scene: &Scene,
    options: &Options,
    blob: &Blob,
    leaves: usize,
    sizes: &[Size],
) -> String {
    let mut steps = Vec::new();
    steps.extend(blob.scene().ok().as_ref().and_then(narrower_storage));
    let mut asked = options.structures.clone();
    asked.sort();
    asked.dedup();
    asked.retain(|&structure| structure != Structure::List);
    if options.leaf_size == 0 && asked.iter().copied().any(takes_hierarchy) {
        steps.push(String::from(
            "`--leaf-size 8` makes fewer nodes and costs time",
        ));
    }
    if let [structure] = asked[..] {
        // Without a hierarchy primitives keep the file's order as well, so all of it is built.
        let list = Options {
            structures: vec![Structure::List],
            max_bytes: None,
            ..options.clone()
        };
        if let Ok(list) = compile(scene, &list) {
            steps.push(format!(
                "`--accel list` instead of {} saves {} bytes and costs time",
                structure.name(),
                grouped(blob.bytes().len() - list.report.bytes)
            ));
        }
    }
    for &structure in asked.iter().filter(|_| asked.len() > 1) {
        let others = asked.iter().copied().filter(|&it| it != structure);
        let kept: Vec<_> = others
            .flat_map(|it| [Some(it), layout::leads_to(it)])
            .flatten()
            .collect();
        let (stay, go): (Vec<&Size>, Vec<&Size>) = sizes
            .iter()
            .partition(|size| kept.contains(&size.structure));
        let mut saved: usize = go.iter().map(|size| size.bytes).sum();
        if !stay.iter().any(|size| size.uses_leaves) {
            saved += leaves;
        }
        steps.push(format!(
            "leaving out `--accel {}` saves {} bytes",
            structure.name(),
            grouped(saved)
        ));
    }
    steps.push(String::from("a scene with fewer primitives"));
    steps.join("; ")
}
