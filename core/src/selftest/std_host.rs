//! A machine with an operating system, as a host of the tests.

use crate::selftest::Host;
use core::ffi::CStr;
use core::fmt;
use std::path::PathBuf;

/// Prints to standard output and saves to the folder for temporary files.
#[derive(Clone, Copy, Debug, Default)]
pub struct StdHost;

impl Host for StdHost {
    fn print(&mut self, line: fmt::Arguments<'_>) {
        println!("{line}");
    }

    fn save(&mut self, name: &CStr, bytes: &[u8]) {
        let path: PathBuf = std::env::temp_dir().join(name.to_string_lossy().as_ref());
        match std::fs::write(&path, bytes) {
            Ok(()) => println!("  saved {}", path.display()),
            Err(error) => println!("  not saved, {}: {error}", path.display()),
        }
    }
}

#[test]
fn all_tests_pass_on_this_machine() {
    assert_eq!(crate::selftest::run(&mut StdHost), 0);
}
