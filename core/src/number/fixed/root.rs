//! Square roots without a division.

use crate::number::fixed::halves::{product, product_unsigned};
use crate::target::SMALL;

/// (1 / sqrt(x) - 1) * 256 in the middle of x = i / 128 to (i + 1) / 128, from i = 32.
const GUESSES: [u8; 96] = {
    let mut guesses = [0; 96];
    let mut i = 0;
    while i < 96 {
        // 256 / sqrt(x) is the root of 2^16 / x, here with 16 bits below the point.
        let square = (1_u64 << 56) / (2 * (i as u64 + 32) + 1);
        guesses[i] = ((square.isqrt() + (1 << 15)) >> 16).wrapping_sub(256) as u8;
        i += 1;
    }
    guesses
};

/// The greatest integer whose square is at most `square`, below 2^32.
///
/// Cost: some ten products.
pub(super) fn root(square: u64) -> u64 {
    let up = square.leading_zeros() & 62;
    root_of_full(square << up) >> (up / 2)
}

/// The greatest integer whose square is at most `square`, which is 0 or at least 2^62.
fn root_of_full(square: u64) -> u64 {
    let high = (square >> 32) as u32;
    // 1 / sqrt(high / 2^32) with 30 fraction bits. Two steps of Newton's iteration lead from 7 bits to 26. Without a
    // table, three steps lead from the line 2.13 - 1.216 x, which is off by a part in 11, to 24.
    let (mut inverse, steps) = if SMALL {
        let below = (product_unsigned(high, 1_305_670_058) >> 32) as u32;
        (2_287_074_672_u32.wrapping_sub(below), 3)
    } else {
        let guess = GUESSES.get((high >> 25).wrapping_sub(32) as usize);
        (256_u32.wrapping_add((*guess.unwrap_or(&0)).into()) << 22, 2)
    };
    for _ in 0..steps {
        let inverse_square = (product_unsigned(inverse, inverse) >> 32) as u32;
        let near_one = (product_unsigned(high, inverse_square) >> 32) as u32;
        let factor = (3_u32 << 28).wrapping_sub(near_one);
        inverse = (product_unsigned(inverse, factor) >> 29) as u32;
    }
    let coarse = (product_unsigned(high, inverse) >> 30).min(u32::MAX.into()) as u32;
    let rest = square.wrapping_sub(product_unsigned(coarse, coarse)) as i64;
    let fine = product((rest >> 10) as i32, (inverse >> 1) as i32) >> 52;
    // At most 1 too much or too little.
    let root = (coarse as u64)
        .wrapping_add_signed(fine)
        .min(u32::MAX.into());
    let rest = square.wrapping_sub(product_unsigned(root as u32, root as u32)) as i64;
    if rest < 0 {
        root.wrapping_sub(1)
    } else {
        root.wrapping_add((rest as u64 > root << 1).into())
    }
}

/// Square root to nearest.
pub(super) fn nearest_root(square: u64) -> u64 {
    let root = root(square);
    let rest = square.wrapping_sub(root.wrapping_mul(root));
    root.wrapping_add(u64::from(rest > root))
}

/// Square root as a mantissa of 32 bits and the power of two that divides it.
pub(super) fn scaled_root(square: u64) -> (u64, u32) {
    let shift = square.leading_zeros() & 62;
    (root_of_full(square << shift), shift / 2)
}
