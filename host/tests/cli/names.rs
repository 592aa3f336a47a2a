//! Names of objects, materials and lights, from scene files to reports.

use crate::program::Folder;
use crate::trace::npy;
use gridel_core::Names;
use gridel_host::blob::Blob;
use serde_json::{Value, json};

/// Two balls of one name, one without a name, and one whose name has control characters.
const SCENE: &str = r#"
[[light]]
kind = "directional"
direction = [0, -1, -1]
name = "sun"

[material.red]
diffuse = [1, 0, 0]

[[object]]
kind = "sphere"
center = [0, 0, 0]
radius = 0.5
name = "ball"
material = "red"

[[object]]
kind = "sphere"
center = [2, 0, 0]
radius = 0.5
name = "ball"

[[object]]
kind = "box"
min = [3.5, -0.5, -0.5]
max = [4.5, 0.5, 0.5]
name = "Käse\u001b[31m\nred"
"#;

/// The three sections' worth of names that a blob of this scene has.
const OBJECTS: [&str; 3] = ["ball", "ball", "Käse\u{1b}[31m\nred"];

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("a.toml", SCENE.as_bytes());
    folder
}

fn names_of(folder: &Folder, blob: &str) -> [String; 3] {
    let blob = Blob::new(&folder.read(blob));
    let names = Names::from_bytes(blob.bytes()).unwrap();
    [0, 1, 2].map(|object| names.object(object).to_owned())
}

fn rays() -> Vec<u8> {
    let down = |x: f64| [x, 0.0, 5.0, 0.0, 0.0, 0.0, -1.0, f64::INFINITY];
    npy("<f8", &[0.0, 0.1, 2.0, 4.0, 9.0].map(down))
}

#[test]
fn build_stores_names_unless_they_are_stripped() {
    let folder = folder();
    let built = folder.json(&["build", "a.toml", "-o", "a.gridel"]);
    assert_eq!(names_of(&folder, "a.gridel"), OBJECTS);
    // Three objects, two materials, a light.
    assert_eq!(built["names"]["names"], 6);
    assert_eq!(built["names"]["left_out"], false);
    let bytes = built["bytes"].as_u64().unwrap();

    let stripped = folder.json(&["build", "a.toml", "-o", "b.gridel", "--strip-names"]);
    assert_eq!(names_of(&folder, "b.gridel"), ["", "", ""]);
    assert_eq!(stripped["names"], Value::Null);
    let saved = bytes - stripped["bytes"].as_u64().unwrap();
    assert!((1..=built["names"]["bytes"].as_u64().unwrap()).contains(&saved));
    let text = folder.done(&["build", "a.toml", "-o", "a.gridel"]);
    assert!(text.contains("6 names, "), "{text}");
}

#[test]
fn blobs_for_boards_have_no_names() {
    let folder = folder();
    folder.done(&["build", "a.toml", "-o", "stripped.gridel", "--strip-names"]);
    let stripped = folder.read("stripped.gridel");
    for options in [
        &["--target", "stm32vldiscovery"][..],
        &["--flash", "128K"],
        &["--ram", "8K"],
        &["--emit-rust", "module"],
    ] {
        let build = ["build", "a.toml", "-o", "a.gridel"];
        folder.done(&[&build, options].concat());
        assert_eq!(folder.read("a.gridel"), stripped, "{options:?}");
    }
    // Constants of the module have them.
    let module = String::from_utf8(folder.read("module/scene.rs")).unwrap();
    for module_of in [
        "pub mod objects {",
        "pub mod materials {",
        "pub mod lights {",
    ] {
        assert!(module.contains(module_of), "{module}");
    }
}

#[test]
fn names_that_exceed_max_bytes_are_left_out_with_a_warning() {
    let folder = folder();
    folder.done(&["build", "a.toml", "-o", "stripped.gridel", "--strip-names"]);
    let most = folder.read("stripped.gridel").len().to_string();
    let build = ["build", "a.toml", "-o", "a.gridel", "--max-bytes", &most];
    let run = folder.run(&build);
    assert_eq!(run.code, Some(0), "{run:?}");
    assert!(run.said().contains("the names are left out"), "{run:?}");
    assert_eq!(folder.read("a.gridel"), folder.read("stripped.gridel"));
}

#[test]
fn long_names_are_cut_with_a_warning() {
    let folder = Folder::new();
    let name = "é".repeat(128);
    let scene = format!(
        "[[object]]\nkind = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nname = \"{name}\"\n"
    );
    folder.write("long.toml", scene.as_bytes());
    let run = folder.run(&["build", "long.toml", "-o", "long.gridel"]);
    assert!(run.said().contains("1 name is cut to 255 bytes"), "{run:?}");
    assert_eq!(names_of(&folder, "long.gridel")[0], "é".repeat(127));
}

#[test]
fn inspect_lists_names_with_control_characters_escaped() {
    let folder = folder();
    folder.done(&["build", "a.toml", "-o", "a.gridel"]);
    for input in ["a.gridel", "a.toml"] {
        let text = folder.done(&["inspect", input]);
        assert!(text.contains("ball, ball, Käse\\u{1b}[31m\\nred"), "{text}");
        assert!(!text.contains('\u{1b}'), "{text}");
        let inspection = folder.json(&["inspect", input]);
        assert_eq!(inspection["names"]["objects"], json!(OBJECTS));
        assert_eq!(inspection["names"]["materials"], json!(["red", "default"]));
        assert_eq!(inspection["names"]["lights"], json!(["sun"]));
    }
    folder.done(&["build", "a.toml", "-o", "b.gridel", "--strip-names"]);
    let inspection = folder.json(&["inspect", "b.gridel"]);
    assert_eq!(inspection["names"]["objects"], json!([]));
    assert!(!folder.done(&["inspect", "b.gridel"]).contains("names"));
}

#[test]
fn inspect_lists_the_first_names_of_many() {
    let folder = Folder::new();
    let ball = |number: u32| {
        format!(
            "[[object]]\nkind = \"sphere\"\ncenter = [{number}, 0, 0]\nradius = 0.4\nname = \"n{number}\"\n"
        )
    };
    let scene: String = (0..1200).map(ball).collect();
    folder.write("many.toml", scene.as_bytes());
    let text = folder.done(&["inspect", "many.toml"]);
    assert!(text.contains("n6, n7, and 1,192 more"), "{text}");
}

#[test]
fn explain_names_objects_materials_and_lights_of_a_blob() {
    let folder = folder();
    folder.done(&["build", "a.toml", "-o", "a.gridel"]);
    let ray = ["--ray", "0,0,5,0,0,-1"];
    for input in ["a.gridel", "a.toml"] {
        let text = folder.done(&[&["explain", input], &ray[..]].concat());
        assert!(text.contains("ball (object 0) of red"), "{text}");
        assert!(text.contains("sun (light 0)"), "{text}");
        let story = folder.json(&[&["explain", input], &ray[..]].concat());
        assert_eq!(
            story["objects"]["0"],
            json!({"name": "ball", "material": "red"})
        );
    }
    let text = folder.done(&["explain", "a.gridel", "--ray", "4,0,5,0,0,-1"]);
    assert!(text.contains("Käse\\u{1b}[31m\\nred (object 2)"), "{text}");
    folder.done(&["build", "a.toml", "-o", "b.gridel", "--strip-names"]);
    let text = folder.done(&[&["explain", "b.gridel"], &ray[..]].concat());
    assert!(text.contains("which is object 0, at"), "{text}");
}

/// The options to trace the rays of a file, with names.
const TRACED: [&str; 5] = ["--rays", "rays.npy", "-o", "hits.npy", "--names=names.json"];

#[test]
fn trace_writes_names_and_counts_hits_by_name() {
    let folder = folder();
    folder.write("rays.npy", &rays());
    folder.done(&["build", "a.toml", "-o", "a.gridel"]);
    for input in ["a.gridel", "a.toml"] {
        let traced = folder.json(&[&["trace", input], &TRACED[..]].concat());
        assert_eq!(traced["hits_by_name"], json!({"ball": 3, OBJECTS[2]: 1}));
        let names: Value = serde_json::from_slice(&folder.read("names.json")).unwrap();
        assert_eq!(
            names["objects"][2],
            json!({
                "object": 2, "name": OBJECTS[2], "first_primitive": 2, "primitives": 1,
                "material": 1, "material_name": "default"
            })
        );
        assert_eq!(names["materials"], json!(["red", "default"]));
        assert_eq!(names["lights"], json!(["sun"]));
    }
    folder.done(&["build", "a.toml", "-o", "b.gridel", "--strip-names"]);
    let traced = folder.json(&[&["trace", "b.gridel"], &TRACED[..]].concat());
    assert_eq!(
        traced["hits_by_name"],
        json!({"object 0": 2, "object 1": 1, "object 2": 1})
    );
    let plain = ["trace", "a.gridel", "--rays", "rays.npy", "-o", "hits.npy"];
    assert_eq!(folder.json(&plain)["hits_by_name"], Value::Null);
}

#[test]
fn trace_prints_hits_by_name_where_names_has_no_file() {
    let folder = folder();
    folder.write("rays.npy", &rays());
    let trace = [
        "trace", "a.toml", "--rays", "rays.npy", "-o", "hits.npy", "--names",
    ];
    let text = folder.done(&trace);
    let table = "\nobject                       hits\nball                            3\n\
                 Käse\\u{1b}[31m\\nred     1\n";
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words(&text).ends_with(&words(table)), "{text}");
    let traced = folder.json(&trace);
    assert_eq!(traced["hits_by_name"], json!({"ball": 3, OBJECTS[2]: 1}));
    assert_eq!(folder.names(), ["a.toml", "hits.npy", "rays.npy"]);
    let any = [&trace[..], &["--any"]].concat();
    folder.fails(2, &any, &["--any finds no objects", "--names=names.json"]);
    // The scene is not the file of names, wherever it stands.
    let last = [&["trace"], &trace[2..], &["a.toml"]].concat();
    let text = folder.done(&last);
    assert!(words(&text).ends_with(&words(table)), "{text}");
}

#[test]
fn trace_never_writes_names_over_its_other_files() {
    let folder = folder();
    folder.write("rays.npy", &rays());
    for (name, said) in [
        ("a.toml", "would be lost"),
        ("rays.npy", "would be lost"),
        ("hits.npy", "would be lost"),
        ("names.png", "unsupported names format"),
        ("-", "cannot go to standard output"),
    ] {
        let option = format!("--names={name}");
        let trace = [
            "trace", "a.toml", "--rays", "rays.npy", "-o", "hits.npy", &option,
        ];
        let run = folder.run(&trace);
        assert_eq!(run.code, Some(2), "{name}: {run:?}");
        assert!(run.said().contains(said), "{name}: {run:?}");
    }
    assert_eq!(folder.names(), ["a.toml", "rays.npy"]);
}

#[test]
fn forged_names_are_errors_of_every_command() {
    let folder = folder();
    folder.write("rays.npy", &rays());
    folder.done(&["build", "a.toml", "-o", "a.gridel"]);
    let mut bytes = folder.read("a.gridel");
    // The last byte is that of the last light's name.
    *bytes.last_mut().unwrap() = 0xff;
    bytes[20..24].fill(0);
    let sum = gridel_core::format::checksum(&bytes);
    bytes[20..24].copy_from_slice(&sum.to_le_bytes());
    folder.write("forged.gridel", &bytes);
    for command in [
        &["inspect", "forged.gridel"][..],
        &["explain", "forged.gridel", "--pixel", "0,0"],
        &[
            "trace",
            "forged.gridel",
            "--rays",
            "rays.npy",
            "-o",
            "hits.npy",
        ],
        &["render", "forged.gridel", "-o", "a.png"],
    ] {
        let run = folder.run(command);
        assert_eq!(run.code, Some(1), "{command:?}: {run:?}");
        assert!(run.said().contains("name-text"), "{command:?}: {run:?}");
    }
}

#[test]
fn importers_name_objects_materials_and_lights() {
    let folder = Folder::new();
    folder.write(
        "a.obj",
        b"o first\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl paint\nf 1 2 3\ng second\nf 1 3 2\n",
    );
    let inspection = folder.json(&["inspect", "a.obj"]);
    assert_eq!(inspection["names"]["objects"], json!(["first", "second"]));
    // NFF has no names.
    folder.write(
        "a.nff",
        b"v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 8 8\n\
          f 1 0 0 1 0 0 0 1\ns 0 0 0 1\n",
    );
    let inspection = folder.json(&["inspect", "a.nff"]);
    assert_eq!(inspection["names"]["objects"], json!([]));
}

#[test]
fn instances_are_named_in_the_order_of_their_numbers() {
    let folder = Folder::new();
    let part = "part = [{ name = 'p', object = [{ kind = 'sphere', center = [0, 0, 0], radius = 0.5 }] }]\n";
    folder.write(
        "inner.toml",
        format!("{part}[[instance]]\npart = 'p'\nname = 'within'\n").as_bytes(),
    );
    let file = format!(
        "{part}[[instance]]\npart = 'p'\nname = 'own'\ntranslate = [4, 0, 0]\n\
         [[object]]\nkind = 'import'\nfile = 'inner.toml'\nname = 'import'\n"
    );
    folder.write("outer.toml", file.as_bytes());
    let names = json!(["import/within", "own"]);
    let inspection = folder.json(&["inspect", "outer.toml"]);
    assert_eq!(inspection["names"]["instances"], names);
    folder.write(
        "rays.npy",
        &npy("<f8", &[[4.0, 0.0, 9.0, 0.0, 0.0, 0.0, -1.0, 100.0]]),
    );
    folder.done(&[&["trace", "outer.toml"], &TRACED[..]].concat());
    let table: Value = serde_json::from_slice(&folder.read("names.json")).unwrap();
    assert_eq!(table["instances"], names);
    // The hit on the file's own instance: t, object and primitive are before its number, and the normal behind it.
    let hits = folder.read("hits.npy");
    let (_, hit) = hits.split_at(hits.len() - 32);
    assert_eq!(hit[16..20], 1_u32.to_le_bytes());
}
