//! Compares every shape with arithmetic of 320 bits: whether, where and from which side rays hit
//! it, and its normal there. One file per shape has the cases of its own.

mod cone;
mod cuboid;
mod cylinder;
mod disc;
mod faces;
mod plane;
mod self_hits;
mod sphere;
mod torus;
mod touching;
mod triangle;

use gridel_core::Number;
use gridel_tests::bounds::{CROSSING, NORMAL, NORMAL_LENGTH, allowed};
use gridel_tests::cases::{Case, SHAPES, cases};
use gridel_tests::effort::part_of;
use gridel_tests::every_format;
use gridel_tests::judge::{Worst, blob_of, verdict};

/// Holds all answers about some cases of a shape to the tables, and returns what was worst.
fn hold<N: Number>(what: &str, shape: &str, cases: &[Case]) -> Worst {
    let mut worst = Worst::default();
    for case in cases {
        let blob = blob_of([&case.solid]);
        let scene = blob.scene().expect("a scene");
        for &ray in &case.rays {
            if let Some(verdict) = verdict::<N>(&case.solid, &scene, ray) {
                worst.take(&verdict, || {
                    format!("{} {:?} {ray:?}", case.class, case.solid)
                });
            }
        }
    }
    let format = N::FORMAT.name();
    eprintln!(
        "{what:28} {format:5}: {:6} rays, {:6} hits; K of t {:4}, of wrong flags {:4}, of normals \
         {:5.2}, their length {:4.2} ulp; points at {:.3} of their bound; {} wrong sides",
        worst.rays,
        worst.hits,
        worst.crossing.0,
        worst.flag.0,
        worst.normal.0,
        worst.length.0,
        worst.point.0,
        worst.wrong_sides.0,
    );
    let most = |found: &(f64, String), most: f64, error: &str| {
        assert!(
            found.0 <= most,
            "{what} {format}, {error} {}: {}",
            found.0,
            found.1
        );
    };
    most(&worst.crossing, allowed(&CROSSING, shape), "t");
    most(&worst.normal, allowed(&NORMAL, shape), "normal");
    most(&worst.length, NORMAL_LENGTH, "length of the normal");
    most(&worst.point, 1.0, "point");
    most(&worst.wrong_sides, 0.0, "side");
    assert!(worst.rays > 0, "{what}: no rays");
    worst
}

/// [`hold`] in every number format; fails after all were tried.
fn hold_all(what: &str, shape: &str, cases: &[Case]) {
    fn one<N: Number>(what: &str, shape: &str, cases: &[Case], failures: &mut Vec<&str>) {
        let result = std::panic::catch_unwind(|| hold::<N>(what, shape, cases));
        failures.extend(result.err().map(|_| N::FORMAT.name()));
    }
    let mut failures = Vec::new();
    every_format!(one(what, shape, cases, &mut failures));
    assert!(failures.is_empty(), "{what}: {failures:?}");
}

/// Shapes and rays of every sort.
fn of_every_sort(shape: usize) {
    // A torus takes ten times as long as the others.
    let usual = if SHAPES[shape] == "torus" { 8 } else { 60 };
    let count = part_of(usual, 2000);
    hold_all(
        SHAPES[shape],
        SHAPES[shape],
        &cases(100 + shape as u64, shape, count, 60),
    );
}
