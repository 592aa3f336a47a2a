//! Joints: what moves the instances of a scene.

use super::placement::Placement;
use super::track::{Track, TrackTarget};
use super::{Instance, Scene};
use glam::{DQuat, DVec3};
use gridel_core::format::limits::SCALES;

/// The least scale of a joint.
pub const LEAST_SCALE: f64 = SCALES[0] as f64 / SCALE;

/// The largest scale of a joint.
pub const LARGEST_SCALE: f64 = SCALES[1] as f64 / SCALE;

/// A scale of 1 in a blob.
const SCALE: f64 = (1 << 24) as f64;

/// The tracks of a joint.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct JointTracks<'s> {
    pub(crate) rotation: Option<&'s Track>,
    pub(crate) shift: Option<&'s Track>,
    pub(crate) scale: Option<&'s Track>,
}

impl<'s> JointTracks<'s> {
    /// The tracks of each joint of a scene.
    pub(crate) fn of(scene: &'s Scene) -> Vec<Self> {
        let mut all = vec![Self::default(); scene.joints.len()];
        for track in &scene.tracks {
            let Some(joint) = all.get_mut(track.index) else {
                continue;
            };
            match track.target {
                TrackTarget::JointRotation => joint.rotation = Some(track),
                TrackTarget::JointShift => joint.shift = Some(track),
                TrackTarget::JointScale => joint.scale = Some(track),
                _ => {}
            }
        }
        all
    }

    /// The own motion of a joint at a time.
    fn motion(&self, pivot: DVec3, seconds: f64) -> Placement {
        let at = |track: Option<&Track>| track.map(|track| track.at(seconds));
        let rotation = at(self.rotation).map(|it| DQuat::from_array(it).normalize());
        let [x, y, z, _] = at(self.shift).unwrap_or_default();
        let scale = at(self.scale).map_or(1.0, |[scale, ..]| scale);
        let still = Placement {
            rotation: rotation.unwrap_or(DQuat::IDENTITY),
            translation: DVec3::ZERO,
            // A spline may lead beyond.
            scale: scale.clamp(LEAST_SCALE, LARGEST_SCALE),
        };
        Placement {
            translation: pivot + DVec3::new(x, y, z) - still.point(pivot),
            ..still
        }
    }
}

impl Scene {
    /// Returns the motion of each joint at a time. It moves what hangs on the joint away from its place at rest.
    ///
    /// This is computed in the precision of `f64`, at the nearest tick. A blob's tracks give the same in integers.
    ///
    /// ```
    /// use glam::DVec3;
    /// use gridel_host::scene::read;
    ///
    /// let file = "[[joint]]\nname = 'hinge'\npivot = [1, 0, 0]\n\
    ///     [[part]]\nname = 'door'\n\
    ///     [[part.object]]\nkind = 'sphere'\ncenter = [2, 0, 0]\nradius = 1\n\
    ///     [[instance]]\npart = 'door'\njoint = 'hinge'\n\
    ///     [[track]]\ntarget = 'joint.hinge.rotation'\naxis = [0, 0, 1]\ntimes = [0, 2]\nvalues = [0, 180]\n";
    /// let imported = read("door.toml".as_ref(), file.into(), &Default::default())?;
    /// let motion = imported.scene.motions(1.0)[0];
    /// assert!(motion.point(DVec3::new(2.0, 0.0, 0.0)).distance(DVec3::new(1.0, 1.0, 0.0)) < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn motions(&self, seconds: f64) -> Vec<Placement> {
        let mut motions: Vec<Placement> = Vec::with_capacity(self.joints.len());
        for (joint, tracks) in self.joints.iter().zip(JointTracks::of(self)) {
            let own = tracks.motion(joint.pivot, seconds);
            let parent = joint.parent.and_then(|parent| motions.get(parent));
            motions.push(parent.map_or(own, |parent| own.within(parent)));
        }
        motions
    }

    /// Returns the instances of the scene where they are at a time.
    pub fn instances_at(&self, seconds: f64) -> Vec<Instance> {
        let motions = self.motions(seconds);
        let posed = |instance: &Instance| {
            let motion = instance.joint.and_then(|joint| motions.get(joint));
            let placement = motion.map(|motion| instance.placement.within(motion));
            Instance {
                placement: placement.unwrap_or(instance.placement),
                ..instance.clone()
            }
        };
        self.instances.iter().map(posed).collect()
    }
}
