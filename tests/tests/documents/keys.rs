//! The documents of the two file formats list the keys that their parsers know, and no others.

use super::text;
use gridel_core::Structure;
use gridel_host::check::Manifest;
use gridel_host::scene::{MoleculeOptions, SceneError, load};
use std::collections::BTreeSet;
use std::path::PathBuf;

const SCENE: &str = "host/docs/SCENE.md";
const CHECK: &str = "host/docs/CHECK.md";

/// Rows of the first table below a heading, as cells without backticks.
fn rows(document: &str, heading: &str) -> Vec<Vec<String>> {
    let page = text(document);
    let (_, section) = page
        .split_once(&format!("\n## {heading}\n"))
        .unwrap_or_else(|| panic!("{document} has no section {heading}"));
    let lines = section.lines().skip_while(|line| !line.starts_with("| "));
    let table = lines.take_while(|line| line.starts_with('|')).skip(2);
    let cells = |line: &str| {
        let cells = line.trim_matches('|').split(" | ");
        let cells = cells.map(|cell| cell.trim().trim_matches('`').to_owned());
        cells.collect()
    };
    table.map(cells).collect()
}

/// The first column of the table below a heading.
fn documented(document: &str, heading: &str) -> BTreeSet<String> {
    let rows = rows(document, heading).into_iter();
    rows.filter_map(|row| row.into_iter().next()).collect()
}

/// Keys or words that an error's remedy lists behind a phrase.
fn listed(error: &SceneError, phrase: &str) -> BTreeSet<String> {
    let (_, list) = error
        .remedy
        .split_once(phrase)
        .unwrap_or_else(|| panic!("{error}: {}", error.remedy));
    list.split(", ").map(String::from).collect()
}

/// A file that lies in a folder of its own.
fn written(name: &str, content: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(name);
    std::fs::write(&path, content).expect("the file can be written to");
    (folder, path)
}

fn scene_error(content: &str) -> SceneError {
    let (_folder, path) = written("scene.toml", content);
    match load(&path, &MoleculeOptions::default()) {
        Ok(_) => panic!("accepted:\n{content}"),
        Err(error) => error,
    }
}

fn manifest_error(content: &str) -> SceneError {
    let (_folder, path) = written("check.toml", content);
    match Manifest::read(&path) {
        Ok(_) => panic!("accepted:\n{content}"),
        Err(error) => error,
    }
}

#[test]
fn scene_page_lists_exactly_the_keys_of_tables() {
    for (heading, content) in [
        ("The scene", "unknown = 1"),
        ("Camera", "[camera]\nunknown = 1"),
        ("Render", "[render]\nunknown = 1"),
        ("Lights", "[[light]]\nunknown = 1"),
        ("Environment", "[environment]\nunknown = 1"),
        (
            "Sun",
            "[environment]\nzenith = 1\nhorizon = 1\nground = 1\nsun = { unknown = 1 }",
        ),
        ("Tracks", "[[track]]\nunknown = 1"),
        ("Materials", "[material.a]\nunknown = 1"),
        ("Checkerboard", "[material.a]\nchecker = { unknown = 1 }"),
        ("Textures", "[material.a]\ntexture = { unknown = 1 }"),
        ("Groups", "[group.a]\nunknown = 1"),
        ("Parts", "[[part]]\nunknown = 1"),
        ("Instances", "[[instance]]\nunknown = 1"),
        ("Joints", "[[joint]]\nunknown = 1"),
        ("Morph targets", "[morph.a]\nunknown = 1"),
        (
            "Rotations",
            "[[object]]\nkind = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\n\
             rotate = { unknown = 1 }",
        ),
    ] {
        let known = listed(&scene_error(content), "The keys are ");
        assert_eq!(documented(SCENE, heading), known, "{SCENE}: {heading}");
    }
}

#[test]
fn scene_page_lists_exactly_the_kinds_of_objects_and_their_keys() {
    let error = scene_error("[[object]]\nkind = \"unknown\"");
    let kinds = listed(&error, "It may be ");
    assert_eq!(documented(SCENE, "Kinds of objects"), kinds);
    let every_object = documented(SCENE, "Objects");
    for kind in kinds {
        let error = scene_error(&format!("[[object]]\nkind = \"{kind}\"\nunknown = 1"));
        let rows = rows(SCENE, "Kinds of objects");
        let own = rows.iter().filter(|row| row[0] == kind);
        let keys = own.map(|row| row[1].clone()).chain(every_object.clone());
        let known = listed(&error, "The keys are ");
        assert_eq!(keys.collect::<BTreeSet<_>>(), known, "{SCENE}: {kind}");
    }
}

#[test]
fn check_page_lists_exactly_the_keys_of_tables() {
    let check = "[[check]]\nscene = \"a.toml\"\n";
    for (heading, content) in [
        ("Checks", "unknown = 1"),
        (
            "Tolerance",
            "reference = \"a.png\"\ntolerance = { unknown = 1 }",
        ),
        ("Budget", "budget = { unknown = 1 }"),
        ("Boards", "board = [{ unknown = 1 }]"),
    ] {
        let known = listed(
            &manifest_error(&format!("{check}{content}")),
            "The keys are ",
        );
        assert_eq!(documented(CHECK, heading), known, "{CHECK}: {heading}");
    }
}

#[test]
fn structures_page_lists_exactly_the_structures() {
    let sections = ["Hierarchies", "Cells", "Lists of candidates"];
    let listed = sections.map(|heading| documented(super::STRUCTURES, heading));
    let listed: BTreeSet<_> = listed.into_iter().flatten().collect();
    let all = Structure::ALL.into_iter();
    assert_eq!(listed, all.map(|it| String::from(it.name())).collect());
}
