//! The exponential function, in integers.

use crate::number::fixed::base::{Fixed, RATIO_BITS};

/// [`Scalar::exp_neg`](crate::number::Scalar::exp_neg).
pub(super) fn exp_neg(length: Fixed, coefficient_q32: u32, shift: u32) -> Fixed {
    // The exponent in powers of two, with 30 fraction bits.
    const LOG2_E: u64 = 1_549_082_005;
    let bits = 15_u32.saturating_sub(shift);
    let exponent = (length.0.max(0) as u64 * coefficient_q32 as u64) >> bits;
    if exponent >= 22 << RATIO_BITS {
        return Fixed(0);
    }
    let fraction = exponent & ((1 << RATIO_BITS) - 1);
    let binary = (exponent >> RATIO_BITS) * LOG2_E + ((fraction * LOG2_E) >> RATIO_BITS);
    let (whole, part) = (
        (binary >> RATIO_BITS) as u32,
        Fixed((binary & ((1 << RATIO_BITS) - 1)) as i32),
    );
    // 2^-x on [0, 1] by Horner's rule over the Taylor series of e^(-x ln 2) up to the tenth
    // power, whose remainder is below 2^-30.
    const TAYLOR: [i32; 10] = [
        1_073_741_824,
        -744_261_118,
        257_941_248,
        -59_597_083,
        10_327_387,
        -1_431_680,
        165_394,
        -16_377,
        1_419,
        -109,
    ];
    let mut power = Fixed(8);
    for &coefficient in TAYLOR.iter().rev() {
        power = power * part + Fixed(coefficient);
    }
    Fixed(power.0 >> (whole & 31))
}
