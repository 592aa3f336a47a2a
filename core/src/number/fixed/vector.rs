//! Vectors of any length, scaled to the available bits: norms, directions and slopes.

use crate::number::Products;
use crate::number::Scalar;
use crate::number::fixed::base::{Fixed, RATIO_BITS, with_sign};
use crate::number::fixed::halves::{leading_zeros, product_unsigned, wide_leading_zeros};
use crate::number::fixed::reciprocal::reciprocal;
use crate::number::fixed::root::nearest_root;
use crate::number::fixed::wide::Product;
use crate::target::inline_unless_small;

inline_unless_small!(
    /// `v >> bits` on the magnitude, so that rounding does not depend on the sign.
    const fn shift_magnitude(v: i64, bits: i32) -> i32 {
        let magnitude = v.unsigned_abs();
        let shifted = if bits >= 0 {
            magnitude >> (bits & 63)
        } else {
            magnitude << (bits.wrapping_neg() & 63)
        } as i32;
        if v < 0 {
            shifted.wrapping_neg()
        } else {
            shifted
        }
    }
);

/// Undoes the shift of [`shift_magnitude`], rounded down.
#[inline(always)]
const fn shift_back(magnitude: u64, bits: i32) -> u64 {
    if bits >= 0 {
        magnitude << (bits & 63)
    } else {
        magnitude >> (bits.wrapping_neg() & 63)
    }
}

/// Length of a vector of at most 31 bits and a sign, to nearest.
#[inline(always)]
fn norm(v: [i32; 3]) -> u64 {
    // Three squares of at most 2^62.
    let square = v.iter().fold(0_u64, |sum, &component| {
        let square = (component as i64).wrapping_mul(component as i64);
        sum.wrapping_add(square as u64)
    });
    nearest_root(square)
}

/// Returns by how many bits to shift down so that the largest magnitude keeps `bits` bits.
#[inline(always)]
fn excess_bits(v: [i64; 3], bits: i32) -> i32 {
    let all = v[0].unsigned_abs() | v[1].unsigned_abs() | v[2].unsigned_abs();
    (64 - bits).wrapping_sub(wide_leading_zeros(all) as i32)
}

/// [`Products::wide_norm`](crate::number::Products::wide_norm).
pub(super) fn wide_norm(v: [Product; 3]) -> Product {
    let v = v.map(|product| product.0);
    let bits = excess_bits(v, 31);
    let norm = norm(v.map(|component| shift_magnitude(component, bits)));
    Product(shift_back(norm, bits) as i64)
}

/// [`Vectors::direction`](crate::number::Vectors::direction).
#[inline(always)]
pub(super) fn direction(v: [i64; 3]) -> [Fixed; 3] {
    let bits = excess_bits(v, 30);
    v.map(|component| Fixed(shift_magnitude(component, bits)))
}

/// [`Vectors::proportions`](crate::number::Vectors::proportions).
#[inline(always)]
pub(super) fn proportions(v: [Product; 3]) -> [Fixed; 3] {
    let v = v.map(|product| product.0);
    let bits = excess_bits(v, 29);
    v.map(|component| Fixed(shift_magnitude(component, bits)))
}

inline_unless_small!(
    /// [`Vectors::slopes`](crate::number::Vectors::slopes).
    pub(super) fn slopes(v: [Product; 3]) -> Option<([Fixed; 3], usize)> {
        let v = v.map(|product| product.0);
        let narrow = v.map(|component| component as i32);
        let same = |k: usize| i64::from(narrow[k]) == v[k] && narrow[k] != i32::MIN;
        if same(0) && same(1) && same(2) {
            slopes_of_narrow(narrow)
        } else {
            slopes_of_wide(v)
        }
    }
);

/// [`Vectors::slopes_of`](crate::number::Vectors::slopes_of).
#[inline(always)]
pub(super) fn slopes_of(v: [Fixed; 3]) -> Option<([Fixed; 3], usize)> {
    slopes_of_narrow(v.map(|component| component.0))
}

/// [`Vectors::slopes`](crate::number::Vectors::slopes) of a vector beyond 31 bits.
fn slopes_of_wide(v: [i64; 3]) -> Option<([Fixed; 3], usize)> {
    let bits = excess_bits(v, 31);
    slopes_of_narrow(v.map(|component| shift_magnitude(component, bits)))
}

inline_unless_small!(
    /// [`Vectors::slopes`](crate::number::Vectors::slopes) of a vector of at most 31 bits and a sign.
    fn slopes_of_narrow(v: [i32; 3]) -> Option<([Fixed; 3], usize)> {
        let [x, y, z] = v.map(i32::unsigned_abs);
        let (largest, axis) = if x >= y && x >= z {
            (x, 0)
        } else if y >= z {
            (y, 1)
        } else {
            (z, 2)
        };
        if largest == 0 {
            return None;
        }
        let up = leading_zeros(largest).wrapping_sub(1) & 31;
        let inverse = reciprocal(largest << up);
        let minor = |component: i32| {
            let scaled = component.unsigned_abs().wrapping_shl(up);
            let magnitude = (product_unsigned(scaled, inverse) >> 31) as u32;
            let magnitude = magnitude.min(1 << RATIO_BITS) as i32;
            Fixed(if component < 0 {
                magnitude.wrapping_neg()
            } else {
                magnitude
            })
        };
        let one = |component: i32| {
            if component < 0 {
                -Fixed::ONE
            } else {
                Fixed::ONE
            }
        };
        let slopes = match axis {
            0 => [one(v[0]), minor(v[1]), minor(v[2])],
            1 => [minor(v[0]), one(v[1]), minor(v[2])],
            _ => [minor(v[0]), minor(v[1]), one(v[2])],
        };
        Some((slopes, axis))
    }
);

inline_unless_small!(
    /// [`Vectors::recip_norm2`](crate::number::Vectors::recip_norm2).
    pub(super) fn recip_norm2(d: [Fixed; 3]) -> Fixed {
        // d . d has 60 fraction bits: as 29, 1 to 3 lies in [2^29, 2^31).
        let norm2 = (Fixed::dot(d, d).0 >> 31) as u32;
        let up = norm2.leading_zeros().saturating_sub(1);
        // 2^61 over 2^29 to 2^31 is 2^32 to 2^30; a ratio has 30 bits.
        Fixed((reciprocal(norm2 << (up & 1)) >> (2 - (up & 1))) as i32)
    }
);

/// [`Vectors::normalize`](crate::number::Vectors::normalize).
pub(super) fn normalize(v: [Fixed; 3]) -> ([Fixed; 3], Fixed) {
    let wide = v.map(|component| component.0 as i64);
    let bits = excess_bits(wide, 31);
    let scaled = wide.map(|component| shift_magnitude(component, bits));
    let norm = norm(scaled);
    if norm == 0 {
        return ([Fixed(0); 3], Fixed(0));
    }
    // The norm lies in [2^30, 2^32).
    let down = (norm >> 31) as u32 & 1;
    let inverse = reciprocal((norm >> down) as u32) as u64;
    let unit = scaled.map(|component| {
        let component = component as i64;
        let magnitude = component.unsigned_abs().wrapping_mul(inverse) >> (31 + down);
        with_sign(magnitude, component)
    });
    // The vector has at most 32 bits, so it was shifted up, or down by one.
    (unit, with_sign(shift_back(norm, bits), 0))
}
