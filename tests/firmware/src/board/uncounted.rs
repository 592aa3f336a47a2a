//! Stand-ins for counters where nothing can be counted: in WebAssembly and in QEMU's user mode.

/// Counts nothing: nobody says how many instructions ran,
pub struct Counter;

impl Counter {
    /// A counter.
    pub fn calibrated() -> Self {
        Self
    }

    /// Runs a phase.
    pub fn instructions(&self, phase: impl FnOnce()) -> Option<u64> {
        phase();
        None
    }
}

/// nor how much of its stack the program took.
pub struct Paint;

impl Paint {
    /// No paint.
    pub fn spread() -> Self {
        Self
    }

    /// Nothing is known.
    pub fn deepest(&self) -> Option<usize> {
        None
    }
}
