//! Boards that scenes are built for, as data: the memory for a program, the best number format, and the costs.
//!
//! | file | what it holds |
//! |---|---|
//! | `mod.rs` | the boards: flash, RAM, number formats |
//! | `programs.json` | code and call stack of programs that were built, written by the board tests |
//! | `programs.rs` | these figures, and what bounds the others |
//! | `estimate.rs` | code and call stack of a scene's program |
//! | `memory.rs` | the memory report: what a scene takes of a board, and what remains |
//! | `account.rs` | flash or RAM, item by item |
//! | `rendering.rs` | the format, structure and width that a report holds for |
//! | `working.rs` | RAM of parts, of meshes that deform, and of instances that move |
//! | `text.rs` | the memory report as text |
//! | `advice.rs` | what makes it smaller |
//! | `bounds.rs` | upper bounds of programs that were not built |
//! | `instructions.rs` | instructions per ray of recorded pictures |

mod account;
mod advice;
mod bounds;
mod estimate;
mod instructions;
mod memory;
#[doc(hidden)]
pub mod programs;
mod rendering;
mod text;
mod working;

pub use account::{Account, Item};
pub use instructions::{PICTURE_COSTS, PictureCost, core_names, instructions, names};
pub use memory::{Fit, MemoryReport, NOT_BUILT, NotMeasured, Sizes, Target, WORK_LIST};
pub use rendering::Rendering;
pub use working::{WorkingRow, working_bytes, working_rows};

use gridel_core::Format;

/// A board, as QEMU or its maker names it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Board {
    pub name: &'static str,
    /// The name of its processor core.
    pub core: &'static str,
    /// The board that QEMU emulates, on whose core programs were built and measured: the board itself, or one with a
    /// core of the same kind.
    pub measured: &'static str,
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

/// All boards: those that QEMU plays, the smallest first, then microcontrollers and their usual modules.
///
/// Flash of an RP2040, an RP2350 and an ESP32 is a separate chip. Its size is that of a Raspberry Pi Pico, a Pico 2,
/// and the smallest usual module. RAM is the size of one address range: the AXI SRAM of an STM32H743, and what the
/// cache of an ESP32-C3 leaves. A Wi-Fi or Bluetooth stack takes RAM of its own.
pub const BOARDS: [Board; 15] = [
    Board {
        name: "stm32vldiscovery",
        core: "Cortex-M3",
        measured: "stm32vldiscovery",
        target: "thumbv7m-none-eabi",
        flash: 128 * KIB,
        ram: 8 * KIB,
        formats: &[Format::Fixed],
    },
    Board {
        name: "microbit",
        core: "Cortex-M0",
        measured: "microbit",
        target: "thumbv6m-none-eabi",
        flash: 256 * KIB,
        ram: 16 * KIB,
        formats: &[Format::Fixed],
    },
    Board {
        name: "sifive_e",
        core: "RV32IMAC",
        measured: "sifive_e",
        target: "riscv32imac-unknown-none-elf",
        flash: 12 * MIB,
        ram: 16 * KIB,
        formats: &[Format::Fixed],
    },
    Board {
        name: "mps2-an385",
        core: "Cortex-M3",
        measured: "mps2-an385",
        target: "thumbv7m-none-eabi",
        flash: 4 * MIB,
        ram: 4 * MIB,
        formats: &[Format::Fixed],
    },
    Board {
        name: "mps2-an386",
        core: "Cortex-M4F",
        measured: "mps2-an386",
        target: "thumbv7em-none-eabihf",
        flash: 4 * MIB,
        ram: 4 * MIB,
        formats: &[Format::F32, Format::Fixed],
    },
    Board {
        name: "mps2-an500",
        core: "Cortex-M7",
        measured: "mps2-an500",
        target: "thumbv7em-none-eabihf",
        flash: 4 * MIB,
        ram: 4 * MIB,
        formats: &[Format::F32, Format::Fixed, Format::F64],
    },
    Board {
        name: "mps2-an505",
        core: "Cortex-M33F",
        measured: "mps2-an505",
        target: "thumbv8m.main-none-eabihf",
        flash: 4 * MIB,
        ram: 2 * MIB,
        formats: &[Format::F32, Format::Fixed],
    },
    Board {
        name: "rp2040",
        core: "Cortex-M0+",
        measured: "microbit",
        target: "thumbv6m-none-eabi",
        flash: 2 * MIB,
        ram: 264 * KIB,
        formats: &[Format::Fixed],
    },
    Board {
        name: "rp2350",
        core: "Cortex-M33F",
        measured: "mps2-an505",
        target: "thumbv8m.main-none-eabihf",
        flash: 4 * MIB,
        ram: 520 * KIB,
        formats: &[Format::F32, Format::Fixed],
    },
    Board {
        name: "rp2350-riscv",
        core: "Hazard3 (RV32IMAC)",
        measured: "sifive_e",
        target: "riscv32imac-unknown-none-elf",
        flash: 4 * MIB,
        ram: 520 * KIB,
        formats: &[Format::Fixed],
    },
    Board {
        name: "nrf52840",
        core: "Cortex-M4F",
        measured: "mps2-an386",
        target: "thumbv7em-none-eabihf",
        flash: MIB,
        ram: 256 * KIB,
        formats: &[Format::F32, Format::Fixed],
    },
    Board {
        name: "stm32f411",
        core: "Cortex-M4F",
        measured: "mps2-an386",
        target: "thumbv7em-none-eabihf",
        flash: 512 * KIB,
        ram: 128 * KIB,
        formats: &[Format::F32, Format::Fixed],
    },
    Board {
        name: "stm32h743",
        core: "Cortex-M7",
        measured: "mps2-an500",
        target: "thumbv7em-none-eabihf",
        flash: 2 * MIB,
        ram: 512 * KIB,
        formats: &[Format::F32, Format::Fixed, Format::F64],
    },
    Board {
        name: "esp32-c3",
        core: "RV32IMC",
        measured: "sifive_e",
        target: "riscv32imc-unknown-none-elf",
        flash: 4 * MIB,
        ram: 384 * KIB,
        formats: &[Format::Fixed],
    },
    Board {
        name: "esp32-c6",
        core: "RV32IMAC",
        measured: "sifive_e",
        target: "riscv32imac-unknown-none-elf",
        flash: 4 * MIB,
        ram: 512 * KIB,
        formats: &[Format::Fixed],
    },
];

impl Board {
    /// Returns the board of a name, in capitals or not.
    pub fn named(name: &str) -> Option<&'static Self> {
        BOARDS
            .iter()
            .find(|board| board.name.eq_ignore_ascii_case(name))
    }

    /// Returns whether QEMU emulates this board.
    pub fn is_emulated(&self) -> bool {
        self.name == self.measured
    }

    /// Returns the board on whose core programs were built and measured: this one, or one with a core of the same kind.
    pub fn measured_on(&self) -> &'static Self {
        Self::named(self.measured).unwrap_or(&BOARDS[0])
    }

    /// Returns the board and number format on which parts and structures were measured, each alone: these, or
    /// those of a similar core.
    pub fn similar(&self, format: Format) -> (&'static Self, Format) {
        let [m3, m0, risc_v, _, m4f, ..] = &BOARDS;
        match (self.target, format) {
            (_, Format::F32 | Format::F64) => (m4f, Format::F32),
            ("thumbv6m-none-eabi", Format::Fixed) => (m0, Format::Fixed),
            ("riscv32imac-unknown-none-elf" | "riscv32imc-unknown-none-elf", Format::Fixed) => {
                (risc_v, Format::Fixed)
            }
            (_, Format::Fixed) => (m3, Format::Fixed),
        }
    }

    /// Returns the default number format.
    pub fn format(&self) -> Format {
        self.formats[0]
    }
}
