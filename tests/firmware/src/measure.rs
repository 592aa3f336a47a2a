//! What a phase costs: instructions, and the depth of the stack.

use crate::board::Counter;
use core::hint::black_box;
use core::ptr;

/// What a phase took.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cost {
    /// Instructions.
    pub instructions: u64,
    /// Bytes of stack in use at its deepest, its callers' included.
    pub stack: usize,
}

impl Cost {
    /// The cost of one phase after the other.
    pub fn then(self, next: Self) -> Self {
        Self {
            instructions: self.instructions + next.instructions,
            stack: self.stack.max(next.stack),
        }
    }
}

/// Measures phases. Nothing may be printed inside one: that costs by the number of digits.
#[derive(Default)]
pub struct Meter {
    counter: Counter,
}

impl Meter {
    /// Runs a phase. It hands its results over by writing to variables of the caller's: moving
    /// them through here would cost stack that no product pays.
    pub fn run(&self, phase: impl FnOnce()) -> Cost {
        let painted = paint();
        let instructions = self.counter.instructions(|| apart(phase));
        let stack = stack_start() - deepest(painted);
        Cost {
            instructions,
            stack,
        }
    }
}

/// Gives a phase a frame of its own, so that the other phases' locals do not count as its stack.
#[inline(never)]
fn apart(phase: impl FnOnce()) {
    phase();
}

const PAINT: u32 = 0x5ac3_a53c;
/// Bytes that are painted: more than any phase may use.
const REACH: usize = 32 * 1024;

unsafe extern "C" {
    /// Where the stack begins; from the linker script of cortex-m-rt.
    static _stack_start: u32;
}

fn stack_start() -> usize {
    &raw const _stack_start as usize
}

/// Paints the memory below the stack pointer and returns where the paint ends.
#[inline(never)]
fn paint() -> usize {
    let here = 0_u32;
    // This frame is no larger than what is left out; a phase's own frames begin above.
    let top = (black_box(&raw const here) as usize - 64) & !3;
    for word in (top - REACH..top).step_by(4) {
        // SAFETY: memory below the stack pointer, which nothing uses.
        unsafe { ptr::write_volatile(word as *mut u32, PAINT) };
    }
    top
}

/// The lowest word that was written to since it was painted.
#[inline(never)]
fn deepest(top: usize) -> usize {
    let bottom = top - REACH;
    let deepest = (bottom..top)
        .step_by(4)
        // SAFETY: as above.
        .find(|&word| unsafe { ptr::read_volatile(word as *const u32) } != PAINT)
        .unwrap_or(top);
    assert!(deepest > bottom, "the stack grew beyond the paint");
    deepest
}
