//! The range of a sample's radiance before samples are added up.

use crate::accel::Number;
use crate::shade::Color;

/// The most of a sample's radiance that counts, as a power of two times display white. It is more than white where the
/// mean of brighter samples is to be right.
#[derive(Clone, Copy)]
pub(super) struct Headroom(u32);

impl Headroom {
    /// Up to white.
    pub(super) const NONE: Self = Self(0);
    /// Up to 4 times white: samples of lights with an area bring up to 2.5 times their mean.
    pub(super) const NARROW: Self = Self(2);
    /// Up to 16 times white.
    pub(super) const WIDE: Self = Self(4);

    /// Returns a sample's radiance, limited before it is added up.
    #[inline(always)]
    pub(super) fn limit<N: Number>(self, radiance: Color<N>) -> Color<N> {
        radiance.limited(1 << (20_u32.wrapping_add(self.0) & 31))
    }

    /// The most samples whose sum is in the range of `fixed`, and the number of bits by which those of more samples are
    /// shifted.
    #[inline(always)]
    pub(super) const fn room_for_samples(self) -> (u16, u32) {
        (1024 >> (self.0 & 15), self.0.wrapping_add(2))
    }
}
