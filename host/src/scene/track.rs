//! Tracks: how the camera, lights, materials, joints and morph targets of a scene change with time.

use super::source_span::SourceSpan;
use glam::{DQuat, DVec3, DVec4};
use gridel_core::format::track::ValueKind;
pub use gridel_core::format::track::{Interpolation, TrackTarget};

/// Ticks per second of all blobs with tracks. Frames at 24, 25, 30, 50, 60, 100 and 120 per second, and milliseconds,
/// are whole numbers of ticks.
pub const TICKS_PER_SECOND: u32 = 48_000;

/// The values of one property at some times.
///
/// Positions and shifts are in scene units, angles in degrees. The direction of a light is the way the light travels.
/// Rotations are quaternions, of about length 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Track {
    pub target: TrackTarget,
    /// The number of the light, material, joint or morph target; 0 for the camera.
    pub index: usize,
    pub interpolation: Interpolation,
    /// At least one, by rising times.
    pub keys: Vec<Key>,
    /// Its place in the scene file, for messages.
    pub place: SourceSpan,
}

/// A value at a time. Values with fewer than four components have zeros for the others.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Key {
    pub seconds: f64,
    pub value: [f64; 4],
    /// For splines: the change per second with which the value is reached.
    pub entering: [f64; 4],
    /// For splines: the change per second with which it is left.
    pub leaving: [f64; 4],
}

impl Key {
    /// Returns a key of a vector, without tangents.
    pub fn of_vector(seconds: f64, vector: DVec3) -> Self {
        let [x, y, z] = vector.to_array();
        Self {
            seconds,
            value: [x, y, z, 0.0],
            ..Self::default()
        }
    }

    /// Returns the first three components of the value.
    pub fn vector(&self) -> DVec3 {
        let [x, y, z, _] = self.value;
        DVec3::new(x, y, z)
    }

    /// Returns the key with each component of its value and of its changes multiplied.
    pub(crate) fn weighted(self, by: [f64; 4]) -> Self {
        let weighted =
            |it: [f64; 4]| std::array::from_fn(|component| it[component] * by[component]);
        Self {
            seconds: self.seconds,
            value: weighted(self.value),
            entering: weighted(self.entering),
            leaving: weighted(self.leaving),
        }
    }
}

impl Track {
    /// Points whose convex hull holds all values of the track.
    pub(crate) fn control_points(&self) -> impl Iterator<Item = DVec4> + Clone {
        control_points(self.interpolation, &self.keys)
    }

    /// The value at the tick that is nearest to a time, in the precision of `f64`. Rotations are of any length but 0.
    pub(crate) fn at(&self, seconds: f64) -> [f64; 4] {
        let turns = self.target.kind() == ValueKind::Rotation;
        interpolate(self.interpolation, &self.keys, turns, seconds)
    }
}

/// Points whose convex hull holds all values between keys.
pub(crate) fn control_points(
    interpolation: Interpolation,
    keys: &[Key],
) -> impl Iterator<Item = DVec4> + Clone {
    let vector = DVec4::from_array;
    let values = keys.iter().map(move |key| vector(key.value));
    let cubic = interpolation == Interpolation::Cubic;
    let pairs = keys.windows(2).filter(move |_| cubic);
    let between = pairs.flat_map(move |pair: &[Key]| {
        let third = (pair[1].seconds - pair[0].seconds) / 3.0;
        [
            vector(pair[0].value) + vector(pair[0].leaving) * third,
            vector(pair[1].value) - vector(pair[1].entering) * third,
        ]
    });
    values.chain(between)
}

/// The values of the first component at keys, and where a spline turns back between them: all extremes.
pub(crate) fn extremes(interpolation: Interpolation, keys: &[Key]) -> impl Iterator<Item = f64> {
    let cubic = interpolation == Interpolation::Cubic;
    let pairs = keys.windows(2).filter(move |_| cubic);
    let between = pairs.flat_map(|pair| {
        let [one, other] = [&pair[0], &pair[1]];
        turning_points(one, other).map(|part| spline(one, other, part)[0])
    });
    keys.iter().map(|key| key.value[0]).chain(between)
}

/// The parts of the time between two keys at which the first component of their spline turns back: where its slope, a
/// polynomial of degree 2, is 0.
pub(crate) fn turning_points(one: &Key, other: &Key) -> impl Iterator<Item = f64> + use<> {
    let duration = on_tick(other.seconds) - on_tick(one.seconds);
    let change = other.value[0] - one.value[0];
    let [leaving, entering] = [one.leaving, other.entering].map(|it| it[0] * duration);
    let a = 3.0 * (leaving + entering) - 6.0 * change;
    let b = 6.0 * change - 4.0 * leaving - 2.0 * entering;
    let root = (b * b - 4.0 * a * leaving).sqrt();
    // Without cancellation.
    let sum = -0.5 * (b + root.copysign(b));
    let parts = [sum / a, leaving / sum].into_iter();
    parts.filter(|part| *part > 0.0 && *part < 1.0)
}

/// The spline between two keys, at a part of the time between them.
fn spline(one: &Key, other: &Key, part: f64) -> [f64; 4] {
    let duration = on_tick(other.seconds) - on_tick(one.seconds);
    let (square, cube) = (part * part, part * part * part);
    std::array::from_fn(|component| {
        (2.0 * cube - 3.0 * square + 1.0) * one.value[component]
            + (cube - 2.0 * square + part) * duration * one.leaving[component]
            + (3.0 * square - 2.0 * cube) * other.value[component]
            + (cube - square) * duration * other.entering[component]
    })
}

/// Returns true if the integers of a program hold a quaternion between keys of this length as one without any.
fn has_no_length(quaternion: &[f64; 4], of_keys: f64) -> bool {
    // Half a step of 30 fraction bits.
    const HALF: f64 = 0.5 / (1 << 30) as f64;
    quaternion.iter().all(|it| it.abs() < HALF * of_keys)
}

/// The time of the nearest tick.
fn on_tick(seconds: f64) -> f64 {
    let ticks = f64::from(TICKS_PER_SECOND);
    (seconds * ticks).round() / ticks
}

/// The value between keys at a time; `turns` says that they are rotations. Where a spline passes a quaternion without a
/// length, this is the earlier key's.
pub(super) fn interpolate(
    interpolation: Interpolation,
    keys: &[Key],
    turns: bool,
    seconds: f64,
) -> [f64; 4] {
    // Times are those of ticks, as in a blob.
    let seconds = on_tick(seconds);
    let after = keys.partition_point(|key| on_tick(key.seconds) <= seconds);
    let one = &keys[after.saturating_sub(1)];
    let Some(other) = keys.get(after).filter(|_| after > 0) else {
        return one.value;
    };
    let begin = on_tick(one.seconds);
    let duration = on_tick(other.seconds) - begin;
    let part = (seconds - begin) / duration;
    if turns && interpolation == Interpolation::Linear {
        let [one, other] = [one, other].map(|key| DQuat::from_array(key.value).normalize());
        return one.slerp(other, part).to_array();
    }
    let linear = |component: usize| {
        one.value[component] + part * (other.value[component] - one.value[component])
    };
    match interpolation {
        Interpolation::Step => one.value,
        Interpolation::Linear => std::array::from_fn(linear),
        Interpolation::Cubic => {
            let between = spline(one, other, part);
            let of_keys = DVec4::from_array(one.value).length();
            match turns && has_no_length(&between, of_keys) {
                // No rotation is meant there.
                true => one.value,
                false => between,
            }
        }
    }
}
