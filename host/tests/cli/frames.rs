//! `gridel render --frames` and `--time`, and `gridel merge` of frames.

use crate::program::Folder;
use serde_json::json;

const SCENE: &str = "\
    [render]\nwidth = 24\nheight = 18\n\
    [material.red]\ndiffuse = [0.8, 0.1, 0.1]\n\
    [[light]]\nkind = 'point'\nposition = [2, 4, 3]\n\
    [[object]]\nkind = 'box'\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\nmaterial = 'red'\n\
    [[track]]\ntarget = 'camera.orbit'\ntimes = [0, 2]\nvalues = [0, 360]\n\
    [[track]]\ntarget = 'light.0.position'\ninterpolation = 'cubic'\ntimes = [0, 1, 2]\n\
    values = [[2, 4, 3], [-2, 4, 3], [2, 5, 3]]\n\
    [[track]]\ntarget = 'material.red.diffuse'\ntimes = [0, 2]\nvalues = [[0.8, 0.1, 0.1], [0, 0, 1]]\n";

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("a.toml", SCENE.as_bytes());
    folder.done(&["build", "a.toml", "-o", "a.gridel"]);
    folder
}

/// The pixels of every frame of an animated PNG, and the hundredths that each is shown for.
fn decoded(file: &[u8]) -> Vec<Vec<u8>> {
    let mut reader = png::Decoder::new(std::io::Cursor::new(file))
        .read_info()
        .unwrap();
    let frames = reader.info().animation_control().unwrap().num_frames;
    let size = reader.output_buffer_size().unwrap();
    let next = |_| {
        let mut pixels = vec![0; size];
        reader.next_frame(&mut pixels).unwrap();
        let control = reader.info().frame_control().unwrap();
        assert_eq!((control.delay_num, control.delay_den), (1, 4));
        pixels
    };
    (0..frames).map(next).collect()
}

/// The pixels of a PPM.
fn pixels(folder: &Folder, name: &str) -> Vec<u8> {
    let file = folder.read(name);
    file[file.len() - 24 * 18 * 3..].to_vec()
}

#[test]
fn frames_are_the_pictures_at_their_times() {
    let folder = folder();
    for input in ["a.toml", "a.gridel"] {
        let accel = ["--accel", "dual-split", "--format", "fixed"];
        let command = [
            "render", input, "--frames", "1..5", "--fps", "4", "-o", "a.apng",
        ];
        folder.done(&[&command[..], &accel].concat());
        let frames = decoded(&folder.read("a.apng"));
        assert_eq!(frames.len(), 4);
        for (frame, time) in frames.iter().zip(["0.25", "0.5", "0.75", "1"]) {
            let command = ["render", input, "--time", time, "-o", "a.ppm"];
            folder.done(&[&command[..], &accel].concat());
            assert!(*frame == pixels(&folder, "a.ppm"), "{input} at {time}");
        }
        assert!(frames[0] != frames[1] && frames[1] != frames[2]);
        folder.done(&[&["render", input, "-o", "a.ppm"], &accel[..]].concat());
        assert!(
            !frames.contains(&pixels(&folder, "a.ppm")),
            "without a time tracks do nothing"
        );
    }
}

#[test]
fn frames_of_several_machines_make_the_animation_of_one() {
    let folder = folder();
    let render = |frames: &str, output: &str| {
        folder.done(&[
            "render", "a.toml", "--frames", frames, "--fps", "10", "-o", output,
        ]);
    };
    render("3..9", "p-%02d.png");
    let early = folder.read("p-08.png");
    render("8..10", "p-%02d.png");
    assert!(
        folder.read("p-08.png") == early,
        "a frame does not depend on the range"
    );
    let frames = [
        "p-09.png", "p-03.png", "p-05.png", "p-04.png", "p-08.png", "p-06.png", "p-07.png",
    ];
    for output in ["merged.apng", "merged.gif"] {
        let command = ["merge", "-o", output];
        let report = folder.json(&[&command[..], &frames].concat());
        assert_eq!(report["frames"], json!([3, 10]));
        assert_eq!(report["per_second"], 10);
        let whole = output.replace("merged", "whole");
        render("3..10", &whole);
        assert!(folder.read(output) == folder.read(&whole), "{output}");
    }
}

#[test]
fn frames_that_make_no_animation_are_rejected() {
    let folder = folder();
    let render = |options: &[&str]| folder.done(&[&["render", "a.toml"], options].concat());
    render(&["--frames", "0..4", "-o", "p-%d.png"]);
    render(&["--frames", "1..2", "--fps", "25", "-o", "fast-%d.png"]);
    render(&["--frames", "1..2", "--samples", "4", "-o", "fine-%d.png"]);
    render(&["--frames", "0..1", "--fps", "60", "-o", "sixty-%d.png"]);
    render(&["-o", "still.png"]);
    let fails = |code: i32, arguments: &[&str], words: &[&str]| {
        folder.fails(code, &[&["merge"], arguments].concat(), words);
    };
    fails(
        1,
        &["p-0.png", "p-2.png", "-o", "x.apng"],
        &["frame 1 is missing", "--frames 1..2"],
    );
    fails(
        1,
        &["p-0.png", "p-1.png", "p-0.png", "-o", "x.apng"],
        &["both are frame 0"],
    );
    fails(
        1,
        &["p-0.png", "fast-1.png", "-o", "x.apng"],
        &["24 frames per second", "25"],
    );
    fails(
        1,
        &["p-0.png", "fine-1.png", "-o", "x.apng"],
        &["samples 1", "samples 4"],
    );
    fails(
        1,
        &["still.png", "-o", "x.apng"],
        &["still.png", "which frame of an animation"],
    );
    fails(1, &["nowhere.png", "-o", "x.gif"], &["nowhere.png"]);
    fails(2, &["sixty-0.png", "-o", "x.gif"], &["at most 50", ".apng"]);
    assert!(!folder.names().iter().any(|name| name.starts_with("x.")));
}

#[test]
fn parts_of_pictures_at_different_times_do_not_merge() {
    let folder = folder();
    for (time, rows, output) in [
        ("0.5", "0..9", "a.png"),
        ("0.75", "9..18", "b.png"),
        ("0.5", "9..18", "c.png"),
    ] {
        folder.done(&[
            "render", "a.toml", "--time", time, "--rows", rows, "-o", output,
        ]);
    }
    folder.done(&["render", "a.toml", "--time", "0.5", "-o", "whole.png"]);
    folder.fails(
        1,
        &["merge", "a.png", "b.png", "-o", "x.png"],
        &["time 0.5 s", "time 0.75 s"],
    );
    folder.done(&["merge", "a.png", "c.png", "-o", "x.png"]);
    assert!(folder.read("x.png") == folder.read("whole.png"));
}

/// Tracks that options replace, and joints whose instances were copied, leave a still picture.
#[test]
fn scenes_whose_tracks_do_nothing_have_a_picture_at_a_time() {
    let folder = Folder::new();
    let ball = "kind = 'sphere', center = [0, 0, 0], radius = 1";
    let size = "[render]\nwidth = 16\nheight = 12\n";
    let orbit = "[[track]]\ntarget = 'camera.orbit'\ntimes = [0, 1]\nvalues = [0, 90]\n";
    let shift = "[[joint]]\nname = 'a'\n[[track]]\ntarget = 'joint.a.shift'\ntimes = [0, 1]\n\
                 values = [[0, 0, 0], [1, 0, 0]]\n";
    let orbited = format!("ambient = 1\nobject = [{{ {ball} }}]\n{size}{orbit}");
    let part = format!("[[part]]\nname = 'p'\nobject = [{{ {ball} }}]\n[[instance]]\npart = 'p'\n");
    folder.write("orbit.toml", orbited.as_bytes());
    folder.write(
        "joint.toml",
        format!("ambient = 1\n{size}{part}{shift}").as_bytes(),
    );
    for (scene, option) in [
        ("orbit.toml", ["--eye", "1,2,8"]),
        ("joint.toml", ["--instances", "flatten"]),
    ] {
        let still = [&["render", scene, "-o", "still.ppm"], &option[..]].concat();
        folder.done(&still);
        let at = [
            &["render", scene, "-o", "at.ppm", "--time", "1"],
            &option[..],
        ]
        .concat();
        folder.done(&at);
        assert!(folder.read("at.ppm") == folder.read("still.ppm"), "{scene}");
    }
    let open = ["--eye", "1,2,8", "--time", "1", "--shutter", "0.1"];
    folder.done(&[&["render", "orbit.toml", "-o", "open.ppm"], &open[..]].concat());
}

#[test]
fn outputs_and_scenes_that_frames_cannot_have_are_rejected() {
    let folder = folder();
    folder.write(
        "still.toml",
        b"[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n",
    );
    let fails = |arguments: &[&str], words: &[&str]| {
        folder.fails(2, &[&["render"], arguments].concat(), words);
    };
    let some = ["--frames", "0..2"];
    for (output, word) in [
        ("x.png", "%03d"),
        ("x.jpg", ".apng"),
        ("x", ".apng"),
        ("-", "cannot go to standard output"),
        ("x-%s.png", "%d"),
        ("x-%d-%d.png", "more than one"),
        ("x-%5d.png", "unsupported `%5d`"),
        ("x-%d.jpg", ".png"),
        ("x-%d.gif", "one file"),
    ] {
        fails(&[&["a.toml", "-o", output], &some[..]].concat(), &[word]);
    }
    fails(
        &[&["still.toml", "-o", "x.apng"], &some[..]].concat(),
        &["has no tracks"],
    );
    fails(
        &["still.toml", "--time", "1", "-o", "x.png"],
        &["has no tracks", "[[track]]"],
    );
    fails(&["a.toml", "--frames", "2..2", "-o", "x.apng"], &["empty"]);
    fails(&["a.toml", "--fps", "5", "-o", "x.png"], &["--frames"]);
    let at = ["a.toml", "--fps", "5", "--time", "1", "-o", "x.png"];
    fails(&at, &["--fps", "--time"]);
    fails(
        &["a.toml", "--frames", "0..2", "--fps", "60", "-o", "x.gif"],
        &["at most 50"],
    );
    fails(
        &["a.toml", "--frames", "0..2", "--time", "1", "-o", "x.apng"],
        &["--time"],
    );
    fails(
        &[
            "a.toml", "--frames", "0..2", "--rows", "0..9", "-o", "x.apng",
        ],
        &["--rows"],
    );
    let many = ["a.toml", "--frames", "7..40000000", "-o", "x-%d.png"];
    fails(&many, &["100,000", "--frames 7..100007"]);
    let late = ["a.toml", "--frames", "1073730..1073743", "-o", "x.apng"];
    fails(&late, &["frame 1073742", "44739 s", "0..1073742"]);
    fails(&["a.toml", "--time", "nan", "-o", "x.png"], &["seconds"]);
    assert!(!folder.names().iter().any(|name| name.starts_with('x')));
}

#[test]
fn options_hold_in_place_of_tracks() {
    let folder = folder();
    for options in [
        &["--eye", "3,3,3", "--light", "0.position=1,2,5"][..],
        &["--light", "0.color=0.2,0.4,0.6"],
    ] {
        for (input, output) in [("a.toml", "scene.ppm"), ("a.gridel", "blob.ppm")] {
            let command = [
                "render",
                input,
                "--time",
                "0.5",
                "--accel",
                "dual-split",
                "-o",
                output,
            ];
            folder.done(&[&command[..], options].concat());
        }
        assert!(
            folder.read("scene.ppm") == folder.read("blob.ppm"),
            "{options:?}"
        );
    }
}

#[test]
fn a_camera_without_a_picture_is_named_with_its_time_and_leaves_nothing() {
    let folder = folder();
    let through = "[camera]\neye = [0, 0, 4]\ntarget = [0, 0, 0]\n\
        [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n\
        [[track]]\ntarget = 'camera.eye'\ntimes = [0, 2]\nvalues = [[0, 0, 4], [0, 0, -4]]\n";
    folder.write("through.toml", through.as_bytes());
    let before = folder.names();
    let command = [
        "render",
        "through.toml",
        "--frames",
        "0..9",
        "--fps",
        "4",
        "-o",
        "x.apng",
    ];
    folder.fails(1, &command, &["at 1 s", "looks nowhere"]);
    assert_eq!(folder.names(), before);
}

/// A fault at the start matters only to those who ask for the start.
#[test]
fn frames_do_not_depend_on_the_first_key() {
    let folder = folder();
    let away = "[camera]\neye = [0, 0, 4]\ntarget = [0, 0, 0]\n\
        [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n\
        [[track]]\ntarget = 'camera.eye'\ntimes = [0, 2]\nvalues = [[0, 0, 0], [0, 0, 4]]\n";
    folder.write("away.toml", away.as_bytes());
    let command = ["render", "away.toml", "--size", "8x8", "--fps", "4"];
    let ask = |frames, output| [&command[..], &["--frames", frames, "-o", output]].concat();
    folder.fails(1, &ask("0..2", "x-%d.png"), &["at 0 s", "looks nowhere"]);
    folder.done(&ask("4..6", "x-%d.png"));
    folder.done(&ask("4..6", "x.apng"));
}

#[test]
fn explain_shows_a_pixel_at_a_time() {
    let folder = folder();
    let explained = |options: &[&str]| {
        let command = ["explain", "a.toml", "--pixel", "12,9"];
        folder.json(&[&command[..], options].concat())["samples"].to_string()
    };
    assert_ne!(explained(&["--time", "0.25"]), explained(&[]));
    assert_eq!(explained(&["--time", "-1"]), explained(&["--time", "0"]));
}

#[test]
fn frames_beyond_memory_have_a_remedy_that_frames_take() {
    let folder = folder();
    let render = [
        "render",
        "a.toml",
        "-o",
        "a.apng",
        "--frames",
        "0..2",
        "--size",
        "16384x8192",
    ];
    let run = folder.run(&render);
    assert_eq!(run.code, Some(2), "{run:?}");
    assert!(
        run.said().contains("smaller `--size`") && !run.said().contains("--rows"),
        "{run:?}"
    );
    folder.fails(
        1,
        &["merge", "missing.png", "-o", "a.gif"],
        &["missing.png cannot be read", "may read"],
    );
}

#[test]
fn tracks_that_do_nothing_are_not_in_the_blob() {
    let folder = Folder::new();
    let scene = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n\
        [material.unused]\nmirror = 1\n\
        [[track]]\ntarget = 'material.unused.mirror'\ntimes = [0, 2]\nvalues = [0, 1]\n";
    folder.write("a.toml", scene.as_bytes());
    let at = ["--time", "1", "--size", "8x6", "-o", "a.png"];
    let run = folder.run(&[&["render", "a.toml"], &at[..]].concat());
    assert_eq!(run.code, Some(0), "{run:?}");
    assert!(
        run.said().contains("no object has the material unused"),
        "{run:?}"
    );
    folder.done(&["build", "a.toml", "-o", "a.gridel"]);
    let words = ["nothing in a.gridel moves", "leave the time out"];
    folder.fails(2, &[&["render", "a.gridel"], &at[..]].concat(), &words);
}
