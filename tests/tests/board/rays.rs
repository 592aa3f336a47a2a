//! Rays without shading: what one costs, with a camera and without.

use crate::casts::Casts;
use crate::figures::Figures;
use crate::firmware::{Build, board};
use crate::plan::Plan;
use crate::scenes::{self, Compiled};
use gridel_core::{Fixed, Format, List, NoCount, Ray, Stack, Structure, closest_hit};
use gridel_host::measure::board::Board;

/// Stack and workspace of the suzanne workload at most: loading, and tracing primary rays.
const PRIMARY_RAM: u64 = 2 * 1024 + 256;

/// One of each core that tracers for boards are compared on, and the one with floats without them.
fn boards_for_primary_rays() -> [(&'static Board, Format); 5] {
    [
        ("mps2-an386", Format::F32),
        ("mps2-an386", Format::Fixed),
        ("mps2-an385", Format::Fixed),
        ("microbit", Format::Fixed),
        ("sifive_e", Format::Fixed),
    ]
    .map(|(name, format)| (board(name), format))
}

pub fn plan(plan: &mut Plan) {
    for (board, format) in boards_for_primary_rays() {
        plan.test_on("primary_rays_of_suzanne", board, format)
            .with_scene(scenes::SUZANNE)
            .in_full()
            .run(move || primary_rays_of_suzanne(board, format));
        plan.test_on("primary_rays_of_suzanne_in_16_bits", board, format)
            .with_scene(scenes::SUZANNE)
            .in_full_if(format == Format::F32)
            .run(move || primary_rays_of_suzanne_in_16_bits(board, format));
        plan.test_on("rays_without_a_camera::torus", board, format)
            .in_full_if(board.core == "Cortex-M0")
            .run(move || rays_without_a_camera(board, format, &scenes::torus_mesh()));
        plan.test_on("rays_without_a_camera::suzanne", board, format)
            .with_scene(scenes::SUZANNE)
            .in_full()
            .run(move || rays_without_a_camera(board, format, &scenes::suzanne()));
    }
    for board in ["mps2-an386", "microbit"].map(board) {
        plan.test_on("the_range_finder_measures_distances", board, board.format())
            .in_full()
            .run(move || the_range_finder_measures_distances(board));
    }
    for board in ["mps2-an386", "mps2-an385"].map(board) {
        let format = board.format();
        plan.test_on("primary_rays_of_molecules::nanotube", board, format)
            .in_full_if(format == Format::F32)
            .run(move || primary_rays_of_a_molecule(board, &scenes::molecule()));
        plan.test_on("primary_rays_of_molecules::protein", board, format)
            .with_scene(scenes::PROTEIN)
            .in_full_if(format == Format::Fixed)
            .run(move || primary_rays_of_a_molecule(board, &scenes::protein()));
        plan.test_on("primary_rays_of_suzanne_in_16_kib", board, format)
            .with_scene(scenes::SUZANNE)
            .in_full()
            .run(move || primary_rays_of_suzanne_in_16_kib(board));
    }
}

/// The example of a range finder prints what the host finds, to the unit.
fn the_range_finder_measures_distances(board: &'static Board) {
    let compiled = scenes::torus_mesh();
    let build = Build::new(board, board.format(), Structure::DualSplit, &compiled);
    let printed = build.program("range").lines();
    let scene = compiled.blob.scene().expect("the compiler's own blob");
    let [x, y, z] = scene.bounds().0.map(|side| side.map(i64::from));
    let distance = |step: i64| {
        let origin = [x[0] + (x[1] - x[0]) * step / 7, y[1] + 1, (z[0] + z[1]) / 2];
        let (origin, down) = (origin.map(|it| it as f64), [0.0, -1.0, 0.0]);
        let ray = Ray::<f64>::from_f64(scene.bounds(), origin, down, 0.0, f64::INFINITY);
        let (ray, mut stack) = (ray.expect("a ray"), Stack::<0>::new());
        let hit = closest_hit::<f64, List, _>(&scene, &ray, stack.as_view(), &mut NoCount);
        hit.map(|hit| hit.t)
    };
    assert_eq!(printed.len(), 8, "{build}: {printed:?}");
    let mut hits = 0;
    for (step, (name, value)) in printed.iter().enumerate() {
        let right = match distance(step as i64) {
            Some(t) => name == "distance" && (*value as f64 + 0.5 - t).abs() < 1.0,
            None => name == "miss" && *value == step as u64,
        };
        hits += usize::from(name == "distance");
        assert!(right, "{build}: {printed:?}, at {step}");
    }
    assert!(hits > 3, "{build}: {printed:?}");
}

fn primary_rays_of_suzanne(board: &'static Board, format: Format) {
    let suzanne = scenes::suzanne();
    let mut figures = Figures::new();
    for structure in [Structure::DualSplit, Structure::Flagged, Structure::Bvh] {
        let build = Build::new(board, format, structure, &suzanne);
        let report = build.program("primary").run();
        assert_eq!(report["rays"], 64 * 64, "{build}");
        assert_eq!(report["hits"], 1400, "{build}");
        let stack = report["load-stack-bytes"].max(report["ray-stack-bytes"]);
        let ram = stack + report["workspace-bytes"];
        assert!(ram <= PRIMARY_RAM, "{build}: {ram} bytes of RAM");
        figures.add(&build.to_string(), &report);
    }
    figures.check();
}

/// Options of meshes for boards: narrow vertices, dual-split nodes alone.
fn primary_rays_of_suzanne_in_16_bits(board: &'static Board, format: Format) {
    let suzanne = scenes::suzanne_in_16_bits();
    assert!(suzanne.blob.bytes().len() <= 32 * 1024);
    let mut figures = Figures::new();
    let build = Build::new(board, format, Structure::DualSplit, &suzanne);
    let report = build.program("primary").run();
    assert_eq!(report["hits"], 1400, "{build}");
    figures.add(&build.to_string(), &report);
    figures.check();
}

/// Instructions that a primary ray through a molecule of some 2,800 spheres takes at most, where there
/// are floats.
const A_RAY_AMONG_SPHERES: u64 = 620;

/// A molecule of that size, computed or a protein, on a lattice of 16 bits.
fn primary_rays_of_a_molecule(board: &'static Board, molecule: &Compiled) {
    let mut figures = Figures::new();
    let build = Build::new(board, board.format(), Structure::DualSplit, molecule);
    let report = build.program("primary").run();
    assert_eq!(report["rays"], 64 * 64, "{build}");
    assert!(report["hits"] > 200, "{build}");
    let a_ray = report["ray-instructions"];
    if board.format() == Format::F32 {
        assert!(a_ray <= A_RAY_AMONG_SPHERES, "{build}: {a_ray} a ray");
    }
    figures.add(&build.to_string(), &report);
    figures.check();
}

/// Stack and workspace of a closest hit at most where there is no camera, in integers and in floats.
const CAST_RAM: u64 = 1024;

/// Rays of a range finder or a collision: hits alone, those of the host's brute force.
fn rays_without_a_camera(board: &'static Board, format: Format, scene: &Compiled) {
    let mut figures = Figures::new();
    let build = Build::new(board, format, Structure::DualSplit, scene);
    let mut report = build.program("casts").run();
    let hosts = casts_through_the_list(scene, format);
    let found = ["hits", "sum"].map(|name| report.remove(name));
    assert_eq!(
        found,
        [hosts.hits, hosts.sum].map(|x| Some(x.into())),
        "{build}"
    );
    let ram = report["cast-stack-bytes"] + report["cast-workspace-bytes"];
    // With half of the registers, a Cortex-M0 puts down more.
    let is_bound = board.core != "Cortex-M0";
    assert!(!is_bound || ram <= CAST_RAM, "{build}: {ram} bytes of RAM");
    figures.add(&build.to_string(), &report);
    figures.check();
}

/// Hits of the rays of `casts` on the host, each primitive tested.
fn casts_through_the_list(scene: &Compiled, format: Format) -> Casts {
    let scene = scene.blob.scene().expect("the compiler's own blob");
    let (mut casts, mut stack) = (Casts::default(), Stack::<0>::new());
    match format {
        Format::F32 => casts.run::<f32, List>(&scene, stack.as_view()),
        Format::F64 => casts.run::<f64, List>(&scene, stack.as_view()),
        Format::Fixed => casts.run::<Fixed, List>(&scene, stack.as_view()),
    }
    casts
}

/// The smallest layout, and what rays pay for it.
fn primary_rays_of_suzanne_in_16_kib(board: &'static Board) {
    let suzanne = scenes::small_suzanne();
    assert!(suzanne.blob.bytes().len() <= 16 * 1024);
    let mut figures = Figures::new();
    let build = Build::new(board, board.format(), Structure::Flagged, &suzanne);
    let report = build.program("primary").run();
    assert_eq!(report["hits"], 1400, "{build}");
    figures.add(&build.to_string(), &report);
    figures.check();
}
