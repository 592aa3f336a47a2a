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

pub use camera::*;
pub use cast::*;
pub use load::*;
pub use render::*;
pub use status::*;
pub use types::*;

/// The version of this header: major, minor and patch number, of 16, 8 and 8 bits. A program whose library returns
/// another number by `gridel_version` is linked with the library of another header, whose types can have other sizes.
pub const GRIDEL_VERSION: u32 = 0x0000_0100;

const _: () = {
    const fn digit(at: usize) -> u32 {
        (env!("CARGO_PKG_VERSION").as_bytes()[at] - b'0') as u32
    }
    // The package's version has one digit per number so far.
    assert!(env!("CARGO_PKG_VERSION").len() == 5);
    assert!(GRIDEL_VERSION == digit(0) << 16 | digit(2) << 8 | digit(4));
};

/// Returns the version of the library, in the form of `GRIDEL_VERSION`.
#[unsafe(no_mangle)]
pub extern "C" fn gridel_version() -> u32 {
    GRIDEL_VERSION
}

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
pub(crate) const STRUCTURE: gridel_core::Structure = if cfg!(feature = "dual-split") {
    gridel_core::Structure::DualSplit
} else if cfg!(feature = "flagged") {
    gridel_core::Structure::Flagged
} else if cfg!(feature = "bvh") {
    gridel_core::Structure::Bvh
} else {
    gridel_core::Structure::List
};

/// Neither Gridel nor this library panics; the project's tests check that in linked programs. A bare machine still
/// needs a handler.
#[cfg(target_os = "none")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {
        core::hint::spin_loop();
    }
}
