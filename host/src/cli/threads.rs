//! The threads of a command.

use super::failure::Failure;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// Starts threads; 0 is one for each processor.
pub fn start(count: usize) -> Result<ThreadPool, Failure> {
    ThreadPoolBuilder::new()
        .num_threads(count)
        .build()
        .map_err(|error| {
            Failure::failed(
                format!("the threads cannot be started: {error}"),
                "ask for fewer with `--threads N`, or end other programs",
            )
        })
}
