//! Eight lanes in two registers of four.

use core::ops::{Add, Mul, Sub};
use glam::Vec4;

/// Eight lanes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Eight([Vec4; 2]);

impl Eight {
    /// The same number in every lane.
    #[inline(always)]
    pub(crate) fn splat(value: f32) -> Self {
        Self([Vec4::splat(value); 2])
    }

    #[inline(always)]
    pub(crate) fn new(lanes: [f32; 8]) -> Self {
        let [a, b, c, d, e, f, g, h] = lanes;
        Self([Vec4::new(a, b, c, d), Vec4::new(e, f, g, h)])
    }

    #[inline(always)]
    pub(crate) fn to_array(self) -> [f32; 8] {
        let ([a, b, c, d], [e, f, g, h]) = (self.0[0].to_array(), self.0[1].to_array());
        [a, b, c, d, e, f, g, h]
    }

    /// Integers as numbers; exact.
    #[inline(always)]
    pub(crate) fn from_i16(lanes: &[i16; 8]) -> Self {
        Self::new(lanes.map(f32::from))
    }

    /// Integers as numbers; exact.
    #[inline(always)]
    pub(crate) fn from_u16(lanes: &[u16; 8]) -> Self {
        Self::new(lanes.map(f32::from))
    }

    /// Integers as numbers; exact below 2^24.
    #[inline(always)]
    pub(crate) fn from_i32(lanes: &[i32; 8]) -> Self {
        Self::new(lanes.map(|lane| lane as f32))
    }

    /// Integers of 24 bits as numbers, given by their low 16 bits, and by their high 8 as the bytes of
    /// words, the low ones in the first four lanes; exact.
    #[inline(always)]
    pub(crate) fn from_i24(low: &[u16; 8], high: &[u16; 4]) -> Self {
        Self::from_u16(low) + Self::from_signed_bytes(high) * Self::splat(65_536.0)
    }

    /// The signed bytes of words as numbers, the low ones in the first four lanes; exact.
    #[inline(always)]
    fn from_signed_bytes(words: &[u16; 4]) -> Self {
        // In terms that the compiler finds lanes in.
        let low = words.map(|word| f32::from((word & 0xff) ^ 0x80));
        let high = words.map(|word| f32::from(word as i16 >> 8));
        Self([
            Vec4::from_array(low) - Vec4::splat(128.0),
            Vec4::from_array(high),
        ])
    }

    #[inline(always)]
    fn zip(self, other: Self, each: impl Fn(Vec4, Vec4) -> Vec4) -> Self {
        Self([each(self.0[0], other.0[0]), each(self.0[1], other.0[1])])
    }

    /// The smaller in every lane; which zero and which NaN is not said.
    #[inline(always)]
    pub(crate) fn min(self, other: Self) -> Self {
        self.zip(other, Vec4::min)
    }

    /// The larger in every lane; which zero and which NaN is not said.
    #[inline(always)]
    pub(crate) fn max(self, other: Self) -> Self {
        self.zip(other, Vec4::max)
    }

    #[inline(always)]
    pub(crate) fn abs(self) -> Self {
        Self([self.0[0].abs(), self.0[1].abs()])
    }

    /// Every lane's neighbour above; the last stays.
    #[inline(always)]
    pub(crate) fn next(self) -> Self {
        let [low, high] = self.0;
        Self([
            Vec4::new(low.y, low.z, low.w, high.x),
            Vec4::new(high.y, high.z, high.w, high.w),
        ])
    }

    /// A bit for each lane that is at most the other's.
    #[inline(always)]
    pub(crate) fn at_most(self, other: Self) -> u32 {
        let (low, high) = (self.0[0].cmple(other.0[0]), self.0[1].cmple(other.0[1]));
        low.bitmask() | high.bitmask() << 4
    }

    /// A bit for each lane whose sign is minus.
    #[inline(always)]
    pub(crate) fn signs(self) -> u32 {
        self.0[0].is_negative_bitmask() | self.0[1].is_negative_bitmask() << 4
    }

    /// A bit for each lane that is zero.
    #[inline(always)]
    pub(crate) fn zero(self) -> u32 {
        let (low, high) = (self.0[0].cmpeq(Vec4::ZERO), self.0[1].cmpeq(Vec4::ZERO));
        low.bitmask() | high.bitmask() << 4
    }
}

impl Add for Eight {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, Vec4::add)
    }
}

impl Sub for Eight {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, Vec4::sub)
    }
}

impl Mul for Eight {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, Vec4::mul)
    }
}
