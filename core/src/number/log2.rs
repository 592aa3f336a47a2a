//! Binary logarithms of integers, with 8 fraction bits. Each is off by less than 0.02, and takes a few instructions.

/// Fraction bits of a logarithm.
pub const LOG2_BITS: u32 = 8;

/// Returns the binary logarithm of 2 to a power.
#[inline(always)]
pub const fn log2_of_power(exponent: i32) -> i32 {
    exponent << LOG2_BITS
}

/// Returns the binary logarithm of a number; that of 0 is 0, as of 1.
///
/// ```
/// use gridel_core::number::log2::{LOG2_BITS, log2, log2_of_power};
///
/// assert_eq!(log2(1 << 40), log2_of_power(40));
/// // 2 to the power of 1.585 is 3.
/// let found = f64::from(log2(3)) / f64::from(1 << LOG2_BITS);
/// assert!((found - 1.585).abs() < 0.02);
/// ```
#[inline(never)]
pub fn log2(number: u64) -> i32 {
    let number = number.max(1);
    let zeros = number.leading_zeros();
    // The digits behind the first one: x of 1 + x, with 16 fraction bits.
    let x = (number.wrapping_shl(zeros) >> 47) as u32 & 0xffff;
    // log2(1 + x) is nearly x + 0.346 x (1 - x).
    let bow = (x.wrapping_mul(0x1_0000_u32.wrapping_sub(x)) >> 16).wrapping_mul(22_700) >> 16;
    let fraction = x.wrapping_add(bow).wrapping_add(128) >> (16 - LOG2_BITS);
    log2_of_power(63_i32.wrapping_sub(zeros.cast_signed())).wrapping_add(fraction.cast_signed())
}

/// Returns the binary logarithm of the length of a vector whose components have at most 63 bits; that of 0 is 0.
pub fn log2_of_length(vector: [i64; 3]) -> i32 {
    let [x, y, z] = vector.map(i64::unsigned_abs);
    // The squares of components below 2^31 fit.
    let excess = 33_u32.saturating_sub((x | y | z).leading_zeros());
    let square = |it: u64| {
        it.wrapping_shr(excess)
            .wrapping_mul(it.wrapping_shr(excess))
    };
    let sum = square(x).wrapping_add(square(y)).wrapping_add(square(z));
    (log2(sum) >> 1).wrapping_add(log2_of_power(excess.cast_signed()))
}

/// Returns the binary logarithm of the sum of two numbers, given their logarithms.
pub fn log2_of_sum(a: i32, b: i32) -> i32 {
    let (larger, smaller) = if a > b { (a, b) } else { (b, a) };
    let apart = larger.wrapping_sub(smaller).cast_unsigned();
    let whole = apart >> LOG2_BITS;
    if whole >= 16 {
        return larger;
    }
    // 2^-x is nearly 1 - x / 2 - 0.172 x (1 - x), for x from 0 to 1: with 16 fraction bits.
    let x = (apart & 255) << 8;
    let bow = (x.wrapping_mul(0x1_0000_u32.wrapping_sub(x)) >> 16).wrapping_mul(11_300) >> 16;
    let power = 0x1_0000_u32.wrapping_sub(x >> 1).wrapping_sub(bow);
    let sum = 0x1_0000_u32.wrapping_add(power.wrapping_shr(whole));
    larger
        .wrapping_add(log2(sum.into()))
        .wrapping_sub(log2_of_power(16))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn close(found: i32, exact: f64) -> bool {
        (f64::from(found) / 256.0 - exact).abs() < 0.02
    }

    #[test]
    fn logarithms_of_small_numbers_are_close() {
        assert_eq!([log2(0), log2(1), log2(2)], [0, 0, 256]);
        for number in 1..=70_000_u32 {
            assert!(
                close(log2(number.into()), f64::from(number).log2()),
                "{number}"
            );
        }
        assert_eq!(log2(u64::MAX), 64 << 8);
        assert_eq!(log2_of_length([0; 3]), 0);
    }

    proptest! {
        #[test]
        fn logarithms_are_close(bits in any::<u64>(), shift in 0..64_u32) {
            let number = bits >> shift;
            prop_assert!(close(log2(number), (number.max(1) as f64).log2()), "{number}");
        }

        #[test]
        fn logarithms_of_lengths_are_close(bits in any::<[i64; 3]>(), shift in 1..64_u32) {
            let vector = bits.map(|it| it >> shift);
            let length = vector.iter().map(|&it| (it as f64).powi(2)).sum::<f64>().sqrt();
            let found = log2_of_length(vector);
            prop_assert!(close(found, length.max(1.0).log2()), "{vector:?}: {found} for {length}");
        }

        #[test]
        fn logarithms_of_sums_are_close(a in 0..16_000_i32, apart in 0..8_000_i32) {
            let sum = |it: i32| (f64::from(it) / 256.0).exp2();
            let exact = (sum(a) + sum(a + apart)).log2();
            prop_assert!(close(log2_of_sum(a, a + apart), exact));
            prop_assert_eq!(log2_of_sum(a + apart, a), log2_of_sum(a, a + apart));
        }
    }
}
