//! The program `gridel`: compiles scenes, inspects blobs, renders, traces and compares.

mod cli;
mod system;

use peak_alloc::PeakAlloc;

/// Knows at every moment how much memory is in use, for `gridel compare`.
#[global_allocator]
static MEMORY: system::Memory = system::Memory(PeakAlloc);

fn main() -> std::process::ExitCode {
    system::keep_file_size_limits();
    cli::run(&MEMORY.0)
}
