//! Compiles a scene into a blob: lattice, primitives, hierarchy, effects, bytes.

mod hierarchy;
mod lattice;
mod layout;
mod pairs;
mod primitives;
mod surroundings;
mod writer;

pub use lattice::BITS as LATTICE_BITS;

use crate::scene::{Object, Scene};
use glam::DVec3;
use gridel_core::Structure;
use hierarchy::Primitive;
use lattice::Lattice;
use layout::Layout;
use primitives::Primitives;
use std::time::{Duration, Instant};

/// What to put into a blob.
#[derive(Clone, Debug)]
pub struct Options {
    /// Acceleration structures; the list is always there.
    pub structures: Vec<Structure>,
    /// Bits that coordinates are snapped to: see [`LATTICE_BITS`].
    pub lattice_bits: u8,
    /// Refuse a blob that would be larger.
    pub max_bytes: Option<u64>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            structures: vec![Structure::Flagged],
            lattice_bits: 24,
            max_bytes: None,
        }
    }
}

/// A blob, and what is worth knowing about how it came to be.
#[derive(Clone, Debug)]
pub struct Compiled {
    pub blob: crate::blob::Blob,
    pub report: Report,
}

/// What compiling did.
#[derive(Clone, Debug, serde::Serialize)]
pub struct Report {
    /// Scene units of a lattice step.
    pub step: f64,
    /// The farthest that snapping moved a point, in scene units.
    pub largest_displacement: f64,
    /// Primitives that the lattice leaves nothing of, by name; they keep their numbers.
    pub collapsed: Vec<String>,
    /// Cost of the hierarchy by the surface area heuristic, the root's area being 1.
    pub sah_cost: f64,
    /// Length of the blob.
    pub bytes: usize,
    /// Effects and the names of what calls for each.
    pub effects: Vec<(String, Vec<String>)>,
    /// What the compiler supplied because the scene has none.
    pub supplied: Vec<String>,
    /// What the structures took to build, from primitives on the lattice to records.
    #[serde(skip)]
    pub setup: Duration,
}

/// Why a scene cannot be compiled.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum CompileError {
    #[error("{object} has a coordinate or a length that is infinite or not a number")]
    NotFinite { object: String },
    #[error("the scene's size is {size}, which no lattice can hold")]
    #[diagnostic(help("scale the scene to a size between 1e-250 and 1e250"))]
    Extent { size: f64 },
    #[error(
        "the scene lies at {middle} and is only {size} large, so its coordinates hold no detail"
    )]
    #[diagnostic(help("move the scene nearer to the origin"))]
    TooFar { middle: DVec3, size: f64 },
    #[error("{bits} lattice bits are not possible")]
    #[diagnostic(help("use 10 to 24"))]
    LatticeBits { bits: u8 },
    #[error("the scene has {count} {what}, more than the {most} that a blob can hold")]
    #[diagnostic(help("split the scene into several blobs"))]
    TooMany {
        what: &'static str,
        count: usize,
        most: usize,
    },
    #[error(
        "the {what} lies {distance:.3e} scene units from a scene of {size:.3e}: too far to be told"
    )]
    #[diagnostic(help("move it nearer; a directional light is as good as one this far away"))]
    FarAway {
        what: String,
        distance: f64,
        size: f64,
    },
    #[error("the blob would have {bytes} bytes, {over} more than --max-bytes allows")]
    #[diagnostic(help("{advice}"))]
    TooLarge {
        bytes: u64,
        over: u64,
        advice: String,
    },
}

/// Compiles a scene.
///
/// The same scene and options give the same bytes on every machine and with any number of threads.
///
/// # Errors
/// If the scene does not fit a lattice, a count does not fit the format, or the blob is larger than
/// the options allow.
pub fn compile(scene: &Scene, options: &Options) -> Result<Compiled, CompileError> {
    if !LATTICE_BITS.contains(&options.lattice_bits) {
        return Err(CompileError::LatticeBits {
            bits: options.lattice_bits,
        });
    }
    let bad = |object: &&Object| !primitives::is_finite(&object.shape);
    if let Some(object) = scene.objects.iter().find(bad) {
        return Err(CompileError::NotFinite {
            object: object.name.clone(),
        });
    }
    let (lowest, highest) = primitives::extent(scene);
    let lattice = Lattice::around(lowest, highest, options.lattice_bits)?;
    let snapped = Primitives::snap(scene, &lattice)?;
    let mut structures = options.structures.clone();
    structures.sort();
    structures.dedup();
    let started = Instant::now();
    let mut order: Vec<Primitive> = snapped.boxes();
    let bounds = hierarchy::bounds(&order);
    let root = if structures.iter().copied().any(layout::takes_hierarchy) {
        hierarchy::build(&mut order)
    } else {
        None
    };
    let flat = match &root {
        Some(root) => pairs::flatten(root, &order),
        None => pairs::Flat::in_file_order(&order),
    };
    let sah_cost = root.as_ref().map_or(0.0, hierarchy::sah_cost);
    let layouts: Vec<Layout> = structures
        .iter()
        .map(|&structure| Layout::of(structure, &flat))
        .collect();
    let setup = started.elapsed();
    let surroundings = surroundings::Surroundings::of(scene, &lattice, (lowest, highest))?;
    let blob = writer::write(&writer::Parts {
        scene,
        lattice: &lattice,
        primitives: &snapped,
        flat: &flat,
        bounds,
        surroundings: &surroundings,
        layouts: &layouts,
    })?;
    let bytes = blob.bytes().len();
    if let Some(most) = options.max_bytes.filter(|&most| bytes as u64 > most) {
        let advice = advice(options, &snapped, &layouts);
        return Err(CompileError::TooLarge {
            bytes: bytes as u64,
            over: bytes as u64 - most,
            advice,
        });
    }
    let report = Report {
        step: lattice.step(),
        largest_displacement: snapped.largest_displacement,
        collapsed: snapped.collapsed.clone(),
        sah_cost,
        bytes,
        effects: surroundings.called_for.clone(),
        supplied: surroundings.supplied.clone(),
        setup,
    };
    Ok(Compiled { blob, report })
}

/// What makes a blob smaller, by its own figures.
fn advice(options: &Options, snapped: &Primitives, layouts: &[Layout]) -> String {
    let mut steps = Vec::new();
    if options.lattice_bits > 16 {
        let saved = 3 * snapped.vertices.len() + 4 * snapped.spheres.len();
        if saved > 0 {
            steps.push(format!("`--lattice-bits 16` saves {saved} bytes"));
        }
    }
    for layout in layouts.iter().filter(|layout| layout.bytes() > 0) {
        let (name, saved) = (layout.structure.name(), layout.bytes());
        steps.push(if layouts.len() > 1 {
            format!("leaving out `--accel {name}` saves {saved} bytes")
        } else {
            format!("`--accel list` instead of {name} saves {saved} bytes and costs time")
        });
    }
    steps.push(String::from("a scene with fewer primitives"));
    steps.join("; ")
}
