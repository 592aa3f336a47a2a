//! `gridel sample`.

use crate::program::{Folder, fixture};
use serde_json::Value;
use std::path::Path;

#[test]
fn every_fixture_is_a_sample() {
    let folder = Folder::new();
    let listed = folder.json(&["sample"]);
    let names: Vec<_> = listed
        .as_array()
        .unwrap()
        .iter()
        .map(|sample| sample["name"].as_str().unwrap())
        .collect();
    let fixtures = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures"));
    for entry in std::fs::read_dir(fixtures).unwrap() {
        let path = entry.unwrap().path();
        if path
            .extension()
            .is_some_and(|extension| extension == "toml")
        {
            let name = path.file_stem().unwrap().to_str().unwrap();
            // What the scenes are held to, and none itself; and a scene that has pictures beside it.
            let is_none = name == "check" || name == "studio";
            assert!(names.contains(&name) || is_none, "{name}");
        }
    }
    let text = folder.done(&["sample"]);
    assert_eq!(text.lines().count(), names.len());
}

#[test]
fn every_sample_can_be_built() {
    let folder = Folder::new();
    for sample in folder.json(&["sample"]).as_array().unwrap() {
        let name = sample["name"].as_str().unwrap();
        folder.done(&["sample", name]);
        let file = format!("{name}.{}", sample["extension"].as_str().unwrap());
        let report = folder.json(&["build", &file, "-o", "a.gridel"]);
        assert!(report["primitives"].as_u64().unwrap() > 0, "{name}");
        // The sun in the smoothest mirrors of one sample is brighter than `fixed` holds, which no display shows.
        let warnings = report["warnings"].as_array().unwrap().iter();
        let of_pictures = |it: &&Value| {
            !it.as_str()
                .unwrap()
                .contains("in `fixed` and linear radiance")
        };
        assert_eq!(warnings.filter(of_pictures).count(), 0, "{report}");
    }
}

#[test]
fn files_are_replaced_only_by_force() {
    let folder = Folder::new();
    folder.done(&["sample", "quick"]);
    assert_eq!(folder.read("quick.toml"), fixture("quick"));
    folder.write("quick.toml", b"mine");
    folder.fails(
        1,
        &["sample", "quick"],
        &["quick.toml exists already", "--force"],
    );
    folder.fails(
        1,
        &["sample", "c60", "-o", "quick.toml"],
        &["exists already"],
    );
    folder.done(&["sample", "quick", "--force"]);
    assert_eq!(folder.read("quick.toml"), fixture("quick"));
    folder.done(&["sample", "quick", "-o", "other.toml"]);
    assert_eq!(folder.read("other.toml"), fixture("quick"));
}

#[test]
fn standard_output_is_not_a_file_that_exists() {
    let folder = Folder::new();
    folder.write("-", b"mine");
    let text = folder.done(&["sample", "quick", "-o", "-"]);
    assert_eq!(text.as_bytes(), fixture("quick"));
    assert_eq!(folder.read("-"), b"mine");
}

#[test]
fn wrong_names_are_rejected_with_the_samples() {
    let folder = Folder::new();
    folder.fails(2, &["sample", "teapot"], &["quick", "glass-chess"]);
    folder.fails(2, &["sample", "c60", "-o", "c60.toml"], &["ends with .pdb"]);
    folder.fails(2, &["sample", "-o", "a.toml"], &["NAME"]);
    folder.fails(2, &["sample", "quick", "--json"], &["--json"]);
    folder.fails(
        1,
        &["sample", "quick", "-o", "absent/a.toml"],
        &["create the folder"],
    );
}
