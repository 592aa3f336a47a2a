//! The program `gridel`: compiles scenes, inspects blobs, renders, traces and compares.

mod cli;

use peak_alloc::PeakAlloc;

/// Knows at every moment how much memory is in use, for `gridel compare`.
#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

fn main() -> std::process::ExitCode {
    cli::run(&MEMORY)
}
