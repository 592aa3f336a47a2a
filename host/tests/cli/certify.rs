//! `gridel certify`.

use crate::program::Folder;
use flate2::Crc;

const BALL: &str = "object = [{ kind = \"sphere\", center = [0, 0, 0], radius = 1 }]\n";

/// Bytes of a pixel in the state, and where it says that it is done.
const PIXEL: usize = 80;
const DONE: usize = 74;

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("ball.toml", BALL.as_bytes());
    folder
}

const SMALL: [&str; 6] = ["certify", "ball.toml", "--size", "13x7", "-o", "out"];

#[test]
fn every_pixel_is_proved_different_or_open() {
    let folder = folder();
    let run = [&SMALL[..], &["--samples", "3", "--format", "fixed"]].concat();
    let report = folder.json(&run);
    assert_eq!(report["size"].to_string(), "[13,7]");
    assert_eq!(report["samples"], 3);
    assert_eq!(report["pixels"], 91);
    let formats = report["formats"].as_array().unwrap();
    assert_eq!(formats.len(), 1);
    assert_eq!(formats[0]["format"], "fixed");
    let count = |key: &str| formats[0][key].as_u64().unwrap();
    assert_eq!(count("equal") + count("different") + count("open"), 91);
    let proved = report["proved"].as_u64().unwrap();
    let reasons = report["reasons"].as_array().unwrap().iter();
    let open: u64 = reasons.map(|it| it["pixels"].as_u64().unwrap()).sum();
    assert_eq!(proved + open, 91);
    let by_bits = report["proved_with_bits"].as_array().unwrap().iter();
    let sum: u64 = by_bits.map(|it| it[1].as_u64().unwrap()).sum();
    assert_eq!(sum, proved);
    // The file holds what is printed, and the pictures are there.
    let file: serde_json::Value = serde_json::from_slice(&folder.read("out/certify.json")).unwrap();
    assert_eq!(file["formats"], report["formats"]);
    for name in ["certify.html", "map.png", "exact.png", "certify.state"] {
        assert!(folder.path(&format!("out/{name}")).exists(), "{name}");
    }
    let text = folder.done(&run);
    assert!(text.contains("sampled picture"), "{text}");
    let page = String::from_utf8(folder.read("out/certify.html")).unwrap();
    assert!(page.contains("sampled picture") && page.contains("3 samples per pixel"));
}

/// A state with its checksum made anew.
fn forged(state: &[u8], change: impl FnOnce(&mut [u8])) -> Vec<u8> {
    let mut bytes = state[..state.len() - 4].to_vec();
    let line = bytes.iter().position(|&byte| byte == b'\n').unwrap() + 1;
    change(&mut bytes[line..]);
    let mut sum = Crc::new();
    sum.update(&bytes);
    bytes.extend(sum.sum().to_le_bytes());
    bytes
}

#[test]
fn an_interrupted_run_continues_where_it_stopped() {
    let folder = folder();
    let whole = folder.json(&SMALL);
    let state = folder.read("out/certify.state");
    // As if it had stopped after some rows.
    let stopped = forged(&state, |pixels| pixels[3 * 13 * PIXEL..].fill(0));
    folder.write("out/certify.state", &stopped);
    assert_eq!(folder.json(&SMALL), whole);
    assert_eq!(folder.read("out/certify.state"), state);
    // What is done is not done again: of a pixel that is marked as open, the mark stays.
    let marked = forged(&state, |pixels| {
        assert_eq!(pixels[DONE], 1);
        pixels[64..67].fill(0);
        pixels[67..70].fill(255);
        pixels[71] = 1;
    });
    folder.write("out/certify.state", &marked);
    let again = folder.json(&SMALL);
    let count = |report: &serde_json::Value| report["proved"].as_u64().unwrap();
    assert_eq!(count(&again) + 1, count(&whole));
    assert_eq!(again["reasons"][0]["open_pixels"][0]["pixel"][0], 0);
}

/// Words of the error of a state of another picture.
const OTHER: [&str; 3] = ["certify.state", "another scene", "another folder with `-o`"];

#[test]
fn states_of_other_pictures_are_rejected_and_broken_ones_replaced_with_a_warning() {
    let folder = folder();
    let whole = folder.json(&SMALL);
    let state = folder.read("out/certify.state");
    let replaced = |bytes: &[u8]| {
        folder.write("out/certify.state", bytes);
        let run = folder.run(&[&SMALL[..], &["--json"]].concat());
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        assert!(run.said().contains("is damaged"), "{}", run.stderr);
        serde_json::from_str::<serde_json::Value>(&run.stdout).unwrap()
    };
    let mut broken = state.clone();
    broken[200] ^= 1;
    for bytes in [
        &broken[..],
        &state[..state.len() - 1],
        &state[..state.len() - PIXEL],
    ] {
        assert_eq!(replaced(bytes), whole);
    }
    let short = forged(&state, |_| ())[..state.len() - PIXEL - 4].to_vec();
    assert_eq!(replaced(&short), whole);
    // Also where the key is damaged.
    let mut keyed = state.clone();
    keyed[9] ^= 1;
    for bytes in [&b""[..], b"my own", &keyed] {
        assert_eq!(replaced(bytes), whole);
    }
    // Of other samples, of another depth, of another scene.
    for more in [["--samples", "2"], ["--depth", "0"]] {
        folder.fails(2, &[&SMALL[..], &more].concat(), &OTHER);
    }
    folder.write(
        "ball.toml",
        BALL.replace("radius = 1", "radius = 2").as_bytes(),
    );
    folder.fails(2, &SMALL, &OTHER);
    assert_eq!(folder.read("out/certify.state"), state);
}

#[test]
fn what_cannot_be_certified_is_rejected() {
    let folder = folder();
    let huge = ["certify", "ball.toml", "--size", "65535x65535"];
    folder.fails(2, &huge, &["4,294,836,225 pixels", "smaller `--size`"]);
    folder.fails(1, &["certify", "none.toml"], &["none.toml"]);
    folder.fails(2, &["certify", "ball.toml", "--format", "f16"], &["f16"]);
    folder.fails(2, &["certify", "ball.toml", "--samples", "0"], &["0"]);
}

/// The command that a report names shows the intervals of that pixel.
#[test]
fn explain_shows_the_intervals_of_a_pixel() {
    let folder = folder();
    let pixel = ["explain", "ball.toml", "--size", "13x7", "--pixel", "6,3"];
    let text = folder.done(&[&pixel[..], &["--interval"]].concat());
    assert!(text.contains("hit") && text.contains("light"), "{text}");
    let json = folder.json(&[&pixel[..], &["--interval"]].concat());
    assert!(json.to_string().contains("\"steps\""), "{json}");
    folder.fails(
        2,
        &[
            "explain",
            "ball.toml",
            "--size",
            "13x7",
            "--pixel",
            "13,3",
            "--interval",
        ],
        &["13"],
    );
}

#[test]
fn manifests_ask_for_a_proved_share_and_a_largest_error() {
    let folder = folder();
    let check = |lines: &str| {
        let text = format!("[[check]]\nscene = \"ball.toml\"\nsize = [13, 7]\n{lines}\n");
        folder.write("check.toml", text.as_bytes());
    };
    check("certified = 1\nmax_proved_error = 0\nformats = [\"f64\"]");
    folder.done(&["check", "check.toml"]);
    for (lines, what) in [
        ("certified = 1.5", "certified"),
        ("certified = -0.1", "certified"),
        ("certified = \"all\"", "certified"),
        ("certified = nan", "certified"),
        ("max_proved_error = 256", "max_proved_error"),
        ("max_proved_error = -1", "max_proved_error"),
        ("max_proved_error = 0.5", "max_proved_error"),
    ] {
        check(lines);
        folder.fails(1, &["check", "check.toml"], &[what, "check.toml"]);
    }
}

#[test]
fn blobs_with_clusters_alone_are_certified() {
    let folder = folder();
    folder.done(&["build", "ball.toml", "--accel", "wide", "-o", "wide.gridel"]);
    let report = folder.json(&["certify", "wide.gridel", "--size", "13x7", "-o", "out"]);
    assert_eq!(report["pixels"], 91);
}

#[test]
fn eye_on_a_surface_proves_no_pixel_different() {
    let objects = [
        "kind = 'box'\nmin = [-1, -1, -1]\nmax = [1, 0, 1]",
        "kind = 'plane'\npoint = [0, 0, 0]\nnormal = [0, 1, 0]",
        "kind = 'plane'\npoint = [0, 0, 0.5]\nnormal = [1, 2, 3]",
        "kind = 'disc'\ncenter = [0, 0, 0]\nnormal = [0, 1, 0]\nradius = 1",
        "kind = 'triangle'\nvertices = [[-1, 0, 1], [1, 0, 1], [0, 0, -1]]",
        "kind = 'cylinder'\nbase = [0, -1, 0]\ntop = [0, 0, 0]\nradius = 1",
        "kind = 'sphere'\ncenter = [0, 0, 0]\nradius = 0.5",
    ];
    for object in objects {
        let folder = Folder::new();
        let file = format!(
            "background = [0.2, 0.4, 0.8]\n[camera]\neye = [0, 0, 0.5]\ntarget = [0.1, 0.13, -5]\n\
             [[light]]\nkind = 'directional'\ndirection = [0.3, -1, -0.4]\n\
             [[object]]\nkind = 'sphere'\ncenter = [0, 1, -5]\nradius = 1\n[[object]]\n{object}\n"
        );
        folder.write("eye.toml", file.as_bytes());
        let report = folder.json(&["certify", "eye.toml", "--size", "12x12", "-o", "out"]);
        for format in report["formats"].as_array().unwrap() {
            assert_eq!(format["different"], 0, "{object}: {format}");
        }
        // Where an axis is normal to the surface, nothing is open.
        if object.contains("'box'") || object.contains("[0, 1, 0]") {
            assert_eq!(report["proved"], 144, "{object}");
        }
    }
}

/// Neither what the scene reads nor what is not a result is replaced.
#[test]
fn files_that_are_no_results_stay() {
    let folder = Folder::new();
    let textured = "[material.red]\ntexture = 'map.png'\n\
        [[object]]\nkind = 'mesh'\nmaterial = 'red'\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n\
        faces = [[0, 1, 2]]\ncoordinates = [[0, 0], [1, 0], [0, 1]]\n";
    folder.write("ball.toml", BALL.as_bytes());
    folder.done(&["render", "ball.toml", "--size", "4x4", "-o", "map.png"]);
    folder.write("textured.toml", textured.as_bytes());
    let here = ["certify", "textured.toml", "--size", "8x8", "-o", "."];
    folder.fails(2, &here, &["map.png", "a file that the scene reads"]);
    std::fs::create_dir(folder.path("out")).unwrap();
    folder.write("out/exact.png", b"my own");
    let words = ["exact.png exists", "certify.state", "another folder"];
    folder.fails(2, &SMALL, &words);
}

/// A blob that has the name of a result, in a folder with the results of an earlier run.
#[test]
fn input_among_the_results_stays() {
    let folder = folder();
    folder.done(&["build", "ball.toml", "-o", "ball.gridel"]);
    let small = ["--size", "4x4", "-o", "."];
    for name in [
        "certify.html",
        "certify.json",
        "map.png",
        "exact.png",
        "certify.state",
    ] {
        folder.done(&[&["certify", "ball.toml"], &small[..]].concat());
        folder.write(name, &folder.read("ball.gridel"));
        let words = [&format!("the output ./{name} is the input, which would be lost")[..]];
        folder.fails(2, &[&["certify", name], &small[..]].concat(), &words);
    }
}

#[test]
fn scenes_that_move_are_certified_at_a_time() {
    let folder = folder();
    let moving = format!(
        "{BALL}track = [{{ target = 'camera.orbit', times = [0, 2], values = [0, 90] }}]\n\
         camera = {{ eye = [0, 1, 4], target = [0, 1, 0] }}\n\
         light = [{{ kind = 'directional', direction = [-1, -1, -1] }}]\n"
    );
    folder.write("ball.toml", moving.as_bytes());
    let at_rest = folder.json(&SMALL);
    let picture = folder.read("out/exact.png");
    let at_a_time = [&SMALL[..], &["--time", "1", "--json"]].concat();
    folder.fails(2, &at_a_time, &OTHER);
    std::fs::remove_dir_all(folder.path("out")).unwrap();
    let report = folder.json(&at_a_time[..at_a_time.len() - 1]);
    assert!(folder.read("out/exact.png") != picture);
    let command = report["explain"].as_str().unwrap();
    assert!(command.contains(" --time=1 "), "{command}");
    assert_eq!(report["formats"][2]["different"], 0, "{report}");
    assert_eq!(at_rest["pixels"], report["pixels"]);
    folder.write("ball.toml", BALL.as_bytes());
    folder.fails(2, &at_a_time, &["has no tracks"]);
}
