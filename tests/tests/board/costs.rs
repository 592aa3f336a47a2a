//! Costs of code, call stacks and pictures, by shape, effect and structure: programs that the memory
//! report shows, and the README's tables.

use crate::figures::Figures;
use crate::firmware::{Build, WASM, board};
use crate::plan::Plan;
use crate::programs::{Linked, footprint};
use crate::scenes::Compiled;
use crate::{boards, measured_in_full, parts};
use gridel_core::{Effects, Format, Prevalidated, Settings, Structure};
use gridel_host::measure::board::Board;
use gridel_host::render::{Aov, Job, Values, render_aovs};
use std::collections::BTreeMap;

pub fn plan(plan: &mut Plan) {
    let discovery = board("stm32vldiscovery");
    for (board, format) in measured_in_full() {
        // Twenty builds on each kind of core.
        plan.test_on("every_core_pays_for_parts_one_by_one", board, format)
            .at_length()
            .run(move || core_pays_for_parts_one_by_one(board, format));
    }
    let others = boards().filter(|&(board, _)| board != &WASM);
    for (board, format) in
        others.filter(|&(board, format)| board.similar(format) != (board, format))
    {
        plan.test_on("every_board_pays_for_few_parts", board, format)
            .at_length()
            .run(move || board_pays_for_few_parts(board, format));
    }
    for (board, format) in boards().filter(|&(board, _)| board != &WASM) {
        plan.test_on("everything_on_every_board", board, format)
            .in_full_if(board == discovery)
            .run(move || everything_on_a_board(board, format));
        if board.similar(format) == (board, format) {
            // Six builds; pictures through these structures run more often.
            plan.test_on("everything_through_other_structures", board, format)
                .at_length()
                .run(move || everything_through_other_structures(board, format));
        }
    }
    plan.test("shapes_cost_what_is_recorded")
        .on(discovery)
        .in_full()
        .run(|| parts_cost_what_is_recorded(parts::shapes().into_iter()));
    // Twenty builds. `hits_and_lights_cost_what_is_recorded` and pictures with all effects run more often.
    plan.test("effects_cost_what_is_recorded")
        .on(discovery)
        .at_length()
        .run(|| {
            parts_cost_what_is_recorded(parts::effects().chain([parts::sphere_and_triangle()]))
        });
    plan.test("code_that_nothing_requires_takes_little_time")
        .on(discovery)
        .in_full()
        .run(code_that_nothing_requires_takes_little_time);
    plan.test("hits_and_lights_cost_what_is_recorded")
        .on(board("mps2-an386"))
        .in_full()
        .run(hits_and_lights_cost_what_is_recorded);
    plan.test("small_code_fits_in_16_kib")
        .on(discovery)
        .in_full()
        .run(small_code_fits_in_16_kib);
}

/// Costs of every shape and effect where all cores of its kind are measured: the README's table is
/// that of the smallest board.
fn core_pays_for_parts_one_by_one(board: &'static Board, format: Format) {
    let mut linked = Linked::new();
    for scene in parts::scenes()
        .iter()
        .chain([&parts::sphere_and_triangle()])
    {
        let build = Build::new(board, format, Structure::DualSplit, scene);
        let elf = build.program("bare").elf();
        linked.add(&build, &scene.features(), scene, &elf);
    }
    for scene in &parts::wider_storage() {
        let build = Build::new(board, format, Structure::DualSplit, scene);
        let features = [&scene.features()[..], &[scene.name]].concat();
        let elf = build.program_with("bare", &features).elf();
        linked.add(&build, &features, scene, &elf);
    }
    linked.check();
}

/// Costs of some parts on a board, by which the memory report scales the figures of a similar core.
fn board_pays_for_few_parts(board: &'static Board, format: Format) {
    let scene = parts::sphere_and_triangle();
    let mut linked = Linked::new();
    let build = Build::new(board, format, Structure::DualSplit, &scene);
    let elf = build.program("bare").elf();
    linked.add(&build, &scene.features(), &scene, &elf);
    linked.check();
}

/// Costs of shapes or effects on the smallest board: the README's table.
fn parts_cost_what_is_recorded(scenes: impl Iterator<Item = Compiled>) {
    let discovery = board("stm32vldiscovery");
    let mut figures = Figures::new();
    for scene in scenes {
        let build = Build::new(discovery, Format::Fixed, Structure::DualSplit, &scene);
        let run = build.program("picture").run();
        let report = [("picture-instructions".into(), run["picture-instructions"])].into();
        figures.add(&build.to_string(), &report);
    }
    figures.check();
}

/// The code of effects that nothing requires is negligible. That of shapes and wider storage is not: leaves choose
/// between them.
fn code_that_nothing_requires_takes_little_time() {
    let discovery = board("stm32vldiscovery");
    let base = &parts::shapes()[0];
    let build = Build::new(discovery, Format::Fixed, Structure::DualSplit, base);
    let effects = Effects::NAMED.map(|(_, name)| name);
    let spent = |features: &[&str]| {
        let run = build.program_with("picture", features).run();
        run["picture-instructions"]
    };
    let alone = spent(&base.features());
    let with_effects = spent(&[&effects, &base.features()[..]].concat());
    let with_everything = spent(&["everything"]);
    println!("instructions: alone {alone}, effects {with_effects}, everything {with_everything}");
    assert!(
        100 * with_effects <= 102 * alone,
        "{with_effects} instructions with every effect compiled in, {alone} without"
    );
    assert!(
        100 * with_everything <= 110 * alone,
        "{with_everything} instructions with everything compiled in, {alone} without"
    );
}

/// Measures the cost per hit of everything that looks colors up, and of a sample of a light, on a processor with `f32`.
/// It is a table of the page of memory.
fn hits_and_lights_cost_what_is_recorded() {
    let here = board("mps2-an386");
    let build = |scene| Build::new(here, Format::F32, Structure::DualSplit, scene);
    let spent = |scene| build(scene).program("picture").run()["picture-instructions"];
    let (parts, lamps) = (parts::scenes(), parts::lamps());
    let colored = parts.iter().filter(|it| PER_HIT.contains(&it.name));
    let mut figures = Figures::new();
    for (base, scenes) in [
        (&parts[0], colored.collect::<Vec<_>>()),
        (&lamps[0], lamps[1..].iter().collect()),
    ] {
        let without = spent(base);
        for scene in scenes {
            let view = scene.blob.scene().expect("the compiler's own blob");
            let job = Job::whole(Format::F32, Structure::DualSplit, Settings::of(&view));
            let objects = render_aovs(&view, &job, &[Aov::Object]).expect("a picture");
            let hits = match &objects[..] {
                [Values::Numbers(all)] => all.iter().filter(|it| **it != u32::MAX).count() as u64,
                _ => panic!("objects are numbers"),
            };
            let each = (spent(scene) - without).div_ceil(hits);
            println!("{}: {each} instructions per hit, {hits} hits", scene.name);
            let report = [("hit-instructions".into(), each)].into();
            figures.add(&build(scene).to_string(), &report);
        }
    }
    figures.check();
}

/// The effects whose costs per hit are measured.
const PER_HIT: [&str; 4] = ["vertex-colors", "texture", "texture-levels", "normal-map"];

/// Measures a product with every shape and effect on a board, fast or small, and on one of each kind of core with
/// instances. The memory report scales by these costs.
fn everything_on_a_board(board: &'static Board, format: Format) {
    let mut linked = Linked::new();
    add_everything(&mut linked, board, format, Structure::DualSplit);
    if board.similar(format) == (board, format) {
        let placed = parts::everything(Structure::DualSplit, true);
        let fast = || Build::new(board, format, Structure::DualSplit, &placed);
        for build in [fast(), fast().small()] {
            let (build, features) = (build.beyond_flash(), ["everything", "instances"]);
            let elf = build.program_with("bare", &features).elf();
            linked.add(&build, &features, &placed, &elf);
        }
    }
    linked.check();
}

/// Measures everything through the other structures that boards prevalidate.
fn everything_through_other_structures(board: &'static Board, format: Format) {
    let mut linked = Linked::new();
    let others = Prevalidated::STRUCTURES.into_iter();
    for structure in others.filter(|&other| other != Structure::DualSplit) {
        add_everything(&mut linked, board, format, structure);
    }
    linked.check();
}

/// Links all code for a structure, fast and small.
fn add_everything(
    linked: &mut Linked,
    board: &'static Board,
    format: Format,
    structure: Structure,
) {
    let scene = parts::everything(structure, false);
    let fast = || Build::new(board, format, structure, &scene);
    for build in [fast(), fast().small()] {
        let build = build.beyond_flash();
        let elf = build.program_with("bare", &["everything"]).elf();
        linked.add(&build, &["everything"], &scene, &elf);
    }
}

/// Largest flash for all code of a small build that a diffuse scene of triangles and spheres with shadows needs.
/// Includes the vector table.
const SMALL_CODE: u64 = 16 * 1024;

/// Savings of the feature `small`, and its costs per ray: the README's table.
fn small_code_fits_in_16_kib() {
    let discovery = board("stm32vldiscovery");
    let scene = parts::sphere_and_triangle();
    let fast = || Build::new(discovery, Format::Fixed, Structure::DualSplit, &scene);
    let (mut figures, mut linked) = (Figures::new(), Linked::new());
    for build in [fast(), fast().small()] {
        let elf = build.program("bare").elf();
        linked.add(&build, &scene.features(), &scene, &elf);
        let mut report: BTreeMap<String, u64> =
            [("vector-bytes".into(), elf.vector_bytes())].into();
        if build.is_small() {
            let code = footprint(&build, &elf, &scene).code;
            assert!(code <= SMALL_CODE, "{build}: {code} bytes of code");
        }
        let program = build.program("picture");
        let mut run = program.run();
        run.retain(|name, _| name.ends_with("-instructions"));
        assert!(program.file("picture.rgb") == scene.picture(Format::Fixed));
        report.extend(run);
        figures.add(&build.to_string(), &report);
    }
    figures.check();
    linked.check();
}
