//! Tracks as records: times in ticks, values as integers.

mod splines;
#[cfg(test)]
mod tests;

use crate::compile::CompileError;
use crate::compile::section::{Section, section};
use crate::compile::view::camera::angle;
use crate::scene::{Camera, CauseAndRemedy, Key, Scene, TICKS_PER_SECOND, Track};
use crate::shape::{exp2, unit};
use crate::table::significant;
use glam::{DQuat, DVec3};
use gridel_core::format::SectionKind;
use gridel_core::format::record::Header;
use gridel_core::format::track::{
    self as records, Interpolation, Timeline, TrackTarget, ValueKind,
};

/// Returns the sections of a scene's tracks; none where nothing moves. `camera` has the values that its tracks leave
/// out. `materials` has the number in the blob of each material that an object has.
pub fn sections(
    scene: &Scene,
    tracks: Vec<Track>,
    camera: &Camera,
    materials: &[Option<u32>],
    header: &Header,
) -> Result<Vec<Section>, CompileError> {
    let mut all = tracks;
    check_camera(scene, &all)?;
    // Tracks that are supplied have the times of these.
    for track in &all {
        times(track).map_err(|it| fault(scene, track, it))?;
        check_spline(scene, track)?;
    }
    complete(&mut all, camera);
    let mut numbered: Vec<(TrackTarget, u32, &Track)> = Vec::new();
    for track in &all {
        let index = match track.target.is_of_material() {
            // Such a material is not visible.
            true => match materials[track.index] {
                Some(number) => {
                    check_alpha(scene, track)?;
                    number
                }
                None => continue,
            },
            false => track.index as u32,
        };
        numbered.push((track.target, index, track));
    }
    numbered.sort_by_key(|&(target, index, _)| (target, index));
    for pair in numbered.windows(2) {
        if (pair[0].0, pair[0].1) == (pair[1].0, pair[1].1) {
            let cause = String::from("the property has two tracks");
            let fault = CauseAndRemedy::new(cause, "put the keys of both into one track");
            return Err(self::fault(scene, pair[1].2, fault));
        }
    }
    let mut parts = Parts::default();
    for (target, index, track) in numbered {
        let keys = keys(track, header).map_err(|it| fault(scene, track, it))?;
        parts.tracks.push(records::Track {
            target: target as u16,
            interpolation: track.interpolation as u16,
            index,
            keys: keys.len() as u32,
            first_time: parts.times.len() as u32,
            first_word: parts.words.len() as u32,
        });
        for (time, words) in keys {
            parts.times.push(time);
            parts.words.extend(words);
        }
    }
    let (Some(&first), Some(&last)) = (parts.times.iter().min(), parts.times.iter().max()) else {
        return Ok(Vec::new());
    };
    let timeline = Timeline {
        ticks_per_second: TICKS_PER_SECOND,
        first,
        last,
    };
    Ok(vec![
        section(SectionKind::Timeline, &[timeline]),
        section(SectionKind::Tracks, &parts.tracks),
        section(SectionKind::TrackTimes, &parts.times),
        section(SectionKind::TrackWords, &parts.words),
    ])
}

/// Records so far.
#[derive(Default)]
struct Parts {
    tracks: Vec<records::Track>,
    times: Vec<i32>,
    words: Vec<i32>,
}

/// Proves that a camera that is turned by rotations is turned by nothing else.
fn check_camera(scene: &Scene, tracks: &[Track]) -> Result<(), CompileError> {
    let mut all = tracks.iter();
    let turned = all.any(|track| track.target == TrackTarget::CameraRotation);
    let aims = |track: &&Track| {
        let target = track.target;
        target == TrackTarget::CameraTarget
            || target == TrackTarget::CameraUp
            || target == TrackTarget::CameraOrbit
    };
    match tracks.iter().find(aims).filter(|_| turned) {
        None => Ok(()),
        Some(track) => {
            let cause = String::from("the camera has a rotation that moves, too");
            Err(fault(
                scene,
                track,
                CauseAndRemedy::new(cause, "remove one of the two"),
            ))
        }
    }
}

/// Checks that a track makes no glass of a material whose texture has an alpha, which glass ignores.
fn check_alpha(scene: &Scene, track: &Track) -> Result<(), CompileError> {
    let material = &scene.materials[track.index];
    let is_glass = material.transmit != [0.0; 3];
    let becomes_glass = track.target == TrackTarget::MaterialTransmit && track.raises();
    match material.alpha.is_some() && !is_glass && becomes_glass {
        false => Ok(()),
        true => {
            let cause = String::from("the material has an `alpha`, and glass has none");
            Err(fault(
                scene,
                track,
                CauseAndRemedy::new(cause, "remove `alpha` or the track"),
            ))
        }
    }
}

/// Checks that a spline does not lead out of the range of its values.
pub fn check_spline(scene: &Scene, track: &Track) -> Result<(), CompileError> {
    match splines::beyond(track) {
        None => Ok(()),
        Some(cause) => {
            let remedy = "use smaller tangents, more keys, or linear interpolation";
            Err(fault(scene, track, CauseAndRemedy::new(cause, remedy)))
        }
    }
}

/// Adds tracks of one key for what stands still of a camera that moves.
fn complete(tracks: &mut Vec<Track>, camera: &Camera) {
    let Some(first) = tracks.iter().find(|track| track.target.is_of_camera()) else {
        return;
    };
    let place = first.place.clone();
    // Times of other keys, so that the timeline stays as it is.
    let seconds = first.keys[0].seconds;
    let has = |target| tracks.iter().any(|track| track.target == target);
    let turned = has(TrackTarget::CameraRotation);
    let fov = DVec3::new(camera.fov_degrees, 0.0, 0.0);
    let still = [
        (TrackTarget::CameraEye, camera.eye, true),
        (TrackTarget::CameraTarget, camera.target, !turned),
        (TrackTarget::CameraUp, camera.up, !turned),
        (TrackTarget::CameraFieldOfView, fov, true),
    ];
    let missing = still.map(|(target, value, needed)| {
        (needed && !has(target)).then(|| Track {
            target,
            index: 0,
            interpolation: Interpolation::Step,
            keys: vec![Key::of_vector(seconds, value)],
            place: place.clone(),
        })
    });
    tracks.extend(missing.into_iter().flatten());
}

/// Returns the positions that a track reaches, for the choice of coordinates.
pub fn places(tracks: &[Track], camera: &Camera) -> Vec<DVec3> {
    let of = |target| {
        let tracks = tracks.iter().filter(move |track| track.target == target);
        tracks.flat_map(|track| track.keys.iter().map(Key::vector))
    };
    let [eyes, targets] = [TrackTarget::CameraEye, TrackTarget::CameraTarget].map(of);
    let orbits = tracks
        .iter()
        .any(|track| track.target == TrackTarget::CameraOrbit);
    let around = orbits.then(|| {
        let reach = |eye: DVec3| eye.distance(camera.target);
        let eyes = of(TrackTarget::CameraEye).chain([camera.eye]);
        let radius = DVec3::splat(eyes.map(reach).fold(0.0, f64::max));
        [camera.target - radius, camera.target + radius]
    });
    eyes.chain(targets)
        .chain(of(TrackTarget::LightPosition))
        .chain(around.into_iter().flatten())
        .collect()
}

/// An error of a track.
fn fault(scene: &Scene, track: &Track, fault: CauseAndRemedy) -> CompileError {
    let CauseAndRemedy { cause, remedy } = fault;
    CompileError::Track {
        place: track.place.clone(),
        target: scene.target_of(track),
        cause,
        // A file without lines is one with an animation to choose.
        remedy: match track.place.line {
            0 if track.place.is_known() => {
                format!("{remedy}, or leave the animation out with `--animation none`")
            }
            _ => remedy,
        },
    }
}

/// The times of a track's keys in ticks.
fn times(track: &Track) -> Result<Vec<i32>, CauseAndRemedy> {
    let mut times = Vec::with_capacity(track.keys.len());
    for key in &track.keys {
        let ticks = (key.seconds * f64::from(TICKS_PER_SECOND)).round();
        if ticks.abs() > f64::from(i32::MAX) {
            let most = i32::MAX as u32 / TICKS_PER_SECOND;
            let cause = format!("the time {} is beyond {most} seconds", key.seconds);
            return Err(CauseAndRemedy::new(cause, "use earlier times"));
        }
        times.push(ticks as i32);
    }
    if let Some(pair) = times.windows(2).position(|pair| pair[0] >= pair[1]) {
        let [one, other] = [pair, pair + 1].map(|key| track.keys[key].seconds);
        let cause = format!(
            "the times {one} and {other} are less than a tick apart, 1/{TICKS_PER_SECOND} of a second"
        );
        return Err(CauseAndRemedy::new(
            cause,
            "move them apart, or use only one of them",
        ));
    }
    Ok(times)
}

/// The keys of a track: each one's time and words.
fn keys(track: &Track, header: &Header) -> Result<Vec<(i32, Vec<i32>)>, CauseAndRemedy> {
    let kind = track.target.kind();
    let times = times(track)?;
    let seconds =
        |from: i32, to: i32| (f64::from(to) - f64::from(from)) / f64::from(TICKS_PER_SECOND);
    let scale = Scale::of(kind, track, header);
    let values = scale.values(track);
    let components = kind.components();
    let mut all = Vec::with_capacity(times.len());
    for (number, &time) in times.iter().enumerate() {
        let key = &track.keys[number];
        let mut words = Vec::new();
        // Changes per segment: those of its first and last key have no segment outside.
        let before = number.checked_sub(1).map(|it| seconds(times[it], time));
        let behind = times.get(number + 1).map(|&it| seconds(time, it));
        let factors = scale.factors(key);
        let change = |per_second: [f64; 4], duration: Option<f64>| {
            std::array::from_fn(|k| per_second[k] * factors[k] * duration.unwrap_or(0.0))
        };
        let spline = track.interpolation == Interpolation::Cubic;
        let groups: [(Number, Option<[f64; 4]>); 3] = [
            (
                Number::Entering,
                spline.then(|| change(key.entering, before)),
            ),
            (Number::Value, Some(values[number])),
            (Number::Leaving, spline.then(|| change(key.leaving, behind))),
        ];
        for (which, group) in groups {
            let numbers = group.into_iter().flatten().zip(factors);
            for (word, factor) in numbers.take(components) {
                let rounded = word.round();
                let most = match (kind, which) {
                    (ValueKind::Weight, Number::Value) => kind.range()[1],
                    _ => i32::MAX,
                };
                if rounded.is_nan() || rounded.abs() > f64::from(most) {
                    let limit = f64::from(i32::MAX) / factor.abs();
                    let (cause, remedy) = which.too_large(kind, limit);
                    return Err(CauseAndRemedy::new(
                        format!("at {} s {cause}", key.seconds),
                        remedy,
                    ));
                }
                words.push(rounded as i32);
            }
        }
        if (kind, track.interpolation) == (ValueKind::Rotation, Interpolation::Linear) {
            let next = values.get(number + 1).unwrap_or(&values[number]);
            words.push(between(values[number], *next));
        }
        all.push((time, words));
    }
    Ok(all)
}

/// A number of a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Number {
    /// The change with which the value is reached.
    Entering,
    Value,
    /// The change with which it is left.
    Leaving,
}

impl Number {
    /// Returns what to say of a number that is too large, and the remedy. `limit` is the largest change.
    fn too_large(self, kind: ValueKind, limit: f64) -> (String, &'static str) {
        let smaller = "use smaller values";
        let side = match (self, kind) {
            (Self::Entering, _) => "since the key before",
            (Self::Leaving, _) => "to the next key",
            (Self::Value, ValueKind::Weight) => {
                return (
                    String::from("a weight is beyond ±64"),
                    "use smaller weights",
                );
            }
            (Self::Value, ValueKind::Position) => {
                return (
                    String::from("it leads beyond the range of scene coordinates"),
                    "use smaller values, or move them nearer to the scene",
                );
            }
            (Self::Value, ValueKind::Turns) => {
                let cause =
                    "the angle is not above -46080 and below 46080 degrees, which are 128 turns";
                return (String::from(cause), smaller);
            }
            (Self::Value, _) => {
                let cause = format!("a value is beyond {}", significant(limit));
                return (cause, smaller);
            }
        };
        let cause = format!(
            "the tangent is too large: multiplied by the time {side}, it must be below {}",
            significant(limit)
        );
        (cause, "use a smaller tangent, or more keys")
    }
}

/// The angle between two quaternions as a part of a turn with 32 bits.
fn between(one: [f64; 4], other: [f64; 4]) -> i32 {
    let [one, other] = [one, other].map(|it| DQuat::from_array(it).normalize());
    // For small angles the sine is more exact than the cosine.
    let difference = one.inverse() * other;
    let angle = libm::atan2(difference.xyz().length(), difference.w.abs());
    let part = angle / std::f64::consts::TAU * exp2(32);
    part.round().min(exp2(30)) as i32
}

/// The conversion of a scene file's numbers to words.
enum Scale {
    /// Less an offset, times a factor.
    Linear {
        offset: DVec3,
        factor: f64,
    },
    /// Directions of light, brought to length 1.
    Towards,
    /// Quaternions.
    Rotation,
    FieldOfView,
    /// Colors, by their factor and largest value.
    Color {
        factor: f64,
        most: f64,
    },
}

impl Scale {
    fn of(kind: ValueKind, track: &Track, header: &Header) -> Self {
        match kind {
            ValueKind::Position => Self::Linear {
                offset: DVec3::from_array(header.coordinate_origin()),
                factor: exp2(-header.coordinate_exponent()),
            },
            ValueKind::Direction => {
                let largest = track
                    .keys
                    .iter()
                    .map(|key| key.vector().abs().max_element());
                let (_, exponent) = libm::frexp(largest.fold(0.0, f64::max));
                Self::Linear {
                    offset: DVec3::ZERO,
                    factor: libm::ldexp(1.0, 30 - exponent),
                }
            }
            ValueKind::UnitDirection => Self::Towards,
            ValueKind::FieldOfView => Self::FieldOfView,
            ValueKind::Rotation => Self::Rotation,
            ValueKind::Turns => Self::Linear {
                offset: DVec3::ZERO,
                factor: exp2(24) / 360.0,
            },
            ValueKind::Shift => Self::Linear {
                offset: DVec3::ZERO,
                factor: exp2(-header.coordinate_exponent()),
            },
            ValueKind::Scale | ValueKind::Weight => Self::Linear {
                offset: DVec3::ZERO,
                factor: exp2(24),
            },
            ValueKind::Radiance => Self::Color {
                factor: exp2(20),
                most: f64::from(i32::MAX),
            },
            ValueKind::Ratios => Self::Color {
                factor: exp2(30),
                most: exp2(30),
            },
        }
    }

    /// Returns the factors of the components of a key's changes.
    fn factors(&self, key: &Key) -> [f64; 4] {
        match *self {
            Self::Linear { factor, .. } | Self::Color { factor, .. } => [factor; 4],
            Self::Towards => [-exp2(30) / key.vector().length(); 4],
            Self::Rotation => [exp2(30); 4],
            Self::FieldOfView => [exp2(32) / 360.0; 4],
        }
    }

    /// The values of all keys.
    fn values(&self, track: &Track) -> Vec<[f64; 4]> {
        let vector = |vector: DVec3| {
            let [x, y, z] = vector.to_array();
            [x, y, z, 0.0]
        };
        let mut before = None;
        let value = |key: &Key| match *self {
            Self::Linear { offset, factor } => vector((key.vector() - offset) * factor),
            Self::Towards => vector(-unit(key.vector()) * exp2(30)),
            Self::FieldOfView => vector(DVec3::X * f64::from(angle(key.value[0]).0)),
            Self::Color { factor, most } => {
                key.value.map(|channel| (channel * factor).clamp(0.0, most))
            }
            Self::Rotation => {
                let mut rotation = DQuat::from_array(key.value).normalize();
                // A rotation has two quaternions. This takes the one on the shorter way. Splines state their way.
                let linear = track.interpolation == Interpolation::Linear;
                let turns_back = before.is_some_and(|before| rotation.dot(before) < 0.0);
                if linear && turns_back {
                    rotation = -rotation;
                }
                before = Some(rotation);
                rotation.to_array().map(|it| it * exp2(30))
            }
        };
        track.keys.iter().map(value).collect()
    }
}
