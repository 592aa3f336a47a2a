//! Instructions of x86-64, in a program that is built for any x86-64 processor.
//!
//! [`Avx2`] proves that the processor has the instructions: only [`Avx2::detect`] makes one. Code that has one can make
//! [`F32x8`], and code that has an [`F32x8`] can compute with it. So the functions here are safe to call.
//!
//! The operations compile to single instructions only inside of [`Avx2::call`], whose function must be
//! inlined into it. Anywhere else they are correct, but each is a call.
//!
//! No operation but [`F32x8::mul_add`] is fused, so every lane holds the bits that scalar code gives.

mod f32x8;
mod f64x4;

use core::arch::x86_64::{_MM_HINT_ET0, _MM_HINT_T0, _mm_prefetch};
pub use f32x8::F32x8;
pub use f64x4::{F64x4, Mask4};

/// Starts to load the cache line where a value begins, and does not wait for it. Only affects time.
#[inline(always)]
pub fn prefetch<T>(value: &T) {
    // SAFETY: every x86-64 processor has the instruction, and it never faults.
    unsafe { _mm_prefetch::<_MM_HINT_T0>((&raw const *value).cast()) }
}

/// Starts to load the cache line where a value begins, to be written to: see [`prefetch`].
#[inline(always)]
pub fn prefetch_to_write<T>(value: &T) {
    // SAFETY: as above.
    unsafe { _mm_prefetch::<_MM_HINT_ET0>((&raw const *value).cast()) }
}

/// Proof that this processor has AVX2, FMA, BMI1, BMI2, LZCNT and POPCNT.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Avx2(());

impl Avx2 {
    /// Returns the proof, on processors that have the instructions. The processor is queried only once.
    pub fn detect() -> Option<Self> {
        let has_all = is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("fma")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("lzcnt")
            && is_x86_feature_detected!("popcnt");
        has_all.then_some(Self(()))
    }

    /// Calls a function that is compiled with these instructions if it is inlined here. The call itself is never
    /// inlined. Arguments are passed one by one, so that they stay in registers.
    #[inline(always)]
    pub fn call<A, B, C, D, E, R>(
        self,
        function: impl FnOnce(Self, A, B, C, D, E) -> R,
        (a, b, c, d, e): (A, B, C, D, E),
    ) -> R {
        #[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
        #[inline(never)]
        #[expect(clippy::too_many_arguments, reason = "its arguments stay in registers")]
        fn with_avx2<A, B, C, D, E, R>(
            avx2: Avx2,
            function: impl FnOnce(Avx2, A, B, C, D, E) -> R,
            a: A,
            b: B,
            c: C,
            d: D,
            e: E,
        ) -> R {
            function(avx2, a, b, c, d, e)
        }
        // SAFETY: `self` proves that the processor has the instructions.
        unsafe { with_avx2(self, function, a, b, c, d, e) }
    }
}
