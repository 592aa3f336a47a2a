//! Eight lanes in two registers of four, on every machine.

use crate::simd::{F32x8, Simd};
use core::ops::{Add, Mul, Sub};
use glam::Vec4;

/// No more instructions than the program is built for.
#[derive(Clone, Copy, Debug)]
pub struct Portable;

/// Eight lanes.
#[derive(Clone, Copy, Debug)]
pub struct Vec4x2([Vec4; 2]);

impl Simd for Portable {
    type F32x8 = Vec4x2;

    #[inline(always)]
    fn splat(self, value: f32) -> Vec4x2 {
        Vec4x2([Vec4::splat(value); 2])
    }

    #[inline(always)]
    fn lanes(self, lanes: &[f32; 8]) -> Vec4x2 {
        let [a, b, c, d, e, f, g, h] = *lanes;
        Vec4x2([Vec4::new(a, b, c, d), Vec4::new(e, f, g, h)])
    }

    #[inline(always)]
    fn of_i16(self, lanes: &[i16; 8]) -> Vec4x2 {
        self.lanes(&lanes.map(f32::from))
    }

    #[inline(always)]
    fn of_u16(self, lanes: &[u16; 8]) -> Vec4x2 {
        self.lanes(&lanes.map(f32::from))
    }

    #[inline(always)]
    fn of_i32(self, lanes: &[i32; 8]) -> Vec4x2 {
        self.lanes(&lanes.map(|lane| lane as f32))
    }

    #[inline(always)]
    fn of_i24(self, low: &[u16; 8], high: &[u16; 4]) -> Vec4x2 {
        self.of_u16(low) + from_signed_bytes(high) * self.splat(65_536.0)
    }

    #[inline(never)]
    fn call<A, B, C, D, E, R>(
        self,
        function: impl FnOnce(Self, A, B, C, D, E) -> R,
        (a, b, c, d, e): (A, B, C, D, E),
    ) -> R {
        function(self, a, b, c, d, e)
    }
}

/// The signed bytes of words as numbers, the low ones in the first four lanes; exact.
#[inline(always)]
fn from_signed_bytes(words: &[u16; 4]) -> Vec4x2 {
    // In a form in which the compiler finds lanes.
    let low = words.map(|word| f32::from((word & 0xff) ^ 0x80));
    let high = words.map(|word| f32::from(word as i16 >> 8));
    Vec4x2([
        Vec4::from_array(low) - Vec4::splat(128.0),
        Vec4::from_array(high),
    ])
}

impl Vec4x2 {
    #[inline(always)]
    fn zip(self, other: Self, each: impl Fn(Vec4, Vec4) -> Vec4) -> Self {
        Self([each(self.0[0], other.0[0]), each(self.0[1], other.0[1])])
    }
}

impl F32x8 for Vec4x2 {
    #[inline(always)]
    fn to_array(self) -> [f32; 8] {
        let ([a, b, c, d], [e, f, g, h]) = (self.0[0].to_array(), self.0[1].to_array());
        [a, b, c, d, e, f, g, h]
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.zip(other, Vec4::min)
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, Vec4::max)
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, summand: Self) -> Self {
        self * factor + summand
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self([self.0[0].abs(), self.0[1].abs()])
    }

    #[inline(always)]
    fn next(self) -> Self {
        let [low, high] = self.0;
        Self([
            Vec4::new(low.y, low.z, low.w, high.x),
            Vec4::new(high.y, high.z, high.w, high.w),
        ])
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        let (low, high) = (self.0[0].cmple(other.0[0]), self.0[1].cmple(other.0[1]));
        low.bitmask() | high.bitmask() << 4
    }

    #[inline(always)]
    fn signs(self) -> u32 {
        self.0[0].is_negative_bitmask() | self.0[1].is_negative_bitmask() << 4
    }

    #[inline(always)]
    fn zero(self) -> u32 {
        let (low, high) = (self.0[0].cmpeq(Vec4::ZERO), self.0[1].cmpeq(Vec4::ZERO));
        low.bitmask() | high.bitmask() << 4
    }
}

impl Add for Vec4x2 {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, Vec4::add)
    }
}

impl Sub for Vec4x2 {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, Vec4::sub)
    }
}

impl Mul for Vec4x2 {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, Vec4::mul)
    }
}
