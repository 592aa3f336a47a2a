//! Square roots of floats, rounded to nearest: the same bits by whatever computes them.

/// The square root of a positive number: the processor's where there is a way to it, or else libm's.
#[inline(always)]
pub(super) fn of_f32(x: f32) -> f32 {
    // libm would use an SSE instruction on x86-64, for which a core waits while its wide registers are in use.
    #[cfg(feature = "std")]
    let root = x.sqrt();
    #[cfg(all(not(feature = "std"), target_arch = "arm", target_abi = "eabihf"))]
    let root = gridel_cpu::sqrt(x);
    #[cfg(not(any(feature = "std", all(target_arch = "arm", target_abi = "eabihf"))))]
    let root = libm::sqrtf(x);
    root
}

/// [`of_f32`] in double precision.
#[inline(always)]
pub(super) fn of_f64(x: f64) -> f64 {
    #[cfg(feature = "std")]
    let root = x.sqrt();
    #[cfg(not(feature = "std"))]
    let root = libm::sqrt(x);
    root
}
