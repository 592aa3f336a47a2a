//! Scenes that change while a program runs: every frame is the host's, and a change costs little.

use crate::figures::Figures;
use crate::firmware::{self, Build};
use crate::orbit::{FRAMES, camera};
use crate::plan::Plan;
use crate::scenes::{self, Compiled};
use gridel_core::{Format, Structure};
use gridel_host::measure::board::Board;

/// Instructions of a frame before its first ray: camera, its checks, and the renderer's set-up.
const FRAME: u64 = 3_000;

pub fn plan(plan: &mut Plan) {
    for (board, format) in [("mps2-an386", Format::F32), ("mps2-an385", Format::Fixed)] {
        let board = firmware::board(board);
        plan.test_on("a_camera_orbits::suzanne", board, format)
            .with_scene(scenes::SUZANNE)
            .in_full()
            .run(move || a_camera_orbits(board, format, &scenes::suzanne()));
    }
    for (board, format) in [
        ("mps2-an386", Format::Fixed),
        ("microbit", Format::Fixed),
        ("sifive_e", Format::Fixed),
    ] {
        let board = firmware::board(board);
        plan.test_on("a_camera_orbits::torus", board, format)
            .in_full()
            .run(move || a_camera_orbits(board, format, &scenes::torus_mesh_in_few_pixels()));
    }
}

fn a_camera_orbits(board: &'static Board, format: Format, compiled: &Compiled) {
    let build = Build::new(board, format, Structure::DualSplit, compiled);
    let program = build.program("orbit");
    let report = program.run();
    let frames = program.file("orbit.rgb");
    let scene = compiled.blob.scene().expect("the compiler's own blob");
    let bytes = frames.len() / FRAMES as usize;
    assert_eq!(
        bytes,
        3 * usize::from(scene.view().width) * usize::from(scene.view().height)
    );
    let mut pictures = Vec::new();
    for (number, frame) in (0..FRAMES).zip(frames.chunks(bytes)) {
        let view = camera(&scene, number).expect("a camera").view(&scene);
        let seen = scene.with_view(&view).expect("a view");
        let host = scenes::picture(&seen, Structure::DualSplit, format);
        assert!(
            frame == host,
            "{build}: frame {number} differs from the host's"
        );
        pictures.push(host);
    }
    pictures.dedup();
    assert_eq!(
        pictures.len(),
        FRAMES as usize,
        "{build}: the camera stands still"
    );
    // A Cortex-M0 has no products of 64 bits.
    if board.core != "Cortex-M0" {
        let instructions = report["frame-instructions"];
        assert!(
            instructions <= FRAME,
            "{build}: {instructions} instructions a frame"
        );
    }
    let mut figures = Figures::new();
    figures.add(&format!("orbit {build}"), &report);
    figures.check();
}
