//! Four lanes of double precision.

use crate::Avx2;
use core::arch::x86_64::*;
use core::ops::{Add, BitAnd, Div, Mul, Sub};

/// Four numbers of double precision.
#[derive(Clone, Copy, Debug)]
pub struct F64x4(__m256d);

/// A choice for each of four lanes.
#[derive(Clone, Copy, Debug)]
pub struct Mask4(__m256d);

/// One call of intrinsics.
macro_rules! avx2 {
    ($call:expr) => {
        // SAFETY: an `Avx2`, an `F64x4` or a `Mask4` is available, each of which proves that the processor has AVX2 and
        // FMA. Loads and stores are of arrays of the size that is loaded or stored.
        unsafe { $call }
    };
}

impl F64x4 {
    /// A number in every lane.
    #[inline(always)]
    pub fn splat(_: Avx2, value: f64) -> Self {
        Self(avx2!(_mm256_set1_pd(value)))
    }

    /// Numbers from memory.
    #[inline(always)]
    pub fn new(_: Avx2, lanes: [f64; 4]) -> Self {
        Self(avx2!(_mm256_loadu_pd(lanes.as_ptr())))
    }

    /// The lanes as numbers.
    #[inline(always)]
    pub fn to_array(self) -> [f64; 4] {
        let mut lanes = [0.0; 4];
        avx2!(_mm256_storeu_pd(lanes.as_mut_ptr(), self.0));
        lanes
    }

    /// The lanes in single precision, each rounded to the nearest number.
    #[inline(always)]
    pub fn to_f32(self) -> [f32; 4] {
        let mut lanes = [0.0; 4];
        avx2!(_mm_storeu_ps(lanes.as_mut_ptr(), _mm256_cvtpd_ps(self.0)));
        lanes
    }

    /// Magnitudes.
    #[inline(always)]
    pub fn abs(self) -> Self {
        Self(avx2!(_mm256_andnot_pd(_mm256_set1_pd(-0.0), self.0)))
    }

    /// Magnitudes with the signs of other numbers.
    #[inline(always)]
    pub fn copysign(self, sign: Self) -> Self {
        Self(avx2!({
            let bit = _mm256_set1_pd(-0.0);
            _mm256_or_pd(_mm256_andnot_pd(bit, self.0), _mm256_and_pd(bit, sign.0))
        }))
    }

    /// The smaller in every lane: `other` unless this one is smaller.
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        Self(avx2!(_mm256_min_pd(self.0, other.0)))
    }

    /// The larger in every lane: `other` unless this one is larger.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        Self(avx2!(_mm256_max_pd(self.0, other.0)))
    }

    /// The lanes that are below the other's; none where either is NaN.
    #[inline(always)]
    pub fn below(self, other: Self) -> Mask4 {
        Mask4(avx2!(_mm256_cmp_pd::<_CMP_LT_OQ>(self.0, other.0)))
    }

    /// The lanes that are at most the other's; none where either is NaN.
    #[inline(always)]
    pub fn at_most(self, other: Self) -> Mask4 {
        Mask4(avx2!(_mm256_cmp_pd::<_CMP_LE_OQ>(self.0, other.0)))
    }
}

impl Mask4 {
    /// Every lane of `yes` that is chosen, and the others of `no`.
    #[inline(always)]
    pub fn select(self, yes: F64x4, no: F64x4) -> F64x4 {
        F64x4(avx2!(_mm256_blendv_pd(no.0, yes.0, self.0)))
    }

    /// One bit for each lane that is chosen.
    #[inline(always)]
    pub fn bits(self) -> u32 {
        avx2!(_mm256_movemask_pd(self.0)) as u32
    }
}

impl BitAnd for Mask4 {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(avx2!(_mm256_and_pd(self.0, other.0)))
    }
}

/// An operator that is one instruction.
macro_rules! operator {
    ($operator:ident, $function:ident, $instruction:ident) => {
        impl $operator for F64x4 {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                Self(avx2!($instruction(self.0, other.0)))
            }
        }
    };
}

operator!(Add, add, _mm256_add_pd);
operator!(Sub, sub, _mm256_sub_pd);
operator!(Mul, mul, _mm256_mul_pd);
operator!(Div, div, _mm256_div_pd);
