//! A program of Linux, for processors that boards without an operating system do not show: run by
//! QEMU's user mode, which counts nothing.

extern crate std;

use core::ffi::CStr;
use std::io::Write;

/// Prints text.
pub fn print(text: &str) {
    std::print!("{text}");
}

/// A file in the current folder.
pub struct File(std::fs::File);

impl File {
    /// Creates a file, or empties it.
    pub fn create(name: &CStr) -> Option<Self> {
        std::fs::File::create(name.to_str().ok()?).ok().map(Self)
    }

    /// Writes bytes, all or none. Returns whether it did.
    pub fn write(&self, bytes: &[u8]) -> bool {
        (&self.0).write_all(bytes).is_ok()
    }
}

/// Ends the program.
pub fn exit(code: u8) -> ! {
    std::process::exit(code.into())
}
