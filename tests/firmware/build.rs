//! Puts the blob that `GRIDEL_BLOB` names into flash, what it needs into constants, and the memory
//! of the board that `GRIDEL_BOARD` names before the linker.

use gridel_core::scene::part_blobs;
use gridel_core::{BlobError, Requirements, Scene, Tracks};
use std::path::PathBuf;
use std::{env, fs};

fn main() {
    println!("cargo::rerun-if-env-changed=GRIDEL_BLOB");
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    let blob = env::var("GRIDEL_BLOB")
        .expect("set GRIDEL_BLOB to the absolute path of the blob that goes into flash");
    println!("cargo::rerun-if-changed={blob}");
    let bytes = fs::read(&blob).unwrap_or_else(|error| panic!("{blob}: {error}"));

    // Checked here as the board will check it, so that a bad blob fails to compile.
    let mut aligned = vec![0_u128; bytes.len().div_ceil(size_of::<u128>())];
    let aligned: &mut [u8] = bytemuck::cast_slice_mut(&mut aligned);
    aligned[..bytes.len()].copy_from_slice(&bytes);
    let target = env::var("TARGET").expect("cargo sets TARGET");
    // Of an nRF51, and of an STM32F100.
    let interrupts = if target.starts_with("thumbv6m") {
        32
    } else {
        61
    };
    let constants = constants(&aligned[..bytes.len()], interrupts)
        .unwrap_or_else(|error| panic!("{blob}: {error}"));
    fs::write(out.join("limits.rs"), constants).expect("OUT_DIR can be written to");
    fs::write(out.join("scene.gridel"), &bytes).expect("OUT_DIR can be written to");

    println!("cargo::rerun-if-env-changed=GRIDEL_BOARD");
    if target.contains("linux") {
        return;
    }
    if target.starts_with("wasm32") {
        println!("cargo::rustc-link-arg-bins=--export=start");
        return;
    }
    let board = env::var("GRIDEL_BOARD")
        .expect("set GRIDEL_BOARD to the name of a file in src/board/memory, without `.x`");
    let memory = format!("src/board/memory/{board}.x");
    println!("cargo::rerun-if-changed={memory}");
    fs::copy(&memory, out.join("memory.x")).unwrap_or_else(|error| panic!("{memory}: {error}"));
    // No interrupt has a handler of its own.
    fs::write(out.join("device.x"), "").expect("OUT_DIR can be written to");
    println!("cargo::rustc-link-search={}", out.display());
    // Here rather than in Cargo's configuration, which RUSTFLAGS would override.
    if target.starts_with("riscv") {
        println!("cargo::rustc-link-arg-bins=-Tmemory.x");
    }
    println!("cargo::rustc-link-arg-bins=-Tlink.x");
    println!("cargo::rustc-link-arg-bins=--nmagic");
}

/// What a blob needs, as constants.
fn constants(blob: &[u8], interrupts: u32) -> Result<String, BlobError> {
    let parts: Vec<_> = part_blobs(blob)?
        .map(Scene::from_bytes)
        .collect::<Result<_, _>>()?;
    let scene = Scene::with_parts(blob, &parts)?;
    let tracks = Tracks::from_bytes(blob)?;
    let requirements = Requirements::of(blob)?;
    Ok(format!(
        "/// Entries of the traversal stack.\n\
         pub const STACK_DEPTH: usize = {};\n\
         /// Places for rays that wait.\n\
         pub const WORK_DEPTH: usize = {};\n\
         /// The effects that the scene requires.\n\
         pub const EFFECTS: u32 = {};\n\
         /// Pixels of a row.\n\
         pub const WIDTH: usize = {};\n\
         /// Vertices of all meshes.\n\
         pub const VERTICES: usize = {};\n\
         /// Pairs of the hierarchy of boxes.\n\
         pub const PAIRS: usize = {};\n\
         /// Parts of the scene.\n\
         pub const PARTS: usize = {};\n\
         /// Instances of the scene.\n\
         pub const INSTANCES: usize = {};\n\
         /// Joints on which instances hang.\n\
         pub const JOINTS: usize = {};\n\
         /// Interrupts of the board's chip.\n\
         pub const INTERRUPTS: usize = {interrupts};\n",
        scene.stack_depth(),
        scene.effects().work_depth(scene.view().depth),
        scene.effects().0,
        scene.view().width,
        requirements.vertices,
        requirements.pairs,
        parts.len(),
        scene.instances().len(),
        tracks.joints().len(),
    ))
}
