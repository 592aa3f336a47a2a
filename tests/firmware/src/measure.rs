//! Costs of a phase: instructions, and the depth of the stack.

use crate::board::{Counter, Paint};

/// The costs of a phase; `None` where the board cannot count.
#[derive(Clone, Copy, Debug)]
pub struct Cost {
    /// Instructions.
    pub instructions: Option<u64>,
    /// Bytes of stack in use at its deepest, its callers' included.
    pub stack: Option<usize>,
}

impl Cost {
    /// The cost of nothing.
    pub const NONE: Self = Self {
        instructions: Some(0),
        stack: Some(0),
    };

    /// Each one's share of the instructions.
    pub fn each(self, number: u32) -> Self {
        let share = |all: u64| all.checked_div(number.into()).unwrap_or(0);
        Self {
            instructions: self.instructions.map(share),
            ..self
        }
    }

    /// Returns the instructions by which this exceeds another.
    pub fn beyond(self, other: Self) -> Self {
        let instructions = self.instructions.zip(other.instructions);
        Self {
            instructions: instructions.map(|(all, part)| all.saturating_sub(part)),
            ..self
        }
    }

    /// The cost of one phase after the other.
    pub fn then(self, next: Self) -> Self {
        let instructions = self.instructions.zip(next.instructions);
        Self {
            instructions: instructions.map(|(first, second)| first.wrapping_add(second)),
            stack: self
                .stack
                .zip(next.stack)
                .map(|(first, second)| first.max(second)),
        }
    }
}

/// Measures phases. Nothing may be printed inside one.
pub struct Meter {
    counter: Counter,
}

impl Meter {
    /// Starts to measure.
    #[expect(clippy::new_without_default, reason = "it starts a timer")]
    pub fn new() -> Self {
        Self {
            counter: Counter::calibrated(),
        }
    }

    /// Runs a phase. It hands its results over by writing to variables of the caller's: moving
    /// them through here would cost stack that no product pays.
    pub fn run(&self, phase: impl FnOnce()) -> Cost {
        let paint = Paint::spread();
        let instructions = self.counter.instructions(|| apart(phase));
        Cost {
            instructions,
            stack: paint.deepest(),
        }
    }
}

/// Gives a phase a frame of its own, so that the other phases' locals do not count as its stack.
#[inline(never)]
fn apart(phase: impl FnOnce()) {
    phase();
}
