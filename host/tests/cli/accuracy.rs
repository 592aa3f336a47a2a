//! `gridel accuracy`.

use crate::program::Folder;

const SMALL: [&str; 8] = [
    "accuracy",
    "ball.toml",
    "--size",
    "12x9",
    "--repeat",
    "1",
    "-o",
    "out",
];

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write(
        "ball.toml",
        b"object = [{ kind = \"sphere\", center = [0, 0, 0], radius = 1 }]\n",
    );
    folder
}

#[test]
fn what_a_single_repeat_cannot_tell_is_not_told() {
    let folder = folder();
    let text = folder.done(&SMALL);
    let line = text
        .lines()
        .find(|line| line.contains("f32-24bit-1spp"))
        .unwrap();
    let columns: Vec<_> = line.split_whitespace().collect();
    let name = columns
        .iter()
        .position(|it| it.starts_with("f32-"))
        .unwrap();
    assert_eq!(columns[name + 2], "-", "{line}");
    let page = String::from_utf8(folder.read("out/page.html")).unwrap();
    assert!(page.contains("256 samples a pixel"), "no samples");
    assert!(page.contains("<code>fixed</code>") && !page.contains('`'));
    assert!(page.contains("<td>-</td>"));
}

#[test]
fn the_reference_is_better_than_what_it_measures() {
    let folder = folder();
    let few = [&SMALL[..], &["--reference-samples", "127"]].concat();
    folder.fails(2, &few, &["127 samples", "at least 128"]);
    folder.done(&[&SMALL[..], &["--reference-samples", "128"]].concat());
}

/// A bound that nothing keeps is an error, behind the table that shows it.
#[test]
fn a_bound_that_is_too_tight_still_shows_the_table() {
    let folder = folder();
    let run = folder.run(&[&SMALL[..], &["--max-error", "0"]].concat());
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    assert!(run.stdout.contains("RMSE") && run.stdout.contains("page.html"));
    assert!(
        run.stderr.contains("allow a larger error"),
        "{}",
        run.stderr
    );
    // Boards have the names that `build --target` gives them.
    for board in ["cortex-m3", "mps2-an385"] {
        let bound = ["--max-error", "0.9", "--board", board];
        let report = folder.json(&[&SMALL[..], &bound].concat());
        let name = report["cheapest"]["name"].as_str().unwrap();
        assert!(name.starts_with("fixed-"), "{name}");
        let build = report["cheapest"]["build"].as_str().unwrap();
        assert!(build.contains("--accel dual-split"), "{build}");
    }
}
