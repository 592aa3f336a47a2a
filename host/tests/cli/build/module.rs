//! The Rust module of `--emit-rust`.

use crate::program::{Folder, fixture};
use gridel_core::Structure;

/// The module walks what the blob was built for, whatever that is, and names its feature.
#[test]
fn a_module_is_emitted_for_every_structure() {
    let folder = Folder::new();
    folder.write("quick.toml", &fixture("quick"));
    for structure in Structure::ALL {
        let name = structure.name();
        let build = ["build", "quick.toml", "-o", "b.gridel", "--accel", name];
        // Small tables.
        let options: &[_] = match name.starts_with("cylinder") {
            true => &["--gridels", "2"],
            false => &[],
        };
        folder.done(&[&build[..], options, &["--emit-rust", "src"]].concat());
        let module = String::from_utf8(folder.read("src/scene.rs")).unwrap();
        let accel = format!("pub type Accel = gridel_core::{structure:?};");
        assert!(module.contains(&accel), "{name}: {module}");
        let feature = format!("features = [\"{name}\", ");
        assert_eq!(
            module.contains(&feature),
            structure != Structure::List,
            "{name}: {module}"
        );
    }
}

/// A scene unit in steps is there where it is a number of 64 bits; other lengths are converted in scenes of every size.
#[test]
fn modules_convert_lengths_in_scenes_of_every_size() {
    let folder = Folder::new();
    for (size, has_unit) in [
        ("1e-30", false),
        ("1e-3", true),
        ("1", true),
        ("1e9", false),
    ] {
        let scene = format!("[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = {size}\n");
        folder.write("ball.toml", scene.as_bytes());
        folder.done(&["build", "ball.toml", "-o", "b.gridel", "--emit-rust", "src"]);
        let module = String::from_utf8(folder.read("src/scene.rs")).unwrap();
        assert_eq!(module.contains("pub const UNIT: i64"), has_unit, "{size}");
        assert!(module.contains("pub const fn steps("), "{size}");
    }
}

#[test]
fn a_module_is_emitted_for_the_board() {
    let folder = Folder::new();
    folder.write("quick.toml", &fixture("quick"));
    let emit = ["--emit-rust", "module", "--target", "mps2-an386"];
    folder.done(&[&["build", "quick.toml", "-o", "quick.gridel"], &emit[..]].concat());
    assert_eq!(
        folder.read("module/scene.gridel"),
        folder.read("quick.gridel")
    );
    let module = String::from_utf8(folder.read("module/scene.rs")).unwrap();
    for line in [
        "pub type Number = f32;",
        "pub type Accel = gridel_core::DualSplit;",
        "\"dual-split\", \"triangle\", \"sphere\", \"box\", \"disc\", \"cone\", \"wide-lattice\"",
        "pub const WORK_DEPTH: usize = 7;",
        "gridel_core::Scene::prevalidated(PREVALIDATED)",
        "the blob outgrew the flash of mps2-an386",
        "required.counts_as(COORDINATE_EXPONENT, COORDINATE_ORIGIN)",
        "required.morph_targets == 0",
    ] {
        assert!(module.contains(line), "{line}: {module}");
    }
    // A structure that is made for hosts cannot be prevalidated.
    folder.done(
        &[
            &[
                "build",
                "quick.toml",
                "-o",
                "quick.gridel",
                "--accel",
                "wide",
            ],
            &emit[..2],
        ]
        .concat(),
    );
    let module = String::from_utf8(folder.read("module/scene.rs")).unwrap();
    assert!(
        module.contains("gridel_core::Scene::from_bytes(BLOB)"),
        "{module}"
    );
}

/// The number of parts is asserted at compile time, and what only a part holds is among the features.
#[test]
fn a_module_asserts_the_number_of_parts() {
    let folder = Folder::new();
    let text = "[[part]]\nname = \"wheel\"\nobject = [{ kind = \"torus\", center = [0, 0, 0], \
                axis = [0, 1, 0], major_radius = 1, minor_radius = 0.25 }]\n\
                [[instance]]\npart = \"wheel\"\n";
    folder.write("wheel.toml", text.as_bytes());
    folder.done(&[
        "build",
        "wheel.toml",
        "-o",
        "w.gridel",
        "--emit-rust",
        "src",
    ]);
    let module = String::from_utf8(folder.read("src/scene.rs")).unwrap();
    for line in [
        "pub const PARTS: usize = 1;",
        "required.parts <= PARTS",
        "required.instances <= INSTANCES",
        "required.joints <= JOINTS",
        "gridel_core::Parts<'static, PARTS>",
        "\"torus\"",
        "\"instances\"",
    ] {
        assert!(module.contains(line), "{line}: {module}");
    }
}

/// Firmware plays the tracks of a blob, so it needs the effects of all times.
#[test]
fn a_module_has_the_effects_that_tracks_call_for() {
    let folder = Folder::new();
    let scene = "[material.x]\ndiffuse = 1\n\
                 [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'x'\n";
    let build = ["build", "a.toml", "-o", "a.gridel", "--emit-rust", "src"];
    let module = |track: &str| {
        folder.write("a.toml", format!("{scene}{track}").as_bytes());
        folder.done(&build);
        String::from_utf8(folder.read("src/scene.rs")).unwrap()
    };
    let still = module("");
    assert!(still.contains("WORK_DEPTH: usize = 0;") && !still.contains("\"mirror\""));
    let track = "[[track]]\ntarget = 'material.x.mirror'\ntimes = [0, 2]\nvalues = [0, 0.5]\n";
    let moving = module(track);
    assert!(moving.contains("\"mirror\""), "{moving}");
    assert!(!moving.contains("WORK_DEPTH: usize = 0;"), "{moving}");
    let report = folder.json(&["inspect", "a.gridel", "--target", "mps2-an386"]);
    let account = report["memory_report"].to_string();
    assert!(account.contains("mirror"), "{account}");
}
