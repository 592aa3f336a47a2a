//! The pictures that the README shows are those that the program renders.

use super::{README, block, repository, text};
use gridel_core::render::Pixel;
use gridel_core::{Format, Rgb888, Settings, Structure};
use gridel_host::compile::{Options, compile};
use gridel_host::picture::{hash, write_png};
use gridel_host::render::{Job, Picture, render};
use gridel_tests::scenes;
use std::fs;

/// The example of a manifest passes for a reader who copies it.
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
    holds_picture("board.png", &picture, ENLARGED);
}

/// The links lead to pictures that show the effects.
#[test]
fn pictures_of_effects_are_those_of_their_files() {
    for (name, enlarged) in [("studio", 2), ("room", 2), ("sky", 2), ("tumbler", 2)] {
        let file = scenes::fixture_folder().join(format!("{name}.toml"));
        let blob = compile(&scenes::read(&file), &Options::default());
        let blob = blob.expect("compiles").blob;
        let scene = blob.scene().expect("the compiler's blob");
        let job = Job::whole(Format::F32, Structure::DualSplit, Settings::of(&scene));
        let picture = render(&scene, &job, &|| ()).expect("a picture");
        holds_picture(&format!("{name}.png"), &picture, enlarged);
    }
}

/// Compares a file with a picture, whose pixels it shows as squares of some rows and columns.
fn holds_picture(name: &str, picture: &Picture, enlarged: usize) {
    let rows = picture.pixels.chunks(picture.width.into());
    let bytes: Vec<u8> = rows
        .flat_map(|row| std::iter::repeat_n(row, enlarged))
        .flatten()
        .flat_map(|&linear| std::iter::repeat_n(Rgb888::encode(linear, None).0, enlarged))
        .flatten()
        .collect();
    let size = [picture.width, picture.height].map(|it| u32::from(it) * enlarged as u32);
    let mut rendered = Vec::new();
    write_png(&mut rendered, size, &bytes, None).expect("a file in memory");
    let path = repository().join("fixtures/pictures").join(name);
    if std::env::var_os("GRIDEL_BLESS").is_some_and(|value| value == "1") {
        fs::write(&path, &rendered).expect("the picture can be written to");
    }
    let shown = fs::read(&path).expect("the picture");
    assert!(shown == rendered, "GRIDEL_BLESS=1 writes {name}");
}

#[test]
fn readme_shows_the_pictures() {
    for name in [
        "glass-chess.png",
        "board.png",
        "studio.png",
        "room.png",
        "sky.png",
        "accuracy.svg",
    ] {
        assert!(
            text(README).contains(&format!("fixtures/pictures/{name}")),
            "{name}"
        );
    }
}
