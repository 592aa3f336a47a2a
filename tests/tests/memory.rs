//! Builders take no more memory than they state.

use glam::DVec3;
use gridel_core::Structure;
use gridel_host::compile::{Compiled, Options, compile};
use gridel_host::scene::{Scene, Shape};
use gridel_host::shape::Sphere;
use gridel_tests::scenes;
use peak_alloc::PeakAlloc;

/// This file has one test, so that all that is counted is its own.
#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Compiles with one structure, and returns the most memory beyond what was there before.
fn peak(scene: &Scene, structure: Structure, budget: Option<u64>) -> (u64, Compiled) {
    let options = Options {
        structures: vec![structure],
        budget,
        ..Options::default()
    };
    MEMORY.reset_peak_usage();
    let before = MEMORY.current_usage();
    let compiled = compile(scene, &options).expect("compiles");
    ((MEMORY.peak_usage() - before) as u64, compiled)
}

#[test]
fn builders_keep_to_their_budgets() {
    // A table, the blob that it is copied to, 72 bytes per cell, and what threads work with.
    let soup = scenes::soup(31, 400, 0.2);
    let (base, _) = peak(&soup, Structure::Bvh, None);
    for structure in [
        Structure::CylinderCube,
        Structure::CylinderCubeTight,
        Structure::CylinderCubeEntry,
        Structure::Apex,
    ] {
        for budget in [50_000, 500_000] {
            let (peak, compiled) = peak(&soup, structure, Some(budget));
            let figures = compiled.report.tables[0].figures;
            // For the eye and for the light that the compiler supplies.
            let budgets = if structure == Structure::Apex { 2 } else { 1 };
            assert!(figures.bytes <= budgets * budget, "{figures:?}");
            let most = base + 2 * figures.bytes + 72 * figures.cells + (256 << 10);
            eprintln!("{}, {budget}: {peak} of {most}", structure.name());
            assert!(peak <= most, "{}: {peak} of {most}", structure.name());
        }
    }
    // Every primitive in every cell: without a bound these would take gigabytes.
    let everywhere = |_| {
        Shape::Sphere(Sphere {
            center: DVec3::ZERO,
            radius: 1.0,
        })
    };
    let crowd = scenes::of((0..20_000).map(everywhere));
    let (base, _) = peak(&crowd, Structure::List, None);
    for structure in [Structure::Grid, Structure::Octree] {
        let (peak, compiled) = peak(&crowd, structure, None);
        eprintln!("{}: {peak}", structure.name());
        assert!(peak <= base + (256 << 20), "{}: {peak}", structure.name());
        assert_eq!(compiled.report.longest_list, 20_000);
    }
}
