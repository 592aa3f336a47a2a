//! The boards: how each counts instructions, and how it talks to the host.
//!
//! | file | what is in it |
//! |---|---|
//! | `memory/BOARD.x` | the board's flash and RAM, for the linker |
//! | `cortex_m.rs`, `riscv.rs` | the counter of a family of cores |
//! | `paint.rs` | how deep the stack grew |
//! | `semihost.rs` | files, text and the end of the program, through QEMU |
//! | `wasm.rs`, `linux.rs` | the same for WebAssembly, and for a process of Linux |
//! | `uncounted.rs` | what stands in for counter and paint there |

#[cfg(target_arch = "arm")]
mod cortex_m;
#[cfg(target_os = "linux")]
mod linux;
#[cfg(target_os = "none")]
mod paint;
#[cfg(target_arch = "riscv32")]
mod riscv;
#[cfg(target_os = "none")]
mod semihost;
#[cfg(not(target_os = "none"))]
mod uncounted;
#[cfg(target_arch = "wasm32")]
mod wasm;

#[cfg(target_arch = "arm")]
pub use cortex_m::Counter;
#[cfg(target_os = "linux")]
pub use linux::{File, exit, print};
#[cfg(target_os = "none")]
pub use paint::Paint;
#[cfg(target_arch = "riscv32")]
pub use riscv::Counter;
#[cfg(target_os = "none")]
pub use semihost::{File, exit, print};
#[cfg(not(target_os = "none"))]
pub use uncounted::{Counter, Paint};
#[cfg(target_arch = "wasm32")]
pub use wasm::{File, exit, print};
