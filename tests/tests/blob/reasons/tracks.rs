//! The times and tracks of moving properties.

use super::{Errors, aside, everything};
use crate::blob::small_scene;
use bytemuck::Pod;
use gridel_core::Tracks;
use gridel_core::format::track::{Interpolation, Timeline, Track, TrackTarget};
use gridel_core::format::{BlobError, Field, Reason, SectionKind};
use gridel_host::compile::{Options, compile};
use gridel_tests::fuzz::Base;
use gridel_tests::scenes;

/// The error of tracks after a record was changed.
pub(super) fn forged<T: Pod>(
    base: &Base,
    kind: SectionKind,
    index: usize,
    change: impl FnOnce(&mut T),
) -> BlobError {
    let mut base = base.clone();
    base.change(kind, index, change);
    aside(base, |blob| Tracks::from_bytes(blob).map(drop))
}

/// The number of a target's first track, and the track.
fn find(base: &Base, target: TrackTarget) -> (usize, Track) {
    let mut base = base.clone();
    let all = 0..base.records(SectionKind::Tracks);
    let mut tracks = all.map(|index| (index, base.record(SectionKind::Tracks, index)));
    let is_meant = |(_, track): &(usize, Track)| track.target() == Some(target);
    tracks.find(is_meant).expect("a track")
}

/// A track and a change of it.
type TrackForgery<'f> = (TrackTarget, Field, TrackChange<'f>);
type TrackChange<'f> = &'f dyn Fn(&mut Track);

pub(super) fn tracks() -> Errors {
    let mut errors = everything();
    let base = errors.base.clone();
    let timeline = |change: fn(&mut Timeline)| forged(&base, SectionKind::Timeline, 0, change);
    for (field, error) in [
        (
            Field::TicksPerSecond,
            timeline(|it| it.ticks_per_second = 0),
        ),
        (
            Field::TicksPerSecond,
            timeline(|it| it.ticks_per_second = 1 << 31),
        ),
        (Field::FirstTime, timeline(|it| it.first += 1)),
        (Field::LastTime, timeline(|it| it.last = i32::MAX)),
    ] {
        errors.take_field(error, "section timeline", field);
    }
    let forgeries: [TrackForgery; 9] = [
        (TrackTarget::CameraEye, Field::TrackTarget, &|it| {
            it.target = 18
        }),
        (TrackTarget::CameraUp, Field::Interpolation, &|it| {
            it.interpolation = 3
        }),
        (TrackTarget::CameraEye, Field::TrackIndex, &|it| {
            it.index = 1
        }),
        (TrackTarget::LightColor, Field::TrackIndex, &|it| {
            it.index = 2
        }),
        (TrackTarget::MaterialMirror, Field::TrackIndex, &|it| {
            it.index = u32::MAX
        }),
        (TrackTarget::CameraEye, Field::Keys, &|it| it.keys = 0),
        (TrackTarget::MaterialMirror, Field::Keys, &|it| {
            it.keys = u32::MAX
        }),
        (TrackTarget::CameraUp, Field::FirstTime, &|it| {
            it.first_time = 0
        }),
        (TrackTarget::CameraUp, Field::FirstWord, &|it| {
            it.first_word += 1
        }),
    ];
    for (target, field, change) in forgeries {
        let (index, _) = find(&base, target);
        let error = forged(&base, SectionKind::Tracks, index, change);
        errors.take_field(error, &format!("track {index}"), field);
    }
    let (_, up) = find(&base, TrackTarget::CameraUp);
    for same in [0, -48_000] {
        let key = up.first_time as usize + 1;
        let error = forged(&base, SectionKind::TrackTimes, key, |it: &mut i32| {
            *it = same
        });
        errors.take_field(error, &format!("key {key} of tracks"), Field::KeyTime);
    }
    let words: [(TrackTarget, Field, &[i32]); 6] = [
        (
            TrackTarget::CameraFieldOfView,
            Field::FieldOfView,
            &[1, 0, -1],
        ),
        (
            TrackTarget::LightDirection,
            Field::Direction,
            &[(1 << 30) + 1, i32::MIN],
        ),
        (TrackTarget::LightColor, Field::Color, &[-1]),
        (
            TrackTarget::MaterialDiffuse,
            Field::Color,
            &[-1, (1 << 30) + 1],
        ),
        (TrackTarget::MaterialOdd, Field::Color, &[-1]),
        (
            TrackTarget::MaterialTransmit,
            Field::Color,
            &[(1 << 30) + 1],
        ),
    ];
    for (target, field, values) in words {
        let (_, track) = find(&base, target);
        let spline = track.interpolation() == Some(Interpolation::Cubic);
        // In a spline the value stands behind the change before it.
        let word = track.first_word as usize + if spline { 3 } else { 0 };
        for &value in values {
            let error = forged(&base, SectionKind::TrackWords, word, |it: &mut i32| {
                *it = value
            });
            errors.take_field(error, &format!("word {word} of tracks"), field);
        }
    }
    let zero = up.first_word as usize;
    let error = forged(&base, SectionKind::TrackWords, zero + 1, |it: &mut i32| {
        *it = 0
    });
    errors.take_reason(
        error,
        &format!("word {zero} of tracks"),
        Reason::ZeroDirection,
    );

    let (eye, _) = find(&base, TrackTarget::CameraEye);
    let (color, _) = find(&base, TrackTarget::LightColor);
    let (direction, _) = find(&base, TrackTarget::LightDirection);
    let reasons: [(usize, Reason, TrackChange); 3] = [
        (eye + 1, Reason::TrackOrder, &|it| {
            it.target = TrackTarget::CameraEye as u16
        }),
        (color + 1, Reason::TrackOrder, &|it| it.index = 0),
        (direction, Reason::WrongLight, &|it| it.index = 0),
    ];
    for (index, reason, change) in reasons {
        let error = forged(&base, SectionKind::Tracks, index, change);
        errors.take_reason(error, &format!("track {index}"), reason);
    }
    let mut short = base.clone();
    short.remove(&[SectionKind::Timeline]);
    let error = Tracks::from_bytes(short.sealed().bytes()).expect_err("no timeline");
    assert_eq!(
        error.to_string(),
        "section timeline: it has 0 records; it must have 1"
    );
    errors
}

/// A camera that turns by rotations.
pub(super) fn turned_camera() -> Errors {
    let mut scene = small_scene();
    scene.tracks = scenes::moving(&scene, true);
    let blob = compile(&scene, &Options::default()).expect("compiles").blob;
    let mut errors = Errors::of(Base::of(blob.bytes()));
    let base = errors.base.clone();
    let (index, track) = find(&base, TrackTarget::CameraRotation);
    let word = track.first_word as usize;
    for (place, value, field) in [
        (word, (1 << 30) + 1, Field::Rotation),
        (word + 4, (1 << 30) + 1, Field::RotationAngle),
        (word + 4, -1, Field::RotationAngle),
    ] {
        let change = |it: &mut i32| *it = value;
        let error = forged(&base, SectionKind::TrackWords, place, change);
        errors.take_field(error, &format!("word {place} of tracks"), field);
    }
    let error = forged(&base, SectionKind::TrackWords, word + 3, |it: &mut i32| {
        *it = 0
    });
    errors.take_reason(
        error,
        &format!("word {word} of tracks"),
        Reason::ZeroRotation,
    );
    assert_eq!(index, 2);
    let blind = |it: &mut Track| it.target = TrackTarget::CameraTarget as u16;
    let error = forged(&base, SectionKind::Tracks, 0, blind);
    errors.take_reason(error, "section tracks", Reason::CameraInPart);
    errors
}
