//! Eight lanes in one register, or in two where the machine has none of that size.

use core::ops::{Add, Mul, Sub};
use wide::{f32x8, i16x8, i32x8, u16x8};

/// Eight lanes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Eight(f32x8);

impl Eight {
    /// The same number in every lane.
    #[inline(always)]
    pub(crate) fn splat(value: f32) -> Self {
        Self(f32x8::splat(value))
    }

    #[cfg(test)]
    pub(crate) fn new(lanes: [f32; 8]) -> Self {
        Self(f32x8::new(lanes))
    }

    #[inline(always)]
    pub(crate) fn to_array(self) -> [f32; 8] {
        self.0.to_array()
    }

    /// Integers as numbers; exact.
    #[inline(always)]
    pub(crate) fn from_i16(lanes: &[i16; 8]) -> Self {
        Self(f32x8::from_i32x8(i32x8::from_i16x8(i16x8::new(*lanes))))
    }

    /// Integers as numbers; exact.
    #[inline(always)]
    pub(crate) fn from_u16(lanes: &[u16; 8]) -> Self {
        Self(f32x8::from_i32x8(i32x8::from_u16x8(u16x8::new(*lanes))))
    }

    /// Integers as numbers; exact below 2^24.
    #[inline(always)]
    pub(crate) fn from_i32(lanes: &[i32; 8]) -> Self {
        Self(f32x8::from_i32x8(i32x8::new(*lanes)))
    }

    /// Integers of 24 bits as numbers, given by their low 16 bits, and by their high 8 as the bytes of
    /// words, the low ones in the first four lanes; exact.
    #[inline(always)]
    pub(crate) fn from_i24(low: &[u16; 8], &[a, b, c, d]: &[u16; 4]) -> Self {
        let words = i32x8::from_u16x8(u16x8::new([a, b, c, d, a, b, c, d]));
        // Shifts, a number of bits for each lane.
        let [first, last] = [1 << 24, 1 << 16];
        let top = words * i32x8::new([first, first, first, first, last, last, last, last]);
        let high = top.unbounded_shr_scalar(8) & i32x8::splat(-1 << 16);
        Self(f32x8::from_i32x8(
            high | i32x8::from_u16x8(u16x8::new(*low)),
        ))
    }

    /// The smaller in every lane; which zero and which NaN is not said.
    #[inline(always)]
    pub(crate) fn min(self, other: Self) -> Self {
        Self(self.0.fast_min(other.0))
    }

    /// The larger in every lane; which zero and which NaN is not said.
    #[inline(always)]
    pub(crate) fn max(self, other: Self) -> Self {
        Self(self.0.fast_max(other.0))
    }

    #[inline(always)]
    pub(crate) fn abs(self) -> Self {
        Self(self.0.abs())
    }

    /// Every lane's neighbour above; the last stays.
    #[inline(always)]
    pub(crate) fn next(self) -> Self {
        let [_, b, c, d, e, f, g, h] = self.0.to_array();
        Self(f32x8::new([b, c, d, e, f, g, h, h]))
    }

    /// A bit for each lane that is at most the other's.
    #[inline(always)]
    pub(crate) fn at_most(self, other: Self) -> u32 {
        self.0.simd_le(other.0).to_bitmask()
    }

    /// A bit for each lane whose sign is minus.
    #[inline(always)]
    pub(crate) fn signs(self) -> u32 {
        self.0.to_bitmask()
    }

    /// A bit for each lane that is zero.
    #[inline(always)]
    pub(crate) fn zero(self) -> u32 {
        self.0.simd_eq(f32x8::ZERO).to_bitmask()
    }
}

impl Add for Eight {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl Sub for Eight {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl Mul for Eight {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0)
    }
}
