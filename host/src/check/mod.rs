//! Regression tests of scenes and their memory, for continuous integration: a *manifest* lists
//! scenes, what their pictures are and the most that they may cost; [`run`] measures all of it.
//!
//! A manifest is TOML. A key that is not listed here is an error. Paths are relative to the
//! manifest. Budgets are the most that is allowed; what has no budget is not measured.
//!
//! `[[check]]`, once for each scene, with at least one of `hash`, `reference`, `budget`, `target` and
//! `board`
//!
//! | key | type | default |
//! |---|---|---|
//! | `scene` | path of a scene file or a blob | |
//! | `name` | text, which no other check has | the file's name without its extension |
//! | `accel` | name of the acceleration structure | what `build` builds; for a blob the best it holds |
//! | `lattice_bits` | 10 to 24; scene files only | 24 |
//! | `allow_outside` | whether the scene file may name files outside of its folder | `false` |
//! | `formats` | array of `"fixed"`, `"f32"`, `"f64"`: pictures are rendered in each | `["f32"]` |
//! | `size` | `[width, height]` of the pictures | what the scene states |
//! | `samples` | samples a pixel, 1 to 256 | what the scene states |
//! | `hash` | `{ FORMAT = "...", ... }`: the [hash](crate::picture::hash) of each picture, for all `formats` or none | pictures are not hashed |
//! | `reference` | path of a PNG with 8 bits a channel that pictures must look like; where there is none yet, [`bless()`] makes it | none |
//! | `tolerance` | `{ channel, pixels }`: how many codes of 255 a channel may differ from the reference, and how many pixels may differ by more | 0, 0 |
//! | `budget` | table, below | no budget |
//! | `target` | name of a board whose memory the scene must fit, by the memory report of `gridel inspect --target`: nothing is run | none |
//! | `board` | array of tables, below | none |
//!
//! `[check.budget]`
//!
//! | key | the most |
//! |---|---|
//! | `blob_bytes` | bytes of the blob |
//! | `working_bytes` | bytes that must be writable beside the call stack to render on a board of 32 bits, in each format |
//! | `stack_entries` | entries of the traversal stack |
//! | `tests_per_ray` | boxes and primitives that are tested for a ray of the picture, in the mean; may have a fraction |
//! | `flash` | bytes of flash on the `target`: blob and code |
//! | `ram` | bytes of RAM on the `target`: working memory, a row of pixels, and the call stack |
//! | `call_stack` | bytes of the call stack on the `target` |
//!
//! The last three need a `target`. They are figures of the memory report in each of `formats` that the
//! board computes itself, or in the board's own format if it computes none of them. A figure that is
//! unknown, because no such program was measured, is within no budget and fits no board.
//!
//! `[[check.board]]`: a program that runs on an emulated board and prints its figures, a name and
//! a whole number a line, as the programs in `tests/firmware` do
//!
//! | key | type | default |
//! |---|---|---|
//! | `machine` | the board, as QEMU names it | |
//! | `emulator` | the program | `"qemu-system-arm"` |
//! | `elf` | path of the program's ELF file, built before | |
//! | `firmware` | instead of `elf`: a folder with a Cargo package, which is built in release with the absolute path of the blob in the environment variable `GRIDEL_BLOB` and the machine in `GRIDEL_BOARD` | |
//! | `program`, `target`, `features` | for `firmware`: the binary's name, the Rust target, an array of Cargo features | features: none |
//! | `picture` | file that the program writes: the picture of the blob in three bytes a pixel, which must be the host's | not compared |
//! | `format` | for `picture`: the number format that the program renders in | `"f32"` |
//! | `shift` | an instruction takes 2^`shift` ns on the board's clock: QEMU's `-icount` | 4 |
//! | `seconds` | how long the program may run | 300 |
//! | `budget` | `{ NAME = number, ... }`: the most for figures that the program prints | |
//!
//! Instructions are counted by the emulator's clock (`-icount`), so they are the same in every run
//! and on every machine. A board whose emulator, Rust target or ELF file is not there is not run,
//! and said not to be: that is neither held nor broken.
//!
//! ```toml
//! [[check]]
//! scene = "quick.toml"
//! accel = "flagged"
//! formats = ["fixed", "f32"]
//! size = [48, 36]
//! hash = { fixed = "c50483f14794bca8", f32 = "2506030936d23933" }
//!
//! [check.budget]
//! blob_bytes = 2048
//! working_bytes = 512
//! tests_per_ray = 12.5
//!
//! [[check.board]]
//! machine = "mps2-an386"
//! firmware = "../tests/firmware"
//! program = "picture"
//! target = "thumbv7em-none-eabihf"
//! features = ["f32", "flagged", "everything"]
//! picture = "picture.rgb"
//! budget = { picture-instructions = 12_000_000, picture-stack-bytes = 2500 }
//! ```

mod bless;
mod board;
mod diff;
mod image;
mod junit;
mod manifest;
mod measure;
mod memory;
mod report;

#[cfg(test)]
mod tests;

pub use bless::{Blessed, bless};
pub use image::Image;
pub use manifest::{Board, Budget, Check, Manifest, Named, Program, Reference};
pub use measure::run;
pub use report::{Evidence, Figure, Finding, Outcome, Report};
