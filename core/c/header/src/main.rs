//! Writes `gridel.h` from the declarations of the C library, or with `--check` fails where the committed header is another.

use std::path::Path;
use std::process::ExitCode;
use std::{env, fs};

/// The section that Rust wants for each function. The header's first comment says it, for all of them.
const SAFETY: &str = "//
// # Safety
// Each pointer is null, or points to what its type states.
";

fn main() -> ExitCode {
    let library = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let config =
        cbindgen::Config::from_file(library.join("cbindgen.toml")).expect("cbindgen.toml is valid");
    let bindings = cbindgen::Builder::new()
        .with_config(config)
        .with_src(library.join("src/lib.rs"))
        .generate()
        .expect("the declarations are valid");
    let mut text = Vec::new();
    bindings.write(&mut text);
    let text = String::from_utf8(text).expect("cbindgen writes UTF-8");
    let text = text.replace(SAFETY, "");
    let header = library.join("include/gridel.h");
    if env::args().any(|argument| argument == "--check") {
        if fs::read_to_string(&header).is_ok_and(|committed| committed == text) {
            return ExitCode::SUCCESS;
        }
        eprintln!(
            "include/gridel.h is not that of the declarations: run `cargo run` in core/c/header"
        );
        return ExitCode::FAILURE;
    }
    fs::write(&header, text).expect("the header can be written to");
    ExitCode::SUCCESS
}
