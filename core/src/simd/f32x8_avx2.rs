//! Eight lanes in one register of AVX2.

use crate::simd::{F32x8, Simd};
pub use gridel_cpu::Avx2;

impl Simd for Avx2 {
    type F32x8 = gridel_cpu::F32x8;

    #[inline(always)]
    fn splat(self, value: f32) -> Self::F32x8 {
        Self::F32x8::splat(self, value)
    }

    #[inline(always)]
    fn lanes(self, lanes: &[f32; 8]) -> Self::F32x8 {
        Self::F32x8::new(self, lanes)
    }

    #[inline(always)]
    fn of_i16(self, lanes: &[i16; 8]) -> Self::F32x8 {
        Self::F32x8::from_i16(self, lanes)
    }

    #[inline(always)]
    fn of_u16(self, lanes: &[u16; 8]) -> Self::F32x8 {
        Self::F32x8::from_u16(self, lanes)
    }

    #[inline(always)]
    fn of_i32(self, lanes: &[i32; 8]) -> Self::F32x8 {
        Self::F32x8::from_i32(self, lanes)
    }

    #[inline(always)]
    fn of_i24(self, low: &[u16; 8], high: &[u16; 4]) -> Self::F32x8 {
        Self::F32x8::from_i24(self, low, high)
    }

    #[inline(always)]
    fn call<A, B, C, D, E, R>(
        self,
        function: impl FnOnce(Self, A, B, C, D, E) -> R,
        arguments: (A, B, C, D, E),
    ) -> R {
        Avx2::call(self, function, arguments)
    }
}

impl F32x8 for gridel_cpu::F32x8 {
    #[inline(always)]
    fn to_array(self) -> [f32; 8] {
        self.to_array()
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.min(other)
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.max(other)
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, summand: Self) -> Self {
        self.mul_add(factor, summand)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.abs()
    }

    #[inline(always)]
    fn next(self) -> Self {
        self.next()
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        self.at_most(other)
    }

    #[inline(always)]
    fn signs(self) -> u32 {
        self.signs()
    }

    #[inline(always)]
    fn zero(self) -> u32 {
        self.zero()
    }
}
