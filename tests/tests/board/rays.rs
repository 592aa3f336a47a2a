//! Rays without shading: what one costs, with a camera and without.

use crate::casts::Casts;
use crate::elf::{computes_in_floating_point, panics};
use crate::figures::Figures;
use crate::finder;
use crate::firmware::{Build, board};
use crate::plan::Plan;
use crate::scenes::{self, Compiled};
use gridel_core::{Fixed, Format, List, NoCount, Number, Scene, Stack, Structure, closest_hit};
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
            .run(move || primary_rays_of_suzanne(board, format, &[Structure::DualSplit]));
        // Other structures, often on one core with floats and one without.
        let is_often = format == Format::F32 || board.core == "Cortex-M3";
        plan.test_on("primary_rays_of_suzanne_through_boxes", board, format)
            .with_scene(scenes::SUZANNE)
            .in_full_if(is_often)
            .run(move || {
                primary_rays_of_suzanne(board, format, &[Structure::Flagged, Structure::Bvh])
            });
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
    for board in ["mps2-an386", "mps2-an385", "microbit", "sifive_e"].map(board) {
        plan.test_on("the_range_finder_measures_distances", board, board.format())
            .in_full_if(board.core != "RV32IMAC")
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

/// The range finder prints the host's distances, to the step, and nearly those of double precision and brute force.
/// None of its code panics, and in `fixed` none computes in floating point.
fn the_range_finder_measures_distances(board: &'static Board) {
    let compiled = scenes::torus_mesh();
    let format = board.format();
    let build = Build::new(board, format, Structure::DualSplit, &compiled);
    let program = build.program("range");
    let printed = program.lines();
    let scene = compiled.blob.scene().expect("the compiler's own blob");
    let expected = match format {
        Format::Fixed => fan::<Fixed>(&scene),
        Format::F32 => fan::<f32>(&scene),
        Format::F64 => fan::<f64>(&scene),
    };
    let lines = expected
        .iter()
        .zip(0..)
        .map(|(distance, number)| match distance {
            Some(steps) => (String::from("distance"), *steps),
            None => (String::from("miss"), number),
        });
    assert_eq!(printed, lines.collect::<Vec<_>>(), "{build}");
    let hits = expected.iter().flatten().count();
    assert!((3..expected.len()).contains(&hits), "{build}: {printed:?}");
    for (found, exact) in expected.iter().zip(fan::<f64>(&scene)) {
        let apart = found.zip(exact).map(|(a, b)| a.abs_diff(b));
        let near = exact.unwrap_or_default() >> if format == Format::F32 { 18 } else { 24 };
        assert!(
            apart.is_some_and(|apart| apart <= near + 64) || *found == exact,
            "{build}: {found:?}, {exact:?}"
        );
    }
    let elf = program.elf();
    let panicking = elf.functions(panics);
    assert!(panicking.is_empty(), "{build} can panic: {panicking:#?}");
    if format == Format::Fixed {
        let float = elf.functions(computes_in_floating_point);
        assert!(float.is_empty(), "{build} has soft floats: {float:#?}");
    }
}

/// Distances that the range finder measures, through brute force.
fn fan<N: Number>(scene: &Scene<'_>) -> Vec<Option<u64>> {
    let mut stack = Stack::<0>::new();
    let measure = |number| {
        let ray = scene.ray_within::<N>(
            finder::place(scene),
            finder::direction(number),
            finder::reach(scene),
        );
        let ray = ray.expect("a ray");
        let hit = closest_hit::<N, List, _>(scene, &ray, stack.as_view(), &mut NoCount);
        hit.map(|hit| scene.distance(&ray, &hit))
    };
    (0..finder::RAYS).map(measure).collect()
}

fn primary_rays_of_suzanne(board: &'static Board, format: Format, structures: &[Structure]) {
    let suzanne = scenes::suzanne();
    let mut figures = Figures::new();
    for &structure in structures {
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
const PER_RAY_AMONG_SPHERES: u64 = 620;

/// A molecule of that size, computed or a protein, on a lattice of 16 bits.
fn primary_rays_of_a_molecule(board: &'static Board, molecule: &Compiled) {
    let mut figures = Figures::new();
    let build = Build::new(board, board.format(), Structure::DualSplit, molecule);
    let report = build.program("primary").run();
    assert_eq!(report["rays"], 64 * 64, "{build}");
    assert!(report["hits"] > 200, "{build}");
    let per_ray = report["ray-instructions"];
    if board.format() == Format::F32 {
        assert!(
            per_ray <= PER_RAY_AMONG_SPHERES,
            "{build}: {per_ray} per ray"
        );
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
    // With half of the registers, a Cortex-M0 spills more.
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
