//! RISC-V boards. QEMU with `-icount shift=0` counts instructions in `minstret`, exactly.

use core::arch::asm;

/// Counts instructions.
pub struct Counter {
    /// Instructions of a phase without content.
    idle: u64,
}

impl Counter {
    /// Finds out what counting itself takes.
    pub fn calibrated() -> Self {
        Self {
            idle: instructions_of(|| ()),
        }
    }

    /// Runs a phase and returns the instructions that it took.
    pub fn instructions(&self, phase: impl FnOnce()) -> Option<u64> {
        Some(instructions_of(phase).saturating_sub(self.idle))
    }
}

fn instructions_of(phase: impl FnOnce()) -> u64 {
    let start = retired();
    phase();
    retired().wrapping_sub(start)
}

/// Instructions since the core was reset.
fn retired() -> u64 {
    loop {
        let (high, low, again): (u32, u32, u32);
        // SAFETY: reads counters that every RV32 core has in machine mode.
        unsafe {
            asm!(
                "csrr {high}, minstreth", "csrr {low}, minstret", "csrr {again}, minstreth",
                high = out(reg) high, low = out(reg) low, again = out(reg) again,
                options(nomem, nostack)
            );
        }
        if high == again {
            return u64::from(high) << 32 | u64::from(low);
        }
    }
}
