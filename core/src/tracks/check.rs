//! The proofs that [`Tracks::from_bytes`](crate::Tracks::from_bytes) makes.

use crate::format::range::{At, Ranges};
use crate::format::record::Light;
use crate::format::track::{Interpolation, Joint, Track, TrackTarget, ValueKind};
use crate::format::{BlobError, Field, Location, Reason, SectionKind};
use crate::number::Angle;
use crate::tracks::records::Records;

/// Proves all that is in the tracks of a blob with these lights and this many materials.
pub(super) fn check(
    records: &Records<'_>,
    lights: &[Light],
    materials: usize,
) -> Result<(), BlobError> {
    let section = SectionKind::Timeline;
    let timeline = At { section, index: 0 };
    records.timeline.check_ranges(timeline.location())?;
    let mut next = Taken::default();
    let mut last = None;
    let mut camera = 0_u32;
    for (index, track) in records.tracks.iter().enumerate() {
        let section = SectionKind::Tracks;
        let at = At { section, index };
        let counts = Counts {
            materials,
            joints: records.joints.len(),
            morph_targets: records.weights.len(),
        };
        let target = check_track(at, track, lights, counts)?;
        at.ensure(last < Some((target, track.index)), Reason::TrackOrder)?;
        last = Some((target, track.index));
        if target.is_of_camera() {
            camera |= 1 << target as u32;
        }
        next = check_keys(records, at, track, target.kind(), next)?;
    }
    for (section, found, expected) in [
        (SectionKind::TrackTimes, records.times.len(), next.times),
        (SectionKind::TrackWords, records.words.len(), next.words),
    ] {
        if found != expected {
            return Err(BlobError::Count {
                section,
                found,
                expected,
            });
        }
    }
    let times = records.times.iter().copied();
    let (first, latest) = (times.clone().min(), times.max());
    for (field, found, expected) in [
        (Field::FirstTime, records.timeline.first, first),
        (Field::LastTime, records.timeline.last, latest),
    ] {
        // Without keys there is no timeline.
        let expected = expected.unwrap_or(found).into();
        timeline.within(field, found.into(), expected, expected)?;
    }
    Location::Section(SectionKind::Tracks).ensure(is_whole(camera), Reason::CameraInPart)
}

/// Proves that joints hang on earlier joints, and this many instances on joints.
pub(super) fn check_joints(records: &Records<'_>, instances: usize) -> Result<(), BlobError> {
    let section = SectionKind::Joints;
    for (index, joint) in records.joints.iter().enumerate() {
        let hangs = joint.parent == Joint::NONE || (joint.parent as usize) < index;
        At { section, index }.ensure(hangs, Reason::JointOrder)?;
    }
    let joints = records.joints.len();
    let (section, found) = (SectionKind::InstanceJoints, records.instance_joints.len());
    let expected = if joints == 0 { 0 } else { instances };
    if found != expected {
        return Err(BlobError::Count {
            section,
            found,
            expected,
        });
    }
    let last = joints as i64 - 1;
    let hanging = records.instance_joints.iter().enumerate();
    for (index, &joint) in hanging.filter(|(_, joint)| **joint != Joint::NONE) {
        At { section, index }.within(Field::Joint, joint.into(), 0, last)?;
    }
    Ok(())
}

/// Returns true if tracks of the camera, a bit for each, are either none or all that it needs.
fn is_whole(camera: u32) -> bool {
    use TrackTarget::{
        CameraEye, CameraFieldOfView, CameraOrbit, CameraRotation, CameraTarget, CameraUp,
    };
    let bit = |target: TrackTarget| 1_u32 << target as u32;
    let basis = bit(CameraEye) | bit(CameraFieldOfView);
    let aimed = basis | bit(CameraTarget) | bit(CameraUp);
    let turned = basis | bit(CameraRotation);
    [0, aimed, aimed | bit(CameraOrbit), turned].contains(&camera)
}

/// The numbers of what tracks can move, lights aside.
#[derive(Clone, Copy)]
struct Counts {
    materials: usize,
    joints: usize,
    morph_targets: usize,
}

/// Proves the numbers in a track; returns its target.
fn check_track(
    at: At,
    track: &Track,
    lights: &[Light],
    counts: Counts,
) -> Result<TrackTarget, BlobError> {
    let out_of_range = |field, found: u16, count: usize| {
        let range = [0, count as i64 - 1];
        Location::Record(at.section, at.index).out_of_range(field, found.into(), range)
    };
    let Some(target) = track.target() else {
        let count = TrackTarget::ALL.len();
        return Err(out_of_range(Field::TrackTarget, track.target, count));
    };
    if track.interpolation().is_none() {
        let count = Interpolation::ALL.len();
        return Err(out_of_range(
            Field::Interpolation,
            track.interpolation,
            count,
        ));
    }
    let count = if target.is_of_camera() {
        1
    } else if target.is_of_material() {
        counts.materials
    } else if target.is_of_joint() {
        counts.joints
    } else if target == TrackTarget::MorphWeight {
        counts.morph_targets
    } else {
        lights.len()
    };
    let last = count as i64 - 1;
    at.within(Field::TrackIndex, track.index.into(), 0, last)?;
    let light = lights.get(track.index as usize);
    let fits = match target {
        TrackTarget::LightPosition => light.is_some_and(Light::has_position),
        TrackTarget::LightDirection => light.is_some_and(|it| it.kind == Light::DIRECTIONAL),
        _ => true,
    };
    at.ensure(fits, Reason::WrongLight)?;
    track.check_ranges(at.location())?;
    Ok(target)
}

/// Times and words that earlier tracks use.
#[derive(Clone, Copy, Default)]
struct Taken {
    times: usize,
    words: usize,
}

/// Proves the keys of a track, which follow those of the tracks before.
fn check_keys(
    records: &Records<'_>,
    at: At,
    track: &Track,
    kind: ValueKind,
    next: Taken,
) -> Result<Taken, BlobError> {
    let interpolation = track.interpolation().unwrap_or(Interpolation::Step);
    let stride = Track::words(kind, interpolation);
    let exactly = |field, found: u32, expected: usize| {
        at.within(field, found.into(), expected as i64, expected as i64)
    };
    exactly(Field::FirstTime, track.first_time, next.times)?;
    exactly(Field::FirstWord, track.first_word, next.words)?;
    // Both arrays are contiguous, so there are fewer keys than words.
    let left = records.times.len().saturating_sub(next.times);
    let words_left = records.words.len().saturating_sub(next.words);
    let most = left.min(words_left.checked_div(stride).unwrap_or(0));
    at.within(Field::Keys, track.keys.into(), 1, most as i64)?;
    let keys = track.keys as usize;
    let taken = Taken {
        times: next.times.saturating_add(keys),
        words: next.words.saturating_add(keys.saturating_mul(stride)),
    };
    let mut earliest = i64::from(i32::MIN);
    let times = records.times.get(next.times..taken.times).unwrap_or(&[]);
    for (&time, index) in times.iter().zip(next.times..) {
        let section = SectionKind::TrackTimes;
        let at = At { section, index };
        at.within(Field::KeyTime, time.into(), earliest, i32::MAX.into())?;
        earliest = i64::from(time) + 1;
    }
    let words = records.words.get(next.words..taken.words).unwrap_or(&[]);
    for (key, index) in words.chunks_exact(stride.max(1)).zip(0_usize..) {
        let index = next.words.saturating_add(index.saturating_mul(stride));
        check_value(kind, interpolation, key, index)?;
    }
    Ok(taken)
}

/// Proves the ranges of a key's value, of which the first word has this index.
fn check_value(
    kind: ValueKind,
    interpolation: Interpolation,
    key: &[i32],
    index: usize,
) -> Result<(), BlobError> {
    let section = SectionKind::TrackWords;
    let components = kind.components();
    // The changes of a spline can be any number.
    let before = match interpolation {
        Interpolation::Cubic => components,
        _ => 0,
    };
    let index = index.saturating_add(before);
    let (value, rest) = key
        .get(before..)
        .unwrap_or(&[])
        .split_at_checked(components)
        .unwrap_or((&[], &[]));
    let [low, high] = kind.range().map(i64::from);
    for (&word, index) in value.iter().zip(index..) {
        At { section, index }.within(kind.field(), word.into(), low, high)?;
    }
    let at = At { section, index };
    let is_zero = value.iter().all(|&word| word == 0);
    let reason = match kind {
        ValueKind::Rotation => Reason::ZeroRotation,
        _ => Reason::ZeroDirection,
    };
    at.ensure(!(kind.has_length() && is_zero), reason)?;
    if let (Interpolation::Linear, [angle]) = (interpolation, rest) {
        let index = index.saturating_add(components);
        let quarter = Angle::QUARTER.0.into();
        At { section, index }.within(Field::RotationAngle, (*angle).into(), 0, quarter)?;
    }
    Ok(())
}
