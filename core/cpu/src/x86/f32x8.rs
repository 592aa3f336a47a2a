//! Eight lanes.

use crate::Avx2;
use core::arch::x86_64::*;
use core::ops::{Add, Div, Mul, Sub};

/// Eight numbers.
#[derive(Clone, Copy, Debug)]
pub struct F32x8(__m256);

/// One call of intrinsics.
macro_rules! avx2 {
    ($call:expr) => {
        // SAFETY: an `Avx2` or an `F32x8` is available, either of which proves that the processor has AVX2 and FMA. Loads
        // read an array of the size that is loaded.
        unsafe { $call }
    };
}

impl F32x8 {
    /// A number in every lane.
    #[inline(always)]
    pub fn splat(_: Avx2, value: f32) -> Self {
        Self(avx2!(_mm256_set1_ps(value)))
    }

    /// Numbers from memory.
    #[inline(always)]
    pub fn new(_: Avx2, lanes: &[f32; 8]) -> Self {
        Self(avx2!(_mm256_loadu_ps(lanes.as_ptr())))
    }

    /// Integers as numbers; exact.
    #[inline(always)]
    pub fn from_i16(_: Avx2, lanes: &[i16; 8]) -> Self {
        Self(avx2!(_mm256_cvtepi32_ps(_mm256_cvtepi16_epi32(
            _mm_loadu_si128(lanes.as_ptr().cast())
        ))))
    }

    /// Integers as numbers; exact.
    #[inline(always)]
    pub fn from_u16(_: Avx2, lanes: &[u16; 8]) -> Self {
        Self(avx2!(_mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(
            _mm_loadu_si128(lanes.as_ptr().cast())
        ))))
    }

    /// Integers as numbers; exact below 2^24.
    #[inline(always)]
    pub fn from_i32(_: Avx2, lanes: &[i32; 8]) -> Self {
        Self(avx2!(_mm256_cvtepi32_ps(_mm256_loadu_si256(
            lanes.as_ptr().cast()
        ))))
    }

    /// Converts integers of 24 bits to numbers, exactly. Their low 16 bits are given, and their high 8 as the bytes of
    /// words, the low ones in the first four lanes.
    #[inline(always)]
    pub fn from_i24(_: Avx2, low: &[u16; 8], high: &[u16; 4]) -> Self {
        Self(avx2!({
            let bytes = _mm256_broadcastq_epi64(_mm_loadl_epi64(high.as_ptr().cast()));
            // The byte of each lane moves to the top, and back with its sign.
            let to_top = _mm256_setr_epi32(
                0x00ff_ffff,
                0x02ff_ffff,
                0x04ff_ffff,
                0x06ff_ffff,
                0x01ff_ffff,
                0x03ff_ffff,
                0x05ff_ffff,
                0x07ff_ffff,
            );
            let high = _mm256_srai_epi32::<8>(_mm256_shuffle_epi8(bytes, to_top));
            let low = _mm256_cvtepu16_epi32(_mm_loadu_si128(low.as_ptr().cast()));
            _mm256_cvtepi32_ps(_mm256_or_si256(high, low))
        }))
    }

    /// The lanes as numbers.
    #[inline(always)]
    pub fn to_array(self) -> [f32; 8] {
        let mut lanes = [0.0; 8];
        avx2!(_mm256_storeu_ps(lanes.as_mut_ptr(), self.0));
        lanes
    }

    /// The smaller in every lane: `other` unless this one is smaller.
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        Self(avx2!(_mm256_min_ps(self.0, other.0)))
    }

    /// The larger in every lane: `other` unless this one is larger.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        Self(avx2!(_mm256_max_ps(self.0, other.0)))
    }

    /// `self * factor + summand`, rounded once.
    #[inline(always)]
    pub fn mul_add(self, factor: Self, summand: Self) -> Self {
        Self(avx2!(_mm256_fmadd_ps(self.0, factor.0, summand.0)))
    }

    /// Square roots, rounded to nearest.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        Self(avx2!(_mm256_sqrt_ps(self.0)))
    }

    /// Magnitudes.
    #[inline(always)]
    pub fn abs(self) -> Self {
        Self(avx2!(_mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0)))
    }

    /// Every lane's neighbor above; the last stays.
    #[inline(always)]
    pub fn next(self) -> Self {
        let above = avx2!(_mm256_setr_epi32(1, 2, 3, 4, 5, 6, 7, 7));
        Self(avx2!(_mm256_permutevar8x32_ps(self.0, above)))
    }

    /// One bit for each lane that is at most the other's.
    #[inline(always)]
    pub fn at_most(self, other: Self) -> u32 {
        let at_most = avx2!(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, other.0));
        Self(at_most).signs()
    }

    /// One bit for each lane whose sign is minus.
    #[inline(always)]
    pub fn signs(self) -> u32 {
        avx2!(_mm256_movemask_ps(self.0)) as u32
    }

    /// One bit for each lane that is zero.
    #[inline(always)]
    pub fn zero(self) -> u32 {
        let zero = avx2!(_mm256_cmp_ps::<_CMP_EQ_OQ>(self.0, _mm256_setzero_ps()));
        Self(zero).signs()
    }
}

impl Add for F32x8 {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(avx2!(_mm256_add_ps(self.0, other.0)))
    }
}

impl Sub for F32x8 {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(avx2!(_mm256_sub_ps(self.0, other.0)))
    }
}

impl Mul for F32x8 {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(avx2!(_mm256_mul_ps(self.0, other.0)))
    }
}

impl Div for F32x8 {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Self(avx2!(_mm256_div_ps(self.0, other.0)))
    }
}
