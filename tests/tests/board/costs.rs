//! What code, call stacks and pictures cost, by shape, effect and structure: what ledgers are added up from.

use crate::figures::{self, Figures};
use crate::firmware::{Build, WASM, board};
use crate::plan::Plan;
use crate::scenes::{self, Compiled};
use crate::{boards, elf, parts};
use gridel_core::{Effects, Format, Structure, Vouched};
use gridel_host::board::Board;
use gridel_host::report::{Ledger, Target};
use std::collections::BTreeMap;

pub fn plan(plan: &mut Plan) {
    for (board, format) in measured_in_full() {
        plan.test_on("every_core_pays_for_parts_one_by_one", board, format)
            .in_full()
            .run(move || core_pays_for_parts_one_by_one(board, format));
    }
    let others = boards().filter(|&(board, _)| board != &WASM);
    for (board, format) in others.filter(|&(board, format)| board.kin(format) != (board, format)) {
        plan.test_on("every_board_pays_for_few_parts", board, format)
            .in_full()
            .run(move || board_pays_for_few_parts(board, format));
    }
    for (board, format) in boards().filter(|&(board, _)| board != &WASM) {
        plan.test_on("everything_on_every_board", board, format)
            .in_full()
            .run(move || everything_on_a_board(board, format));
    }
    let discovery = board("stm32vldiscovery");
    plan.test("shapes_and_effects_are_paid_for_one_by_one")
        .on(discovery)
        .in_full()
        .run(shapes_and_effects_are_paid_for_one_by_one);
    plan.test("small_code_fits_in_16_kib")
        .on(discovery)
        .in_full()
        .run(small_code_fits_in_16_kib);
    plan.test("ledgers_are_enough_for_what_was_measured")
        .run(ledgers_are_enough_for_what_was_measured);
}

/// What every shape and effect takes where all cores of its kind are measured: the README's table is
/// that of the smallest board, and ledgers are added up from it.
fn core_pays_for_parts_one_by_one(board: &'static Board, format: Format) {
    let mut figures = Figures::new();
    for scene in parts::scenes()
        .iter()
        .chain([&parts::sphere_and_triangle()])
    {
        let build = Build::new(board, format, Structure::DualSplit, scene);
        let elf = build.program("bare").elf();
        figures.add(&build.to_string(), &footprint(&build, &elf, scene));
    }
    for scene in &parts::wider_storage() {
        let build = Build::new(board, format, Structure::DualSplit, scene);
        let features = [&scene.features()[..], &[scene.name]].concat();
        let elf = build.program_with("bare", &features).elf();
        figures.add(&build.to_string(), &footprint(&build, &elf, scene));
    }
    figures.check();
}

/// What some parts take on a board, by which the ledgers stretch what was measured for its kin.
fn board_pays_for_few_parts(board: &'static Board, format: Format) {
    let scene = parts::sphere_and_triangle();
    let mut figures = Figures::new();
    let build = Build::new(board, format, Structure::DualSplit, &scene);
    let elf = build.program("bare").elf();
    figures.add(&build.to_string(), &footprint(&build, &elf, &scene));
    figures.check();
}

/// Boards on whose cores all is measured that others are told by.
fn measured_in_full() -> impl Iterator<Item = (&'static Board, Format)> {
    boards().filter(|&(board, format)| board.kin(format) == (board, format))
}

/// What every shape and effect costs rays on the smallest board: the README's table.
fn shapes_and_effects_are_paid_for_one_by_one() {
    let discovery = board("stm32vldiscovery");
    let mut figures = Figures::new();
    let mut instructions = BTreeMap::new();
    let scenes = parts::scenes();
    for scene in scenes.iter().chain([&parts::sphere_and_triangle()]) {
        let build = Build::new(discovery, Format::Fixed, Structure::DualSplit, scene);
        let run = build.program("picture").run();
        let spent = run["picture-instructions"];
        instructions.insert(scene.name, spent);
        let report = [("picture-instructions".into(), spent)].into();
        figures.add(&build.to_string(), &report);
    }
    figures.check();
    // The code of effects that nothing calls for costs next to nothing. That of shapes and wider
    // storage does: leaves choose between them.
    let base = &scenes[0];
    let build = Build::new(discovery, Format::Fixed, Structure::DualSplit, base);
    let effects = Effects::NAMED.map(|(_, name)| name);
    let spent = |features: &[&str]| {
        let run = build.program_with("picture", features).run();
        run["picture-instructions"]
    };
    let alone = instructions[parts::BASE];
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

/// What a product with every shape and effect takes on a board, fast or small, and on one of each kind
/// of core through every structure that boards vouch for: the ledgers' bounds.
fn everything_on_a_board(board: &'static Board, format: Format) {
    let scene = scenes::quick();
    let mut figures = Figures::new();
    let in_full = board.kin(format) == (board, format);
    let measured = |&it: &Structure| in_full || it == Structure::DualSplit;
    for structure in Vouched::STRUCTURES.into_iter().filter(measured) {
        let fast = || Build::new(board, format, structure, &scene);
        for build in [fast(), fast().small()] {
            let elf = build.program_with("bare", &["everything"]).elf();
            figures.add(&build.to_string(), &footprint(&build, &elf, &scene));
        }
    }
    figures.check();
}

/// What parts add up to is enough for a program that holds some of them.
fn ledgers_are_enough_for_what_was_measured() {
    let scene = parts::sphere_and_triangle();
    let view = scene.blob.scene().expect("the compiler's own blob");
    for (board, format) in boards().filter(|&(board, _)| board != &WASM) {
        let target = Target {
            board,
            flash: board.flash,
            ram: board.ram,
        };
        let ledger = Ledger::of(&view, scene.blob.bytes(), &target, format);
        let ledger = ledger.expect("it was measured");
        let build = Build::new(board, format, Structure::DualSplit, &scene).to_string();
        let code = ledger.flash.used - scene.blob.bytes().len() as u64;
        let measured = figures::recorded(&build, "code-bytes");
        assert!(
            code >= measured,
            "{build}: {code} bytes of code, {measured}"
        );
    }
}

/// Flash for all code that a diffuse scene of triangles and spheres with shadows needs, the vector table
/// included: at most this where it shall be small.
const SMALL_CODE: u64 = 16 * 1024;

/// What the feature `small` saves, and what rays pay for it: the README's table.
fn small_code_fits_in_16_kib() {
    let discovery = board("stm32vldiscovery");
    let scene = parts::sphere_and_triangle();
    let fast = || Build::new(discovery, Format::Fixed, Structure::DualSplit, &scene);
    let mut figures = Figures::new();
    for build in [fast(), fast().small()] {
        let elf = build.program("bare").elf();
        let mut report = footprint(&build, &elf, &scene);
        report.insert("vector-bytes".into(), elf.vector_bytes());
        if build.is_small() {
            let code = report["code-bytes"];
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
}

/// Flash for code, and the deepest call stack.
fn footprint(build: &Build<'_>, elf: &elf::Elf, scene: &Compiled) -> BTreeMap<String, u64> {
    let code = elf.flash_bytes() - scene.blob.bytes().len() as u64;
    let path = elf.deepest_path();
    let path = path.unwrap_or_else(|why| panic!("{build}: no bound on its stack: {why}"));
    [
        ("code-bytes".into(), code),
        ("call-stack-bytes".into(), path.bytes),
    ]
    .into()
}
