//! Runs the core's own tests on the board.
#![no_std]
#![no_main]

use core::ffi::CStr;
use core::fmt;
use core::panic::PanicInfo;
use gridel_core::selftest;
use gridel_core::selftest::Host;
use gridel_firmware::rt::entry;
use semihosting::fs::File;
use semihosting::io::Write;
use semihosting::{eprintln, println};

/// The machine at the other end of semihosting.
struct Semihost;

impl Host for Semihost {
    fn print(&mut self, line: fmt::Arguments<'_>) {
        println!("{line}");
    }

    fn save(&mut self, name: &CStr, bytes: &[u8]) {
        let saved = File::create(name).and_then(|mut file| file.write_all(bytes));
        if saved.is_err() {
            eprintln!("  not saved: {name:?}");
        }
    }
}

#[entry]
fn main() -> ! {
    let failed = selftest::run(&mut Semihost);
    semihosting::process::exit(i32::from(failed > 0))
}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    eprintln!("{info}");
    semihosting::process::exit(101)
}
