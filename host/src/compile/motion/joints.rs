//! Joints as records of a blob.

use super::tracks::check_spline;
use crate::compile::error::CompileError;
use crate::compile::section::{Section, section};
use crate::compile::view::coordinates::position;
use crate::scene::{Joint, JointTracks, Key, ScaleRange, Scene, Track, TrackTarget};
use crate::table::printable;
use glam::DVec3;
use gridel_core::format::SectionKind;
use gridel_core::format::record::Header;
use gridel_core::format::track as records;

/// Most joints that hang on each other, so that a chain takes little time.
const MOST_LEVELS: usize = 1024;

/// Checks that joints hang on joints before them, not too many on each other, and that instances and tracks name joints
/// that exist.
pub fn check(scene: &Scene) -> Result<(), CompileError> {
    let mut levels: Vec<usize> = Vec::with_capacity(scene.joints.len());
    let error = |name: &str, cause: String| CompileError::Joint {
        name: printable(name),
        cause,
        remedy: "hang joints on joints before them, in shorter chains, with pivots near the scene",
    };
    for joint in &scene.joints {
        let Joint {
            name,
            parent,
            pivot,
            ..
        } = joint;
        let level = match parent.map(|parent| levels.get(parent)) {
            None => 1,
            Some(Some(level)) => level + 1,
            Some(None) => {
                let cause = String::from("hangs on a joint that is not before it");
                return Err(error(name, cause));
            }
        };
        if level > MOST_LEVELS {
            let cause = format!("stands in a chain of more than {MOST_LEVELS} joints");
            return Err(error(name, cause));
        }
        if !pivot.is_finite() {
            let cause = String::from("has a pivot that is infinite or not a number");
            return Err(error(name, cause));
        }
        levels.push(level);
    }
    let is_valid = |joint: usize| joint < levels.len();
    let mut instances = scene.instances.iter();
    if let Some(lost) = instances.find(|it| it.joint.is_some_and(|joint| !is_valid(joint))) {
        return Err(CompileError::Instance {
            instance: printable(&lost.name),
        });
    }
    let mut tracks = scene.tracks.iter();
    match tracks.find(|track| track.target.is_of_joint() && !is_valid(track.index)) {
        None => check_scales(scene),
        Some(track) => Err(CompileError::Track {
            place: track.place.clone(),
            target: scene.target_of(track),
            cause: format!("there is no joint {}", track.index),
            remedy: String::from("use the number of a joint of the scene"),
        }),
    }
}

/// Checks that programs can compose the scales of all joints that move instances.
fn check_scales(scene: &Scene) -> Result<(), CompileError> {
    let mut moves = vec![false; scene.joints.len()];
    for instance in scene.instances.iter().filter(|it| scene.is_placed(it)) {
        let mut next = instance.joint;
        while let Some(joint) = next.filter(|&joint| !moves[joint]) {
            moves[joint] = true;
            next = scene.joints[joint].parent;
        }
    }
    let mut ranges: Vec<ScaleRange> = Vec::with_capacity(scene.joints.len());
    for ((joint, tracks), moves) in scene.joints.iter().zip(JointTracks::of(scene)).zip(moves) {
        if let Some(track) = tracks.scale.filter(|_| moves) {
            check_spline(scene, track)?;
        }
        let own = tracks.scale.map_or(ScaleRange::REST, |track| {
            ScaleRange::of(track.interpolation, &track.keys)
        });
        let above = joint.parent.map_or(ScaleRange::REST, |it| ranges[it]);
        let range = own.under(&above);
        if let Some(cause) = range.fault().filter(|_| moves) {
            return Err(CompileError::Joint {
                name: printable(&joint.name),
                cause,
                remedy: "use smaller changes of scale, or copy the instances with `--instances flatten`",
            });
        }
        ranges.push(range);
    }
    Ok(())
}

/// Returns the tracks of a scene that a blob holds: those of joints only if instances can follow them.
pub fn kept_tracks(scene: &Scene) -> Vec<Track> {
    let has_instances = !scene.instances.is_empty();
    let kept = |track: &&Track| has_instances || !track.target.is_of_joint();
    scene.tracks.iter().filter(kept).cloned().collect()
}

/// Returns the positions that joints reach, for the choice of coordinates.
pub fn places(scene: &Scene) -> impl Iterator<Item = DVec3> {
    let shifts = scene
        .tracks
        .iter()
        .filter(|track| track.target == TrackTarget::JointShift);
    let shifted = shifts.flat_map(|track| {
        let pivot = scene.joints[track.index].pivot;
        track.keys.iter().map(Key::vector).map(move |it| pivot + it)
    });
    scene.joints.iter().map(|joint| joint.pivot).chain(shifted)
}

/// Returns the section of joints; none where there is nothing to move.
pub fn sections(scene: &Scene, header: &Header) -> Result<Vec<Section>, CompileError> {
    if scene.instances.is_empty() || scene.joints.is_empty() {
        return Ok(Vec::new());
    }
    let record = |joint: &Joint| {
        let far = || CompileError::Joint {
            name: printable(&joint.name),
            cause: String::from("has a pivot beyond the range of scene coordinates"),
            remedy: "move the pivot nearer to the scene",
        };
        Ok(records::Joint {
            pivot: position(header, joint.pivot).ok_or_else(far)?.0,
            parent: joint
                .parent
                .map_or(records::Joint::NONE, |parent| parent as u32),
        })
    };
    let records = scene.joints.iter().map(record);
    let records: Vec<_> = records.collect::<Result<_, CompileError>>()?;
    Ok(vec![section(SectionKind::Joints, &records)])
}

#[cfg(test)]
mod tests;
