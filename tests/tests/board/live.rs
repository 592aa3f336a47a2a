//! Scenes that change while a program runs: every frame is the host's, and a change costs little.

use crate::arm;
use crate::figures::Figures;
use crate::firmware::{self, Build};
use crate::orbit::{FRAMES, MOMENTS, SAMPLES, camera};
use crate::plan::Plan;
use crate::scenes::{self, Compiled};
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::{
    DualSplit, Fixed, Format, Motion, NoCount, Number, Poses, Position, Scene, Settings, Stack,
    Structure, Tracks, closest_hit,
};
use gridel_host::measure::board::Board;
use std::collections::BTreeMap;

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
    for (board, format) in [
        ("mps2-an386", Format::F32),
        ("mps2-an385", Format::Fixed),
        ("sifive_e", Format::Fixed),
        ("mps2-an500", Format::F64),
    ] {
        let board = firmware::board(board);
        plan.test_on("motion_is_blurred", board, format)
            .in_full()
            .run(move || motion_is_blurred(board, format, &scenes::torus_mesh_in_few_pixels()));
    }
    for (board, format) in [
        ("mps2-an386", Format::F32),
        ("mps2-an385", Format::Fixed),
        ("sifive_e", Format::Fixed),
    ] {
        let board = firmware::board(board);
        plan.test_on("an_arm_bends", board, format)
            .in_full()
            .run(move || an_arm_bends(board, format, &scenes::arm()));
    }
    for (board, format, most) in [
        ("mps2-an386", Format::F32, 1.38),
        ("mps2-an385", Format::Fixed, 1.69),
    ] {
        let board = firmware::board(board);
        plan.test_on("an_instance_costs_little", board, format)
            .with_scene(scenes::SUZANNE)
            .in_full()
            .run(move || an_instance_costs_little(board, format, most));
    }
    let board = firmware::board("mps2-an386");
    plan.test_on("hierarchy_above_32_poses_is_built", board, Format::F32)
        .in_full()
        .run(move || {
            let scene = scenes::thirty_two_balls();
            let build = Build::new(board, Format::F32, Structure::DualSplit, &scene);
            let report = build.program("arm").run();
            let instructions = report["build-instructions"];
            assert!(instructions <= 40_000, "{instructions} instructions");
            let mut figures = Figures::new();
            figures.add(&format!("arm {build}"), &report);
            figures.check();
        });
}

fn an_arm_bends(board: &'static Board, format: Format, compiled: &Compiled) {
    let build = Build::new(board, format, Structure::DualSplit, compiled);
    let program = build.program("arm");
    let lines = program.lines();
    let ranges = lines.iter().filter(|(name, _)| name == "range");
    let ranges: Vec<u64> = ranges.map(|(_, q13)| *q13).collect();
    let figures = lines.iter().filter(|(name, _)| name != "range");
    let report: BTreeMap<String, u64> = figures.cloned().collect();
    let frames = program.file("arm.rgb");
    let scene = compiled.blob.scene().expect("the compiler's own blob");
    let tracks = Tracks::from_bytes(compiled.blob.bytes()).expect("the compiler's own tracks");
    let bytes = frames.len() / arm::FRAMES as usize;
    let mut pictures = Vec::new();
    for (number, frame) in (0..arm::FRAMES).zip(frames.chunks(bytes)) {
        let mut motions = vec![Motion::REST; tracks.joints().len()];
        arm::bend(&tracks, number, &mut motions).expect("motions");
        let mut memory = Poses::<6>::new();
        let mut poses = memory.at_rest(&scene).expect("room for six");
        tracks.place(&scene, &motions, &mut poses).expect("poses");
        let posed = scene.with_poses(poses).expect("poses in the scene's box");
        let host = scenes::picture(&posed, Structure::DualSplit, format);
        assert!(
            frame == host,
            "{build}: frame {number} differs from the host's"
        );
        pictures.push(host);
        let (place, direction) = arm::hand(&tracks, &motions).expect("a hand");
        let range = match format {
            Format::Fixed => range::<Fixed>(&posed, place, direction),
            Format::F32 => range::<f32>(&posed, place, direction),
            Format::F64 => range::<f64>(&posed, place, direction),
        };
        assert_eq!(ranges[number as usize], range, "{build}: frame {number}");
    }
    assert!(
        ranges.iter().any(|&q13| q13 > 0),
        "{build}: the hand sees nothing"
    );
    pictures.dedup();
    assert_eq!(
        pictures.len(),
        arm::FRAMES as usize,
        "{build}: the arm stands still"
    );
    let poses = report["bend-instructions"] + report["build-instructions"];
    let frame = report["set-up-instructions"] + report["picture-instructions"];
    assert!(
        100 * poses <= frame,
        "{build}: poses take {poses} instructions of {frame}"
    );
    let mut figures = Figures::new();
    figures.add(&format!("arm {build}"), &report);
    figures.check();
}

/// Returns the length of a ray up to its hit, in units with 13 fraction bits; 0 if it misses.
fn range<N: Number>(scene: &Scene<'_>, place: Position, direction: [i32; 3]) -> u64 {
    let ray = scene.ray_from::<N>(place, direction).expect("a direction");
    let mut stack = Stack::<MAX_STACK_DEPTH>::new();
    let hit = closest_hit::<N, DualSplit, _>(scene, &ray, stack.as_view(), &mut NoCount);
    hit.map_or(0, |hit| N::narrow(hit.t).to_q13() as u64)
}

/// Suzanne as an instance against the same triangles in the scene itself, in the same view.
fn an_instance_costs_little(board: &'static Board, format: Format, most: f64) {
    let [placed, flat] = scenes::suzanne_as_an_instance().map(|scene| {
        let build = Build::new(board, format, Structure::DualSplit, &scene);
        let features = ["instances", "triangle", "wide-lattice"];
        let report = build.program_with("arm", &features).run();
        report["picture-instructions"]
    });
    let ratio = placed as f64 / flat as f64;
    println!("{placed} instructions with an instance, {flat} without: {ratio:.3}");
    assert!(ratio <= most, "{ratio}");
}

/// A picture of several moments has the host's bytes.
fn motion_is_blurred(board: &'static Board, format: Format, compiled: &Compiled) {
    let build = Build::new(board, format, Structure::DualSplit, compiled);
    let program = build.program("blur");
    let report = program.run();
    let scene = compiled.blob.scene().expect("the compiler's own blob");
    let views = (0..MOMENTS as u32).map(|moment| {
        let camera = camera(&scene, moment).expect("a camera");
        camera.view(&scene)
    });
    let views: Vec<_> = views.collect();
    let moments = views.iter().map(|view| scene.with_view(view));
    let moments: Vec<_> = moments.map(|seen| seen.expect("a view")).collect();
    let settings = Settings {
        samples: SAMPLES,
        ..Settings::of(&scene)
    };
    let host = scenes::picture_of(&moments, Structure::DualSplit, format, settings);
    assert!(
        program.file("blur.rgb") == host,
        "{build}: the picture differs from the host's"
    );
    let still = scenes::picture_of(&moments[..1], Structure::DualSplit, format, settings);
    assert!(host != still, "{build}: nothing moves");
    let mut figures = Figures::new();
    figures.add(&format!("blur {build}"), &report);
    figures.check();
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
            "{build}: {instructions} instructions per frame"
        );
    }
    let mut figures = Figures::new();
    figures.add(&format!("orbit {build}"), &report);
    figures.check();
}
