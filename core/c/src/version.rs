//! The version of header and library.

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
