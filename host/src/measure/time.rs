//! The spread of repeats.

use super::median;

/// Returns the least and the largest; `None` for a single repeat, which has no interval.
///
/// ```
/// use gridel_host::measure::time::interval;
/// assert_eq!(interval(&[3.0, 1.0, 2.0]), Some([1.0, 3.0]));
/// assert_eq!(interval(&[3.0]), None);
/// ```
pub fn interval(seconds: &[f64]) -> Option<[f64; 2]> {
    let largest = seconds.iter().copied().fold(0.0, f64::max);
    let least = seconds.iter().copied().fold(f64::INFINITY, f64::min);
    (seconds.len() > 1).then_some([least, largest])
}

/// Returns whether every repeat took less than every repeat of another.
pub fn is_below(seconds: &[f64], other: &[f64]) -> bool {
    let both = interval(seconds).zip(interval(other));
    both.is_some_and(|([_, largest], [least, _])| largest < least)
}

/// Returns the largest less the least, as a part of the median.
pub fn spread(seconds: &[f64]) -> Option<f64> {
    let [least, largest] = interval(seconds)?;
    Some((largest - least) / median(seconds)?.max(f64::MIN_POSITIVE))
}
