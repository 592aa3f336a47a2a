//! The curves of a glTF animation: keys of one property of a node.

use super::buffers::Buffers;
use crate::scene::track::interpolate;
use crate::scene::{Interpolation, Key, SceneError, TICKS_PER_SECOND};
use glam::{DAffine3, DMat3, DVec3, DVec4};
use gltf::animation::Property;

/// The motion of a node's property.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    pub(super) interpolation: Interpolation,
    pub(super) keys: Vec<Key>,
}

impl Curve {
    /// Reads the keys of a channel; none if its counts do not fit.
    pub(super) fn read(
        channel: &gltf::animation::Channel<'_>,
        buffers: &Buffers<'_>,
    ) -> Result<Self, SceneError> {
        let sampler = channel.sampler();
        let times = buffers.times(&sampler.input())?;
        let values: Vec<[f64; 4]> = match channel.target().property() {
            Property::Rotation => buffers.numbers::<4>(&sampler.output())?,
            _ => {
                let vectors = buffers.numbers::<3>(&sampler.output())?;
                vectors
                    .into_iter()
                    .map(|[x, y, z]| [x, y, z, 0.0])
                    .collect()
            }
        };
        let interpolation = interpolation(&sampler);
        let each = values_of_key(interpolation);
        let keys = if values.len() == each * times.len() {
            let key = |([seconds], values): (&[f64; 1], &[[f64; 4]])| match *values {
                [entering, value, leaving] => Key {
                    seconds: *seconds,
                    value,
                    entering,
                    leaving,
                },
                _ => Key {
                    seconds: *seconds,
                    value: values[0],
                    ..Key::default()
                },
            };
            times
                .iter()
                .zip(values.chunks_exact(each))
                .map(key)
                .collect()
        } else {
            Vec::new()
        };
        Ok(Self {
            interpolation,
            keys,
        })
    }

    /// Reads the weights of so many morph targets; without keys if the counts do not fit.
    pub(super) fn weights(
        channel: &gltf::animation::Channel<'_>,
        targets: usize,
        buffers: &Buffers<'_>,
    ) -> Result<Vec<Self>, SceneError> {
        let sampler = channel.sampler();
        let times = buffers.times(&sampler.input())?;
        let values = buffers.numbers::<1>(&sampler.output())?;
        let interpolation = interpolation(&sampler);
        let each = values_of_key(interpolation);
        let fits = values.len() == targets * each * times.len();
        let key = |target: usize, number: usize| {
            // The values of all targets, between their changes where there are some.
            let value = |group: usize| {
                let [weight] = values[(number * each + group) * targets + target];
                [weight, 0.0, 0.0, 0.0]
            };
            let [seconds] = times[number];
            match interpolation {
                Interpolation::Cubic => Key {
                    seconds,
                    entering: value(0),
                    value: value(1),
                    leaving: value(2),
                },
                _ => Key {
                    seconds,
                    value: value(0),
                    ..Key::default()
                },
            }
        };
        let curve = |target: usize| Self {
            interpolation,
            keys: match fits {
                true => (0..times.len()).map(|number| key(target, number)).collect(),
                false => Vec::new(),
            },
        };
        Ok((0..targets).map(curve).collect())
    }

    /// Returns the keys with each value, and each change of it, mapped linearly.
    pub(super) fn map(&self, map: impl Fn([f64; 4]) -> [f64; 4]) -> Self {
        let key = |key: &Key| Key {
            seconds: key.seconds,
            value: map(key.value),
            entering: map(key.entering),
            leaving: map(key.leaving),
        };
        Self {
            interpolation: self.interpolation,
            keys: self.keys.iter().map(key).collect(),
        }
    }

    /// Returns the keys relative to a place at rest, with values and changes mapped by `linear`.
    pub(super) fn relative_to(&self, rest: DVec4, linear: DMat3) -> Self {
        let vector = |[x, y, z, _]: [f64; 4]| {
            let [x, y, z] = (linear * DVec3::new(x, y, z)).to_array();
            [x, y, z, 0.0]
        };
        let mut curve = self.clone();
        for key in &mut curve.keys {
            key.value = vector((DVec4::from_array(key.value) - rest).to_array());
            (key.entering, key.leaving) = (vector(key.entering), vector(key.leaving));
        }
        curve
    }

    /// Returns the positions in the scene's coordinates.
    pub(super) fn placed(&self, above: &DAffine3) -> Self {
        let vector = |[x, y, z, _]: [f64; 4]| {
            let [x, y, z] = above.transform_vector3(DVec3::new(x, y, z)).to_array();
            [x, y, z, 0.0]
        };
        let mut curve = self.map(vector);
        for (placed, key) in curve.keys.iter_mut().zip(&self.keys) {
            let [x, y, z] = above.transform_point3(key.vector()).to_array();
            placed.value = [x, y, z, 0.0];
        }
        curve
    }

    /// Moves keys to the nearest tick, so that a sample there does not see the value before it. Programs write a jump
    /// as two keys, which may share a tick. One of them then moves to the adjacent tick. If that has a key, they keep
    /// their times, which errors show.
    pub(super) fn round_times(&mut self) {
        let mut ticks: Vec<i64> = self.keys.iter().map(|key| tick(key.seconds)).collect();
        for second in 1..ticks.len() {
            let first = second - 1;
            let shared = ticks[first];
            if ticks[second] != shared {
                continue;
            }
            let before = first.checked_sub(1).and_then(|it| ticks.get(it));
            let is_free_before = before.is_none_or(|&tick| tick < shared - 1);
            let is_free_behind = ticks.get(second + 1).is_none_or(|&tick| tick > shared + 1);
            let off = |key: usize| self.keys[key].seconds - seconds(shared);
            match -off(first) > off(second) {
                true if is_free_before && shared > 0 => ticks[first] -= 1,
                false if is_free_behind => ticks[second] += 1,
                _ => {}
            }
        }
        for (number, key) in self.keys.iter_mut().enumerate() {
            let neighbors = [number.checked_sub(1), Some(number + 1)];
            let neighbors = neighbors.into_iter().flatten();
            let mut times = neighbors.filter_map(|it| ticks.get(it));
            if times.all(|time| *time != ticks[number]) {
                key.seconds = seconds(ticks[number]);
            }
        }
    }

    /// Proves what glTF promises.
    pub(super) fn check(&self, property: Property) -> Result<(), String> {
        if self.keys.is_empty() {
            return Err("it has no keys, or not a value for each".into());
        }
        let numbers = self.keys.iter().flat_map(|key| {
            let vectors = [key.value, key.entering, key.leaving];
            vectors.into_iter().flatten().chain([key.seconds])
        });
        if !numbers.into_iter().all(f64::is_finite) {
            return Err("a number is not finite".into());
        }
        // A blob counts ticks in 32 bits.
        let is_late = |key: &Key| i32::try_from(tick(key.seconds)).is_err();
        if let Some(late) = self.keys.iter().find(|key| is_late(key)) {
            let time = late.seconds;
            return Err(format!(
                "the time {time} is beyond 44739 seconds, the limit"
            ));
        }
        if !self
            .keys
            .is_sorted_by(|one, other| one.seconds < other.seconds)
        {
            return Err("its times do not ascend".into());
        }
        let turns = |key: &Key| key.value != [0.0; 4];
        if property == Property::Rotation && !self.keys.iter().all(turns) {
            return Err("a rotation has length 0".into());
        }
        Ok(())
    }

    /// The value at a time, as glTF defines it.
    pub(super) fn at(&self, seconds: f64, property: Property) -> [f64; 4] {
        let turns = property == Property::Rotation;
        interpolate(self.interpolation, &self.keys, turns, seconds)
    }
}

/// Returns the number of keys that a channel is read as; `targets` is the number of morph targets, each of which has
/// keys of its own. Values that belong to no time count as keys, because they are read, too.
pub(super) fn key_count(channel: &gltf::animation::Channel<'_>, targets: usize) -> u64 {
    let sampler = channel.sampler();
    let curves = match channel.target().property() {
        Property::MorphTargetWeights => targets.max(1),
        _ => 1,
    };
    let times = sampler.input().count().saturating_mul(curves);
    let values = sampler.output().count() / values_of_key(interpolation(&sampler));
    times.max(values) as u64
}

/// The interpolation of a sampler.
fn interpolation(sampler: &gltf::animation::Sampler<'_>) -> Interpolation {
    match sampler.interpolation() {
        gltf::animation::Interpolation::Step => Interpolation::Step,
        gltf::animation::Interpolation::Linear => Interpolation::Linear,
        gltf::animation::Interpolation::CubicSpline => Interpolation::Cubic,
    }
}

/// Returns the number of values per key: a spline's key has a change before and behind it.
fn values_of_key(interpolation: Interpolation) -> usize {
    match interpolation {
        Interpolation::Cubic => 3,
        _ => 1,
    }
}

/// The nearest tick, as the blob has times.
pub(super) fn tick(seconds: f64) -> i64 {
    (seconds * f64::from(TICKS_PER_SECOND)).round() as i64
}

/// The time of a tick.
pub(super) fn seconds(tick: i64) -> f64 {
    tick as f64 / f64::from(TICKS_PER_SECOND)
}
