//! `gridel render --shutter`: motion blur.

use crate::program::Folder;

const SCENE: &str = "\
    [render]\nwidth = 24\nheight = 18\nsamples = 8\n\
    [[light]]\nkind = 'point'\nposition = [2, 4, 3]\n\
    [[object]]\nkind = 'box'\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\n\
    [[track]]\ntarget = 'camera.orbit'\ntimes = [0, 2]\nvalues = [0, 90]\n";

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("a.toml", SCENE.as_bytes());
    folder.done(&["build", "a.toml", "-o", "a.gridel"]);
    folder
}

fn rendered(folder: &Folder, options: &[&str]) -> Vec<u8> {
    folder.done(&[&["render", "a.toml", "-o", "a.ppm"], options].concat());
    folder.read("a.ppm")
}

#[test]
fn shutters_blur_what_moves() {
    let folder = folder();
    let still = rendered(&folder, &["--time", "1"]);
    let open = ["--time", "1", "--shutter", "0.25"];
    let blurred = rendered(&folder, &open);
    assert!(still != blurred);
    // A moment is that in the middle.
    let one = rendered(&folder, &[&open[..], &["--moments", "1"]].concat());
    assert!(one == rendered(&folder, &["--time", "1.125"]));
    // There are 16 moments, or else as many as samples.
    let eight = rendered(&folder, &[&open[..], &["--moments", "8"]].concat());
    assert!(eight == blurred);
    let many = [&open[..], &["--samples", "32"]].concat();
    let sixteen = rendered(&folder, &[&many[..], &["--moments", "16"]].concat());
    assert!(sixteen == rendered(&folder, &many));
    // From a blob, and with other threads and structures.
    let command = [
        "render",
        "a.gridel",
        "-o",
        "b.ppm",
        "--threads",
        "1",
        "--accel",
        "list",
    ];
    let report = folder.json(&[&command[..], &open].concat());
    assert!(folder.read("b.ppm") == blurred);
    assert_eq!(report["moments"], 8);
    let said = folder.done(&[&command[..], &open].concat());
    assert!(said.contains("8 samples per pixel at 8 moments"), "{said}");
    // In linear radiance, too.
    for (output, options) in [("still.npy", &open[..2]), ("blurred.npy", &open[..])] {
        folder.done(&[&["render", "a.toml", "-o", output], options].concat());
    }
    assert!(folder.read("still.npy") != folder.read("blurred.npy"));
}

#[test]
fn frames_are_blurred_from_their_times_on() {
    let folder = folder();
    let command = ["render", "a.toml", "--frames", "2..4", "--fps", "4"];
    let shutter = ["--shutter", "0.125", "--moments", "4"];
    let output = ["-o", "f-%d.ppm"];
    let report = folder.json(&[&command[..], &shutter, &output].concat());
    assert_eq!(report["moments"], 4);
    for (frame, time) in [("f-2.ppm", "0.5"), ("f-3.ppm", "0.75")] {
        let picture = rendered(&folder, &[&["--time", time], &shutter[..]].concat());
        assert!(folder.read(frame) == picture, "{frame}");
    }
    // Frames that are blurred otherwise are not of one animation.
    folder.done(&[&command[..], &shutter, &["-o", "p-%d.png"]].concat());
    folder.done(&[
        "render", "a.toml", "--frames", "4..5", "--fps", "4", "-o", "p-%d.png",
    ]);
    let merge = ["merge", "p-2.png", "p-3.png", "p-4.png", "-o", "a.apng"];
    folder.fails(1, &merge, &["p-4.png", "shutter"]);
    folder.done(&["merge", "p-2.png", "p-3.png", "-o", "a.apng"]);
    folder.done(&[&command[..], &shutter, &["-o", "b.apng"]].concat());
    assert!(folder.read("a.apng") == folder.read("b.apng"));
}

/// Copies of instances stand where they are when the shutter opens; the camera is blurred.
#[test]
fn copies_stand_where_they_are_as_the_shutter_opens() {
    let folder = Folder::new();
    let part = "[[part]]\nname = 'p'\nobject = [{ kind = 'sphere', center = [0, 0, 0], radius = 1 }]\n\
                [[joint]]\nname = 'j'\n[[instance]]\npart = 'p'\njoint = 'j'\n";
    let shift =
        "[[track]]\ntarget = 'joint.j.shift'\ntimes = [0, 1]\nvalues = [[0, 0, 0], [2, 0, 0]]\n";
    folder.write("a.toml", format!("{SCENE}{part}{shift}").as_bytes());
    let at = ["--time", "1", "--instances", "flatten"];
    let sharp = rendered(&folder, &at);
    let moment = ["--shutter", "0.0001", "--moments", "1"];
    assert!(rendered(&folder, &[&at[..], &moment].concat()) == sharp);
    // Which is said.
    let command = [&["render", "a.toml", "-o", "a.ppm"], &at[..], &moment].concat();
    let report = folder.json(&command);
    let warnings = report["warnings"].to_string();
    assert!(warnings.contains("are not blurred"), "{warnings}");
    // Where nothing else moves, nothing is left to blur.
    let still = SCENE.split("[[track]]").next().expect("a scene");
    folder.write("b.toml", format!("{still}{part}{shift}").as_bytes());
    let command = [&["render", "b.toml", "-o", "b.ppm"], &at[..], &moment[..]].concat();
    folder.fails(2, &command, &["not blurred", "`--shutter`"]);
}

#[test]
fn rows_of_a_blurred_picture_are_joined() {
    let folder = folder();
    let open = ["--time", "1", "--shutter", "0.25"];
    let part = |rows: &str, output: &str, options: &[&str]| {
        let command = ["render", "a.toml", "--rows", rows, "-o", output];
        folder.done(&[&command[..], options].concat());
    };
    part("0..9", "upper.ppm", &open);
    part("9..18", "lower.ppm", &open);
    folder.done(&["merge", "upper.ppm", "lower.ppm", "-o", "whole.ppm"]);
    assert!(folder.read("whole.ppm") == rendered(&folder, &open));
    part("9..18", "sharp.ppm", &open[..2]);
    let merge = ["merge", "upper.ppm", "sharp.ppm", "-o", "x.ppm"];
    folder.fails(1, &merge, &["sharp.ppm"]);
}

#[test]
fn shutters_without_a_time_or_without_samples_are_rejected() {
    let folder = folder();
    folder.write(
        "still.toml",
        b"[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n",
    );
    for (options, words) in [
        (&["a.toml", "--shutter", "0.1"][..], &["--time"][..]),
        (
            &[
                "a.toml",
                "--time",
                "0",
                "--shutter",
                "0.1",
                "--moments",
                "9",
            ],
            &["8 samples", "9 moments", "--samples 9", "--moments 8"],
        ),
        (
            &["a.toml", "--time", "0", "--shutter", "1e-9"],
            &["less than a tick"],
        ),
        (&["a.toml", "--time", "0", "--shutter", "0"], &["above 0"]),
        (&["a.toml", "--time", "0", "--shutter", "-1"], &["above 0"]),
        (&["a.toml", "--time", "0", "--shutter", "nan"], &["above 0"]),
        (&["a.toml", "--time", "0", "--moments", "4"], &["--shutter"]),
        (
            &["a.toml", "--time", "0", "--shutter", "1", "--moments", "0"],
            &["1..=256"],
        ),
        (
            &["still.toml", "--time", "0", "--shutter", "1"],
            &["nothing in still.toml moves"],
        ),
    ] {
        let command = ["render", "-o", "x.png"];
        folder.fails(2, &[&command[..], options].concat(), words);
    }
    let late = ["render", "a.toml", "--time", "1e300", "-o", "x.png"];
    folder.fails(
        2,
        &[&late[..], &["--shutter", "0.1"]].concat(),
        &["beyond the end of time"],
    );
    for seconds in ["44740", "1e300"] {
        let command = [&late[..], &["--shutter", seconds]].concat();
        folder.fails(2, &command, &["longer than the 44739 s"]);
    }
}

#[test]
fn moments_that_count_unevenly_are_warned_of_in_json() {
    let folder = folder();
    let open = ["--shutter", "0.1", "--moments", "3"];
    for output in [
        &["--time", "0", "-o", "x.png"][..],
        &["--frames", "0..2", "-o", "x.apng"],
    ] {
        let report = folder.json(&[&["render", "a.toml"], output, &open].concat());
        let warnings = report["warnings"].to_string();
        assert!(warnings.contains("some of the 3 moments"), "{warnings}");
    }
}
