//! The firmware on emulated boards: the same pictures as the host's, within the recorded cost.
//!
//! Needs `qemu-system-arm` and the targets `thumbv7em-none-eabihf` and `thumbv7m-none-eabi`
//! (`rustup target add`). Without them the tests say so and pass, unless `GRIDEL_REQUIRE_BOARDS`
//! is 1. `fixtures/recorded/board.json` holds what was measured last: nothing may grow by more than 2 %.
//! `GRIDEL_RECORD_BOARDS=1` records anew; read the difference before it is committed.

mod elf;
mod figures;
mod firmware;
mod scenes;

use figures::Figures;
use firmware::{AN385, AN386, Board, Build};
use gridel_core::{Format, Structure};

/// Stack and workspace of the suzanne workload at most: loading, and tracing primary rays.
const PRIMARY_RAM: u64 = 2 * 1024;
/// Stack and workspace of the glass chessboard at depth 6 at most, beside the row.
const PICTURE_RAM: u64 = 4 * 1024;

/// The formats that boards with and without a floating-point unit run.
const FORMATS: [(&Board, Format); 3] = [
    (&AN386, Format::F32),
    (&AN386, Format::Fixed),
    (&AN385, Format::Fixed),
];

#[test]
fn pictures_are_the_hosts_byte_for_byte() {
    if !firmware::available() {
        return;
    }
    let mut figures = Figures::new();
    for scene in [scenes::quick(), scenes::glass_chess()] {
        for (board, format) in FORMATS {
            let build = Build::new(board, format, Structure::DualSplit, &scene);
            let program = build.program("picture");
            let report = program.run();
            let picture = program.file("picture.rgb");
            assert!(
                picture == scene.picture(format),
                "{build}: the picture differs from the host's; see {}",
                program.folder().display()
            );
            if scene.name == "glass-chess" {
                let stack = report["load-stack-bytes"].max(report["picture-stack-bytes"]);
                let ram = stack + report["workspace-bytes"];
                assert!(ram <= PICTURE_RAM, "{build}: {ram} bytes of RAM");
            }
            figures.add(&build.to_string(), &report);
        }
    }
    figures.check();
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
    for (board, format) in FORMATS {
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
    for (board, format) in FORMATS {
        let build = Build::new(board, format, Structure::Flagged, &suzanne);
        let report = build.program("primary").run();
        assert_eq!(report["hits"], 1400, "{build}");
        figures.add(&build.to_string(), &report);
    }
    figures.check();
}

#[test]
fn the_cores_own_tests_pass_on_boards() {
    if !firmware::available() {
        return;
    }
    let scene = scenes::quick();
    for (board, format) in [(&AN386, Format::F32), (&AN385, Format::Fixed)] {
        let build = Build::new(board, format, Structure::DualSplit, &scene);
        build.program("selftest").run();
    }
}

/// What a product would flash holds no function that panics and, in `fixed`, none that computes
/// in floating point.
#[test]
fn nothing_is_linked_that_must_not_be() {
    if !firmware::available() {
        return;
    }
    let mut figures = Figures::new();
    for scene in [scenes::quick(), scenes::glass_chess()] {
        for (board, format) in FORMATS {
            let build = Build::new(board, format, Structure::DualSplit, &scene);
            let program = build.program("bare");
            let elf = elf::Elf::read(program.path());
            let panicking = elf.functions(elf::panics);
            assert!(panicking.is_empty(), "{build} can panic: {panicking:#?}");
            if format == Format::Fixed {
                let float = elf.functions(elf::computes_in_floating_point);
                assert!(float.is_empty(), "{build} has soft floats: {float:#?}");
            }
            let flash = elf.flash_bytes() - scene.blob.bytes().len() as u64;
            figures.add(&build.to_string(), &[("code-bytes".into(), flash)].into());
        }
    }
    figures.check();
}
