//! Compiles tinybvh if its header is found.

use std::path::PathBuf;

fn main() {
    println!("cargo::rerun-if-env-changed=TINYBVH");
    println!("cargo::rerun-if-changed=src/tinybvh.cpp");
    println!("cargo::rerun-if-changed=tiny_bvh.h");
    let folder = std::env::var_os("TINYBVH").map_or_else(|| PathBuf::from("."), PathBuf::from);
    if !folder.join("tiny_bvh.h").exists() {
        return;
    }
    cc::Build::new()
        .cpp(true)
        .std("c++20")
        .opt_level(3)
        .flags(["-mavx2", "-mfma", "-mbmi", "-mbmi2", "-mlzcnt", "-mpopcnt"])
        .warnings(false)
        .include(folder)
        .file("src/tinybvh.cpp")
        .compile("tinybvh");
    println!("cargo::rustc-cfg=tinybvh");
}
