//! WebAssembly. The host brings what the module imports: see `run.mjs`.

use core::ffi::CStr;

#[link(wasm_import_module = "gridel")]
unsafe extern "C" {
    fn print_bytes(text: *const u8, length: usize);
    fn create_file(name: *const u8, length: usize);
    fn write_file(bytes: *const u8, length: usize);
    fn end(code: u32) -> !;
}

/// Prints text on the host.
pub fn print(text: &str) {
    // SAFETY: the host reads as many bytes as the text has.
    unsafe { print_bytes(text.as_ptr(), text.len()) }
}

/// A file of the host: one at a time.
pub struct File;

impl File {
    /// Creates a file, or empties it.
    pub fn create(name: &CStr) -> Option<Self> {
        // SAFETY: the host reads as many bytes as the name has.
        unsafe { create_file(name.as_ptr().cast(), name.count_bytes()) }
        Some(Self)
    }

    /// Writes bytes; the host ends the program if it cannot.
    pub fn write(&self, bytes: &[u8]) -> bool {
        // SAFETY: the host reads as many bytes as there are.
        unsafe { write_file(bytes.as_ptr(), bytes.len()) }
        true
    }
}

/// Ends the program.
pub fn exit(code: u8) -> ! {
    // SAFETY: the host throws, and so does not return.
    unsafe { end(code.into()) }
}
