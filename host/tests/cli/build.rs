//! `gridel build`.

use crate::program::{Folder, fixture};
use gridel_core::Structure;
use gridel_host::blob::Blob;
use gridel_host::table::grouped;
use serde_json::json;

#[test]
fn the_report_is_that_of_the_blob() {
    let folder = Folder::new();
    folder.write("quick.toml", &fixture("quick"));
    let report = folder.json(&["build", "quick.toml", "-o", "quick.gridel"]);
    let blob = Blob::new(&folder.read("quick.gridel"));
    let scene = blob.scene().unwrap();
    assert_eq!(report["blob"], "quick.gridel");
    assert_eq!(report["bytes"], blob.bytes().len());
    assert_eq!(report["primitives"], scene.header().primitives);
    assert_eq!(report["objects"], 10);
    assert_eq!(report["structures"], json!(["list", "dual-split"]));
    assert_eq!(report["stack_depth"], scene.stack_depth());
    assert_eq!(report["collapsed"], json!([]));
    let effects = report["effects"].as_array().unwrap();
    let glass = effects.iter().find(|e| e["effect"] == "glass").unwrap();
    assert_eq!(glass["by"], json!(["material glass"]));

    let text = folder.done(&["build", "quick.toml", "-o", "again.gridel"]);
    assert!(text.contains("glass, for material glass"), "{text}");
    assert_eq!(folder.read("again.gridel"), blob.bytes());
    assert_eq!(
        folder.names(),
        ["again.gridel", "quick.gridel", "quick.toml"]
    );
}

#[test]
fn structures_are_those_asked_for() {
    let folder = Folder::new();
    folder.write("quick.toml", &fixture("quick"));
    for (asked, held) in [
        (&["--accel", "list"][..], &[Structure::List][..]),
        (&["--accel", "bvh"], &[Structure::List, Structure::Bvh]),
        (
            &["--accel", "bvh", "--accel", "flagged", "--accel", "wide"],
            &[
                Structure::List,
                Structure::Bvh,
                Structure::Flagged,
                Structure::Wide,
            ],
        ),
        (&["--accel", "wide"], &[Structure::List, Structure::Wide]),
        // Rays without a list need a hierarchy.
        (
            &["--accel", "apex"],
            &[Structure::List, Structure::Bvh, Structure::Apex],
        ),
    ] {
        folder.done(&[&["build", "quick.toml", "-o", "b"], asked].concat());
        let blob = Blob::new(&folder.read("b"));
        let scene = blob.scene().unwrap();
        for structure in Structure::ALL {
            assert_eq!(scene.holds(structure), held.contains(&structure));
        }
    }
    for unknown in ["kd-tree", "BVH", ""] {
        folder.fails(
            2,
            &["build", "quick.toml", "-o", "new", "--accel", unknown],
            &["list, bvh, flagged, dual-split"],
        );
    }
}

#[test]
fn a_budget_refuses_before_writing() {
    let folder = Folder::with_quick();
    let accels = ["--accel", "bvh", "--accel", "flagged", "--strip-names"];
    folder.done(&[&["build", "quick.toml", "-o", "quick.gridel"], &accels[..]].concat());
    let most = folder.read("quick.gridel").len();
    let build = |bytes: &str| {
        let accels = ["--accel", "bvh", "--accel", "flagged", "--max-bytes"];
        let mut arguments = vec!["build", "quick.toml", "-o", "quick.gridel"];
        arguments.extend(accels);
        arguments.push(bytes);
        arguments.into_iter().map(String::from).collect::<Vec<_>>()
    };
    let run = |bytes: &str, check: &dyn Fn(&[&str])| {
        let arguments = build(bytes);
        check(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
    };
    let advice = ["--max-bytes", "leaving out `--accel bvh` saves"];
    run("1K", &|arguments| folder.fails(3, arguments, &advice));
    run(&(most - 1).to_string(), &|arguments| {
        folder.fails(3, arguments, &advice);
    });
    run(&most.to_string(), &|arguments| {
        folder.done(arguments);
    });
    run("1M", &|arguments| {
        folder.done(arguments);
    });
    run("some", &|arguments| folder.fails(2, arguments, &["64K"]));
}

#[test]
fn the_lattice_is_that_asked_for_and_its_losses_are_named() {
    let folder = Folder::new();
    folder.write(
        "dust.toml",
        br#"
        [[object]]
        name = "wall"
        kind = "box"
        min = [0, 0, 0]
        max = [1000, 1000, 1000]
        [[object]]
        name = "speck"
        kind = "sphere"
        center = [5, 5, 5]
        radius = 0.1
        "#,
    );
    let build = ["build", "dust.toml", "-o", "dust.gridel"];
    let fine = folder.json(&build);
    assert_eq!(fine["collapsed"], json!([]));
    assert_eq!(fine["lattice_bits"], 24);
    assert_eq!(fine["supplied"].as_array().unwrap().len(), 3);

    let coarse = [&build[..], &["--lattice-bits", "10"]].concat();
    let report = folder.json(&coarse);
    assert_eq!(report["collapsed"], json!(["speck (dust.toml:7)"]));
    assert!(report["step"].as_f64() > fine["step"].as_f64());
    let text = folder.done(&coarse);
    assert!(text.contains("collapsed   speck"), "{text}");
    let picture = ["render", "dust.toml", "-o", "dust.png"];
    let run = folder.run(&[&picture[..], &["--lattice-bits", "10"]].concat());
    assert!(run.stderr.contains("warning: dust.toml"), "{}", run.stderr);

    for bits in ["9", "25", "-1", "x"] {
        folder.fails(2, &[&build[..], &["--lattice-bits", bits]].concat(), &[]);
    }
}

#[test]
fn the_input_is_never_overwritten() {
    let folder = Folder::with_quick();
    std::fs::create_dir(folder.path("sub")).unwrap();
    for output in ["quick.toml", "./quick.toml", "sub/../quick.toml"] {
        folder.fails(
            2,
            &["build", "quick.toml", "-o", output],
            &["is the input", "give the output another name"],
        );
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(folder.path("quick.toml"), folder.path("link")).unwrap();
        folder.fails(2, &["build", "quick.toml", "-o", "link"], &["is the input"]);
    }
}

#[test]
fn what_is_no_scene_is_told() {
    let folder = Folder::with_quick();
    let fails = |scene: &str, words: &[&str]| {
        folder.fails(1, &["build", scene, "-o", "new.gridel"], words);
    };
    fails("quick.gridel", &["quick.gridel is a blob already"]);
    // The content counts, and not the name.
    folder.write("blob.toml", &folder.read("quick.gridel"));
    fails("blob.toml", &["is a blob already"]);
    fails("absent.toml", &["absent.toml cannot be read"]);
    fails(".", &["not a file"]);
    folder.write("scene.fbx", b"");
    fails("scene.fbx", &["fbx", ".toml, .obj"]);
    folder.write(
        "wrong.toml",
        b"[camera]\neye = [0, 0, 5]\ntraget = [0, 0, 0]\n",
    );
    fails("wrong.toml", &["wrong.toml:3", "target"]);
    folder.write("bent.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
    fails("bent.obj", &["bent.obj:4"]);
}

#[test]
fn molecules_have_a_style_a_model_and_alternates() {
    let folder = Folder::new();
    folder.done(&["sample", "c60"]);
    let build = ["build", "c60.pdb", "-o", "c60.gridel"];
    let primitives = |options: &[&str]| {
        let report = folder.json(&[&build[..], options].concat());
        report["primitives"].as_u64().unwrap()
    };
    assert_eq!(primitives(&[]), 60);
    assert_eq!(primitives(&["--style", "space-filling"]), 60);
    assert!(primitives(&["--style", "ball-and-stick"]) >= 60 + 90);
    folder.fails(
        1,
        &[&build[..], &["--model", "2"]].concat(),
        &["c60.pdb", "model"],
    );
    folder.fails(2, &[&build[..], &["--model", "0"]].concat(), &[]);
    folder.fails(
        2,
        &[&build[..], &["--style", "cartoon"]].concat(),
        &["space-filling"],
    );
    folder.fails(2, &[&build[..], &["--altloc", "AB"]].concat(), &[]);
}

#[test]
fn unwritable_places_are_errors_that_leave_nothing() {
    let folder = Folder::with_quick();
    let fails = |output: &str, words: &[&str]| {
        folder.fails(1, &["build", "quick.toml", "-o", output], words);
    };
    fails(
        "absent/quick.gridel",
        &["cannot be written", "create the folder"],
    );
    fails(".", &["cannot be written"]);
    #[cfg(target_os = "linux")]
    {
        fails("/dev/full", &["/dev/full cannot be written", "make room"]);
        std::os::unix::fs::symlink("/dev/full", folder.path("full")).unwrap();
        fails("full", &["full cannot be written"]);
    }
}

/// What the text says reads well: numbers of one thing, what is left out, what remains on a board.
#[test]
fn the_text_counts_and_explains() {
    let folder = Folder::new();
    let face = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    folder.write("one.obj", face.as_bytes());
    let build = |scene: &str, options: &[&str]| {
        folder.done(&[&["build", scene, "-o", "new.gridel"], options].concat())
    };
    let text = build("one.obj", &["--target", "mps2-an385"]);
    for word in [
        "1 primitive of 1 object",
        "largest displacement 0\n",
        "bytes of flash remain",
    ] {
        assert!(text.contains(word), "{word}: {text}");
    }
    // Nothing to tell of where there is no hierarchy.
    for accel in ["list", "wide"] {
        let text = build("one.obj", &["--accel", accel]);
        assert!(!text.contains("SAH cost"), "{text}");
    }
    let report = folder.json(&["build", "one.obj", "-o", "new.gridel", "--accel", "wide"]);
    assert_eq!(report["sah_cost"], json!(null));

    // Triangles without area are no fault of the lattice.
    let flat = format!("{face}{}", "f 1 2 1\n".repeat(29));
    folder.write("flat.obj", flat.as_bytes());
    let text = build("flat.obj", &[]);
    assert_eq!(text.matches("no area").count(), 6, "{text}");
    assert!(
        text.contains("and 24 more") && !text.contains("collapsed"),
        "{text}"
    );
    let run = folder.run(&["render", "flat.obj", "-o", "a.png", "--size", "8x8"]);
    assert!(
        run.stderr.contains("29 primitives without area"),
        "{}",
        run.stderr
    );
}

/// What would be saved is what is saved.
#[test]
fn the_advice_for_a_budget_is_exact() {
    let folder = Folder::with_quick();
    let bytes = |accels: &[&str]| {
        let options: Vec<_> = accels.iter().flat_map(|accel| ["--accel", accel]).collect();
        let build = ["build", "quick.toml", "-o", "new.gridel", "--strip-names"];
        folder.done(&[&build, &options[..]].concat());
        folder.read("new.gridel").len()
    };
    let advice = |accels: &[&str]| {
        let options: Vec<_> = accels.iter().flat_map(|accel| ["--accel", accel]).collect();
        let build = [
            "build",
            "quick.toml",
            "-o",
            "new.gridel",
            "--max-bytes",
            "1K",
        ];
        folder.run(&[&build[..], &options].concat()).said()
    };
    let list = bytes(&["list"]);
    for accel in ["dual-split", "flagged", "wide", "apex"] {
        let saved = bytes(&[accel]) - list;
        let said = advice(&[accel]);
        let expected = format!("instead of {accel} saves {} bytes", grouped(saved));
        assert!(said.contains(&expected), "{expected}: {said}");
    }
    let whole = bytes(&["dual-split"]);
    folder.done(&[
        "build",
        "quick.toml",
        "-o",
        "new.gridel",
        "--lattice-bits",
        "16",
        "--strip-names",
    ]);
    let saved = whole - folder.read("new.gridel").len();
    let expected = format!("`--lattice-bits 16` saves {} bytes", grouped(saved));
    let said = advice(&["dual-split"]);
    assert!(said.contains(&expected), "{expected}: {said}");
    let saved = bytes(&["bvh", "flagged"]) - bytes(&["flagged"]);
    let said = advice(&["bvh", "flagged"]);
    let expected = format!("leaving out `--accel bvh` saves {} bytes", grouped(saved));
    assert!(said.contains(&expected), "{expected}: {said}");
}

#[test]
fn a_table_beyond_its_budget_is_refused_as_a_blob_is() {
    let folder = Folder::with_quick();
    let build = [
        "build",
        "quick.toml",
        "-o",
        "new.gridel",
        "--accel",
        "cylinder-cube",
    ];
    let tight = ["--gridels", "1", "--budget", "10"];
    folder.fails(
        3,
        &[&build[..], &tight].concat(),
        &["1 gridel a side", "--budget"],
    );
}

#[test]
fn numbers_without_end_are_short() {
    let folder = Folder::new();
    folder.write("big.obj", b"v -1e300 0 0\nv 1e300 0 0\nv 0 1 0\nf 1 2 3\n");
    let build = ["build", "big.obj", "-o", "new.gridel"];
    folder.fails(1, &build, &["size is 2e300,"]);
    folder.write("wide.toml", b"render = { width = 6400, height = 10 }\n");
    let build = ["build", "wide.toml", "-o", "new.gridel"];
    folder.fails(1, &build, &["wide.toml:1", "64 times as wide"]);
}

#[test]
fn names_that_mean_something_else_are_refused() {
    let folder = Folder::with_quick();
    for name in ["x.png", "x.toml", "x.obj", "x.npy", "x.txt"] {
        folder.fails(2, &["build", "quick.toml", "-o", name], &[name, ".gridel"]);
    }
    folder.write("rays.npy", b"");
    let trace = ["trace", "quick.gridel", "--rays", "rays.npy", "-o", "h.txt"];
    folder.fails(2, &trace, &["h.txt", ".npy"]);
}

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

/// A file of another sort stays what it is.
#[test]
fn nothing_of_the_users_own_is_written_over() {
    let folder = Folder::with_quick();
    let own = b"a buffer, or a program";
    let build = [
        "build",
        "quick.toml",
        "-o",
        "scene.bin",
        "--emit-rust",
        "src",
    ];
    for (path, said) in [
        ("scene.bin", "scene.bin exists and is not a blob"),
        (
            "src/scene.rs",
            "scene.rs exists and is not a module of Gridel",
        ),
    ] {
        std::fs::create_dir_all(folder.path("src")).unwrap();
        folder.write(path, own);
        folder.fails(2, &build, &[said, "move that file away"]);
        assert_eq!(folder.read(path), own);
        std::fs::remove_file(folder.path(path)).unwrap();
    }
    // What was written before is written anew.
    folder.done(&build);
    folder.done(&build);
    // Neither is a file taken for a folder, nor does a folder stay that nothing came into.
    let build = [
        "build",
        "quick.toml",
        "-o",
        "b.gridel",
        "--emit-rust",
        "quick.toml",
    ];
    folder.fails(2, &build, &["quick.toml is not a folder"]);
    let build = [
        "build",
        "quick.toml",
        "-o",
        "none/b.gridel",
        "--emit-rust",
        "new",
    ];
    folder.fails(1, &build, &["none/b.gridel cannot be written"]);
    assert!(!folder.path("new").exists());
}

/// The blob and the module's two files come together or not at all.
#[test]
fn what_belongs_together_is_written_together() {
    let folder = Folder::with_quick();
    folder.write("n.gridel", b"old");
    for name in ["scene.rs", "scene.gridel"] {
        let module = folder.path("em");
        std::fs::create_dir_all(module.join(name)).unwrap();
        let build = ["build", "quick.toml", "-o", "n.gridel", "--emit-rust", "em"];
        folder.fails(1, &build, &[name, "cannot be written"]);
        let left = std::fs::read_dir(&module).unwrap();
        let left: Vec<_> = left.map(|entry| entry.unwrap().file_name()).collect();
        assert_eq!(left, [name]);
        std::fs::remove_dir_all(&module).unwrap();
    }
    // Neither does a picture come without its heat map.
    std::fs::create_dir(folder.path("heat.png")).unwrap();
    let render = [
        "render",
        "quick.gridel",
        "-o",
        "a.png",
        "--heat-map",
        "heat.png",
    ];
    folder.fails(1, &render, &["heat.png cannot be written"]);
}

/// Code and stack of the boards were measured, so they can change: what is asked for here lies far
/// from any border.
#[test]
fn a_scene_that_does_not_fit_a_board_is_refused_with_figures() {
    let folder = Folder::new();
    folder.write("quick.toml", &fixture("quick"));
    let build = ["build", "quick.toml", "-o", "quick.gridel"];
    let with = |options: &[&'static str]| [&build, options].concat();

    let refused = |arguments: &[&str]| {
        let run = folder.run(arguments);
        assert_eq!(run.code, Some(3), "{arguments:?}: {}", run.stderr);
        run.said()
    };
    let text = refused(&with(&["--target", "stm32vldiscovery", "--ram", "1K"]));
    assert!(
        text.contains("bytes of RAM") && text.contains("more than the 1,024"),
        "{text}"
    );
    assert!(
        text.contains("a ray depth of 5 in place of 6 saves 40 bytes"),
        "{text}"
    );
    // Rows are counted whole, so parts of them are no advice.
    assert!(!text.contains("parts of rows"), "{text}");
    let text = refused(&with(&["--flash", "8K"]));
    assert!(text.contains("bytes of flash"), "{text}");
    assert!(text.contains("with the feature `small`"), "{text}");
    let text = refused(&with(&["--flash", "8K", "--ram", "1K"]));
    assert_eq!(text.matches("`--accel list`").count(), 1, "{text}");
    assert_eq!(folder.names(), ["quick.toml"]);
    folder.done(&with(&["--target", "mps2-an386"]));
}

/// What is said to make a blob smaller is what it does, whether its own bytes are bounded or a board's.
#[test]
fn advice_on_flash_is_what_it_saves() {
    let folder = Folder::new();
    // Larger leaves and flagged sides pay where there is a hierarchy to speak of.
    folder.done(&["sample", "nanotube", "-o", "tube.pdb"]);
    let bytes = |options: &[&str]| {
        let build = ["build", "tube.pdb", "-o", "tube.gridel"];
        folder.done(&[&build[..], options].concat());
        folder.read("tube.gridel").len()
    };
    let all = bytes(&[]);
    for refusing in [["--flash", "8K"], ["--max-bytes", "8K"]] {
        let run = folder.run(&[&["build", "tube.pdb", "-o", "new.gridel"], &refusing[..]].concat());
        assert_eq!(run.code, Some(3), "{}", run.stderr);
        for option in [
            ["--lattice-bits", "16"],
            ["--leaf-size", "8"],
            ["--accel", "flagged"],
            ["--accel", "list"],
        ] {
            let saved = all - bytes(&option);
            let instead = match option[0] {
                "--accel" => " instead of dual-split",
                _ => "",
            };
            let option = option.join(" ");
            let advice = format!("`{option}`{instead} saves {} bytes", grouped(saved));
            assert!(run.said().contains(&advice), "{advice}: {}", run.said());
        }
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
    ] {
        assert!(module.contains(line), "{line}: {module}");
    }
    // Nobody vouches for a structure that is made for hosts.
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
