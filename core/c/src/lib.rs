//! Gridel for C: a static library, and `include/gridel.h` for it. `README.md` explains it.
//!
//! | file | what it declares |
//! |---|---|
//! | `status.rs` | the codes that functions return, and their texts |
//! | `types.rs` | what goes in and comes out |
//! | `load.rs` | from a blob to a scene |
//! | `cast.rs` | rays |
//! | `camera.rs` | cameras of the caller's |
//! | `render.rs` | pictures |
//! | `version.rs` | the version of header and library |
//! | `memory.rs` | memory of the caller's: the one place that trusts pointers |
//!
//! The header is written from these files, so names are C's.
#![cfg_attr(target_os = "none", no_std)]
#![deny(
    missing_docs,
    unsafe_op_in_unsafe_fn,
    clippy::undocumented_unsafe_blocks
)]
#![allow(non_camel_case_types)]

mod camera;
mod cast;
mod load;
mod memory;
mod render;
mod status;
mod types;
mod version;

pub use camera::*;
pub use cast::*;
pub use load::*;
pub use render::*;
pub use status::*;
pub use types::*;
pub use version::*;

/// The structure that rays walk through.
#[cfg(feature = "dual-split")]
pub(crate) type Accel = gridel_core::DualSplit;
/// The structure that rays walk through.
#[cfg(all(feature = "flagged", not(feature = "dual-split")))]
pub(crate) type Accel = gridel_core::Flagged;
/// The structure that rays walk through.
#[cfg(all(feature = "bvh", not(feature = "flagged"), not(feature = "dual-split")))]
pub(crate) type Accel = gridel_core::Bvh;
/// The structure that rays walk through.
#[cfg(not(any(feature = "bvh", feature = "flagged", feature = "dual-split")))]
pub(crate) type Accel = gridel_core::List;

/// Its name.
pub(crate) const STRUCTURE: gridel_core::Structure =
    <Accel as gridel_core::accel::Traverse>::STRUCTURE;

/// Neither Gridel nor this library panics; the project's tests check that in linked programs. A bare machine still
/// needs a handler.
#[cfg(target_os = "none")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {
        core::hint::spin_loop();
    }
}
