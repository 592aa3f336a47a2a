//! The tracks of an import, where its camera, lights and materials are taken over.

use super::item::Item;
use super::source::Source;
use crate::scene::placement::rotation_and_scale;
use crate::scene::{Placement, Scene, SceneError, Track, TrackTarget};
use glam::{DAffine3, DQuat, DVec3};
use gridel_core::format::track::ValueKind;
use std::collections::HashSet;

/// The parts of an import that are adopted.
pub(super) struct ImportPlace<'p> {
    pub(super) camera: bool,
    /// The number of its first light.
    pub(super) lights: Option<usize>,
    /// The numbers of its materials; none if all its objects have another.
    pub(super) materials: &'p [usize],
}

impl ImportPlace<'_> {
    /// The import's tracks in this scene.
    pub(super) fn tracks(
        &self,
        source: &Source,
        item: &Item,
        import: &Scene,
    ) -> Result<Vec<Track>, SceneError> {
        let mut tracks = Vec::new();
        // Those of joints come along with the instances, and those of morph targets with these.
        let own = import
            .tracks
            .iter()
            .filter(|it| !it.target.is_of_joint() && it.target != TrackTarget::MorphWeight);
        for track in own {
            let (index, what) = if track.target.is_of_camera() {
                (self.camera.then_some(0), "camera")
            } else if track.target.is_of_material() {
                (self.materials.get(track.index).copied(), "material")
            } else {
                (self.lights.map(|first| first + track.index), "light")
            };
            if let Some(index) = index {
                let moved = moved(track, &item.transform);
                let mut moved = moved.ok_or_else(|| lost(source, item, what))?;
                if track.target == TrackTarget::LightColor
                    && let Some(Some(form)) = import.light_forms.get(track.index)
                {
                    brighten(&mut moved, form.moved_brightness(&item.transform));
                }
                tracks.push(Track { index, ..moved });
            }
        }
        Ok(tracks)
    }
}

/// Multiplies the colors of a track.
fn brighten(track: &mut Track, by: f64) {
    for key in &mut track.keys {
        *key = key.weighted([by; 4]);
    }
}

/// A scene's own tracks, and those of imports of what it does not move itself.
pub(super) fn with_imported(mut own: Vec<Track>, imported: Vec<Track>) -> Vec<Track> {
    let aims = own.iter().any(|track| {
        let target = track.target;
        target == TrackTarget::CameraTarget
            || target == TrackTarget::CameraUp
            || target == TrackTarget::CameraOrbit
    });
    let mut moved: HashSet<_> = own.iter().map(|it| (it.target, it.index)).collect();
    for track in imported {
        let instead = aims && track.target == TrackTarget::CameraRotation;
        if !instead && moved.insert((track.target, track.index)) {
            own.push(track);
        }
    }
    own
}

/// A track after a transform; `None` where it cannot follow.
pub(super) fn moved(track: &Track, by: &DAffine3) -> Option<Track> {
    let mut moved = track.clone();
    let of_joint = track.target.is_of_joint();
    let rotation = match track.target.kind() {
        ValueKind::Rotation if of_joint => {
            let placement = Placement::from_affine(by.matrix3, by.translation);
            Some(placement?.rotation)
        }
        ValueKind::Rotation => Some(rotation_of(by)?),
        _ => None,
    };
    // A mirror image turns the other way.
    let turns = by.matrix3.determinant().signum();
    let vector = |[x, y, z, _]: [f64; 4]| {
        let [x, y, z] = by.transform_vector3(DVec3::new(x, y, z)).to_array();
        [x, y, z, 0.0]
    };
    for key in &mut moved.keys {
        let place = by.transform_point3(key.vector());
        for value in [&mut key.value, &mut key.entering, &mut key.leaving] {
            *value = match (track.target.kind(), rotation) {
                (
                    ValueKind::Position
                    | ValueKind::Direction
                    | ValueKind::UnitDirection
                    | ValueKind::Shift,
                    _,
                ) => vector(*value),
                // It turns in the scene's coordinates, not from a rest of its own.
                (ValueKind::Rotation, Some(by)) if of_joint => {
                    (by * DQuat::from_array(*value) * by.inverse()).to_array()
                }
                (ValueKind::Rotation, Some(by)) => (by * DQuat::from_array(*value)).to_array(),
                (ValueKind::Turns, _) => value.map(|it| it * turns),
                _ => *value,
            };
        }
        if track.target.kind() == ValueKind::Position {
            let [x, y, z] = place.to_array();
            key.value = [x, y, z, 0.0];
        }
        let all = [key.value, key.entering, key.leaving];
        let is_direction = track.target.kind().is_direction();
        let finite = all.iter().flatten().all(|it| it.is_finite());
        if !finite || is_direction && key.value == [0.0; 4] {
            return None;
        }
    }
    Some(moved)
}

/// Returns the rotation of a transform that scales equally in all directions.
fn rotation_of(by: &DAffine3) -> Option<DQuat> {
    /// Far above rounding, and far below visible differences.
    const TOLERANCE: f64 = 1e-9;
    rotation_and_scale(by.matrix3, TOLERANCE).map(|(rotation, _)| rotation)
}

/// Returns the error of a track that cannot follow the transform of its import.
pub(super) fn lost(source: &Source, item: &Item, what: &str) -> SceneError {
    source.error(
        &item.span,
        format!("a {what} of this import cannot follow the transform of the import"),
        format!(
            "scale it alike along all axes, without a mirror and near to 1, move it less far, or give this scene its own {what}"
        ),
    )
}
