//! Options that would change nothing are rejected, and never ignored.

use crate::program::Folder;
use crate::trace::npy;

/// Options of one structure alone, where it is not built.
#[test]
fn options_of_structures_that_are_not_built_are_rejected() {
    let folder = Folder::with_quick();
    let fails = |arguments: &[&str], words: &[&str]| folder.fails(2, arguments, words);
    let build = ["build", "quick.toml", "-o", "new.gridel"];
    for (options, words) in [
        (
            &["--accel", "list", "--slabs", "7"][..],
            &[
                "--slabs is for slabs, flagged-slabs",
                "what is built is list",
            ][..],
        ),
        (
            &["--accel", "list", "--leaf-size", "4"],
            &["--leaf-size is for bvh"],
        ),
        (
            &["--accel", "wide", "--builder", "sah"],
            &["--builder is for bvh"],
        ),
        (&["--accel", "bvh", "--grid", "8"], &["--grid is for grid"]),
        (
            &["--accel", "bvh", "--budget", "1M"],
            &["--budget is for", "cylinder-cube", "apex"],
        ),
        (
            &["--accel", "ray-classes", "--gridels", "2"],
            &["--gridels is for cylinder-cube"],
        ),
        (
            &["--quality", "fast"],
            &["--quality is for wide", "dual-split"],
        ),
        (
            &["--model", "2"],
            &["--model is for molecules", "quick.toml is none of these"],
        ),
        (
            &["--style", "ball-and-stick"],
            &["--style is for molecules"],
        ),
        (&["--altloc", "A"], &["--altloc is for molecules"]),
    ] {
        fails(&[&build[..], options].concat(), words);
    }
    let render = ["render", "quick.toml", "-o", "new.png", "--accel", "bvh"];
    fails(
        &[&render[..], &["--quality", "fast"]].concat(),
        &["--quality is for wide"],
    );
    let verify = [
        "verify",
        "quick.toml",
        "--accel",
        "bvh",
        "--quality",
        "fast",
    ];
    fails(&verify, &["--quality is for wide"]);
    let compare = ["compare", "quick.toml", "--accel", "bvh"];
    fails(
        &[&compare[..], &["--quality", "fast"]].concat(),
        &["--quality is for wide"],
    );
    fails(
        &[&compare[..], &["--slabs", "3"]].concat(),
        &["--slabs is for slabs"],
    );
    let accuracy = ["accuracy", "quick.toml", "--quality", "fast"];
    fails(&accuracy, &["--quality is for wide"]);
}

/// Options for scene files, given with a blob; options that a command does not use are unknown to it.
#[test]
fn options_that_a_command_cannot_use_are_rejected() {
    let folder = Folder::with_quick();
    let fails = |arguments: &[&str], words: &[&str]| folder.fails(2, arguments, words);
    fails(
        &["verify", "quick.gridel", "--accel", "bvh"],
        &["--accel is for scene files"],
    );
    let render = ["render", "quick.gridel", "-o", "a.png", "--quality", "fast"];
    fails(&render, &["--quality is for scene files"]);
    fails(
        &[
            "trace",
            "quick.toml",
            "--rays",
            "r.npy",
            "-o",
            "h.npy",
            "--cutoff",
            "0",
        ],
        &["--cutoff"],
    );
    fails(
        &["inspect", "quick.toml", "--quality", "fast"],
        &["--quality"],
    );
    fails(
        &["accuracy", "quick.toml", "--lattice-bits", "16"],
        &["--lattice-bits"],
    );
    let explain = ["explain", "quick.gridel", "--ray", "0,4,11,0,-.3,-1"];
    fails(
        &[&explain[..], &["--samples", "4"]].concat(),
        &["--samples is for pixels"],
    );
    for (option, value) in [
        ("--eye", "0,0,5"),
        ("--target", "0,0,0"),
        ("--up", "0,0,1"),
        ("--fov", "20"),
    ] {
        let words = format!("{option} is for pixels, not for --ray");
        let words = words.replace("--target", "--target X,Y,Z");
        fails(&[&explain[..], &[option, value]].concat(), &[&words]);
    }
    // A ray that hits nothing shows it.
    folder.done(&[&explain[..], &["--background", "1,0,0"]].concat());
    let help = folder.done(&["accuracy", "--help"]);
    assert!(!help.contains("--lattice-bits"), "{help}");
    // Verbs that want a scene file say so of a blob.
    for command in ["compare", "accuracy"] {
        folder.fails(
            1,
            &[command, "quick.gridel"],
            &["is a blob already, not a scene file"],
        );
    }
}

/// A structure that is asked for twice is built once, and `--quality` reaches the builder.
#[test]
fn compare_takes_its_options() {
    let folder = Folder::with_quick();
    let compare = ["compare", "quick.toml", "--size", "16x12", "--repeat", "0"];
    let wide = ["--accel", "wide", "--accel", "wide"];
    let rows = folder.json(&[&compare[..], &wide].concat())["rows"].clone();
    assert_eq!(rows.as_array().unwrap().len(), 1);

    folder.done(&["sample", "icosphere"]);
    let nodes = |quality: &str| {
        let options = ["--size", "16x12", "--repeat", "0", "--quality", quality];
        let compare = ["compare", "icosphere.obj", "--accel", "wide"];
        folder.json(&[&compare[..], &options].concat())["rows"][0]["work"].clone()
    };
    assert_ne!(nodes("fast"), nodes("good"));
}

/// The commands that are printed are about the scene that was read.
#[test]
fn verify_prints_commands_with_its_options() {
    let folder = Folder::new();
    let c60 = concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/c60.pdb");
    std::fs::copy(c60, folder.path("my c60.pdb")).unwrap();
    let verify = [
        "verify",
        "my c60.pdb",
        "--style",
        "ball-and-stick",
        "--lattice-bits",
        "10",
        "--accel",
        "bvh",
        "--rays",
        "50",
    ];
    let text = folder.done(&verify);
    let command = "gridel explain 'my c60.pdb' --style ball-and-stick --lattice-bits 10 --ray=";
    assert!(text.contains(command), "{text}");
}

/// A pipe is no file, and nobody waits for what comes through it.
#[cfg(unix)]
#[test]
fn pipes_are_not_waited_for() {
    let folder = Folder::new();
    let pipe = folder.path("pipe.toml");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.unwrap().success());
    folder.fails(1, &["inspect", "pipe.toml"], &["it is not a file"]);
}

/// Each command that compiles a scene names in its JSON what the lattice leaves out.
#[test]
fn what_the_lattice_leaves_out_is_in_the_json_of_every_command() {
    let folder = Folder::new();
    let sphere = |x: f64, radius: f64| {
        format!("[[object]]\nkind = 'sphere'\ncenter = [{x}, 0, 0]\nradius = {radius}\n")
    };
    let scene = sphere(0.0, 1e6) + &sphere(3.0, 1e-3);
    folder.write("a.toml", scene.as_bytes());
    let ray = [0.0, 0.0, 1e7, 0.0, 0.0, 0.0, -1.0, 1e9];
    folder.write("rays.npy", &npy("<f8", &[ray]));
    for command in [
        &["build", "-o", "a.gridel"][..],
        &["render", "-o", "a.png", "--size", "8x6"],
        &["trace", "--rays", "rays.npy", "-o", "hits.npy"],
        &["inspect"],
        &["explain", "--pixel", "4,3", "--size", "8x6"],
        &["verify"],
        &["certify", "-o", "certified", "--size", "8x6"],
        &["compare", "--size", "8x6", "--repeat", "0"],
        &[
            "accuracy", "-o", "accuracy", "--size", "8x6", "--repeat", "1",
        ],
    ] {
        let report = folder.json(&[&command[..1], &["a.toml"], &command[1..]].concat());
        let warnings = report["warnings"].to_string();
        let words = "a.toml: 1 primitive too small for the lattice, left out: sphere 2";
        assert!(warnings.contains(words), "{command:?}: {warnings}");
    }
}

/// Only bvh can be refitted, so it is what a scene with room for moving vertices is compiled for.
#[test]
fn scenes_with_room_are_compiled_for_bvh() {
    let folder = Folder::new();
    let mesh = "[[object]]\nkind = 'mesh'\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, 2]]\n";
    folder.write("a.toml", mesh.as_bytes());
    fn with_room<'a>(start: &[&'a str]) -> Vec<&'a str> {
        [start, &["--room", "1"]].concat()
    }
    folder.done(&with_room(&[
        "build", "a.toml", "-o", "a.gridel", "--accel", "bvh",
    ]));
    folder.done(&with_room(&["build", "a.toml", "-o", "c.gridel"]));
    assert!(folder.read("c.gridel") == folder.read("a.gridel"));
    let of_scene = folder.json(&with_room(&["inspect", "a.toml"]));
    let of_blob = folder.json(&["inspect", "a.gridel"]);
    for key in ["contents", "memory_map"] {
        assert!(
            !of_blob[key].is_null() && of_scene[key] == of_blob[key],
            "{key}: {of_scene}"
        );
    }
    for start in [
        &["build", "a.toml", "-o", "b.gridel", "--accel", "wide"][..],
        &["render", "a.toml", "-o", "b.png", "--accel", "wide"],
        &["verify", "a.toml", "--rays", "10", "--accel", "wide"],
        &["compare", "a.toml", "--accel", "wide"],
    ] {
        folder.fails(
            2,
            &with_room(start),
            &["only bvh can be refitted", "--accel bvh"],
        );
    }
}

/// The mean of the samples is shown where tone mapping changes it, and colors are ratios in JSON.
#[test]
fn explained_colors_are_ratios_before_and_after_tone_mapping() {
    let folder = Folder::new();
    let scene = |curve: &str| {
        format!(
            "ambient = 1\ncamera = {{ eye = [0, 0, 4], target = [0, 0, 0] }}\n\
             render = {{ tone_mapping = '{curve}' }}\nmaterial.m = {{ diffuse = 0.5 }}\n\
             object = [{{ kind = 'sphere', center = [0, 0, 0], radius = 1, material = 'm' }}]\n"
        )
    };
    for (curve, shown) in [("none", 0.5), ("reinhard", 0.5 / 1.5)] {
        folder.write("a.toml", scene(curve).as_bytes());
        let explain = ["explain", "a.toml", "--pixel", "160,120"];
        let report = folder.json(&explain);
        let found = report["linear"][0].as_f64().unwrap();
        assert!((found - shown).abs() < 1e-3, "{curve}: {found}");
        let text = folder.done(&explain);
        assert_eq!(
            text.contains("mean of the samples, 0.5"),
            curve != "none",
            "{text}"
        );
    }
}

/// An environment is shown in place of a background.
#[test]
fn backgrounds_that_an_environment_hides_are_not_ignored_silently() {
    let folder = Folder::new();
    let scene = "background = [0, 0, 1]\n[environment]\nzenith = 0.5\nhorizon = 0.5\nground = 0\n\
        [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n";
    folder.write("a.toml", scene.as_bytes());
    let report = folder.json(&["build", "a.toml", "-o", "a.gridel"]);
    let warning = "the environment (a.toml:2) is shown in place of the scene's background";
    let warnings = report["warnings"].to_string();
    assert!(warnings.contains(warning), "{warnings}");
    let words = ["--background has no effect", "environment"];
    for input in ["a.toml", "a.gridel"] {
        let render = ["render", input, "-o", "a.png", "--background", "1,0,0"];
        folder.fails(2, &render, &words);
    }
    let render = ["render", "a.toml", "-o", "a.png", "--background", "1,0,0"];
    let without = ["--without", "environment", "--size", "8x6"];
    let report = folder.json(&[&render[..], &without].concat());
    let warnings = report["warnings"].to_string();
    assert!(!warnings.contains("shown in place"), "{warnings}");
}

/// The advice to put `--` before a number below 0 would not help.
#[test]
fn numbers_below_0_are_rejected_with_their_range() {
    let folder = Folder::with_quick();
    let render = ["render", "quick.toml", "-o", "new.png"];
    for (option, value, words) in [
        ("--room", "-1", "write a length in scene units"),
        ("--samples", "-1", "-1 is not in 1..=4096"),
        ("--depth", "-2", "-2 is not in 0..=32"),
        ("--light", "-1.color=1,1,1", "write a light's number"),
    ] {
        folder.fails(2, &[&render[..], &[option, value]].concat(), &[words]);
    }
    for (option, words) in [
        ("--max-rays", "write a number above 0"),
        ("--max-error", "write a number from 0 to 1"),
    ] {
        folder.fails(2, &["accuracy", "quick.toml", option, "-1"], &[words]);
    }
}
