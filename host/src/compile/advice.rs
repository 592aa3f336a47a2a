//! Advice for blobs that are larger than allowed.

use super::options::Options;
use super::sizes::{Size, Sizes};
use super::structures::leads_to;
use crate::blob::Blob;
use crate::scene::Scene;
use crate::table::grouped;
use gridel_core::{Prevalidated, Structure};

/// The most primitives, with those of instances, for which a scene is compiled with copies in place of instances only to
/// say how many bytes they take.
pub const MOST_COPIED: u64 = 200_000;

/// Returns whether to say how many bytes copies of a scene's instances take: if they stand still, and are few.
pub fn may_copy(scene: &Scene) -> bool {
    let moves = scene.instances.iter().any(|it| it.joint.is_some());
    !scene.instances.is_empty() && !moves && scene.placed_primitives() <= MOST_COPIED
}

/// Returns advice that makes a blob smaller, from its figures.
/// `bytes_with` compiles the scene with other options, and returns the size of the blob; `as_copies` is its size with
/// instances copied, if there are any that stand still.
pub fn advice(
    options: &Options,
    blob: &Blob,
    sizes: &Sizes,
    bytes_with: &dyn Fn(&Options) -> Option<usize>,
    as_copies: Option<usize>,
) -> String {
    let mut asked = options.structures.clone();
    asked.sort();
    asked.dedup();
    asked.retain(|&structure| structure != Structure::List);
    // Leaves and the order of primitives change as well, so all of it is built.
    let saves = |what: String, other: Options| {
        let saved = blob.bytes().len().checked_sub(bytes_with(&other)?);
        let saved = saved.filter(|&saved| saved > 0)?;
        Some(format!("{what} saves {} bytes", grouped(saved)))
    };
    let and_costs_time = |step| format!("{step} and costs time");
    let mut steps = Vec::new();
    let saved = as_copies.and_then(|bytes| blob.bytes().len().checked_sub(bytes));
    if let Some(saved) = saved.filter(|&saved| saved > 0) {
        steps.push(format!(
            "`--instances flatten` saves {} bytes",
            grouped(saved)
        ));
    }
    // Tables take long to make: with them nothing is tried.
    if asked.iter().all(|it| Prevalidated::STRUCTURES.contains(it)) {
        let narrow = Options {
            lattice_bits: options.lattice_bits.min(16),
            ..options.clone()
        };
        steps.extend(saves(String::from("`--lattice-bits 16`"), narrow));
        if options.leaf_size == 0 {
            let fewer_nodes = Options {
                leaf_size: 8,
                ..options.clone()
            };
            let step = saves(String::from("`--leaf-size 8`"), fewer_nodes);
            steps.extend(step.map(and_costs_time));
        }
    }
    if let [structure] = asked[..] {
        for other in [Structure::Flagged, Structure::List] {
            let what = format!("`--accel {}` instead of {}", other.name(), structure.name());
            let structures = vec![other];
            let step = saves(
                what,
                Options {
                    structures,
                    ..options.clone()
                },
            );
            steps.extend(step.map(and_costs_time));
        }
    }
    for &structure in asked.iter().filter(|_| asked.len() > 1) {
        let what = format!("leaving out `--accel {}`", structure.name());
        let others = asked.iter().copied().filter(|&it| it != structure);
        if asked.iter().all(|it| it.is_proved()) {
            let structures = others.collect();
            let rest = Options {
                structures,
                ..options.clone()
            };
            steps.extend(saves(what, rest));
            continue;
        }
        let kept: Vec<_> = others
            .flat_map(|it| [Some(it), leads_to(it)])
            .flatten()
            .collect();
        let (stay, go): (Vec<&Size>, Vec<&Size>) = sizes
            .structures
            .iter()
            .partition(|size| kept.contains(&size.structure));
        let mut saved: usize = go.iter().map(|size| size.bytes).sum();
        if !stay.iter().any(|size| size.uses_leaves) {
            saved += sizes.leaves;
        }
        if saved > 0 {
            steps.push(format!("{what} saves {} bytes", grouped(saved)));
        }
    }
    steps.push(String::from("a scene with fewer primitives or instances"));
    steps.join("; ")
}
