//! The pictures that the README shows are those that the program renders.

use super::{README, block, repository, text};
use gridel_core::render::Pixel;
use gridel_core::{Format, Rgb888, Settings, Structure};
use gridel_host::compile::{Options, compile};
use gridel_host::picture::{hash, write_png};
use gridel_host::render::{Job, render};
use gridel_tests::scenes;
use std::fs;

/// Whoever copies the example of a manifest sees it pass.
#[test]
fn hashes_of_the_manifests_example_are_those_of_its_scene() {
    let manifest = text("host/docs/CHECK.md");
    let example = block(&manifest, "## Example", "toml");
    let scene = scenes::read(&scenes::fixture_folder().join("quick.toml"));
    let options = Options {
        structures: vec![Structure::Flagged],
        ..Options::default()
    };
    let blob = compile(&scene, &options).expect("compiles").blob;
    let scene = blob.scene().expect("the compiler's blob");
    let settings = Settings {
        width: 48,
        height: 36,
        ..Settings::of(&scene)
    };
    for format in [Format::Fixed, Format::F32] {
        let job = Job::whole(format, Structure::Flagged, settings);
        let picture = render(&scene, &job, &|| ()).expect("a picture");
        let stated = format!("{} = \"{}\"", format.name(), hash(&picture.pixels));
        assert!(example.contains(&stated), "CHECK.md lacks {stated}");
    }
}

/// Rows and columns of a pixel of the board's display.
const ENLARGED: usize = 3;

/// The tests of boards compare such a board's pictures with the host's.
#[test]
fn picture_of_the_board_is_the_one_that_fixed_renders() {
    let scene = scenes::read(&scenes::fixture_folder().join("glass-chess.toml"));
    let options = Options {
        lattice_bits: 16,
        ..Options::default()
    };
    let blob = compile(&scene, &options).expect("compiles").blob;
    let scene = blob.scene().expect("the compiler's blob");
    let settings = Settings {
        width: 128,
        height: 128,
        samples: 4,
        depth: 4,
        dither: false,
    };
    let job = Job::whole(Format::Fixed, Structure::DualSplit, settings);
    let picture = render(&scene, &job, &|| ()).expect("a picture");
    let rows = picture.pixels.chunks(128);
    let enlarged: Vec<u8> = rows
        .flat_map(|row| std::iter::repeat_n(row, ENLARGED))
        .flatten()
        .flat_map(|&linear| [Rgb888::encode(linear, None).0; ENLARGED])
        .flatten()
        .collect();
    let side = 128 * ENLARGED as u32;
    let mut rendered = Vec::new();
    write_png(&mut rendered, [side; 2], &enlarged, None).expect("a file in memory");
    let path = repository().join("fixtures/pictures/board.png");
    if std::env::var_os("GRIDEL_BLESS").is_some_and(|value| value == "1") {
        fs::write(&path, &rendered).expect("the picture can be written to");
    }
    let shown = fs::read(&path).expect("the picture");
    assert!(shown == rendered, "GRIDEL_BLESS=1 writes the picture");
}

#[test]
fn readme_shows_three_pictures() {
    for name in ["glass-chess.png", "board.png", "accuracy.svg"] {
        assert!(
            text(README).contains(&format!("fixtures/pictures/{name}")),
            "{name}"
        );
    }
}
