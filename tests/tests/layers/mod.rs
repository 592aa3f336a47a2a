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
        "output simd srgb palette explained random table blob observed picture_rays shape deformation",
        "scene sample compile",
        "blob_view morphed state render trace npy picture layer openexr animation merge resolution report",
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

/// The functions of the standard library whose results differ from one machine to another. Bytes of a blob must not.
const UNEQUAL: [&str; 22] = [
    "sin", "cos", "tan", "sin_cos", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "exp",
    "exp2", "exp_m1", "ln", "ln_1p", "log", "log2", "log10", "powf", "cbrt", "hypot",
];

#[test]
fn blobs_come_from_functions_that_are_equal_on_every_machine() {
    let host = Path::new(env!("CARGO_MANIFEST_DIR")).join(HOST.sources);
    let of_blobs = "palette random shape deformation scene compile blob_view morphed state";
    let is_of_blobs = |module: &str| of_blobs.split(' ').any(|it| it == module);
    let mut faults = Vec::new();
    for source in sources(&host) {
        let module = source::module(&source.file);
        let is_test = module.iter().any(|it| it == "tests");
        if is_test || !module.first().is_some_and(|it| is_of_blobs(it)) {
            continue;
        }
        for (number, line) in source.text.lines().enumerate() {
            let called = |name: &&str| line.contains(&format!(".{name}("));
            if let Some(name) = UNEQUAL.into_iter().find(called) {
                let line = number + 1;
                faults.push(format!(
                    "{}:{line}: use libm in place of {name}",
                    source.file
                ));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
