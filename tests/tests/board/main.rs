//! The firmware on emulated boards: the same pictures as the host's, within the recorded cost.
//!
//! Needs `qemu-system-arm`, `qemu-system-riscv32`, Node, and the Rust targets of all boards
//! (`rustup target add`). Without them the tests say so and pass, unless `GRIDEL_REQUIRE_BOARDS`
//! is 1. `fixtures/recorded/board.json` holds what was measured last: nothing may grow by more than 2 %.
//! `GRIDEL_RECORD_BOARDS=1` records anew; read the difference before it is committed.

#[path = "../../firmware/src/casts.rs"]
mod casts;
mod costs;
mod elf;
mod emitted;
mod figures;
mod firmware;
mod parts;
mod rays;
mod scenes;
mod stack;
mod structures;

use figures::Figures;
use firmware::{AARCH64, Build, S390X, WASM, board};
use gridel_core::{Format, Structure};
use gridel_host::board::{BOARDS, Board};
use scenes::Compiled;
use std::collections::BTreeMap;
use std::fs;

/// Every board in every number format that it computes itself.
fn boards() -> impl Iterator<Item = (&'static Board, Format)> {
    let boards = BOARDS.iter().chain([&WASM]);
    boards.flat_map(|board| board.formats.iter().map(move |&format| (board, format)))
}

#[test]
fn every_effect_on_every_board() {
    let scene = scenes::quick();
    pictures_are_the_hosts(boards().map(|(board, format)| (board, format, &scene)));
}

/// Every number format and every structure, where lanes are those of NEON or of none, is the host's to
/// the bit. Where bytes lie the other way round, the blob is refused.
#[test]
fn every_structure_on_other_processors() {
    if !firmware::all_available([&WASM, &AARCH64, &S390X]) {
        return;
    }
    let scene = scenes::quick_through_everything();
    let program = |board| {
        Build::new(board, Format::Fixed, Structure::DualSplit, &scene)
            .program_with("everywhere", &["everywhere"])
    };
    let mut pictures = Vec::new();
    for format in Format::ALL {
        for structure in Structure::ALL {
            pictures.extend(scene.picture_through(structure, format));
        }
    }
    for board in [&WASM, &AARCH64] {
        let program = program(board);
        let report = program.run();
        assert_eq!(report["structures"], Structure::ALL.len() as u64);
        assert!(
            program.file("pictures.rgb") == pictures,
            "{}: pictures differ from the host's",
            board.name
        );
    }
    let refusal = program(&S390X).failure();
    assert!(
        refusal.contains("little-endian and this machine must be too"),
        "{refusal}"
    );
}

#[test]
fn glass_on_boards() {
    let scene = scenes::glass_chess();
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
    let both = boards.chain([(board("mps2-an386"), Format::Fixed)]);
    pictures_are_the_hosts(both.map(|(board, format)| (board, format, &scene)));
}

/// What 8 KiB of RAM and 128 KiB of flash are enough for, and 16 KiB and 256 KiB.
#[test]
fn the_smallest_boards_render_large_scenes() {
    let discovery = board("stm32vldiscovery");
    let (glass, molecule, torus) = (
        scenes::glass_chess_small(),
        scenes::molecule(),
        scenes::torus(),
    );
    let protein = scenes::protein();
    let mut all = vec![
        (discovery, Format::Fixed, &glass),
        (discovery, Format::Fixed, &molecule),
        (board("microbit"), Format::Fixed, &torus),
    ];
    all.extend(
        protein
            .iter()
            .map(|protein| (discovery, Format::Fixed, protein)),
    );
    pictures_are_the_hosts(all);
}

/// Builds and runs each, compares its picture with the host's, and looks at what was linked:
/// nothing that panics or allocates, no soft floats in `fixed`, and no more memory than there is.
fn pictures_are_the_hosts<'s>(
    all: impl IntoIterator<Item = (&'static Board, Format, &'s Compiled)>,
) {
    if !firmware::available() {
        return;
    }
    let mut figures = Figures::new();
    for (board, format, scene) in all {
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
        figures.add(&build.to_string(), &report);
    }
    figures.check();
}

/// Checks a linked program, and adds to the report what it tells.
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

/// No sum, product or shift of the core leaves its type, and the compiler can tell: with all of them
/// checked, nothing is linked that panics.
#[test]
fn nothing_panics_with_overflow_checks() {
    if !firmware::available() {
        return;
    }
    let scene = scenes::quick();
    let everywhere = [
        ("microbit", Format::Fixed),
        ("mps2-an385", Format::Fixed),
        ("sifive_e", Format::Fixed),
        ("mps2-an386", Format::F32),
        ("mps2-an500", Format::F64),
    ]
    .map(|(name, format)| (name, format, Structure::DualSplit));
    let checked = |name, format, structure| {
        Build::new(board(name), format, structure, &scene).with_overflow_checks()
    };
    let others = [
        Structure::Flagged,
        Structure::Bvh,
        Structure::Grid,
        Structure::Apex,
    ]
    .map(|structure| ("mps2-an385", Format::Fixed, structure));
    let builds = everywhere.into_iter().chain(others);
    let builds = builds.map(|(name, format, structure)| checked(name, format, structure));
    // In single precision libm's square root holds a sum that small code does not see through.
    let small = [
        ("microbit", Format::Fixed),
        ("mps2-an385", Format::Fixed),
        ("sifive_e", Format::Fixed),
        ("mps2-an500", Format::F64),
    ]
    .map(|(name, format)| checked(name, format, Structure::DualSplit).small());
    for build in builds.chain(small) {
        let elf = build.program_with("picture", &["everything"]).elf();
        let panicking = elf.functions(elf::panics);
        assert!(panicking.is_empty(), "{build} can panic: {panicking:#?}");
    }
}

/// Small code gives the same bits, with every shape and effect, and holds no more that panics.
#[test]
fn small_pictures_are_the_hosts() {
    if !firmware::available() {
        return;
    }
    let scene = scenes::quick();
    for (name, format) in [
        ("mps2-an386", Format::F32),
        ("mps2-an385", Format::Fixed),
        ("microbit", Format::Fixed),
        ("sifive_e", Format::Fixed),
    ] {
        let build = Build::new(board(name), format, Structure::DualSplit, &scene).small();
        let program = build.program("picture");
        let mut report = program.run();
        let picture = program.file("picture.rgb");
        assert!(picture == scene.picture(format), "{build}: another picture");
        look_into(&build, &program.elf(), board(name), format, &mut report);
    }
}

#[test]
fn the_cores_own_tests_pass_on_boards() {
    if !firmware::available() {
        return;
    }
    let scene = scenes::quick();
    for name in ["mps2-an386", "mps2-an385"] {
        let board = board(name);
        let build = Build::new(board, board.format(), Structure::DualSplit, &scene);
        build.program_with("selftest", &["selftest"]).run();
    }
}

/// The linker knows the boards that the host knows.
#[test]
fn memory_maps_are_the_boards() {
    for board in &BOARDS {
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
