//! Cortex-M boards. QEMU with `-icount` advances the clock by a fixed time an instruction, so the
//! core's SysTick counts instructions, in a ratio that [`Counter::calibrated`] measures.

use crate::report::fail;
use core::arch::asm;
use core::ptr;

/// SysTick's registers (Armv7-M Architecture Reference Manual, B3.3.2; Armv6-M's and Armv8-M's
/// are the same).
const CONTROL: *mut u32 = 0xe000_e010 as *mut u32;
const RELOAD: *mut u32 = 0xe000_e014 as *mut u32;
const CURRENT: *mut u32 = 0xe000_e018 as *mut u32;
/// Control: runs, by the core's clock, without interrupts.
const RUN: u32 = 1 << 2 | 1;
/// Control: the timer has reached 0 since it was last asked.
const WRAPPED: u32 = 1 << 16;
/// The value from which the timer counts down: its largest value.
const START: u32 = 0x00ff_ffff;

/// Instructions of the loop that calibrates the counter.
const CALIBRATION: u32 = 4_000_000;

/// Counts instructions.
pub struct Counter {
    /// Ticks that [`CALIBRATION`] instructions take.
    ticks: u32,
    /// Ticks of a phase without content.
    idle: u32,
}

impl Counter {
    /// Starts the timer and calibrates it.
    pub fn calibrated() -> Self {
        write(RELOAD, START);
        write(CONTROL, RUN);
        let (Some(idle), Some(ticks)) = (ticks_of(|| ()), ticks_of(|| count_down(CALIBRATION / 2)))
        else {
            fail("the timer is too fast")
        };
        let ticks = ticks.saturating_sub(idle);
        Self { ticks, idle }
    }

    /// Runs a phase and returns the instructions that it took, to within a few; `None` where it was
    /// too long for the timer.
    pub fn instructions(&self, phase: impl FnOnce()) -> Option<u64> {
        let ticks = ticks_of(phase)?.saturating_sub(self.idle);
        (u64::from(ticks) * u64::from(CALIBRATION)).checked_div(self.ticks.into())
    }
}

/// Ticks of a phase, of the call and the reading too.
fn ticks_of(phase: impl FnOnce()) -> Option<u32> {
    // Clears the timer and the mark that it has reached 0; it reloads with its next tick.
    write(CURRENT, 0);
    while read(CURRENT) == 0 {}
    let start = read(CURRENT);
    phase();
    let end = read(CURRENT);
    (read(CONTROL) & WRAPPED == 0).then_some(start.wrapping_sub(end))
}

/// Counts down, two instructions per round.
#[inline(never)]
fn count_down(rounds: u32) {
    // SAFETY: changes nothing but the register that is named as an output, and the flags.
    unsafe {
        asm!("2:", "subs {rounds}, {rounds}, #1", "bne 2b", rounds = inout(reg) rounds => _);
    }
}

fn read(register: *mut u32) -> u32 {
    // SAFETY: only called with SysTick's registers, which every Armv7-M core has.
    unsafe { ptr::read_volatile(register) }
}

fn write(register: *mut u32, value: u32) {
    // SAFETY: as above, and nothing else uses the timer.
    unsafe { ptr::write_volatile(register, value) }
}
