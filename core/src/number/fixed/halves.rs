//! Products and quotients by halves, with the same bits. The Cortex-M0 needs them: it multiplies 32 bits to 32, does
//! not divide and does not count bits.

use crate::number::fixed::base::Fixed;
use crate::target::NARROW_PRODUCTS;

/// A product in 64 bits.
#[inline(always)]
pub(crate) const fn product(a: i32, b: i32) -> i64 {
    if NARROW_PRODUCTS {
        product_of_halves(a, b)
    } else {
        a as i64 * b as i64
    }
}

/// A product of unsigned numbers in 64 bits.
#[inline(always)]
pub(super) const fn product_unsigned(a: u32, b: u32) -> u64 {
    if NARROW_PRODUCTS {
        product_of_halves_unsigned(a, b)
    } else {
        a as u64 * b as u64
    }
}

/// Four products of halves, each of which fits 32 bits together with its carry.
#[inline(always)]
pub(super) const fn product_of_halves(a: i32, b: i32) -> i64 {
    let (a_high, a_low) = (a >> 16, a & 0xffff);
    let (b_high, b_low) = (b >> 16, b & 0xffff);
    let low = a_low.wrapping_mul(b_low) as u32;
    let middle = a_high.wrapping_mul(b_low).wrapping_add((low >> 16) as i32);
    let other = a_low.wrapping_mul(b_high).wrapping_add(middle & 0xffff);
    let high = a_high
        .wrapping_mul(b_high)
        .wrapping_add(middle >> 16)
        .wrapping_add(other >> 16);
    (high as i64) << 32 | ((other as u32) << 16 | low & 0xffff) as i64
}

/// Four unsigned products of halves; see [`product_of_halves`].
#[inline(always)]
pub(super) const fn product_of_halves_unsigned(a: u32, b: u32) -> u64 {
    let (a_high, a_low) = (a >> 16, a & 0xffff);
    let (b_high, b_low) = (b >> 16, b & 0xffff);
    let low = a_low.wrapping_mul(b_low);
    let middle = a_high.wrapping_mul(b_low).wrapping_add(low >> 16);
    let other = a_low.wrapping_mul(b_high).wrapping_add(middle & 0xffff);
    let high = a_high
        .wrapping_mul(b_high)
        .wrapping_add(middle >> 16)
        .wrapping_add(other >> 16);
    (high as u64) << 32 | (other << 16 | low & 0xffff) as u64
}

/// (2^32 - 1) / `d`, rounded down, for `d` in \[2^15, 2^16\].
#[inline(always)]
pub(super) fn quotient(d: u32) -> u32 {
    if NARROW_PRODUCTS {
        quotient_by_products(d)
    } else {
        u32::MAX.checked_div(d).unwrap_or(0)
    }
}

/// Returns the number of zero bits above the highest one bit. For 0 it returns all, or all but one.
#[inline(always)]
pub(crate) const fn leading_zeros(x: u32) -> u32 {
    if NARROW_PRODUCTS {
        leading_zeros_by_shifts(x)
    } else {
        x.leading_zeros()
    }
}

/// Counts the leading zeros of 64 bits.
#[inline(always)]
pub(super) const fn wide_leading_zeros(x: u64) -> u32 {
    if NARROW_PRODUCTS {
        match (x >> 32) as u32 {
            0 => leading_zeros_by_shifts(x as u32).wrapping_add(32),
            high => leading_zeros_by_shifts(high),
        }
    } else {
        x.leading_zeros()
    }
}

/// Most numbers have few leading zeros.
#[inline(always)]
pub(super) const fn leading_zeros_by_shifts(x: u32) -> u32 {
    let (mut rest, mut zeros) = (x | 1, 0_u32);
    while rest >> 24 == 0 {
        (rest, zeros) = (rest << 8, zeros.wrapping_add(8));
    }
    while rest >> 31 == 0 {
        (rest, zeros) = (rest << 1, zeros.wrapping_add(1));
    }
    zeros
}

/// Returns the quotient by Newton's iteration.
#[inline(always)]
pub(super) fn quotient_by_products(d: u32) -> u32 {
    // 2^16 (48 / 17 - 32 / 17 x) is 1 / x, for x from 1/2 to 1, to a part in 17.
    let mut guess = 185_043_u32.wrapping_sub(d.wrapping_mul(30_840) >> 14);
    for _ in 0..2 {
        let rest = d.wrapping_mul(guess).wrapping_neg() as i32;
        let step = (rest >> 14).wrapping_mul(guess as i32) >> 18;
        guess = guess.wrapping_add(step as u32);
    }
    // All steps were rounded down, so the result is too low by at most 2.
    let mut rest = u32::MAX.wrapping_sub(d.wrapping_mul(guess));
    for _ in 0..2 {
        if rest >= d {
            (guess, rest) = (guess.wrapping_add(1), rest.wrapping_sub(d));
        }
    }
    guess
}

/// [`Project::surrounds_origin`](crate::geometry::Project::surrounds_origin) by the upper 16 bits of all coordinates;
/// `None` where those do not decide.
pub(crate) fn surround(a: [Fixed; 2], b: [Fixed; 2], c: [Fixed; 2]) -> Option<bool> {
    let magnitude = |x: Fixed| x.0 ^ x.0 >> 31;
    let all = [a, b, c]
        .as_flattened()
        .iter()
        .fold(0, |all, &x| all | magnitude(x));
    // Down to 15 bits and a sign, because this core has no instruction that counts bits.
    let mut shift = 0_i32;
    for (step, limit) in [(8, 1 << 21), (4, 1 << 17), (2, 1 << 15), (2, 1 << 15)] {
        if all >> (shift & 31) >= limit {
            shift = shift.wrapping_add(step);
        }
    }
    let [a, b, c] = [a, b, c].map(|point| point.map(|x| x.0 >> (shift & 31)));
    // Each factor lacks less than 1. So each of the two products lacks less than its factors' magnitudes and 1.
    const OPEN: i32 = (4 << 15) + 2;
    let cross = |p: [i32; 2], q: [i32; 2]| {
        let cross = p[0]
            .wrapping_mul(q[1])
            .wrapping_sub(p[1].wrapping_mul(q[0]));
        (!(-OPEN..=OPEN).contains(&cross)).then_some(cross < 0)
    };
    let (u, v) = (cross(b, c)?, cross(c, a)?);
    if u != v {
        return Some(false);
    }
    Some(u == cross(a, b)?)
}
