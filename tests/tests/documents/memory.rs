//! Bytes of blobs and of working memory.

use super::{MEMORY, holds_table};
use gridel_host::compile::{Options, compile};
use gridel_host::measure::board::BOARDS;
use gridel_host::measure::working_memory;
use gridel_host::sample::{DIAMOND_2_800, DIAMOND_27_000, diamond, icosphere, nanotube, obj, pdb};
use gridel_host::scene::Scene;
use gridel_host::table::grouped;
use gridel_tests::scenes;
use std::fmt::Write;

fn fixture(name: &str) -> Scene {
    scenes::read(&scenes::fixture_folder().join(name))
}

/// Reads a scene from the file that `gridel sample` writes.
fn sample(name: &str, text: &str) -> Scene {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(name);
    std::fs::write(&path, text).expect("the file can be written to");
    scenes::read(&path)
}

fn molecule(scene: &Scene) -> Scene {
    sample("molecule.pdb", &pdb(scene).expect("a molecule"))
}

#[test]
fn memory_page_shows_bytes_of_blobs() {
    let mut table = String::from(
        "| scene | primitives | blob | per primitive | stack | workspace `fixed`, `f32` | \
         workspace `f64` |\n|---|---|---|---|---|---|---|\n",
    );
    for (name, scene) in [
        ("glass-chess.toml", fixture("glass-chess.toml")),
        ("quick.toml", fixture("quick.toml")),
        ("cornell.toml", fixture("cornell.toml")),
        ("c60", fixture("c60.pdb")),
        ("nanotube", molecule(&nanotube(10, 10, 172.0))),
        ("diamond", molecule(&diamond(DIAMOND_2_800))),
        ("diamond-large", molecule(&diamond(DIAMOND_27_000))),
        ("icosphere", sample("sphere.obj", &obj(&icosphere(5)))),
    ] {
        let blob = compile(&scene, &Options::default()).expect("compiles").blob;
        let scene = blob.scene().expect("the compiler's blob");
        let primitives = scene.header().primitives;
        let bytes = blob.bytes().len();
        let board: Vec<_> = working_memory(&scene)
            .into_iter()
            .filter(|memory| memory.word_bits == 32)
            .collect();
        let of = |format: &str| {
            let mut board = board.iter();
            board.find(|memory| memory.format == format).expect(format)
        };
        let [fixed, single, double] = ["fixed", "f32", "f64"].map(of);
        assert_eq!(fixed.workspace, single.workspace);
        table += &format!(
            "| {name} | {} | {} | {:.1} | {} | {} | {} |\n",
            grouped(primitives),
            grouped(bytes),
            bytes as f64 / f64::from(primitives),
            grouped(single.stack),
            grouped(single.workspace),
            grouped(double.workspace)
        );
    }
    holds_table(MEMORY, "blobs", &table);
}

#[test]
fn memory_page_names_all_boards() {
    let mut table = String::from(
        "| name | core | number formats | flash, KiB | RAM, KiB | figures of |\n|---|---|---|---|---|---|\n",
    );
    for board in BOARDS {
        let formats = board
            .formats
            .iter()
            .map(|format| format!("`{}`", format.name()));
        let figures = if board.is_emulated() {
            "itself"
        } else {
            board.measured
        };
        writeln!(
            table,
            "| {} | {} | {} | {} | {} | {figures} |",
            board.name,
            board.core,
            formats.collect::<Vec<_>>().join(", "),
            grouped(board.flash >> 10),
            grouped(board.ram >> 10)
        )
        .expect("a string");
    }
    holds_table(MEMORY, "names", &table);
}
