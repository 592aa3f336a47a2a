//! Threads that work is spread over.

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::mem;
use std::num::NonZeroUsize;
use std::process;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

/// Calls a function without the GIL, in a pool of so many threads; 0 for one per core.
///
/// None of its work may be spread over rayon's own pool, which a fork of the process does not have.
pub fn in_pool<T: Send>(
    py: Python<'_>,
    threads: usize,
    work: impl FnOnce() -> T + Send,
) -> PyResult<T> {
    let pool = kept(py, threads)?;
    Ok(py.detach(|| pool.install(work)))
}

/// How many threads [`in_pool`] works with.
pub fn workers(threads: usize) -> usize {
    match threads {
        0 => thread::available_parallelism().map_or(1, NonZeroUsize::get),
        _ => threads,
    }
}

/// A pool that is kept for the next call.
struct Kept {
    /// The process whose threads it has.
    process: u32,
    /// As it was asked for: 0 for one per core.
    threads: usize,
    pool: Arc<ThreadPool>,
}

/// Returns the pool of this process with so many threads. One with a thread per core is kept for good, and one of
/// another size until a call asks for a third size.
///
/// A fork of the process has none of its threads, and makes pools of its own. Whoever holds the lock has the GIL, and so
/// has whoever forks: no fork begins with the lock held.
fn kept(_: Python<'_>, threads: usize) -> PyResult<Arc<ThreadPool>> {
    static POOLS: Mutex<[Option<Kept>; 2]> = Mutex::new([const { None }; 2]);
    let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    let place = &mut pools[usize::from(threads != 0)];
    let process = process::id();
    if let Some(kept) = place
        && (kept.process, kept.threads) == (process, threads)
    {
        return Ok(Arc::clone(&kept.pool));
    }
    let pool = Arc::new(pool(threads)?);
    let before = place.replace(Kept {
        process,
        threads,
        pool: Arc::clone(&pool),
    });
    if let Some(before) = before.filter(|it| it.process != process) {
        // The threads of another process cannot be ended from here.
        mem::forget(before);
    }
    Ok(pool)
}

fn pool(threads: usize) -> PyResult<ThreadPool> {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|error| {
        PyRuntimeError::new_err(format!(
            "the threads cannot be started: {error}; ask for fewer with `threads`"
        ))
    })
}
