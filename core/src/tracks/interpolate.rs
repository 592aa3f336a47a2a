//! The value of a track at a time.

use crate::format::track::{Interpolation, Track, ValueKind};
use crate::number::Angle;
use crate::tracks::Tracks;

/// A value with this many components.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sample<const N: usize> {
    /// The value of a key.
    Key([i32; N]),
    /// A value between two keys, and that of the earlier one.
    Between([i32; N], [i32; N]),
}

impl<const N: usize> Sample<N> {
    pub(super) fn value(self) -> [i32; N] {
        match self {
            Self::Key(value) | Self::Between(value, _) => value,
        }
    }
}

/// The part of the time between two keys that has passed; neither none nor all of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    elapsed: u32,
    duration: u32,
}

/// Returns the key at or before a time, or else the first, and how far the time is towards the next one.
fn locate(times: &[i32], time: i32) -> (usize, Option<Part>) {
    let after = times.partition_point(|&key| key <= time);
    let key = after.saturating_sub(1);
    let part = match (times.get(key), times.get(after)) {
        (Some(&from), Some(&to)) if from < time => Some(Part {
            // Below 2^32, because times ascend.
            elapsed: time.wrapping_sub(from) as u32,
            duration: to.wrapping_sub(from) as u32,
        }),
        _ => None,
    };
    (key, part)
}

impl Tracks<'_> {
    /// The value of a track at a time, whose kind has `N` components.
    pub(super) fn sample<const N: usize>(
        &self,
        track: &Track,
        kind: ValueKind,
        time: i32,
    ) -> Option<Sample<N>> {
        let first = track.first_time as usize;
        let times = self.0.times.get(first..)?.get(..track.keys as usize)?;
        let interpolation = track.interpolation()?;
        let (key, part) = locate(times, time);
        let stride = Track::words(kind, interpolation);
        let words = self.0.words.get(track.first_word as usize..)?;
        let words = words.get(key.wrapping_mul(stride)..)?;
        let take = |start: usize| words.get(start..)?.first_chunk::<N>().copied();
        // A spline has the value between its two changes.
        let spline = interpolation == Interpolation::Cubic;
        let value = take(if spline { N } else { 0 })?;
        let Some(part) = part.filter(|_| interpolation != Interpolation::Step) else {
            return Some(Sample::Key(value));
        };
        let between = if spline {
            let leaving = take(N.wrapping_mul(2))?;
            let entering = take(stride)?;
            let next = take(stride.wrapping_add(N))?;
            let part = part.fraction();
            each([value, leaving, entering, next], |segment| {
                cubic(segment, part)
            })
        } else {
            let next = take(stride)?;
            match kind {
                ValueKind::Rotation => {
                    let angle = Angle(words.get(N).copied()? as u32);
                    turned(value, next, angle, part.fraction())
                }
                _ => each([value, next], |[from, to]| linear(from, to, part)),
            }
        };
        // A spline can pass a quaternion without a length: the earlier key's rotation stays.
        let is_lost = kind == ValueKind::Rotation && between.iter().all(|&it| it == 0);
        let between = if is_lost { value } else { between };
        // A spline can leave the range; a direction that is scaled to length 1 keeps its course.
        let [low, high] = match kind.has_length() {
            true => [i32::MIN, i32::MAX],
            false => kind.range(),
        };
        Some(Sample::Between(
            between.map(|it| it.clamp(low, high)),
            value,
        ))
    }
}

/// Calls a function with the components of several values, one after the other.
fn each<const N: usize, const M: usize>(
    values: [[i32; N]; M],
    interpolate: impl Fn([i32; M]) -> i32,
) -> [i32; N] {
    core::array::from_fn(|component| {
        interpolate(values.map(|value| value.get(component).copied().unwrap_or_default()))
    })
}

impl Part {
    /// The part as a fraction with 32 bits, to nearest. It is below 1: the remaining part is at least 2^-32.
    fn fraction(self) -> u32 {
        let Self { elapsed, duration } = self;
        let half = u64::from(duration / 2);
        let scaled = (u64::from(elapsed) << 32).wrapping_add(half);
        scaled.checked_div(duration.into()).unwrap_or(0) as u32
    }
}

/// Returns the nearest number on the way from one to another; of two, the later.
fn linear(from: i32, to: i32, Part { elapsed, duration }: Part) -> i32 {
    let change = u64::from(to.abs_diff(from));
    // Below 2^64: both factors are below 2^32, and one is less by 2.
    let product = change.wrapping_mul(elapsed.into());
    let rounded = product.wrapping_add(u64::from(duration / 2));
    let way = rounded.checked_div(duration.into()).unwrap_or(0) as u32;
    if to < from {
        from.wrapping_sub_unsigned(way)
    } else {
        from.wrapping_add_unsigned(way)
    }
}

/// Fraction bits of the sums of a spline.
const GUARD_BITS: u32 = 16;

/// Returns the cubic Hermite spline through two values. The changes per segment at the exit of the first and the entry
/// of the second are given. The result is within 1/2 + 2^-14 + slope * 2^-33 of the exact number, the slope being the
/// steepest per segment. Values beyond the range are moved to its end.
fn cubic([from, leaving, entering, to]: [i32; 4], part: u32) -> i32 {
    let [from, leaving, entering, to] = [from, leaving, entering, to].map(i64::from);
    let change = to.wrapping_sub(from);
    // Magnitudes below 2^35, and with fraction bits below 2^51.
    let square = (3 * change)
        .wrapping_sub(2 * leaving)
        .wrapping_sub(entering);
    let cube = leaving.wrapping_add(entering).wrapping_sub(2 * change);
    let [leaving, square, cube] = [leaving, square, cube].map(|it| it << GUARD_BITS);
    let way = times(cube, part).wrapping_add(square);
    let way = times(way, part).wrapping_add(leaving);
    let way = times(way, part).wrapping_add(1 << (GUARD_BITS - 1)) >> GUARD_BITS;
    let value = from.wrapping_add(way);
    value.clamp(i32::MIN.into(), i32::MAX.into()) as i32
}

/// A number of at most 60 bits times a fraction with 32, rounded down.
fn times(number: i64, fraction: u32) -> i64 {
    let high = (number >> 32).wrapping_mul(fraction.into());
    let low = u64::from(number as u32).wrapping_mul(fraction.into()) >> 32;
    high.wrapping_add(low as i64)
}

/// Returns the quaternion on the arc from one to another, of any length. Between the two lies an angle of at most a
/// quarter of a turn. Turns evenly, as spherical interpolation does: at length 1 each component is within 2^-27 of the
/// exact one.
fn turned<const N: usize>(from: [i32; N], to: [i32; N], angle: Angle, part: u32) -> [i32; N] {
    let passed = u64::from(angle.0).wrapping_mul(part.into());
    let passed = Angle((passed.wrapping_add(1 << 31) >> 32) as u32);
    let [to_share, _] = passed.sin_cos();
    let [from_share, _] = angle.plus(passed.negative()).sin_cos();
    // Below 2^61 each.
    let sums: [i64; N] = core::array::from_fn(|component| {
        let product = |of: [i32; N], share: i32| {
            let component = of.get(component).copied().unwrap_or_default();
            i64::from(component).wrapping_mul(share.into())
        };
        product(from, from_share).wrapping_add(product(to, to_share))
    });
    let all = sums.iter().fold(0, |all, sum| all | sum.unsigned_abs());
    if all == 0 {
        // They are the same rotation.
        return from;
    }
    // The largest component gets 30 bits: small angles have small sines.
    let down = 34_u32.saturating_sub(all.leading_zeros());
    let up = all.leading_zeros().saturating_sub(34);
    sums.map(|sum| (sum.wrapping_shl(up) >> down) as i32)
}

#[cfg(test)]
mod tests;
