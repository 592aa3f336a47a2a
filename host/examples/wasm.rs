//! Compiles a scene from bytes in WebAssembly, without files, threads or a clock:
//!
//! ```text
//! cargo build --example wasm --target wasm32-unknown-unknown
//! ```
//!
//! `.ci/run` runs it in Node, and compares the blob with the program's.

use gridel_host::blob::Blob;
use gridel_host::compile::{Options, compile};
use gridel_host::scene::{ImportOptions, read};
use std::sync::OnceLock;

static FILE: &[u8] = include_bytes!("../scenes/quick.toml");

fn blob() -> &'static [u8] {
    static BLOB: OnceLock<Option<Blob>> = OnceLock::new();
    let compiled = BLOB.get_or_init(|| {
        let file = FILE.to_vec();
        let imported = read("quick.toml".as_ref(), file, &ImportOptions::default()).ok()?;
        let options = Options {
            names: true,
            ..Options::default()
        };
        Some(compile(&imported.scene, &options).ok()?.blob)
    });
    compiled.as_ref().map_or(&[], Blob::bytes)
}

/// Returns the number of bytes of the blob; 0 if the scene does not compile.
// SAFETY: no other function of the module has this name.
#[unsafe(no_mangle)]
pub extern "C" fn blob_length() -> usize {
    blob().len()
}

/// Returns the address of the blob.
// SAFETY: no other function of the module has this name.
#[unsafe(no_mangle)]
pub extern "C" fn blob_address() -> *const u8 {
    blob().as_ptr()
}
