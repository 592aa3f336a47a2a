//! Boards that scenes are built for, as data: what a program has there, how it computes best, and what it
//! costs.
//!
//! | file | what it holds |
//! |---|---|
//! | `mod.rs` | the boards: flash, RAM, number formats |
//! | `programs.json` | code and call stack of programs that were built, written by the board tests |
//! | `programs.rs` | these figures, and what bounds the others |
//! | `estimate.rs` | code and call stack of a scene's program |
//! | `memory.rs` | the memory report: what a scene takes of a board, and what remains |
//! | `advice.rs` | what makes it smaller |
//! | `instructions.rs` | instructions per ray of recorded pictures |

mod account;
mod advice;
mod estimate;
mod instructions;
mod memory;
#[doc(hidden)]
pub mod programs;

pub use account::{Account, Item};
pub use instructions::{PICTURE_COSTS, PictureCost, core_names, instructions, names};
pub use memory::{Fit, MemoryReport, NotMeasured, Sizes, Target, WORK_LIST};

use gridel_core::Format;

/// A board, as QEMU and its maker name it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Board {
    pub name: &'static str,
    /// The name of its processor core.
    pub core: &'static str,
    /// The Rust target of its core.
    pub target: &'static str,
    /// Bytes of flash for a program.
    pub flash: u64,
    /// Bytes of RAM.
    pub ram: u64,
    /// The number formats that it computes without soft floats, the best first.
    pub formats: &'static [Format],
}

const KIB: u64 = 1 << 10;
const MIB: u64 = 1 << 20;

/// All boards, the smallest first.
pub const BOARDS: [Board; 7] = [
    Board {
        name: "stm32vldiscovery",
        core: "Cortex-M3",
        target: "thumbv7m-none-eabi",
        flash: 128 * KIB,
        ram: 8 * KIB,
        formats: &[Format::Fixed],
    },
    Board {
        name: "microbit",
        core: "Cortex-M0",
        target: "thumbv6m-none-eabi",
        flash: 256 * KIB,
        ram: 16 * KIB,
        formats: &[Format::Fixed],
    },
    Board {
        name: "sifive_e",
        core: "RV32IMAC",
        target: "riscv32imac-unknown-none-elf",
        flash: 12 * MIB,
        ram: 16 * KIB,
        formats: &[Format::Fixed],
    },
    Board {
        name: "mps2-an385",
        core: "Cortex-M3",
        target: "thumbv7m-none-eabi",
        flash: 4 * MIB,
        ram: 4 * MIB,
        formats: &[Format::Fixed],
    },
    Board {
        name: "mps2-an386",
        core: "Cortex-M4F",
        target: "thumbv7em-none-eabihf",
        flash: 4 * MIB,
        ram: 4 * MIB,
        formats: &[Format::F32, Format::Fixed],
    },
    Board {
        name: "mps2-an500",
        core: "Cortex-M7",
        target: "thumbv7em-none-eabihf",
        flash: 4 * MIB,
        ram: 4 * MIB,
        formats: &[Format::F32, Format::Fixed, Format::F64],
    },
    Board {
        name: "mps2-an505",
        core: "Cortex-M33F",
        target: "thumbv8m.main-none-eabihf",
        flash: 4 * MIB,
        ram: 2 * MIB,
        formats: &[Format::F32, Format::Fixed],
    },
];

impl Board {
    /// The board of a name.
    pub fn named(name: &str) -> Option<&'static Self> {
        BOARDS.iter().find(|board| board.name == name)
    }

    /// The board and number format on which parts and structures were measured, each alone: these, or
    /// those of a similar core.
    pub fn similar(&self, format: Format) -> (&'static Self, Format) {
        let [m3, m0, risc_v, _, m4f, _, _] = &BOARDS;
        match (self.target, format) {
            (_, Format::F32 | Format::F64) => (m4f, Format::F32),
            ("thumbv6m-none-eabi", Format::Fixed) => (m0, Format::Fixed),
            ("riscv32imac-unknown-none-elf", Format::Fixed) => (risc_v, Format::Fixed),
            (_, Format::Fixed) => (m3, Format::Fixed),
        }
    }

    /// The number format to use where none is asked for.
    pub fn format(&self) -> Format {
        self.formats[0]
    }
}
