//! Numbers and colors as words.

use crate::table::counted;

pub(super) fn counted_were(number: usize, thing: &str) -> String {
    let verb = if number == 1 { "was" } else { "were" };
    format!("{} {verb}", counted(number, thing))
}

pub(super) fn peak(color: [f64; 3]) -> f64 {
    color.into_iter().fold(0.0, f64::max)
}

pub(super) fn color([red, green, blue]: [f64; 3]) -> String {
    format!("{red:.5} {green:.5} {blue:.5}")
}

pub(super) fn vector(vector: [f64; 3], number: impl Fn(f64) -> String) -> String {
    let [x, y, z] = vector.map(number);
    format!("({x}, {y}, {z})")
}

/// Writes a number with all digits that are significant for a given error, and two more.
pub(super) fn precise(number: f64, error: f64) -> String {
    let digits = (number.abs().log10().floor() - error.log10().floor()).clamp(0.0, 14.0);
    if !digits.is_finite() || !(1e-5..1e15).contains(&number.abs()) {
        return number.to_string();
    }
    let decimals = (digits + 2.0 - number.abs().log10().floor()).max(0.0);
    format!("{number:.*}", decimals as usize)
}

/// An error, rounded up.
pub(super) fn bound(error: f64) -> String {
    match error {
        0.0 => String::from("0"),
        _ => format!("{:.1e}", 1.06 * error),
    }
}
