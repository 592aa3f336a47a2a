//! Options that would change nothing are rejected, and never ignored.

use crate::program::Folder;

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
            &["--model is for molecules", "quick.toml has none"],
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
