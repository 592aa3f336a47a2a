//! Behavior of the program at the system's limits of memory and file sizes.

use gridel_host::output::unfinished;
use peak_alloc::PeakAlloc;
use std::alloc::{GlobalAlloc, Layout};
use std::cell::Cell;
use std::io::{self, Write};

/// An allocator that knows how much memory is in use. Where there is no more, it ends the program with an error.
pub struct Memory(pub PeakAlloc);

thread_local! {
    /// True if this thread is ending the program.
    static IS_ENDING: Cell<bool> = const { Cell::new(false) };
}

/// Returns the memory; ends the program if it is null.
fn checked(memory: *mut u8, layout: Layout) -> *mut u8 {
    // What ending the program needs may be missing, too; then it aborts.
    if memory.is_null() && !IS_ENDING.replace(true) {
        let _ = writeln!(
            io::stderr(),
            "  × there is not enough memory: {} more bytes are needed at once\n  help: let the program use more, or \
             choose a smaller scene, another structure, fewer rays or fewer pixels",
            layout.size()
        );
        unfinished::exit_without_memory(1);
    }
    memory
}

// SAFETY: all memory is that of `PeakAlloc`, under the same conditions.
unsafe impl GlobalAlloc for Memory {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller's conditions are those of `PeakAlloc`; likewise below.
        checked(unsafe { self.0.alloc(layout) }, layout)
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { self.0.dealloc(memory, layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as above.
        checked(unsafe { self.0.alloc_zeroed(layout) }, layout)
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as above.
        let moved = unsafe { self.0.realloc(memory, layout, size) };
        checked(
            moved,
            Layout::from_size_align(size, layout.align()).unwrap_or(layout),
        )
    }
}

/// Lets writing beyond the largest size of a file fail, where the system would end the program otherwise.
pub fn keep_file_size_limits() {
    #[cfg(unix)]
    {
        use nix::sys::signal::{SigHandler, Signal, signal};
        // SAFETY: ignoring a signal calls no code.
        let _ = unsafe { signal(Signal::SIGXFSZ, SigHandler::SigIgn) };
    }
}
