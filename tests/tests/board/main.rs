//! The firmware on emulated boards: the same pictures as the host's, within the recorded cost.
//!
//! Needs `qemu-system-arm`, `qemu-system-riscv32`, Node, and the Rust targets of all boards
//! (`rustup target add`). Without them the tests say so and pass, unless `GRIDEL_REQUIRE_BOARDS`
//! is 1. `fixtures/recorded/board.json` holds what was measured last: nothing may grow by more than 2 %.
//! `GRIDEL_RECORD_BOARDS=1` records anew; read the difference before it is committed.

#[path = "../../firmware/src/casts.rs"]
mod casts;
mod elf;
mod figures;
mod firmware;
mod parts;
mod scenes;
mod stack;

use casts::Casts;
use figures::Figures;
use firmware::{AARCH64, Build, S390X, WASM, board};
use gridel_core::{Effects, Fixed, Format, List, Stack, Structure, Vouched};
use gridel_host::board::{BOARDS, Board};
use gridel_host::emit::{self, Emitted};
use gridel_host::report::{Ledger, Target};
use scenes::Compiled;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::LazyLock;

/// Stack and workspace of the suzanne workload at most: loading, and tracing primary rays.
const PRIMARY_RAM: u64 = 2 * 1024 + 256;

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

/// What every shape and effect takes where all cores of its kind are measured: the README's table is
/// that of the smallest board, and ledgers are added up from it.
#[test]
fn every_core_pays_for_parts_one_by_one() {
    if !firmware::available() {
        return;
    }
    let mut figures = Figures::new();
    let scenes = parts::scenes();
    for (board, format) in measured_in_full() {
        for scene in scenes.iter().chain([&parts::sphere_and_triangle()]) {
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
    }
    figures.check();
}

/// What some parts take on the other boards, by which the ledgers stretch what was measured for their kin.
#[test]
fn every_board_pays_for_few_parts() {
    if !firmware::available() {
        return;
    }
    let scene = parts::sphere_and_triangle();
    let mut figures = Figures::new();
    let others = boards().filter(|&(board, _)| board != &WASM);
    for (board, format) in others.filter(|&(board, format)| board.kin(format) != (board, format)) {
        let build = Build::new(board, format, Structure::DualSplit, &scene);
        let elf = build.program("bare").elf();
        figures.add(&build.to_string(), &footprint(&build, &elf, &scene));
    }
    figures.check();
}

/// Boards on whose cores all is measured that others are told by.
fn measured_in_full() -> impl Iterator<Item = (&'static Board, Format)> {
    boards().filter(|&(board, format)| board.kin(format) == (board, format))
}

/// What every shape and effect costs rays on the smallest board: the README's table.
#[test]
fn shapes_and_effects_are_paid_for_one_by_one() {
    if !firmware::available() {
        return;
    }
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

/// What a product with every shape and effect takes on every board, fast or small, and one on each kind
/// of core through every structure that boards vouch for: the ledgers' bounds.
#[test]
fn everything_on_every_board() {
    if !firmware::available() {
        return;
    }
    let scene = scenes::quick();
    let mut figures = Figures::new();
    for (board, format) in boards().filter(|&(board, _)| board != &WASM) {
        let in_full = board.kin(format) == (board, format);
        let measured = |&it: &Structure| in_full || it == Structure::DualSplit;
        for structure in Vouched::STRUCTURES.into_iter().filter(measured) {
            let fast = || Build::new(board, format, structure, &scene);
            for build in [fast(), fast().small()] {
                let elf = build.program_with("bare", &["everything"]).elf();
                figures.add(&build.to_string(), &footprint(&build, &elf, &scene));
            }
        }
    }
    figures.check();
}

/// What parts add up to is enough for a program that holds some of them.
#[test]
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
#[test]
fn small_code_fits_in_16_kib() {
    if !firmware::available() {
        return;
    }
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

/// What `gridel build --emit-rust` writes runs on a board; with a blob that is not the one that it
/// was written for, or that has no room, it does not compile.
#[test]
fn emitted_modules_run_or_do_not_compile() {
    if !firmware::available() {
        return;
    }
    let discovery = board("stm32vldiscovery");
    let scene = parts::sphere_and_triangle();
    let view = scene.blob.scene().expect("the compiler's own blob");
    let mut emitted = Emitted {
        scene: &view,
        structure: Structure::DualSplit,
        format: Format::Fixed,
        budget: Some((96 * 1024, discovery)),
    };
    let build = Build::new(discovery, Format::Fixed, Structure::DualSplit, &scene);
    let folder = build.folder("emitted");
    let features = [&["emitted"], &scene.features()[..]].concat();
    let outgrown = |features: &[&str], why: &str| {
        let errors = build.try_program("emitted", features).map(|_| ());
        let errors = errors.expect_err("it compiles all the same");
        assert!(errors.contains(why), "{errors}");
    };

    let write = |module: &str, blob: &Compiled| write_module(&folder, module, blob.blob.bytes());
    write(&emitted.module(), &scene);
    let program = build.program_with("emitted", &features);
    program.run();
    assert!(program.file("picture.rgb") == scene.picture(Format::Fixed));

    outgrown(
        &features[..features.len() - 1],
        "the scene calls for `shadow`: enable that feature",
    );
    emitted.budget = Some((scene.blob.bytes().len() as u64 - 1, discovery));
    write(&emitted.module(), &scene);
    outgrown(&features, "the blob outgrew the flash of stm32vldiscovery");
    emitted.budget = None;
    let module = emitted.module();
    let mut damaged = scene.blob.bytes().to_vec();
    damaged[200] ^= 1;
    write_module(&folder, &module, &damaged);
    outgrown(&features, "the blob was damaged");
    write_module(&folder, &module, &scene.blob.bytes()[..10]);
    outgrown(&features, "the blob was cut off");
    for (why, other) in parts::outgrown() {
        write(&module, &other);
        outgrown(&features, why);
    }
    let [shallow, deep] = parts::deeper();
    let view = shallow.blob.scene().expect("the compiler's own blob");
    emitted.scene = &view;
    write(&emitted.module(), &deep);
    let features = [&["emitted"], &deep.features()[..]].concat();
    outgrown(&features, "the blob outgrew WORK_DEPTH");
}

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

/// Firmware that vouches for its blob loads it in the same time, however long it is, and without the
/// code that proves the rest.
#[test]
fn vouched_blobs_load_in_constant_time() {
    if !firmware::available() {
        return;
    }
    let (quick, molecule) = (scenes::quick(), scenes::molecule());
    let mut figures = Figures::new();
    for (name, scene) in [
        ("mps2-an385", &quick),
        ("mps2-an385", &molecule),
        ("microbit", &quick),
        ("sifive_e", &quick),
    ] {
        let build = Build::new(board(name), Format::Fixed, Structure::DualSplit, scene);
        let emitted = Emitted {
            scene: &scene.blob.scene().expect("the compiler's own blob"),
            structure: Structure::DualSplit,
            format: Format::Fixed,
            budget: None,
        };
        let folder = build.folder("emitted");
        write_module(&folder, &emitted.module(), scene.blob.bytes());
        let features = [&["emitted"], &scene.features()[..]].concat();
        let program = build.program_with("emitted", &features);
        let mut report = program.run();
        assert!(program.file("picture.rgb") == scene.picture(Format::Fixed));
        look_into(
            &build,
            &program.elf(),
            board(name),
            Format::Fixed,
            &mut report,
        );
        let load = report["load-instructions"];
        assert!(load <= 6000, "{build}: {load} instructions to load");
        figures.add(&format!("{build} vouched"), &report);
    }
    figures.check();
}

/// Writes what `gridel build --emit-rust` does.
fn write_module(folder: &Path, module: &str, blob: &[u8]) {
    fs::write(folder.join(emit::MODULE), module).expect("the target folder can be written to");
    fs::write(folder.join(emit::BLOB), blob).expect("the target folder can be written to");
}

#[test]
fn primary_rays_of_suzanne() {
    if !firmware::available() {
        return;
    }
    let Some(suzanne) = scenes::suzanne() else {
        return;
    };
    let mut figures = Figures::new();
    for (board, format) in boards_for_primary_rays() {
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
    }
    figures.check();
}

/// What meshes for boards are compiled to: narrow vertices, dual-split nodes alone.
#[test]
fn primary_rays_of_suzanne_in_16_bits() {
    if !firmware::available() {
        return;
    }
    let Some(suzanne) = scenes::suzanne_in_16_bits() else {
        return;
    };
    assert!(suzanne.blob.bytes().len() <= 32 * 1024);
    let mut figures = Figures::new();
    for (board, format) in boards_for_primary_rays() {
        let build = Build::new(board, format, Structure::DualSplit, &suzanne);
        let report = build.program("primary").run();
        assert_eq!(report["hits"], 1400, "{build}");
        figures.add(&build.to_string(), &report);
    }
    figures.check();
}

/// Instructions that a primary ray through a molecule of some 2,800 spheres takes at most, where there
/// are floats.
const A_RAY_AMONG_SPHERES: u64 = 620;

/// Molecules of that size, a computed one and a protein, on a lattice of 16 bits.
#[test]
fn primary_rays_of_molecules() {
    if !firmware::available() {
        return;
    }
    let mut figures = Figures::new();
    for molecule in [scenes::molecule()].into_iter().chain(scenes::protein()) {
        for name in ["mps2-an386", "mps2-an385"] {
            let board = board(name);
            let build = Build::new(board, board.format(), Structure::DualSplit, &molecule);
            let report = build.program("primary").run();
            assert_eq!(report["rays"], 64 * 64, "{build}");
            assert!(report["hits"] > 200, "{build}");
            let a_ray = report["ray-instructions"];
            if board.format() == Format::F32 {
                assert!(a_ray <= A_RAY_AMONG_SPHERES, "{build}: {a_ray} a ray");
            }
            figures.add(&build.to_string(), &report);
        }
    }
    figures.check();
}

/// Stack and workspace of a closest hit at most where there is no camera, in integers and in floats.
const CAST_RAM: u64 = 1024;

/// What a range finder or a collision needs: hits alone, those of the host's list.
#[test]
fn rays_without_a_camera() {
    if !firmware::available() {
        return;
    }
    let mut figures = Figures::new();
    for scene in [scenes::torus()].into_iter().chain(scenes::suzanne()) {
        for (board, format) in boards_for_primary_rays() {
            let build = Build::new(board, format, Structure::DualSplit, &scene);
            let mut report = build.program("casts").run();
            let hosts = casts_through_the_list(&scene, format);
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
        }
    }
    figures.check();
}

/// What the rays of `casts` meet on the host, each primitive tested.
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
#[test]
fn primary_rays_of_suzanne_in_16_kib() {
    if !firmware::available() {
        return;
    }
    let Some(suzanne) = scenes::small_suzanne() else {
        return;
    };
    assert!(suzanne.blob.bytes().len() <= 16 * 1024);
    let mut figures = Figures::new();
    for name in ["mps2-an386", "mps2-an385"] {
        let board = board(name);
        let format = board.format();
        let build = Build::new(board, format, Structure::Flagged, &suzanne);
        let report = build.program("primary").run();
        assert_eq!(report["hits"], 1400, "{build}");
        figures.add(&build.to_string(), &report);
    }
    figures.check();
}

/// The paper's claim, on its own sorts of scenes: whole pictures take less with flagged sides.
#[test]
fn flagged_is_ahead_of_plain() {
    if !firmware::available() {
        return;
    }
    const STRUCTURES: [Structure; 3] = [Structure::Bvh, Structure::Flagged, Structure::DualSplit];
    let mut figures = Figures::new();
    for scene in scenes::papers(&STRUCTURES) {
        for (name, format) in PAPER_BOARDS {
            let [plain, flagged, dual] = STRUCTURES.map(|structure| {
                let spent = spent(name, format, structure, &scene, &mut figures);
                spent.expect("short parts")
            });
            let about = format!("{} {}", scene.name, format.name());
            println!(
                "{about}: plain over flagged {:.3}, over dual-split {:.3}",
                plain / flagged,
                plain / dual
            );
            assert!(flagged < plain, "{about}: flagged sides do not pay");
        }
    }
    figures.check();
}

#[test]
fn lists_of_candidates_in_floats() {
    lists_of_candidates(PAPER_BOARDS[0]);
}

#[test]
fn lists_of_candidates_in_integers() {
    lists_of_candidates(PAPER_BOARDS[1]);
}

/// The grid and lists of candidates on the paper's scenes, as far as a board's flash holds them, and
/// on a molecule that fills the picture. What hierarchies take there `flagged_is_ahead_of_plain`
/// records; the test `documents` compares.
fn lists_of_candidates((name, format): (&str, Format)) {
    use Structure::{Apex, CylinderCube, CylinderCubeEntry, CylinderCubeTight, DualSplit, Grid};
    // Gridels a side are those that the builder would find for its budget.
    static SCENES: LazyLock<Vec<(Structure, Compiled)>> = LazyLock::new(|| {
        let [chess, molecule, large] = scenes::PAPERS;
        let all = [
            (chess, Grid, None),
            (chess, CylinderCube, None),
            (chess, CylinderCubeTight, Some(12)),
            (chess, CylinderCubeEntry, Some(12)),
            (chess, Apex, None),
            (molecule, Grid, None),
            (molecule, CylinderCube, None),
            (molecule, CylinderCubeTight, Some(4)),
            (molecule, CylinderCubeEntry, Some(8)),
            (molecule, Apex, None),
            (large, Grid, None),
            (large, CylinderCubeEntry, Some(8)),
            (large, Apex, None),
            (scenes::CLOSE, Grid, None),
            (scenes::CLOSE, DualSplit, None),
            (scenes::CLOSE, Apex, None),
        ];
        all.map(|(scene, structure, gridels)| {
            (structure, scenes::paper(scene, &[structure], gridels))
        })
        .into()
    });
    if !firmware::available() {
        return;
    }
    let mut figures = Figures::new();
    for (structure, scene) in SCENES.iter() {
        spent(name, format, *structure, scene, &mut figures);
    }
    figures.check();
}

/// Where the paper's scenes are measured.
const PAPER_BOARDS: [(&str, Format); 2] =
    [("mps2-an386", Format::F32), ("mps2-an385", Format::Fixed)];

/// Instructions of a picture, which must be the host's; `None` where a part of it takes longer than
/// the board's timer counts.
fn spent(
    name: &str,
    format: Format,
    structure: Structure,
    scene: &Compiled,
    figures: &mut Figures,
) -> Option<f64> {
    let build = Build::new(board(name), format, structure, scene);
    let program = build.program("picture");
    let report = program.run();
    let picture = program.file("picture.rgb");
    let hosts = scene.picture_through(structure, format);
    assert!(picture == hosts, "{build}: another picture");
    figures.add(&build.to_string(), &report);
    let spent = report.get("picture-instructions");
    spent.map(|&instructions| instructions as f64)
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
