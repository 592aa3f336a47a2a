//! `gridel inspect`.

use crate::program::{Folder, fixture};
use gridel_core::{Fixed, Stack, Workspace};
use gridel_host::table::grouped;
use serde_json::{Value, json};

#[test]
fn the_memory_map_adds_up_to_the_file() {
    let folder = Folder::with_quick();
    let bytes = folder.read("quick.gridel").len() as u64;
    let inspection = folder.json(&["inspect", "quick.gridel"]);
    let map = &inspection["memory_map"];
    assert_eq!(map["bytes"], bytes);
    let parts = map["parts"].as_array().unwrap();
    let sum: u64 = parts.iter().map(|p| p["bytes"].as_u64().unwrap()).sum();
    assert_eq!(sum, bytes);
    let share: f64 = parts.iter().map(|p| p["share"].as_f64().unwrap()).sum();
    assert!((share - 1.0).abs() < 1e-9);
    // Parts lie behind each other, with less than an alignment in between.
    let mut end = 0;
    for part in parts.iter().filter(|part| part["offset"].is_u64()) {
        let offset = part["offset"].as_u64().unwrap();
        assert!((end..end + 16).contains(&offset), "{part}");
        assert_eq!(
            part["bytes"].as_u64(),
            Some(part["count"].as_u64().unwrap() * part["stride"].as_u64().unwrap())
        );
        end = offset + part["bytes"].as_u64().unwrap();
    }
    assert_eq!(end, bytes);
    let kinds: Vec<_> = parts.iter().map(|p| p["kind"].as_str().unwrap()).collect();
    for kind in [
        "header",
        "section table",
        "spheres",
        "flagged-pairs",
        "padding",
    ] {
        assert!(kinds.contains(&kind), "{kinds:?}");
    }

    let text = folder.done(&["inspect", "quick.gridel"]);
    let total = text.lines().find(|line| line.starts_with("total")).unwrap();
    assert!(total.contains("100.0 %"), "{total}");
}

#[test]
fn limits_and_contents_are_in_scene_units() {
    let folder = Folder::with_quick();
    let inspection = folder.json(&["inspect", "quick.gridel"]);
    let limits = &inspection["limits"];
    assert_eq!(
        limits["bounds"],
        json!([[-6.0, -0.25, -5.0], [6.0, 3.5, 5.0]])
    );
    assert_eq!(
        limits["step"].as_f64(),
        limits["unit"].as_f64().map(|u| u / 256.0)
    );
    let contents = &inspection["contents"];
    assert_eq!(contents["structures"], json!(["list", "bvh", "flagged"]));
    assert_eq!(
        contents["kinds"],
        json!({"triangle": 9, "sphere": 2, "box": 2, "disc": 1, "cone": 3})
    );
    assert_eq!(contents["primitives"], 17);
    assert_eq!(contents["collapsed"], 0);
}

#[test]
fn parts_are_listed_with_what_they_take() {
    let folder = Folder::new();
    folder.write("arm.toml", &fixture("robot-arm"));
    let inspection = folder.json(&["inspect", "arm.toml"]);
    let parts = inspection["parts"].as_array().unwrap();
    let sum = |key: &str| {
        parts
            .iter()
            .map(|it| it[key].as_u64().unwrap())
            .sum::<u64>()
    };
    assert_eq!(inspection["contents"]["parts"], parts.len());
    assert_eq!(inspection["contents"]["instances"], sum("instances"));
    let map = inspection["memory_map"]["parts"].as_array().unwrap();
    let blobs = map.iter().find(|it| it["kind"] == "part-blobs").unwrap();
    assert_eq!(blobs["bytes"], sum("bytes"));
    let text = folder.done(&["inspect", "arm.toml"]);
    let expected = format!(
        "{} bytes, stack depth",
        grouped(parts[0]["bytes"].as_u64().unwrap())
    );
    assert!(text.contains(&expected), "{text}");
    // What a board needs for them beside the workspace.
    let rows = inspection["working_rows"].as_array().unwrap();
    assert_eq!(rows.len(), 3, "{rows:?}");
    for row in rows {
        let bytes = grouped(row["bytes"].as_u64().unwrap());
        let what = row["what"].as_str().unwrap();
        let expected = format!("32-bit board, beside the workspace: {bytes} for {what}\n");
        assert!(text.contains(&expected), "{text}");
    }
}

#[test]
fn a_scene_file_is_inspected_as_the_blob_it_would_be() {
    let folder = Folder::new();
    folder.write("quick.toml", &fixture("quick"));
    folder.done(&["build", "quick.toml", "-o", "quick.gridel"]);
    let blob = folder.json(&["inspect", "quick.gridel"]);
    let scene = folder.json(&["inspect", "quick.toml"]);
    for key in ["memory_map", "limits", "contents", "working_memory"] {
        assert_eq!(blob[key], scene[key], "{key}");
    }
    let by = |inspection: &Value, effect: &str| {
        let effects = inspection["effects"].as_array().unwrap().clone();
        let found = effects.into_iter().find(|e| e["effect"] == effect);
        found.unwrap()["by"].clone()
    };
    let in_file = |part: &str, line: u32| json!({"part": part, "file": "quick.toml", "line": line});
    assert_eq!(
        by(&scene, "mirror"),
        json!([in_file("material mirror", 38)])
    );
    assert_eq!(by(&blob, "mirror"), json!([{"part": "material 2"}]));
    let lights = json!([in_file("light 0", 16), in_file("light 1", 21)]);
    assert_eq!(by(&scene, "shadow"), lights);
    let lights = json!([{"part": "light 0"}, {"part": "light 1"}]);
    assert_eq!(by(&blob, "shadow"), lights);
    let coarse = folder.json(&["inspect", "quick.toml", "--lattice-bits", "16"]);
    assert_eq!(coarse["limits"]["storage_bits"], 16);
    folder.fails(
        2,
        &["inspect", "quick.gridel", "--lattice-bits", "16"],
        &["--lattice-bits is for scene files"],
    );
}

/// A triangle with a texture that has levels.
const LEVELS: &str = "
[material.screen]
texture = { file = 'screen.png', levels = true }
[[object]]
kind = 'triangle'
vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
coordinates = [[0, 0], [1, 0], [0, 1]]
material = 'screen'
";

#[test]
fn working_memory_is_what_the_compiler_says() {
    let folder = Folder::with_quick();
    let quick = String::from_utf8(fixture("quick")).unwrap();
    let nested = quick.replace("transmit", "priority = 1\ntransmit");
    folder.write("nested.toml", nested.as_bytes());
    // This build has room for the states of all effects in every ray that waits.
    folder.write("screen.png", include_bytes!("../../../fixtures/screen.png"));
    let every = nested.replace("[render]\n", "[render]\nbounces = 1\n") + LEVELS;
    folder.write("every.toml", every.as_bytes());
    let accels = ["--accel", "bvh", "--accel", "flagged"];
    folder.done(
        &[
            &["build", "nested.toml", "-o", "nested.gridel"],
            &accels[..],
        ]
        .concat(),
    );
    folder.done(&[&["build", "every.toml", "-o", "every.gridel"], &accels[..]].concat());
    let inspection = folder.json(&["inspect", "every.gridel"]);
    // The figures below are for this stack, and for the scene's ray depth of 6.
    assert_eq!(inspection["limits"]["stack_depth"], 6);
    assert_eq!(inspection["limits"]["work_depth"], 13);
    let needs = inspection["working_memory"].as_array().unwrap();
    let here = usize::BITS;
    let expected = [
        ("fixed", size_of::<Workspace<Fixed, 6, 13>>()),
        ("f32", size_of::<Workspace<f32, 6, 13>>()),
        ("f64", size_of::<Workspace<f64, 6, 13>>()),
    ];
    for (format, workspace) in expected {
        let found = needs
            .iter()
            .find(|n| n["word_bits"] == here && n["format"] == format);
        let found = found.unwrap();
        assert_eq!(found["stack"], size_of::<Stack<6>>());
        assert_eq!(found["workspace"], workspace);
    }
    for (scene, ray) in [("quick.gridel", 40), ("nested.gridel", 44)] {
        let inspection = folder.json(&["inspect", scene]);
        let mut needs = inspection["working_memory"].as_array().unwrap().iter();
        let board = needs.find(|n| n["word_bits"] == 32 && n["format"] == "f32");
        assert_eq!(
            board.unwrap()["workspace"],
            12 * 5 + 4 + ray * 7 + 4,
            "{scene}"
        );
    }
}

#[test]
fn broken_blobs_are_rejected_with_the_reason() {
    let folder = Folder::with_quick();
    let blob = folder.read("quick.gridel");
    let fails = |content: &[u8], words: &[&str]| {
        folder.write("broken.gridel", content);
        folder.fails(1, &["inspect", "broken.gridel"], words);
    };
    let mut flipped = blob.clone();
    flipped[900] ^= 1;
    fails(&flipped, &["broken.gridel", "checksum"]);
    for length in [0, 5, 8, 95, 500, blob.len() - 1] {
        fails(&blob[..length], &["broken.gridel"]);
    }
    fails(&[&blob[..], b"x"].concat(), &["something added"]);
    fails(&fixture("quick"), &["not a Gridel blob"]);
    // As a transfer in text mode leaves it.
    let text: Vec<u8> = String::from_utf8_lossy(&blob).replace('\n', "\r\n").into();
    fails(&text, &["not a Gridel blob"]);
    folder.write("broken.toml", &blob[..500]);
    folder.fails(1, &["inspect", "broken.toml"], &["was it cut off"]);
    folder.fails(
        1,
        &["inspect", "absent.gridel"],
        &["absent.gridel cannot be read"],
    );
}

#[test]
fn collapsed_primitives_alone_are_stated_without_an_empty_list() {
    let folder = Folder::new();
    let triangle = |x: u8| {
        format!(
            "[[object]]\nkind = 'triangle'\nvertices = [[{x}, 0, 0], [{x}, 1e-12, 0], [{x}, 0, 1e-12]]\n"
        )
    };
    folder.write("tiny.toml", (triangle(0) + &triangle(1)).as_bytes());
    let text = folder.done(&["inspect", "tiny.toml"]);
    let line = text.lines().find(|line| line.starts_with("primitives"));
    assert!(
        line.is_some_and(|it| it.ends_with("  2, which collapsed on the lattice")),
        "{text}"
    );
}

#[test]
fn pieces_of_a_cut_triangle_count_once() {
    let folder = Folder::new();
    // A closed tetrahedron with a sliver: its third corner lies next to the middle of an edge.
    folder.write(
        "a.obj",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0.5 0.00001 0.00001\n\
          f 2 1 5\nf 1 3 5\nf 3 2 5\nf 1 2 4\nf 2 3 4\nf 3 1 4\n",
    );
    folder.done(&["build", "a.obj", "-o", "a.gridel", "--lattice-bits", "10"]);
    let contents = &folder.json(&["inspect", "a.gridel"])["contents"];
    let triangles = contents["kinds"]["triangle"].as_u64().unwrap();
    let collapsed = contents["collapsed"].as_u64().unwrap();
    assert!(collapsed > 0, "{contents}");
    assert_eq!(
        triangles + collapsed,
        contents["primitives"].as_u64().unwrap()
    );
}

/// A track raises a mirror from 0: the effect, the work list and the RAM are those of all times, for a scene file and
/// for its blob.
#[test]
fn effects_that_tracks_call_for_are_counted() {
    let folder = Folder::new();
    let ball = "[material.ball]\ndiffuse = 0.5\nMIRROR\n\
        [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'ball'\n";
    let track = "[[track]]\ntarget = 'material.ball.mirror'\ntimes = [0, 1]\nvalues = [0, 1]\n";
    let still = ball.replace("MIRROR", "mirror = 1");
    folder.write("still.toml", still.as_bytes());
    let moving = ball.replace("MIRROR", "") + track;
    folder.write("moving.toml", moving.as_bytes());
    let built = folder.json(&["build", "moving.toml", "-o", "moving.gridel"]);
    let expected = folder.json(&["inspect", "still.toml"]);
    for found in [
        built,
        folder.json(&["inspect", "moving.toml"]),
        folder.json(&["inspect", "moving.gridel"]),
    ] {
        let effects = found["effects"].as_array().unwrap();
        let mirror = effects.iter().find(|it| it["effect"] == "mirror").unwrap();
        assert_eq!(
            mirror["by"],
            json!([{ "part": "a track of material ball" }])
        );
        if found["limits"].is_null() {
            continue;
        }
        assert_eq!(found["working_memory"], expected["working_memory"]);
        let rows = found["working_rows"].as_array().unwrap();
        let what: Vec<_> = rows.iter().map(|row| &row["what"]).collect();
        assert_eq!(what, ["1 material, copied because tracks change them"]);
        assert_eq!(
            found["limits"]["work_depth"],
            expected["limits"]["work_depth"]
        );
    }
}

/// Effects are required by more than the records of materials, lights and meshes, too.
#[test]
fn every_effect_of_a_blob_has_what_requires_it() {
    let folder = Folder::new();
    folder.write("screen.png", include_bytes!("../../../fixtures/screen.png"));
    let scene = format!(
        "ambient = 1\n[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\naperture = 0.5\n\
         [render]\nbounces = 1\ntone_mapping = 'aces'\n\
         [environment]\nzenith = 1\nhorizon = 1\nground = 1\n\
         [material.shiny]\nmirror = 0.5\nroughness = 0.5\n\
         [material.ice]\ntransmit = 1\npriority = 1\n\
         [material.lamp]\nemission = 1\n\
         [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'shiny'\n\
         [[object]]\nkind = 'sphere'\ncenter = [3, 0, 0]\nradius = 1\nmaterial = 'ice'\n\
         [[object]]\nkind = 'sphere'\ncenter = [6, 0, 0]\nradius = 1\nmaterial = 'lamp'\n{LEVELS}"
    );
    folder.write("all.toml", scene.as_bytes());
    folder.done(&["build", "all.toml", "-o", "all.gridel"]);
    let inspection = folder.json(&["inspect", "all.gridel"]);
    let effects = inspection["effects"].as_array().unwrap();
    for effect in effects {
        let by = effect["by"].as_array().unwrap();
        assert!(!by.is_empty(), "{effect}");
    }
    for (name, part) in [
        ("environment", "the environment"),
        ("nested", "material 1"),
        ("glossy", "material 0"),
        ("tone-mapping", "the `tone_mapping` of pictures"),
        ("emission", "material 2"),
        ("depth-of-field", "the camera's `aperture`"),
        ("indirect", "the `bounces` of pictures"),
    ] {
        let found = effects.iter().find(|it| it["effect"] == name).unwrap();
        assert_eq!(found["by"], json!([{ "part": part }]), "{name}");
    }
    let text = folder.done(&["inspect", "all.gridel"]);
    assert!(text.contains("glossy, for material 0\n"), "{text}");
}
