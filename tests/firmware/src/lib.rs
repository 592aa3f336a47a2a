//! What the firmware's programs share: the scene in flash, the board, and measuring on it.
//!
//! | program | what it does |
//! |---|---|
//! | `picture` | renders the scene's picture into a file of the host |
//! | `primary` | traces one ray a pixel and counts the hits |
//! | `selftest` | runs the core's own tests |
//! | `bare` | renders and talks to nobody: what it links is what a product would flash |
//! | `example` | the README's example |
//!
//! All but the last two run in QEMU and print what they measured, a line each: a name and a number.
//! Blob, number format and structure are chosen when they are built:
//!
//! ```text
//! GRIDEL_BLOB=/path/to/scene.gridel cargo run --release --target thumbv7em-none-eabihf \
//!     --features f32,dual-split --bin picture
//! ```
#![no_std]

pub mod board;
pub mod measure;
pub mod scene;

use core::panic::PanicInfo;

/// Ends the program with a message and a failure; for the programs' panic handlers.
pub fn give_up(info: &PanicInfo<'_>) -> ! {
    semihosting::eprintln!("{info}");
    semihosting::process::exit(101)
}
