//! The memory report of `gridel inspect` and `gridel build`.

use crate::program::{Folder, fixture};
use gridel_core::{Format, Structure};
use gridel_host::measure::board::programs::{Footprint, Programs, everything as all_parts};
use gridel_host::measure::board::{BOARDS, Board};
use gridel_host::table::grouped;
use serde_json::Value;

/// The items of the memory report add up, and the blob's are all of its bytes.
#[test]
fn the_memory_report_of_a_board_adds_up() {
    let folder = Folder::new();
    folder.write("quick.toml", &fixture("quick"));
    for target in ["stm32vldiscovery", "sifive_e"] {
        let report = folder.json(&["inspect", "quick.toml", "--target", target]);
        let items = report["memory_report"]["flash"]["items"]
            .as_array()
            .unwrap();
        let blob = items
            .iter()
            .filter(|item| item["what"].as_str().unwrap().starts_with("blob"));
        let bytes: u64 = blob.map(|item| item["bytes"].as_u64().unwrap()).sum();
        assert_eq!(report["memory_map"]["bytes"], bytes);
        let code = items
            .iter()
            .filter(|item| item["what"].as_str().unwrap().starts_with("code"));
        assert!(
            code.map(|item| item["bytes"].as_u64().unwrap())
                .sum::<u64>()
                > 16 * 1024
        );
        let ram = report["memory_report"]["ram"]["items"].as_array().unwrap();
        let all: u64 = ram.iter().map(|item| item["bytes"].as_u64().unwrap()).sum();
        let text = folder.done(&["inspect", "quick.toml", "--target", target]);
        let (_, ram) = text.split_once("RAM  in all").unwrap();
        let shown: String = ram
            .lines()
            .next()
            .unwrap()
            .chars()
            .filter(char::is_ascii_digit)
            .collect();
        assert_eq!(shown, all.to_string());
        assert!(text.contains("remains"), "{text}");
    }
}

/// The recorded figures of a program of all parts: fast, and with the feature `small`.
fn everything(board: &str, format: &str, accel: &str) -> [Footprint; 2] {
    program(board, format, accel, &all_parts().collect::<Vec<_>>())
}

/// The recorded figures of a program of some parts.
fn program(board: &str, format: &str, accel: &str, parts: &[&str]) -> [Footprint; 2] {
    let board = Board::named(board).unwrap();
    let format = Format::ALL.into_iter().find(|it| it.name() == format);
    let structure = Structure::ALL.into_iter().find(|it| it.name() == accel);
    let place = (board, format.unwrap(), structure.unwrap());
    let programs = Programs::recorded();
    let program = programs.get(place, parts).unwrap();
    [program.fast.unwrap(), program.small.unwrap()]
}

/// The bytes of all items of a memory report's account that begin with a word.
fn sum(report: &Value, account: &str, word: &str) -> u64 {
    let items = report["memory_report"][account]["items"]
        .as_array()
        .unwrap();
    let items = items
        .iter()
        .filter(|item| item["what"].as_str().unwrap().starts_with(word));
    items.map(|item| item["bytes"].as_u64().unwrap()).sum()
}

/// The shapes that `quick` lacks.
const OTHER_SHAPES: &[u8] = b"
[[object]]
kind = 'torus'
center = [0, 1, 0]
axis = [0, 1, 0]
major_radius = 1
minor_radius = 0.5

[[object]]
kind = 'plane'
point = [0, -1, 0]
normal = [0, 1, 0]
";

/// The effects that `quick` lacks, but for those of its camera and picture.
const OTHER_EFFECTS: &[u8] = b"
[environment]
zenith = 0.2
horizon = 0.5
ground = 0.1
size = 16

[[light]]
kind = 'rectangle'
corner = [0, 9, 0]
edges = [[1, 0, 0], [0, 0, 1]]
radiance = 5

[material.rough]
mirror = 0.5
roughness = 0.5
transmit = 0.2
priority = 1
emission = 0.1
lights = false

[material.screen]
texture = 'screen.png'
alpha = 'cutout'

[[object]]
kind = 'sphere'
center = [3, 1, 0]
radius = 0.5
material = 'rough'

[[object]]
kind = 'mesh'
material = 'screen'
vertices = [[0, 0, 2], [1, 0, 2.2], [1, 1, 2], [0, 1, 2.2]]
faces = [[0, 1, 2], [0, 2, 3]]
smooth = 90
colors = ['#ff0000', '#00ff00', '#0000ff', '#ffffff']
coordinates = [[0, 1], [1, 1], [1, 0], [0, 0]]
";

/// The call stack is enough for a build with the feature `small`, too, which takes more of it, and the
/// memory report says for which builds that holds.
#[test]
fn the_call_stack_of_a_memory_report_is_enough_for_small_code() {
    let folder = Folder::new();
    folder.write("screen.png", include_bytes!("../../../fixtures/screen.png"));
    let quick = String::from_utf8(fixture("quick")).unwrap();
    let quick = quick.replace("[camera]\n", "[camera]\naperture = 0.1\n");
    let quick = quick.replace(
        "[render]\n",
        "[render]\nbounces = 1\ntone_mapping = 'aces'\n",
    );
    folder.write(
        "quick.toml",
        &[quick.as_bytes(), OTHER_SHAPES, OTHER_EFFECTS].concat(),
    );
    for accel in ["dual-split", "flagged", "bvh", "list"] {
        let build = [
            "build",
            "quick.toml",
            "-o",
            "quick.gridel",
            "--accel",
            accel,
        ];
        folder.done(&build);
        for (board, format) in [
            ("stm32vldiscovery", "fixed"),
            ("microbit", "fixed"),
            ("sifive_e", "fixed"),
            ("mps2-an386", "f32"),
        ] {
            let target = ["--target", board, "--flash", "1M", "--ram", "64K"];
            let inspect = [&["inspect", "quick.gridel"], &target[..]].concat();
            let report = folder.json(&inspect);
            let [fast, small] = ["fast", "small"].map(|build| {
                report["memory_report"][build]["call_stack"]
                    .as_u64()
                    .unwrap()
            });
            let reported = sum(&report, "ram", "call stack");
            assert_eq!(reported, fast.max(small));
            // The scene requires all but vertex indices of more than 16 bits, and display values.
            let most = everything(board, format, accel).map(|build| build.call_stack);
            let most = most[0].max(most[1]);
            assert!(
                10 * reported > 9 * most && 10 * reported < 11 * most,
                "{board} {accel}: {reported} of {most}"
            );
            let text = folder.done(&inspect);
            for word in [
                "lto = \"fat\"",
                "feature `small`",
                &grouped(fast),
                &grouped(small),
            ] {
                assert!(text.contains(word), "{word}: {text}");
            }
        }
    }
    // What was accepted for the fast build alone.
    let target = ["--target", "stm32vldiscovery", "--flash", "1M"];
    let report = folder.json(&[&["inspect", "quick.toml"], &target[..]].concat());
    let all = sum(&report, "ram", "");
    let call_stack = |build: &str| {
        report["memory_report"][build]["call_stack"]
            .as_u64()
            .unwrap()
    };
    let more = call_stack("small") - call_stack("fast");
    let build = |ram: u64| {
        let ram = ram.to_string();
        let build = ["build", "quick.toml", "-o", "new.gridel", "--ram", &ram];
        folder.run(&[&build, &target[..]].concat())
    };
    assert_eq!(build(all).code, Some(0));
    let rejected = build(all - more);
    assert_eq!(rejected.code, Some(3));
    let more = grouped(more);
    let advice = format!("without the feature `small` the call stack takes {more} bytes less");
    assert!(rejected.said().contains(&advice), "{}", rejected.said());
}

/// The items of code add up to the program of the scene, and one part in a hundred more.
#[test]
fn memory_report_lists_the_code_of_the_scenes_program() {
    let folder = Folder::new();
    folder.write("quick.toml", &fixture("quick"));
    for (board, format) in [
        ("stm32vldiscovery", "fixed"),
        ("microbit", "fixed"),
        ("sifive_e", "fixed"),
        ("mps2-an386", "f32"),
    ] {
        let report = folder.json(&["inspect", "quick.toml", "--target", board]);
        let listed = sum(&report, "flash", "code");
        assert_eq!(report["memory_report"]["fast"]["code"], listed);
        let parts = "triangle sphere box disc cone wide-lattice shadow highlight mirror glass absorption checker";
        let parts: Vec<&str> = parts.split(' ').collect();
        let [fast, _] = program(board, format, "dual-split", &parts);
        assert_eq!(listed, fast.code + fast.code.div_ceil(100), "{board}");
        assert_eq!(report["memory_report"]["measured"], true, "{board}");
    }
}

/// The programs of all fixtures were built, so that no bound stands for them.
#[test]
fn memory_reports_of_fixtures_are_measured() {
    let folder = Folder::new();
    for name in [
        "cornell",
        "glass-chess",
        "quick",
        "robot-arm",
        "room",
        "sky",
        "studio",
        "tumbler",
        "turntable",
    ] {
        let path = format!("{}/../fixtures/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        for board in ["stm32vldiscovery", "mps2-an386", "microbit", "sifive_e"] {
            let report = folder.json(&[
                "inspect", &path, "--target", board, "--flash", "1G", "--ram", "1G",
            ]);
            let report = &report["memory_report"];
            assert_eq!(report["is_bounded"], false, "{name} {board}");
            assert_eq!(report["measured"], true, "{name} {board}");
        }
    }
}

/// A program that was not built may fit although its upper bound does not; one whose blob is too large does not.
#[test]
fn upper_bounds_decide_nothing() {
    let folder = Folder::new();
    let scene = "[render]\nwidth = 16\nheight = 8\n[material.default]\nroughness = 0.3\nmirror = 0.5\n\
                 [[object]]\nkind = 'torus'\ncenter = [0, 0, 0]\naxis = [0, 1, 0]\nmajor_radius = 2\nminor_radius = 1\n\
                 [[object]]\nkind = 'plane'\npoint = [0, -1, 0]\nnormal = [0, 1, 0]\n";
    folder.write("rare.toml", scene.as_bytes());
    let target = ["--target", "stm32vldiscovery", "--ram", "1M", "--flash"];
    let report = folder.json(&[&["inspect", "rare.toml"], &target[..], &["1M"]].concat());
    let flash = sum(&report, "flash", "");
    assert_eq!(report["memory_report"]["is_bounded"], true);
    let build = |flash: u64| {
        let flash = flash.to_string();
        folder.run(
            &[
                &["build", "rare.toml", "-o", "b.gridel"],
                &target[..],
                &[&flash],
            ]
            .concat(),
        )
    };
    for (flash, words) in [(flash - 1, "undecided"), (100, "the scene takes")] {
        let rejected = build(flash);
        assert_eq!(rejected.code, Some(3), "{}", rejected.said());
        assert!(
            rejected.said().contains(words),
            "{flash}: {}",
            rejected.said()
        );
        assert_eq!(
            rejected.said().contains("undecided"),
            flash > 100,
            "{}",
            rejected.said()
        );
    }
}

/// Code is listed by shape and effect on every board, so that what requires little is not rejected.
#[test]
fn little_is_asked_of_every_board_for_a_scene_that_calls_for_little() {
    let folder = Folder::new();
    folder.write(
        "plain.toml",
        b"[[object]]\nkind = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\n",
    );
    for board in BOARDS.map(|board| board.name) {
        let report = folder.json(&["inspect", "plain.toml", "--target", board]);
        let code = sum(&report, "flash", "code");
        let items = report["memory_report"]["flash"]["items"].to_string();
        assert!(items.contains("code: sphere"), "{items}");
        assert!(!items.contains("cone"), "{items}");
        let format = report["memory_report"]["format"].as_str().unwrap();
        let measured = Board::named(board).unwrap().measured;
        let [most, _] = everything(measured, format, "dual-split").map(|build| build.code);
        assert!(5 * code < 4 * most, "{board}: {code} of {most}");
        folder.done(&[
            "build",
            "plain.toml",
            "-o",
            "b.gridel",
            "--target",
            board,
            "--flash",
            "80K",
        ]);
    }
}

/// Microcontrollers go by their names; their figures are those of the emulated board with the same kind of core.
#[test]
fn microcontrollers_have_the_figures_of_their_cores_kind() {
    let folder = Folder::new();
    folder.write("quick.toml", &fixture("quick"));
    for (name, measured, flash, ram) in [
        ("RP2040", "microbit", 2 << 20, 264 << 10),
        ("RP2350", "mps2-an505", 4 << 20, 520 << 10),
        ("rp2350-riscv", "sifive_e", 4 << 20, 520 << 10),
        ("nRF52840", "mps2-an386", 1 << 20, 256 << 10),
        ("STM32F411", "mps2-an386", 512 << 10, 128 << 10),
        ("STM32H743", "mps2-an500", 2 << 20, 512 << 10),
        ("ESP32-C3", "sifive_e", 4 << 20, 384 << 10),
        ("ESP32-C6", "sifive_e", 4 << 20, 512 << 10),
    ] {
        let report = |board: &str| {
            let report = folder.json(&["inspect", "quick.toml", "--target", board]);
            report["memory_report"].clone()
        };
        let (chip, kind) = (report(name), report(measured));
        assert_eq!(chip["board"], name.to_lowercase());
        assert_eq!(chip["kind"], measured);
        assert_eq!(kind["kind"], Value::Null);
        for figures in ["fast", "small", "format", "measured_on", "measured"] {
            assert_eq!(chip[figures], kind[figures], "{name}: {figures}");
        }
        assert_eq!(chip["flash"]["items"], kind["flash"]["items"], "{name}");
        assert_eq!(chip["flash"]["available"], flash, "{name}");
        assert_eq!(chip["ram"]["available"], ram, "{name}");
        let shown = folder.done(&["inspect", "quick.toml", "--target", name]);
        assert!(
            shown.contains(&format!("The figures are those of {measured}")),
            "{}",
            shown
        );
    }
}

/// Figures hold for what was measured: structures for boards, and formats that a board computes itself.
#[test]
fn structures_that_were_not_measured_are_rejected() {
    let folder = Folder::new();
    folder.write("quick.toml", &fixture("quick"));
    let build = [
        "build",
        "quick.toml",
        "-o",
        "wide.gridel",
        "--accel",
        "wide",
    ];
    let known = [
        "wide was not measured on boards",
        "list, bvh, flagged, dual-split",
    ];
    folder.fails(2, &[&build[..], &["--ram", "5K"]].concat(), &known);
    assert!(!folder.path("wide.gridel").exists());
    folder.done(&build);
    folder.fails(2, &["inspect", "wide.gridel", "--flash", "1M"], &known);
    let soft = [
        "--target",
        "mps2-an385",
        "--format",
        "f64",
        "--emit-rust",
        "module",
    ];
    folder.fails(
        2,
        &[&["build", "quick.toml", "-o", "soft.gridel"], &soft[..]].concat(),
        &["f64 in software", "use fixed"],
    );
    assert!(!folder.path("soft.gridel").exists());
}

/// A scene that does not fit is shown all the same, and rejected.
#[test]
fn memory_report_with_a_missing_part_is_rejected() {
    let folder = Folder::new();
    folder.write("quick.toml", &fixture("quick"));
    for json in [&[][..], &["--json"]] {
        let inspect = ["inspect", "quick.toml", "--ram", "1K"];
        let run = folder.run(&[&inspect[..], json].concat());
        assert_eq!(run.code, Some(3), "{}", run.stderr);
        let shown = if json.is_empty() {
            "RAM  MISSING"
        } else {
            "\"memory_report\""
        };
        assert!(run.stdout.contains(shown), "{}", run.stdout);
        assert!(run.said().contains("bytes of RAM"), "{}", run.stderr);
    }
    folder.done(&["inspect", "quick.toml", "--ram", "8K"]);
}
