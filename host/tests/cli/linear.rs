//! `gridel render`: linear radiance and AOVs.

use crate::program::{Folder, fixture};
use serde_json::json;

const RENDER: [&str; 4] = ["render", "quick.gridel", "--size", "48x36"];

fn render(folder: &Folder, output: &str, options: &[&str]) -> Vec<u8> {
    folder.done(&[&RENDER[..], &["-o", output], options].concat());
    folder.read(output)
}

/// The header of an array file, and its data.
fn array(file: &[u8]) -> (String, Vec<[u8; 4]>) {
    assert!(file.starts_with(b"\x93NUMPY\x01\x00"));
    let end = 10 + usize::from(u16::from_le_bytes([file[8], file[9]]));
    let header = String::from_utf8(file[10..end].to_vec()).expect("text");
    let words = file[end..].chunks(4);
    let words = words.map(|word| word.try_into().expect("4 bytes"));
    (header, words.collect())
}

fn floats(words: &[[u8; 4]]) -> Vec<f32> {
    words.iter().map(|word| f32::from_le_bytes(*word)).collect()
}

#[test]
fn arrays_hold_what_pictures_show() {
    let folder = Folder::with_quick();
    for format in ["fixed", "f32", "f64"] {
        let options = ["--samples", "1", "--format", format];
        let shown = render(&folder, "a.ppm", &options);
        let (header, data) = array(&render(&folder, "a.npy", &options));
        assert!(
            header.contains("'<f4'") && header.contains("(36, 48, 3, )"),
            "{header}"
        );
        let shown = &shown[shown.len() - 48 * 36 * 3..];
        for (shown, linear) in shown.iter().zip(floats(&data)) {
            let linear = f64::from(linear).clamp(0.0, 1.0);
            let display = if linear <= 0.003_130_8 {
                12.92 * linear
            } else {
                1.055 * linear.powf(1.0 / 2.4) - 0.055
            };
            let apart = (255.0 * display - f64::from(*shown)).abs();
            assert!(apart < 0.51, "{format}: {shown} for {linear}");
        }
    }
}

#[test]
fn threads_rows_and_structures_change_no_byte() {
    let folder = Folder::with_quick();
    let aovs = ["--aov", "depth,normal,albedo,object,primitive,instance"];
    let files = [
        "a.npy",
        "a.depth.npy",
        "a.normal.npy",
        "a.albedo.npy",
        "a.object.npy",
        "a.primitive.npy",
        "a.instance.npy",
    ];
    let all = |options: &[&str]| {
        render(&folder, "a.npy", &[&aovs[..], options].concat());
        files.map(|name| array(&folder.read(name)))
    };
    let expected = all(&["--threads", "1"]);
    for options in [
        &["--threads", "2"][..],
        &["--accel", "list"],
        &["--accel", "flagged"],
    ] {
        assert!(all(options) == expected, "{options:?}");
    }
    let parts = ["0..5", "5..36"].map(|rows| all(&["--rows", rows]));
    for (file, (_, whole)) in expected.iter().enumerate() {
        let joined = [&parts[0][file].1[..], &parts[1][file].1[..]].concat();
        assert!(joined == *whole, "{}", files[file]);
    }
    let depth = floats(&expected[1].1);
    assert!(depth.iter().all(|&length| length > 0.0));
}

#[test]
fn aovs_stand_beside_pictures_of_displays() {
    let folder = Folder::with_quick();
    let command = [
        &RENDER[..],
        &["-o", "out.png", "--aov", "depth,object,depth"],
    ]
    .concat();
    let report = folder.json(&command);
    let files = json!([
        { "name": "depth", "file": "out.depth.npy" },
        { "name": "object", "file": "out.object.npy" }
    ]);
    assert_eq!(report["aovs"], files);
    let text = folder.done(&command);
    assert!(text.contains("out.object.npy: object"), "{text}");
    let (header, data) = array(&folder.read("out.object.npy"));
    assert!(
        header.contains("'<u4'") && header.contains("(36, 48, )"),
        "{header}"
    );
    assert_eq!(data.len(), 48 * 36);
    let plain = render(&folder, "plain.png", &[]);
    assert!(plain == folder.read("out.png"));
}

#[test]
fn the_blob_and_its_scene_file_agree() {
    let folder = Folder::with_quick();
    let from_blob = render(&folder, "a.npy", &["--aov", "normal"]);
    let normals = folder.read("a.normal.npy");
    folder.write("quick.toml", &fixture("quick"));
    let command = ["render", "quick.toml", "-o", "a.npy", "--aov", "normal"];
    folder.done(&[&command[..], &["--size", "48x36"]].concat());
    assert!(folder.read("a.npy") == from_blob);
    assert!(folder.read("a.normal.npy") == normals);
}

#[test]
fn what_does_not_go_together_is_rejected() {
    let folder = Folder::with_quick();
    let fails = |options: &[&str], words: &[&str]| {
        folder.fails(2, &[&RENDER[..], options].concat(), words);
    };
    for option in [
        &["--dither"][..],
        &["--stats"],
        &["--heat-map", "heat.png"],
        &["--tone-mapping", "aces"],
    ] {
        let options = [&["-o", "a.npy"], option].concat();
        fails(&options, &[option[0], "linear radiance"]);
    }
    fails(&["-o", "a.png", "--aov", "colour"], &["depth, normal"]);
    fails(&["-o", "-", "--aov", "depth"], &["standard output", "-o"]);
    let large = [
        "render",
        "quick.gridel",
        "-o",
        "a.npy",
        "--size",
        "65535x65535",
    ];
    folder.fails(2, &large, &["--rows 0..128"]);
    let frames = ["-o", "a.apng", "--frames", "0..2", "--aov", "depth"];
    fails(&frames, &["--aov"]);
    let heat_map = ["-o", "a.png", "--aov", "depth", "--heat-map", "a.png"];
    fails(&heat_map, &["another name"]);
    if cfg!(not(feature = "exr")) {
        fails(&["-o", "a.exr"], &["does not write .exr", "--features exr"]);
    }
    assert_eq!(folder.names(), ["quick.gridel", "quick.toml"]);
    // A folder where an AOV must go.
    std::fs::create_dir(folder.path("a.depth.npy")).expect("a folder");
    let command = [&RENDER[..], &["-o", "a.png", "--aov", "depth"]].concat();
    folder.fails(1, &command, &["a.depth.npy cannot be written"]);
    assert_eq!(
        folder.names(),
        ["a.depth.npy", "quick.gridel", "quick.toml"]
    );
}

/// Linux allows any bytes in names, and JSON does not.
#[cfg(target_os = "linux")]
#[test]
fn names_that_are_not_utf_8_are_shown_with_replacements() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let folder = Folder::with_quick();
    let mut command = folder.command(&[&RENDER[..], &["--aov", "depth", "--json", "-o"]].concat());
    let output = command.arg(OsStr::from_bytes(b"a\xff.npy")).output();
    let output = output.expect("a run");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(report["picture"], "a\u{fffd}.npy");
    let files = json!([{ "name": "depth", "file": "a\u{fffd}.depth.npy" }]);
    assert_eq!(report["aovs"], files);
}
