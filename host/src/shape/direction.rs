//! Directions: of length 1, and as integers.

use glam::DVec3;

/// Largest relative difference at which two lengths or angles count as equal. Far above the
/// rounding of a product of matrices, and far below the resolution of 24 lattice bits.
pub const TOLERANCE: f64 = 1.0 / (1_u64 << 30) as f64;

/// Largest magnitude of a component.
const MOST: u64 = 1 << 24;

/// Returns the vector at length 1, also where its square is out of range.
pub fn unit(vector: DVec3) -> DVec3 {
    (vector / vector.abs().max_element()).normalize()
}

/// Returns the direction of a vector as integers of at most 2^24 in magnitude. `vector` is finite and not
/// zero.
///
/// The integers have the ratios of the components where such integers exist, up to what an `f64`
/// rounds: (0.1, 0.3, 0) is (1, 3, 0). Otherwise each component is rounded to 2^-24 of the largest.
pub fn integers(vector: DVec3) -> [i32; 3] {
    let ratios = vector / vector.abs().max_element();
    let scaled = ratios * MOST as f64;
    let rounded = scaled.round();
    let integers = if scaled == rounded {
        None
    } else {
        common(ratios)
    };
    integers
        .unwrap_or(rounded)
        .to_array()
        .map(|component| component as i32)
}

/// Returns the smallest integers with the given ratios. The largest ratio is 1 or -1.
fn common(ratios: DVec3) -> Option<DVec3> {
    let mut fractions = [(0, 1); 3];
    let mut denominator = 1;
    for (fraction, ratio) in fractions.iter_mut().zip(ratios.to_array()) {
        *fraction = simple_fraction(ratio.abs())?;
        denominator = fraction.1 / gcd(denominator, fraction.1) * denominator;
        if denominator > MOST {
            return None;
        }
    }
    let magnitudes = fractions.map(|(over, under)| (over * (denominator / under)) as f64);
    // Not `signum`, which keeps the sign of a zero.
    let signs = ratios.map(|ratio| if ratio < 0.0 { -1.0 } else { 1.0 });
    Some(DVec3::from_array(magnitudes) * signs)
}

/// Returns the fraction with the smallest denominator that rounds to `x` in a few roundings, for
/// `x` from 0 to 1. `None` if the denominator exceeds [`MOST`].
///
/// Convergents of the continued fraction, in integers.
fn simple_fraction(x: f64) -> Option<(u64, u64)> {
    /// The relative error of three roundings of an `f64`.
    const ROUNDED: f64 = 2.0 * f64::EPSILON;
    if x == 0.0 {
        return Some((0, 1));
    }
    if x * (MOST as f64) < 0.5 {
        return None;
    }
    // x is `mantissa / 2^shift` with a shift of at most 78.
    let bits = x.to_bits();
    let shift = 1075 - (bits >> 52);
    let mantissa = bits & ((1 << 52) - 1) | 1 << 52;
    let (mut over, mut under) = (u128::from(mantissa), 1_u128 << shift);
    let (mut last, mut fraction) = ((1, 0), (0, 1));
    while over > 0 {
        // Below 2^25 in the first round, and below the bound of the denominators in all others that
        // count.
        let whole = u64::try_from(under / over).ok()?;
        (over, under) = (under % over, over);
        let next = |last: u64, this: u64| whole.checked_mul(this)?.checked_add(last);
        let convergent = (next(last.0, fraction.0)?, next(last.1, fraction.1)?);
        (last, fraction) = (fraction, convergent);
        let (p, q) = fraction;
        if q > MOST {
            return None;
        }
        let (p_real, q_real) = (p as f64, q as f64);
        if x.mul_add(q_real, -p_real).abs() <= x * q_real * ROUNDED {
            return Some((p, q));
        }
    }
    None
}

fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(vector: [f64; 3]) -> [i32; 3] {
        integers(DVec3::from_array(vector))
    }

    #[test]
    fn small_integers_stay_exact() {
        assert_eq!(of([1.0, 3.0, 0.0]), [1, 3, 0]);
        assert_eq!(of([-7.0, 5.0, 3.0]), [-7, 5, 3]);
        assert_eq!(of([0.1, -0.3, 0.0]), [1, -3, 0]);
        assert_eq!(of([0.6, 0.0, 0.8]), [3, 0, 4]);
        assert_eq!(of([3e200, 0.0, -9e200]), [1, 0, -3]);
        assert_eq!(of([3e-300, 1e-300, 0.0]), [3, 1, 0]);
        assert_eq!(of([1e-20, 3.0, 7.0]), [0, 7_190_235, 1 << 24]);
    }

    #[test]
    fn dyadic_ratios_are_scaled_to_24_bits() {
        const ONE: i32 = 1 << 24;
        assert_eq!(of([0.0, 2.0, 0.0]), [0, ONE, 0]);
        assert_eq!(of([1.0, -4.0, 0.5]), [ONE / 4, -ONE, ONE / 8]);
    }

    #[test]
    fn integers_up_to_24_bits_stay_exact() {
        let mut state = 1_u64;
        let mut next = || {
            state = state.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(1);
            (state >> 33) as i64
        };
        for _ in 0..20_000 {
            let bits = 1 + next() % 24;
            let vector = [0; 3].map(|_| (next() & ((1 << bits) - 1)) - (1 << (bits - 1)));
            if vector == [0; 3] {
                continue;
            }
            let found = of(vector.map(|x| x as f64)).map(i64::from);
            for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                assert_eq!(found[i] * vector[j], found[j] * vector[i], "{vector:?}");
            }
            assert!((0..3).all(|k| found[k].signum() == vector[k].signum()));
        }
    }

    #[test]
    fn other_directions_are_rounded_to_24_bits() {
        let vector = DVec3::new(0.123_456_789, -1.0, 0.577_215_664_9);
        let found = DVec3::from_array(integers(vector).map(f64::from)) / MOST as f64;
        assert!((found - vector).abs().max_element() <= 0.5 / MOST as f64);
    }
}
