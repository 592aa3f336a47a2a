//! Advice for blobs that are larger than allowed.

use super::compile;
use super::error::CompileError;
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

/// Returns an error with advice if a scene's blob is larger than the options allow.
pub fn check_bytes(
    blob: &Blob,
    scene: &Scene,
    options: &Options,
    sizes: &Sizes,
) -> Result<(), CompileError> {
    let bytes = blob.bytes().len() as u64;
    let Some(most) = options.max_bytes.filter(|&most| bytes > most) else {
        return Ok(());
    };
    let bytes_with = |other: &Options| {
        let unnamed = Options {
            names: false,
            ..other.clone()
        };
        Some(compile(scene, &unnamed).ok()?.report.bytes)
    };
    let bytes_as_copies = || {
        let moves = scene.instances.iter().any(|it| it.joint.is_some());
        if moves || scene.placed_primitives() > MOST_COPIED {
            return None;
        }
        let unlimited = Options {
            names: false,
            max_bytes: None,
            ..options.clone()
        };
        Some(
            compile(&*scene.flattened().ok()?, &unlimited)
                .ok()?
                .report
                .bytes,
        )
    };
    let as_copies = (!scene.instances.is_empty())
        .then(bytes_as_copies)
        .flatten();
    Err(CompileError::TooLarge {
        bytes,
        over: bytes - most,
        advice: advice(options, blob, sizes, &bytes_with, as_copies),
    })
}

/// Returns advice that makes a blob smaller, from its figures.
/// `bytes_with` compiles the scene with other options, and returns the size of the blob; `as_copies` is its size with
/// instances copied, if there are any that stand still.
fn advice(
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
        let other = Options {
            max_bytes: None,
            ..other
        };
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
        let others = asked.iter().copied().filter(|&it| it != structure);
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
        steps.push(format!(
            "leaving out `--accel {}` saves {} bytes",
            structure.name(),
            grouped(saved)
        ));
    }
    steps.push(String::from("a scene with fewer primitives or instances"));
    steps.join("; ")
}
