//! Puts the blob that `GRIDEL_BLOB` names into flash, what it needs into constants, and the memory
//! of the board that `GRIDEL_BOARD` names before the linker.

use gridel_constants::constants;
use std::path::PathBuf;
use std::{env, fs};

fn main() {
    println!("cargo::rerun-if-env-changed=GRIDEL_BLOB");
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    let blob = env::var("GRIDEL_BLOB")
        .expect("set GRIDEL_BLOB to the absolute path of the blob that goes into flash");
    println!("cargo::rerun-if-changed={blob}");
    let bytes = fs::read(&blob).unwrap_or_else(|error| panic!("{blob}: {error}"));

    let target = env::var("TARGET").expect("cargo sets TARGET");
    // Of an nRF51, and of an STM32F100.
    let interrupts = if target.starts_with("thumbv6m") {
        32
    } else {
        61
    };
    // Checked here as the board will check it, so that a bad blob fails to compile.
    let constants = constants(&bytes).unwrap_or_else(|error| panic!("{blob}: {error}"));
    let constants = format!(
        "{constants}/// Interrupts of the board's chip.\npub const INTERRUPTS: usize = {interrupts};\n"
    );
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
