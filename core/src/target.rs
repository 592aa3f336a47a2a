//! The target that the code is compiled for.

/// Whether code shall be small where that makes it slower; no bit of an answer depends on it.
pub(crate) const SMALL: bool = cfg!(feature = "small");

/// Whether the code of the structure `wide`, and of the clusters in its leaves, is in this build.
pub(crate) const WIDE: bool = cfg!(feature = "wide");

/// A value that only builds with [`WIDE`] hold; it has no size in others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct InWide<T>([T; WIDE as usize]);

impl<T> InWide<T> {
    #[inline(always)]
    pub(crate) fn new(make: impl Fn() -> T) -> Self {
        Self(core::array::from_fn(|_| make()))
    }

    #[inline(always)]
    pub(crate) fn get(&self) -> Option<&T> {
        self.0.first()
    }
}

/// Whether this core multiplies 32 bits to 32 and no more: the Cortex-M0, the one family of Arm's
/// without an instruction that compares and swaps.
pub(crate) const NARROW_PRODUCTS: bool =
    cfg!(all(target_arch = "arm", not(target_has_atomic = "32")));
