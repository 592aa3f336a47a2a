//! The report, and the options that it depends on.

use crate::program::{Folder, fixture};
use gridel_core::Structure;
use gridel_host::blob::Blob;
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
    let by = json!([{"part": "material glass", "file": "quick.toml", "line": 30}]);
    assert_eq!(glass["by"], by);

    let text = folder.done(&["build", "quick.toml", "-o", "again.gridel"]);
    assert!(
        text.contains("glass, for material glass (quick.toml:30)"),
        "{text}"
    );
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

/// The text reads well: numbers of one thing, what is left out, what remains on a board.
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
    // Without a hierarchy there is no SAH cost.
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
