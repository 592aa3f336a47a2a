//! Imports run one way: from a layer to those below it, and between files without a cycle.

mod faults;
mod paths;
mod source;

use faults::faults;
use source::sources;
use std::path::Path;

/// A crate whose imports are checked: its sources, and its top modules from the lowest layer up, one row per layer.
struct Layers {
    sources: &'static str,
    order: &'static [&'static str],
}

const CORE: Layers = Layers {
    sources: "../core/src",
    order: &[
        "axis target simd format observe",
        "number ray geometry accel instances scene deform query shade render tracks selftest",
        "shared",
    ],
};

const HOST: Layers = Layers {
    sources: "../host/src",
    order: &[
        "output simd srgb explained random table blob observed picture_rays shape deformation",
        "scene sample compile",
        "live morphed state render trace npy picture layer openexr animation merge resolution report",
        "measure emit",
        "certify accuracy compare verify explain view check",
        "cli main",
    ],
};

#[track_caller]
fn check(layers: &Layers) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(layers.sources);
    let rows = layers.order.iter();
    let order: Vec<&str> = rows.flat_map(|row| row.split_whitespace()).collect();
    let faults = faults(&sources(&folder), &order);
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn core_imports_run_one_way() {
    check(&CORE);
}

#[test]
fn host_imports_run_one_way() {
    check(&HOST);
}
