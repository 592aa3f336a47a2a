//! AVX2 in builds that cannot use it: its proof has no value.

use crate::simd::{Portable, Simd};

/// Proof that this processor has AVX2; it has no value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Avx2 {}

impl Avx2 {
    /// Returns `None`.
    pub fn detect() -> Option<Self> {
        None
    }
}

impl Simd for Avx2 {
    type F32x8 = <Portable as Simd>::F32x8;

    fn splat(self, _: f32) -> Self::F32x8 {
        match self {}
    }

    fn lanes(self, _: &[f32; 8]) -> Self::F32x8 {
        match self {}
    }

    fn of_i16(self, _: &[i16; 8]) -> Self::F32x8 {
        match self {}
    }

    fn of_u16(self, _: &[u16; 8]) -> Self::F32x8 {
        match self {}
    }

    fn of_i32(self, _: &[i32; 8]) -> Self::F32x8 {
        match self {}
    }

    fn of_i24(self, _: &[u16; 8], _: &[u16; 4]) -> Self::F32x8 {
        match self {}
    }

    fn call<A, B, C, D, E, R>(
        self,
        _: impl FnOnce(Self, A, B, C, D, E) -> R,
        _: (A, B, C, D, E),
    ) -> R {
        match self {}
    }
}
