//! Eight numbers of single precision at once, with the instructions that the processor has.
//!
//! Additions, subtractions and products are those of IEEE 754 in every lane. Only [`F32x8::mul_add`] may be fused. So a
//! kernel without it gives the same bits here as one number at a time, and the same bits with any instructions.
//!
//! A kernel is generic over [`Simd`], whose values prove that the processor has the instructions. [`Simd::call`]
//! compiles it for them: every function that the kernel calls must be inlined into it.

#[cfg(all(feature = "avx2", target_arch = "x86_64"))]
#[path = "f32x8_avx2.rs"]
mod avx2;
#[cfg(not(all(feature = "avx2", target_arch = "x86_64")))]
#[path = "without_avx2.rs"]
mod avx2;
mod f32x8_portable;

pub use avx2::Avx2;
pub use f32x8_portable::Portable;
#[cfg(all(feature = "avx2", target_arch = "x86_64"))]
pub(crate) use gridel_cpu::F64x4;

use core::ops::{Add, Mul, Sub};

/// The instructions that queries through [`Wide`](crate::Wide) use. No bit of an answer depends on
/// them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SimdLevel {
    /// The instructions that the program is built for, four lanes at a time.
    #[default]
    Portable,
    /// AVX2, eight lanes at a time; only in builds for x86-64 with the feature `avx2`.
    Avx2(Avx2),
}

impl SimdLevel {
    /// Returns the fastest level of this processor.
    pub fn detect() -> Self {
        Avx2::detect().map_or(Self::Portable, Self::Avx2)
    }

    /// Returns all levels of this processor, the portable one first.
    pub fn available() -> impl Iterator<Item = Self> {
        let best = Some(Self::detect()).filter(|best| *best != Self::Portable);
        core::iter::once(Self::Portable).chain(best)
    }

    /// Returns the name that command lines and tables use.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Portable => "portable",
            Self::Avx2(_) => "avx2",
        }
    }
}

/// Evaluates an expression with `$simd` being the proof of the level's instructions.
macro_rules! with_simd {
    ($level:expr, |$simd:ident| $body:expr) => {
        match $level {
            $crate::simd::SimdLevel::Portable => {
                let $simd = $crate::simd::Portable;
                $body
            }
            $crate::simd::SimdLevel::Avx2($simd) => $body,
        }
    };
}
pub(crate) use with_simd;

/// A set of instructions: a value proves that the processor has them.
pub trait Simd: Copy {
    /// Eight lanes.
    type F32x8: F32x8;

    /// A number in every lane.
    fn splat(self, value: f32) -> Self::F32x8;
    /// Numbers from memory.
    fn lanes(self, lanes: &[f32; 8]) -> Self::F32x8;
    /// Integers as numbers; exact.
    fn of_i16(self, lanes: &[i16; 8]) -> Self::F32x8;
    /// Integers as numbers; exact.
    fn of_u16(self, lanes: &[u16; 8]) -> Self::F32x8;
    /// Integers as numbers; exact below 2^24.
    fn of_i32(self, lanes: &[i32; 8]) -> Self::F32x8;
    /// Converts integers of 24 bits to numbers, exactly. Their low 16 bits are given, and their high 8 as the bytes of
    /// words, the low ones in the first four lanes.
    fn of_i24(self, low: &[u16; 8], high: &[u16; 4]) -> Self::F32x8;
    /// Calls a function, out of line, that is compiled for these instructions. Arguments are passed one by one, so that
    /// they stay in registers.
    fn call<A, B, C, D, E, R>(
        self,
        function: impl FnOnce(Self, A, B, C, D, E) -> R,
        arguments: (A, B, C, D, E),
    ) -> R;
}

/// Eight numbers of single precision.
pub trait F32x8: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// The lanes as numbers.
    fn to_array(self) -> [f32; 8];
    /// The smaller in every lane; which zero and which NaN is not specified.
    fn min(self, other: Self) -> Self;
    /// The larger in every lane; which zero and which NaN is not specified.
    fn max(self, other: Self) -> Self;
    /// `self * factor + summand`, rounded once or twice, whichever is faster.
    fn mul_add(self, factor: Self, summand: Self) -> Self;
    /// Magnitudes.
    fn abs(self) -> Self;
    /// Every lane's neighbor above; the last stays.
    fn next(self) -> Self;
    /// One bit for each lane that is at most the other's.
    fn at_most(self, other: Self) -> u32;
    /// One bit for each lane whose sign is minus.
    fn signs(self) -> u32;
    /// One bit for each lane that is zero.
    fn zero(self) -> u32;
}

#[cfg(test)]
mod tests;
