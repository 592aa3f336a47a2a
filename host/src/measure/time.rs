//! The median and the spread of repeats.

/// Returns the median; `None` without repeats.
///
/// ```
/// use gridel_host::measure::time::median;
/// assert_eq!(median(&[3.0, 1.0, 2.0]), Some(2.0));
/// assert_eq!(median(&[4.0, 1.0]), Some(2.5));
/// assert_eq!(median(&[]), None);
/// ```
pub fn median(seconds: &[f64]) -> Option<f64> {
    let mut sorted = seconds.to_vec();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    match sorted.len() {
        0 => None,
        count if count % 2 == 1 => Some(sorted[middle]),
        _ => Some(0.5 * (sorted[middle - 1] + sorted[middle])),
    }
}

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
