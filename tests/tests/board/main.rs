//! The firmware on emulated boards: the same pictures as the host's, within the recorded cost.
//!
//! Needs `qemu-system-arm`, `qemu-system-riscv32`, Node, and the Rust targets of all boards
//! (`rustup target add`). A test without what its board needs is ignored and says why; it fails if
//! `GRIDEL_REQUIRE_BOARDS` is 1. The ordinary run has a picture of every board, `GRIDEL_FULL=1` all.
//!
//! `fixtures/recorded/board.json` holds the last measurements: nothing may grow by more than 2 %.
//! `GRIDEL_RECORD_BOARDS=1` records again; read the difference before it is committed.

#[path = "../../firmware/src/arm.rs"]
mod arm;
mod c_library;
#[path = "../../firmware/src/casts.rs"]
mod casts;
mod combinations;
mod costs;
mod deform;
mod elf;
mod emitted;
mod figures;
#[path = "../../firmware/src/finder.rs"]
mod finder;
mod firmware;
mod folders;
mod live;
mod morph;
#[path = "../../firmware/src/orbit.rs"]
mod orbit;
mod parts;
mod plan;
mod programs;
mod rays;
mod scenes;
mod stack;
mod structures;
#[path = "../../firmware/src/waves.rs"]
mod waves;

use figures::Figures;
use firmware::{AARCH64, Build, Program, RV32IMC, S390X, WASM, board};
use gridel_core::{Format, Structure};
use gridel_host::measure::board::{BOARDS, Board};
use libtest_mimic::Arguments;
use plan::Plan;
use scenes::Compiled;
use std::collections::BTreeMap;
use std::fs;

/// Every board in every number format that it computes itself.
fn boards() -> impl Iterator<Item = (&'static Board, Format)> {
    let boards = BOARDS
        .iter()
        .filter(|board| board.is_emulated())
        .chain([&WASM]);
    boards.flat_map(|board| board.formats.iter().map(move |&format| (board, format)))
}

fn main() {
    let mut plan = Plan::default();
    pictures(&mut plan);
    other_processors(&mut plan);
    linked(&mut plan);
    costs::plan(&mut plan);
    programs::plan(&mut plan);
    emitted::plan(&mut plan);
    rays::plan(&mut plan);
    c_library::plan(&mut plan);
    live::plan(&mut plan);
    deform::plan(&mut plan);
    morph::plan(&mut plan);
    structures::plan(&mut plan);
    plan.test("memory_maps_are_the_boards")
        .run(memory_maps_are_the_boards);
    plan.test("loading_takes_less_than_40_instructions_a_byte")
        .run(figures::loading_takes_less_than_40_instructions_a_byte);
    // A program that is built waits for others in its folder; meanwhile others run.
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = processors.max(2 * folders::FOLDERS);
    let mut arguments = Arguments::from_args();
    arguments.test_threads.get_or_insert(threads);
    libtest_mimic::run(&arguments, plan.trials).exit();
}

/// Boards on whose cores many programs are measured, by which those of other boards are estimated.
fn measured_in_full() -> impl Iterator<Item = (&'static Board, Format)> {
    let boards = boards().filter(|&(board, _)| board != &WASM);
    boards.filter(|&(board, format)| board.similar(format) == (board, format))
}

fn pictures(plan: &mut Plan) {
    for (board, format) in boards() {
        let test = plan.test_on("every_effect_on_every_board", board, format);
        let is_ordinary = format == board.format();
        let test = if is_ordinary { test } else { test.in_full() };
        test.run(move || picture_is_the_hosts(board, format, &scenes::quick()));
        // The cores of these two have the instructions of others here.
        let is_like_another = ["mps2-an500", "stm32vldiscovery"].contains(&board.name);
        plan.test_on("every_shape_on_every_board", board, format)
            .in_full_if(is_ordinary && !is_like_another)
            .run(move || {
                compare_with_the_hosts(board, format, &parts::every_shape());
            });
    }

    plan.test("every_effect_without_atomic_instructions::rv32imc")
        .on(&RV32IMC)
        .in_full()
        .run(|| {
            compare_with_the_hosts(&RV32IMC, Format::Fixed, &scenes::quick());
        });

    for board in ["mps2-an386", "mps2-an385"].map(board) {
        plan.test_on("limits_hold_without_indirect_light", board, board.format())
            .in_full()
            .run(move || {
                compare_with_the_hosts(board, board.format(), &scenes::deep());
            });
    }

    let names = [
        "microbit",
        "sifive_e",
        "mps2-an385",
        "mps2-an386",
        "mps2-an505",
    ];
    let boards = names.map(board).into_iter().chain([&WASM]);
    let boards = boards.map(|board| (board, board.format()));
    // With floats or without: `gridel accuracy` compares them.
    for (board, format) in boards.chain([(board("mps2-an386"), Format::Fixed)]) {
        plan.test_on("glass_on_boards", board, format)
            .in_full_if(board.core == "Cortex-M4F")
            .run(move || picture_is_the_hosts(board, format, &scenes::glass_chess()));
    }

    // Scenes that fit 8 KiB of RAM and 128 KiB of flash, and 16 KiB and 256 KiB.
    let discovery = board("stm32vldiscovery");
    type Make = fn() -> Compiled;
    let large: [(&str, &'static Board, Make); 4] = [
        ("glass", discovery, scenes::glass_chess_small),
        ("molecule", discovery, scenes::molecule),
        ("torus", board("microbit"), scenes::torus_mesh),
        ("protein", discovery, scenes::protein),
    ];
    for (name, board, scene) in large {
        let test = format!("the_smallest_boards_render_large_scenes::{name}");
        let mut test = plan.test(test).on(board).in_full();
        if name == "protein" {
            test = test.with_scene(scenes::PROTEIN);
        }
        test.run(move || picture_is_the_hosts(board, Format::Fixed, &scene()));
    }

    // A small build gives the same bits, with every shape and effect, and has no more code that panics.
    for (name, format) in [
        ("mps2-an386", Format::F32),
        ("mps2-an385", Format::Fixed),
        ("microbit", Format::Fixed),
        ("sifive_e", Format::Fixed),
    ] {
        let board = board(name);
        plan.test_on("small_pictures_are_the_hosts", board, format)
            .in_full()
            .run(move || {
                let scene = scenes::quick();
                let build = Build::new(board, format, Structure::DualSplit, &scene).small();
                let program = build.program("picture");
                let mut report = program.run();
                let picture = program.file("picture.rgb");
                assert!(picture == scene.picture(format), "{build}: another picture");
                look_into(&build, &program.elf(), board, format, &mut report);
            });
    }

    for board in ["mps2-an386", "mps2-an385"].map(board) {
        let format = board.format();
        plan.test_on("the_cores_own_tests_pass_on_boards", board, format)
            .in_full()
            .run(move || {
                let scene = scenes::quick();
                let build = Build::new(board, format, Structure::DualSplit, &scene);
                build.program_with("selftest", &["selftest"]).run();
            });
    }
}

/// Every number format and structure, with lanes of NEON or without lanes, gives the host's bits. On a big-endian
/// processor the blob is rejected.
fn other_processors(plan: &mut Plan) {
    fn program<'b>(board: &'b Board, scene: &'b Compiled) -> Program<'b> {
        Build::new(board, Format::Fixed, Structure::DualSplit, scene)
            .program_with("everywhere", &["everywhere"])
    }
    const NAME: &str = "every_structure_on_other_processors";
    for board in [&WASM, &AARCH64] {
        let name = format!("{NAME}::{}", board.name);
        plan.test(name).on(board).in_full().run(move || {
            let scene = scenes::quick_through_everything();
            let mut pictures = Vec::new();
            for format in Format::ALL {
                for structure in Structure::ALL {
                    pictures.extend(scene.picture_through(structure, format));
                }
            }
            let program = program(board, &scene);
            let report = program.run();
            assert_eq!(report["structures"], Structure::ALL.len() as u64);
            assert!(
                program.file("pictures.rgb") == pictures,
                "pictures differ from the host's"
            );
        });
    }
    let name = format!("{NAME}::{}", S390X.name);
    plan.test(name).on(&S390X).in_full().run(move || {
        let rejection = program(&S390X, &scenes::quick_through_everything()).failure();
        assert!(
            rejection.contains("little-endian and this machine must be too"),
            "{rejection}"
        );
    });
}

/// Builds and runs a scene's picture, compares it with the host's, and checks the linked code. Nothing panics or
/// allocates, `fixed` has no soft floats, and the program fits the memory.
fn picture_is_the_hosts(board: &'static Board, format: Format, scene: &Compiled) {
    let mut figures = Figures::new();
    let (build, report) = compare_with_the_hosts(board, format, scene);
    figures.add(&build.to_string(), &report);
    figures.check();
}

/// Renders a picture that has to be the host's to the bit, by a program that neither panics nor allocates.
/// Returns its figures.
fn compare_with_the_hosts<'b>(
    board: &'static Board,
    format: Format,
    scene: &'b Compiled,
) -> (Build<'b>, BTreeMap<String, u64>) {
    let build = Build::new(board, format, Structure::DualSplit, scene);
    let program = build.program("picture");
    let mut report = program.run();
    assert!(
        program.file("picture.rgb") == scene.picture(format),
        "{build}: the picture differs from the host's; see {}",
        program.folder().display()
    );
    if board != &WASM {
        look_into(&build, &program.elf(), board, format, &mut report);
    }
    (build, report)
}

/// Checks a linked program, and adds its figures to the report.
fn look_into(
    build: &Build<'_>,
    elf: &elf::Elf,
    board: &Board,
    format: Format,
    report: &mut BTreeMap<String, u64>,
) {
    let panicking = elf.functions(elf::panics);
    assert!(panicking.is_empty(), "{build} can panic: {panicking:#?}");
    let allocating = elf.functions(elf::allocates);
    assert!(allocating.is_empty(), "{build} allocates: {allocating:#?}");
    if format == Format::Fixed {
        let float = elf.functions(elf::computes_in_floating_point);
        assert!(float.is_empty(), "{build} has soft floats: {float:#?}");
    }
    let path = elf.deepest_path();
    let path = path.unwrap_or_else(|why| panic!("{build}: no bound on its stack: {why}"));
    let painted = ["load", "picture", "ray", "surface", "shadow-ray"]
        .iter()
        .filter_map(|phase| report.get(&format!("{phase}-stack-bytes")))
        .max();
    let painted = painted.copied().unwrap_or(0);
    assert!(
        painted <= path.bytes,
        "{build}: {painted} bytes of stack were written to, beyond the bound of {}:\n{}",
        path.bytes,
        path.functions.join("\n")
    );
    let ram = elf.static_bytes() + path.bytes;
    assert!(
        ram <= board.ram,
        "{build}: {ram} bytes of RAM, {} of them stack:\n{}",
        path.bytes,
        path.functions.join("\n")
    );
    report.insert("stack-bound-bytes".into(), path.bytes);
    report.insert("ram-bytes".into(), ram);
    report.insert("flash-bytes".into(), elf.flash_bytes());
}

/// No sum, product or shift of the core leaves its type, and the compiler can check it. With all of these checks
/// enabled, no linked code panics.
fn linked(plan: &mut Plan) {
    let everywhere = [
        ("microbit", Format::Fixed),
        ("mps2-an385", Format::Fixed),
        ("sifive_e", Format::Fixed),
        ("mps2-an386", Format::F32),
        ("mps2-an500", Format::F64),
    ]
    .map(|(name, format)| (name, format, Structure::DualSplit, false));
    let others = [
        Structure::Flagged,
        Structure::Bvh,
        Structure::Grid,
        Structure::Apex,
    ]
    .map(|structure| ("mps2-an385", Format::Fixed, structure, false));
    // In single precision libm's square root holds a sum that small code does not see through.
    let small = [
        ("microbit", Format::Fixed),
        ("mps2-an385", Format::Fixed),
        ("sifive_e", Format::Fixed),
        ("mps2-an500", Format::F64),
    ]
    .map(|(name, format)| (name, format, Structure::DualSplit, true));
    for (name, format, structure, small) in everywhere.into_iter().chain(others).chain(small) {
        let board = board(name);
        let size = if small { "small" } else { structure.name() };
        let test = format!("nothing_panics_with_overflow_checks::{size}");
        // Each core once, and a structure without flags.
        let often = match (board.core, structure) {
            ("Cortex-M0" | "RV32IMAC", Structure::DualSplit) => small,
            (_, Structure::DualSplit | Structure::Bvh) => !small,
            _ => false,
        };
        plan.test_on(&test, board, format)
            .in_full_if(often)
            .run(move || {
                let scene = scenes::quick();
                let build = Build::new(board, format, structure, &scene).with_overflow_checks();
                let build = if small { build.small() } else { build };
                let elf = build.program_with("picture", &["everything"]).elf();
                let panicking = elf.functions(elf::panics);
                assert!(panicking.is_empty(), "{build} can panic: {panicking:#?}");
            });
    }
}

/// The linker knows the boards that the host knows.
fn memory_maps_are_the_boards() {
    for board in BOARDS.iter().filter(|board| board.is_emulated()) {
        let path = format!("tests/firmware/src/board/memory/{}.x", board.name);
        let map = fs::read_to_string(scenes::repository().join(&path)).expect(&path);
        let region = |name: &str| {
            let line = map.lines().find(|line| line.trim().starts_with(name));
            let length = line.and_then(|line| line.split_once("LENGTH = "));
            let (_, length) = length.expect("a region with a length");
            let (digits, unit) = length.trim().split_at(length.trim().len() - 1);
            digits.parse::<u64>().expect("a number") << if unit == "M" { 20 } else { 10 }
        };
        assert_eq!(
            [region("FLASH"), region("RAM")],
            [board.flash, board.ram],
            "{path}"
        );
    }
}
