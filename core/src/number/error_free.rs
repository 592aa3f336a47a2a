//! Sums and products of floats with their rounding errors, as pairs of numbers.

use crate::number::Arithmetic;

/// `a b` minus its rounded product; the splitter halves the digits of a factor.
#[inline(always)]
pub(crate) fn product_error<N: Arithmetic<Wide = N>>(a: N, b: N, splitter: N) -> N {
    let split = |x: N| {
        let scaled = x * splitter;
        let high = scaled - (scaled - x);
        (high, x - high)
    };
    let ((a_high, a_low), (b_high, b_low)) = (split(a), split(b));
    let product = a * b;
    ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low
}

/// Returns `a + b`, rounded, and its rounding error (D. E. Knuth, "The Art of Computer Programming", volume 2, 4.2.2).
#[inline(always)]
pub(super) fn two_sum<N: Arithmetic<Wide = N>>(a: N, b: N) -> (N, N) {
    let sum = a + b;
    let b_part = sum - a;
    (sum, (a - (sum - b_part)) + (b - b_part))
}

/// 2^12 + 1 and 2^27 + 1: see [`product_error`].
pub(super) const SPLITTER_F32: f32 = 4097.0;
pub(crate) const SPLITTER_F64: f64 = 134_217_729.0;

/// Returns `origin + depth * slope`, with depth and slope as pairs of numbers.
#[inline(always)]
pub(super) fn carry<N: Arithmetic<Wide = N>>(
    origin: N,
    (depth, depth_low): (N, N),
    (slope, slope_low): (N, N),
    splitter: N,
) -> N {
    let rise = depth * slope;
    let rise_low = product_error(depth, slope, splitter) + (depth * slope_low + depth_low * slope);
    let (sum, sum_low) = two_sum(origin, rise);
    (sum + (sum_low + rise_low)).flush_tiny()
}
