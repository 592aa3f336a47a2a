//! What the code is compiled for.

/// Whether code shall be small where that makes it slower; no bit of an answer depends on it.
pub(crate) const SMALL: bool = cfg!(feature = "small");

/// Whether this core multiplies 32 bits to 32 and no more: the Cortex-M0, the one family of Arm's
/// without an instruction that compares and swaps.
pub(crate) const NARROW_PRODUCTS: bool =
    cfg!(all(target_arch = "arm", not(target_has_atomic = "32")));
