//! Numbers and colors of 320 bits.

use gridel_host::shape::exact::{Real, Vector};

pub fn real(value: f64) -> Real {
    Real::of(value)
}

pub fn fraction(value: impl Into<i64>, bits: i32) -> Real {
    // Integers below 2^62, in two parts that floats hold.
    let value: i64 = value.into();
    let (high, low) = (value >> 31, value & 0x7fff_ffff);
    let power = f64::powi(2.0, -bits);
    real(high as f64 * f64::powi(2.0, 31) * power) + real(low as f64 * power)
}

pub fn color(values: [i32; 3], bits: i32) -> Vector {
    values.map(|x| fraction(x, bits))
}

pub fn product(a: &Vector, b: &Vector) -> Vector {
    [0, 1, 2].map(|k| &a[k] * &b[k])
}

pub fn sum(a: &Vector, b: &Vector) -> Vector {
    [0, 1, 2].map(|k| &a[k] + &b[k])
}

pub fn one() -> Real {
    real(1.0)
}

/// A number near 0 within the roundings of 320 bits. t of crossings of the surface that a ray starts on differs from 0
/// by no more. t of crossings of the surface of a light differs from 1 by no more.
pub fn nothing() -> Real {
    real(f64::powi(2.0, -150))
}

/// Returns a number within the valid range. Only rounding leaves it.
pub fn limited(x: Real, low: f64, high: f64) -> Real {
    x.max(real(low)).min(real(high))
}

/// Returns the largest integer that is not above a number below 2^52, within the roundings of 320 bits.
pub fn floor(x: &Real) -> i64 {
    let x = x + nothing();
    let near = x.to_f64().floor();
    let below = if x < real(near) {
        near - 1.0
    } else if x >= real(near + 1.0) {
        near + 1.0
    } else {
        near
    };
    below as i64
}

pub fn black() -> Vector {
    [real(0.0), real(0.0), real(0.0)]
}

/// A sum of multiples.
pub fn mixed(vectors: [&Vector; 3], factors: [&Real; 3]) -> Vector {
    let parts = |k: usize| [0, 1, 2].map(|it: usize| &vectors[it][k] * factors[it]);
    [0, 1, 2].map(|k| {
        let [a, b, c] = parts(k);
        a + b + c
    })
}

pub fn peak(color: &Vector) -> Real {
    let [a, b, c] = color.clone();
    a.max(b).max(c)
}

/// e to the power of minus a number, by its series for a 2^32nd of it.
pub fn decay(x: &Real) -> Real {
    let small = x * real(f64::powi(2.0, -32));
    let (mut term, mut result) = (one(), one());
    for n in 1..24 {
        term = -(term * &small) / real(f64::from(n));
        result = result + &term;
    }
    for _ in 0..32 {
        result = &result * &result;
    }
    result
}
