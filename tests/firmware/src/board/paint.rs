//! Measures the depth of the stack: the memory below it is painted, and checked afterwards.

use core::hint::black_box;
use core::ptr;

unsafe extern "C" {
    /// The start of the stack, and the limit that it must not reach, from the linker scripts of cortex-m-rt and
    /// riscv-rt alike.
    static _stack_start: u32;
    static __sheap: u32;
}

const PAINT: u32 = 0x5ac3_a53c;
/// Bytes that are painted at most: more than any phase uses.
const REACH: usize = 32 * 1024;

/// Painted memory below the stack pointer.
pub struct Paint {
    bottom: usize,
    top: usize,
}

impl Paint {
    /// Paints what is free.
    #[inline(never)]
    pub fn spread() -> Self {
        let here = 0_u32;
        // This frame is no larger than what is left out; a phase's own frames begin above.
        let top = (black_box(&raw const here) as usize).wrapping_sub(64) & !3;
        let free = &raw const __sheap as usize;
        let bottom = free.max(top.saturating_sub(REACH));
        for word in (bottom..top).step_by(4) {
            // SAFETY: memory between the statics and the stack, which nothing uses.
            unsafe { ptr::write_volatile(word as *mut u32, PAINT) };
        }
        Self { bottom, top }
    }

    /// Bytes of stack in use when it was deepest since then, the callers' included.
    #[inline(never)]
    pub fn deepest(&self) -> Option<usize> {
        let mut deepest = self.bottom;
        // SAFETY: as above.
        while deepest < self.top && unsafe { ptr::read_volatile(deepest as *const u32) } == PAINT {
            deepest = deepest.wrapping_add(4);
        }
        Some((&raw const _stack_start as usize).wrapping_sub(deepest))
    }
}
