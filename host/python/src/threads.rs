//! Threads that work is spread over.

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::num::NonZeroUsize;
use std::process;
use std::sync::{Mutex, PoisonError};
use std::thread;

/// Calls a function without the GIL, in a pool of so many threads; 0 for one per core.
///
/// None of its work may be spread over rayon's own pool, which a fork of the process does not have.
pub fn in_pool<T: Send>(
    py: Python<'_>,
    threads: usize,
    work: impl FnOnce() -> T + Send,
) -> PyResult<T> {
    if threads == 0 {
        let pool = shared(py)?;
        return Ok(py.detach(|| pool.install(work)));
    }
    let pool = pool(threads)?;
    Ok(py.detach(|| pool.install(work)))
}

/// How many threads [`in_pool`] works with.
pub fn workers(threads: usize) -> usize {
    match threads {
        0 => thread::available_parallelism().map_or(1, NonZeroUsize::get),
        _ => threads,
    }
}

/// The pool of this process, with one thread per core.
///
/// A fork of the process has none of its threads, and makes a pool of its own. Whoever holds the lock has the GIL, and so
/// has whoever forks: no fork begins with the lock held.
fn shared(_: Python<'_>) -> PyResult<&'static ThreadPool> {
    static SHARED: Mutex<Option<(u32, &ThreadPool)>> = Mutex::new(None);
    let mut shared = SHARED.lock().unwrap_or_else(PoisonError::into_inner);
    let process = process::id();
    if let Some((owner, pool)) = *shared
        && owner == process
    {
        return Ok(pool);
    }
    // Never dropped: the threads of another process cannot be ended from here.
    let pool = Box::leak(Box::new(pool(0)?));
    *shared = Some((process, pool));
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
