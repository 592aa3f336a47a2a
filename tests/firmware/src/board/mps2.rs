//! Arm MPS2 boards. QEMU with `-icount` advances the clock by a fixed time an instruction, so
//! SysTick counts instructions, in a ratio that [`Counter::take`] measures.

use core::arch::asm;
use cortex_m::Peripherals;
use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;

/// Counts instructions.
pub struct Counter {
    timer: SYST,
    /// Ticks that [`CALIBRATION`] instructions take.
    ticks: u32,
    /// Ticks of a phase without content.
    idle: u32,
}

/// Instructions of the loop that calibrates the counter.
const CALIBRATION: u32 = 4_000_000;
/// Where the timer starts to count down: its largest value.
const RELOAD: u32 = 0x00ff_ffff;

impl Counter {
    /// Takes the timer and calibrates it. There is one, so the second call fails.
    pub fn take() -> Option<Self> {
        let mut timer = Peripherals::take()?.SYST;
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(RELOAD);
        timer.enable_counter();
        let mut counter = Self {
            timer,
            ticks: 0,
            idle: 0,
        };
        counter.idle = counter.ticks_of(|| ());
        counter.ticks = counter.ticks_of(|| count_down(CALIBRATION / 2));
        Some(counter)
    }

    /// Runs a phase and returns the instructions that it took, to within a tick.
    pub fn instructions(&mut self, phase: impl FnOnce()) -> u64 {
        u64::from(self.ticks_of(phase)) * u64::from(CALIBRATION) / u64::from(self.ticks)
    }

    fn ticks_of(&mut self, phase: impl FnOnce()) -> u32 {
        self.timer.clear_current();
        // The timer reloads with its next tick.
        while SYST::get_current() == 0 {}
        let start = SYST::get_current();
        phase();
        let end = SYST::get_current();
        assert!(
            !self.timer.has_wrapped(),
            "the phase is too long for the timer"
        );
        (start - end).saturating_sub(self.idle)
    }
}

/// Two instructions a round.
#[inline(never)]
fn count_down(rounds: u32) {
    // SAFETY: changes nothing but the register that is named as an output, and the flags.
    unsafe {
        asm!("2:", "subs {rounds}, #1", "bne 2b", rounds = inout(reg) rounds => _);
    }
}
