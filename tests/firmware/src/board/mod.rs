//! The boards: how each counts instructions, and how it talks to the host.
//!
//! | file | what is in it |
//! |---|---|
//! | `memory/BOARD.x` | the board's flash and RAM, for the linker |
//! | `cortex_m.rs`, `riscv.rs` | the counter of a family of cores |
//! | `paint.rs` | how deep the stack grew |
//! | `semihost.rs` | files, text and the end of the program, through QEMU |
//! | `wasm.rs` | all of this for WebAssembly, where nothing can be counted |

#[cfg(target_arch = "arm")]
mod cortex_m;
#[cfg(not(target_arch = "wasm32"))]
mod paint;
#[cfg(target_arch = "riscv32")]
mod riscv;
#[cfg(not(target_arch = "wasm32"))]
mod semihost;
#[cfg(target_arch = "wasm32")]
mod wasm;

#[cfg(target_arch = "arm")]
pub use cortex_m::Counter;
#[cfg(not(target_arch = "wasm32"))]
pub use paint::Paint;
#[cfg(target_arch = "riscv32")]
pub use riscv::Counter;
#[cfg(not(target_arch = "wasm32"))]
pub use semihost::{File, exit, print};
#[cfg(target_arch = "wasm32")]
pub use wasm::{Counter, File, Paint, exit, print};
