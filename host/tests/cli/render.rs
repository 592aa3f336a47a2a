//! `gridel render`.

use crate::program::{Folder, fixture};
use serde_json::json;

const SMALL: [&str; 2] = ["--size", "48x36"];

fn render(folder: &Folder, output: &str, options: &[&str]) -> Vec<u8> {
    let command = ["render", "quick.gridel", "-o", output];
    folder.done(&[&command[..], &SMALL, options].concat());
    folder.read(output)
}

#[test]
fn threads_and_structures_change_no_byte() {
    let folder = Folder::with_quick();
    for output in ["a.png", "a.ppm", "a.rgb565"] {
        let expected = render(&folder, output, &["--threads", "1"]);
        for options in [
            &["--threads", "2"][..],
            &["--threads", "5"],
            &[],
            &["--accel", "list"],
            &["--accel", "bvh"],
            &["--accel", "flagged"],
            &["--stats"],
        ] {
            assert!(render(&folder, output, options) == expected, "{options:?}");
        }
    }
}

#[test]
fn a_scene_file_renders_as_its_blob() {
    let folder = Folder::with_quick();
    let expected = render(&folder, "a.png", &[]);
    let command = ["render", "quick.toml", "-o", "b.png"];
    for options in [&[][..], &["--accel", "list"], &["--accel", "bvh"]] {
        folder.done(&[&command[..], &SMALL, options].concat());
        assert!(folder.read("b.png") == expected, "{options:?}");
    }
    folder.done(&[&command[..], &SMALL, &["--lattice-bits", "10"]].concat());
    assert!(folder.read("b.png") != expected);
}

#[test]
fn number_formats_show_the_same_scene() {
    let folder = Folder::with_quick();
    let pictures =
        ["fixed", "f32", "f64"].map(|format| render(&folder, "a.ppm", &["--format", format]));
    for picture in &pictures[1..] {
        let apart = picture
            .iter()
            .zip(&pictures[0])
            .filter(|(a, b)| a.abs_diff(**b) > 8)
            .count();
        assert!(apart * 50 < picture.len(), "{apart} of {}", picture.len());
    }
}

#[test]
fn rows_are_those_of_the_whole_picture() {
    let folder = Folder::with_quick();
    let header = |rows: usize| format!("P6\n48 {rows}\n255\n").len();
    for options in [&[][..], &["--dither", "--samples", "2"]] {
        let whole = render(&folder, "whole.ppm", options);
        let mut joined = whole[..header(36)].to_vec();
        for (rows, count) in [("0..7", 7), ("7..8", 1), ("8..36", 28)] {
            let part = render(&folder, "part.ppm", &[options, &["--rows", rows]].concat());
            let note = format!("P6\n# rows {rows} of 36; blob ");
            assert!(part.starts_with(note.as_bytes()), "{rows}");
            let end = format!("\n48 {count}\n255\n");
            let mut places = part.windows(end.len());
            let at = places.position(|bytes| bytes == end.as_bytes()).unwrap();
            joined.extend(&part[at + end.len()..]);
        }
        assert!(joined == whole, "{options:?}");
    }
    let raw = render(&folder, "a.rgb565", &["--rows", "10..20"]);
    assert_eq!(raw.len(), 48 * 10 * 2);
}

#[test]
fn stats_count_every_ray() {
    let folder = Folder::with_quick();
    let command = [
        "render",
        "quick.gridel",
        "-o",
        "a.png",
        "--size",
        "32x24",
        "--samples",
        "2",
    ];
    let report = folder.json(&[&command[..], &["--stats", "--heat-map", "heat.png"]].concat());
    let stats = &report["stats"];
    assert_eq!(stats["primary"], 32 * 24 * 2);
    let number = |key: &str| stats[key].as_u64().unwrap();
    let kinds = ["primary", "shadow", "reflected", "refracted"].map(number);
    assert!(kinds.iter().all(|&count| count > 0), "{kinds:?}");
    assert_eq!(number("rays"), kinds.iter().sum::<u64>());
    assert!(report["heat_map"]["maximum"].as_u64().unwrap() > 0);
    assert!(folder.read("heat.png").starts_with(b"\x89PNG"));
    let shallow = folder.json(&[&command[..], &["--stats", "--depth", "0"]].concat());
    assert_eq!(shallow["stats"]["reflected"], 0);
    assert_eq!(shallow["stats"]["refracted"], 0);

    let plain = folder.json(&command);
    assert!(plain.get("stats").is_none() && plain.get("heat_map").is_none());
    assert_eq!(plain["samples"], 2);
    assert_eq!(plain["rows"], json!([0, 24]));
    let text = folder.done(&[&command[..], &["--stats", "--heat-map", "heat.png"]].concat());
    for word in ["a.png: 32 x 24", "heat.png: white is", "rays per second"] {
        assert!(text.contains(word), "{text}");
    }
}

/// Effects that a scene does not require cost nothing.
#[test]
fn a_plain_scene_casts_no_secondary_ray() {
    let folder = Folder::new();
    folder.write(
        "plain.toml",
        b"ambient = 1\n[render]\nshadows = false\n[[object]]\nkind = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\n",
    );
    let report = folder.json(&["render", "plain.toml", "-o", "a.png", "--stats"]);
    assert_eq!(report["stats"]["rays"], report["stats"]["primary"]);
}

#[test]
fn wrong_numbers_are_usage_errors() {
    let folder = Folder::with_quick();
    let fails = |options: &[&str], words: &[&str]| {
        let command = ["render", "quick.gridel", "-o", "a.png"];
        folder.fails(2, &[&command[..], options].concat(), words);
    };
    fails(&["--size", "0x0"], &["at least one pixel"]);
    fails(&["--size", "640"], &["640x480"]);
    fails(&["--size", "70000x70000"], &["65535"]);
    fails(&["--size", "65535x65535"], &["--rows 0..1024"]);
    fails(&["--size", "6500x100"], &["64 times"]);
    for rows in ["5..3", "5..5", "x"] {
        fails(&["--rows", rows], &[]);
    }
    // No option of its own, and nothing to put behind `--`.
    fails(&["--rows", "-5..10"], &["rows count from 0"]);
    fails(&["--cutoff", "-1"], &["a number from 0 to 1"]);
    let explain = ["explain", "quick.gridel", "--pixel", "-1,5"];
    folder.fails(2, &explain, &["column and row"]);
    fails(&["--rows", "200..300"], &["which has 240", "0..240"]);
    for samples in ["0", "4097", "many"] {
        fails(&["--samples", samples], &["--samples"]);
    }
    for threads in ["0", "2000", "99999999999"] {
        fails(&["--threads", threads], &["--threads"]);
    }
    fails(&["--depth", "33"], &["--depth"]);
    fails(&["--format", "f16"], &["fixed, f32, f64"]);
    fails(&["--accel", "kd-tree"], &["list, bvh, flagged, dual-split"]);
    fails(&["--heat-map", "a.png"], &["another name"]);
    fails(&["--heat-map", "heat.ppm"], &[".png"]);
    fails(
        &["--style", "ball-and-stick"],
        &["--style is for scene files"],
    );
    for output in ["a.jpg", "a", "png"] {
        folder.fails(
            2,
            &["render", "quick.gridel", "-o", output],
            &[if cfg!(feature = "exr") {
                ".png, .ppm, .rgb565, .npy or .exr"
            } else {
                ".png, .ppm, .rgb565 or .npy"
            }],
        );
    }
    folder.fails(
        2,
        &["render", "quick.gridel", "-o", "a.jpg"],
        &["a.jpg: unsupported image format `.jpg`"],
    );
    for name in ["a.apng", "a.gif"] {
        let words = ["an animation has several frames", "`--frames 0..48`"];
        folder.fails(2, &["render", "quick.gridel", "-o", name], &words);
    }
}

#[test]
fn structure_that_the_blob_lacks_is_rejected_with_those_it_has() {
    let folder = Folder::new();
    folder.write("quick.toml", &fixture("quick"));
    folder.done(&["build", "quick.toml", "-o", "quick.gridel"]);
    folder.fails(
        2,
        &["render", "quick.gridel", "-o", "a.png", "--accel", "bvh"],
        &[
            "has no structure bvh, only: dual-split, list",
            "--accel bvh",
        ],
    );
}

/// Whatever way a lone face lies, with the camera and the light that it gets it is seen: lit, and never
/// of the background's color.
#[test]
fn faces_towards_the_supplied_camera_are_lit() {
    let folder = Folder::new();
    let render = ["render", "face.obj", "-o", "a.ppm", "--size", "17x17"];
    for (u, v) in [
        ([0, 1, 0], [0, 0, 1]),
        ([0, 0, 1], [1, 0, 0]),
        ([1, 0, 0], [0, 1, 0]),
        ([1, 0, -3], [0, 1, 0]),
        ([1, 2, 0], [0, 1, 3]),
        ([3, 1, -1], [-1, 1, 1]),
    ] {
        let corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)];
        let vertices = corners.map(|(a, b)| {
            let [x, y, z] = [0, 1, 2].map(|k| a * u[k] + b * v[k]);
            format!("v {x} {y} {z}\n")
        });
        // Seen from its front and from its back.
        for face in ["f 1 2 3 4\n", "f 4 3 2 1\n"] {
            folder.write("face.obj", (vertices.concat() + face).as_bytes());
            folder.done(&render);
            let picture = folder.read("a.ppm");
            let pixels = &picture[picture.len() - 17 * 17 * 3..];
            let middle = pixels[3 * (17 * 8 + 8)];
            assert!((90..235).contains(&middle), "{u:?} {v:?} {face}: {middle}");
            assert_eq!(pixels[0], 243);
        }
    }
    // A face across the view from the left shoulder is lit from the right one.
    folder.write(
        "face.obj",
        b"v -1 -1 2\nv 1 -1 -2\nv 1 1 -2\nv -1 1 2\nf 1 2 3 4\n",
    );
    let report = folder.json(&["build", "face.obj", "-o", "face.gridel"]);
    let supplied = report["supplied"][1].as_str().unwrap();
    assert!(supplied.contains("right shoulder"), "{supplied}");
    folder.done(&render);
    let picture = folder.read("a.ppm");
    let middle = picture[picture.len() - 17 * 17 * 3..][3 * (17 * 8 + 8)];
    assert!((150..235).contains(&middle), "{middle}");
}

#[test]
fn an_old_picture_survives_what_fails() {
    let folder = Folder::with_quick();
    folder.write("a.png", b"old");
    folder.write("broken.gridel", &folder.read("quick.gridel")[..700]);
    folder.fails(1, &["render", "broken.gridel", "-o", "a.png"], &[]);
    folder.fails(
        2,
        &[
            "render",
            "quick.gridel",
            "-o",
            "a.png",
            "--rows",
            "900..901",
        ],
        &[],
    );
    #[cfg(target_os = "linux")]
    {
        std::os::unix::fs::symlink("/dev/full", folder.path("full.png")).unwrap();
        let full = ["render", "quick.gridel", "-o", "full.png", "--size", "8x8"];
        folder.fails(1, &full, &["make room"]);
    }
}

/// Before any work, and however two paths lead to one file.
#[test]
fn outputs_are_checked_and_must_differ() {
    let folder = Folder::with_quick();
    let render = |output: &str, heat_map: &str, words: &[&str], code| {
        let render = [
            "render",
            "quick.gridel",
            "-o",
            output,
            "--heat-map",
            heat_map,
        ];
        folder.fails(code, &render, words);
    };
    render("a.png", "./a.png", &["are both a.png"], 2);
    render("none/a.png", "b.png", &["none/a.png cannot be written"], 1);
    std::fs::create_dir(folder.path("b.png")).unwrap();
    render("a.png", "b.png", &["b.png cannot be written"], 1);
    assert!(!folder.path("a.png").exists());
}

#[cfg(unix)]
#[test]
fn files_that_a_scene_reads_are_not_written_over() {
    let folder = Folder::new();
    let ball = "[[object]]\nkind = 'import'\nfile = 'leaf.obj'\n";
    folder.write("leaf.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.write("tree.toml", ball.as_bytes());
    let leaf = folder.read("leaf.obj");
    std::os::unix::fs::symlink("leaf.obj", folder.path("leaf.png")).unwrap();
    std::os::unix::fs::symlink("leaf.obj", folder.path("leaf.xml")).unwrap();
    folder.write("check.toml", b"[[check]]\nscene = 'tree.toml'\nhash = {}\n");
    let quick = ["--size", "8x8"];
    for run in [
        &[&["render", "tree.toml", "-o", "leaf.png"], &quick[..]].concat()[..],
        &[
            &[
                "render",
                "tree.toml",
                "-o",
                "x.png",
                "--heat-map",
                "leaf.png",
            ],
            &quick[..],
        ]
        .concat(),
        &["check", "check.toml", "--junit", "leaf.xml"],
    ] {
        let run = folder.run(run);
        assert_eq!(run.code, Some(2), "{run:?}");
        assert!(run.said().contains("reads, which would be lost"), "{run:?}");
        assert_eq!(folder.read("leaf.obj"), leaf);
    }
}
