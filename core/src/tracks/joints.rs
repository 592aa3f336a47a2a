//! Joints: instances at a time.

use crate::format::track::{Joint, TrackTarget};
use crate::format::{BlobError, SectionKind};
use crate::scene::{Motion, PosesView, Position, Scene};
use crate::tracks::Tracks;

impl<'a> Tracks<'a> {
    /// Returns the joints on which instances hang; a joint comes before those that hang on it.
    pub fn joints(&self) -> &'a [Joint] {
        self.0.joints
    }

    /// Returns the joint of an instance, given by its index among [`Scene::instances`]; `None` if it hangs on none.
    pub fn joint_of(&self, instance: usize) -> Option<usize> {
        let joint = self.0.instance_joints.get(instance).copied();
        joint
            .filter(|joint| *joint != Joint::NONE)
            .map(|joint| joint as usize)
    }

    /// Writes the motions of all joints at a time. Each includes the motions of the joints on which it hangs.
    ///
    /// # Errors
    /// If there are more or fewer motions than joints.
    pub fn motions_at(&self, time: i32, motions: &mut [Motion]) -> Result<(), BlobError> {
        self.check_count(motions)?;
        for ((number, joint), motion) in (0..).zip(self.0.joints).zip(motions.iter_mut()) {
            *motion = self.own_motion(number, joint, time);
        }
        self.chain(motions)
    }

    /// Adds to the own motion of each joint that of the joint on which it hangs. For a program that bends joints.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{Angle, BlobError, Motion, PosesView, Position, Scene, Tracks};
    ///
    /// /// Bends every joint of an arm by the same angle, about z.
    /// fn bend(
    ///     tracks: &Tracks<'_>,
    ///     scene: &Scene<'_>,
    ///     angle: Angle,
    ///     poses: &mut PosesView<'_>,
    /// ) -> Result<(), BlobError> {
    ///     let mut motions = [Motion::REST; 6];
    ///     let motions = &mut motions[..tracks.joints().len()];
    ///     for (joint, motion) in tracks.joints().iter().zip(motions.iter_mut()) {
    ///         let turn = Motion::turn(Position(joint.pivot), [0, 0, 1], angle);
    ///         *motion = turn.unwrap_or(Motion::REST);
    ///     }
    ///     tracks.chain(motions)?;
    ///     tracks.place(scene, motions, poses)
    /// }
    /// # // Nothing hangs on joints here.
    /// # let (scene, tracks) = (Scene::from_bytes(BLOB)?, Tracks::from_bytes(BLOB)?);
    /// # let mut memory = gridel_core::Poses::<0>::new();
    /// # let mut poses = memory.at_rest(&scene)?;
    /// # bend(&tracks, &scene, Angle::QUARTER, &mut poses)?;
    /// # Ok::<(), BlobError>(())
    /// ```
    ///
    /// # Errors
    /// If there are more or fewer motions than joints.
    pub fn chain(&self, motions: &mut [Motion]) -> Result<(), BlobError> {
        self.check_count(motions)?;
        for (index, joint) in self.0.joints.iter().enumerate() {
            // Earlier joints are complete here.
            let parent = motions.get(joint.parent as usize).copied();
            if let (Some(parent), Some(motion)) = (parent, motions.get_mut(index)) {
                *motion = motion.then(&parent);
            }
        }
        Ok(())
    }

    /// Places the instances that hang on joints, given the joints' motions, which include those of the joints on which
    /// they hang.
    ///
    /// # Errors
    /// If there are more or fewer motions than joints. Also if an instance would be too far away, too large or too
    /// small for the scene's lattice.
    pub fn place(
        &self,
        scene: &Scene<'_>,
        motions: &[Motion],
        poses: &mut PosesView<'_>,
    ) -> Result<(), BlobError> {
        self.check_count(motions)?;
        for (index, joint) in self.0.instance_joints.iter().enumerate() {
            if let Some(motion) = motions.get(*joint as usize) {
                poses.place_at(scene, index, motion)?;
            }
        }
        Ok(())
    }

    fn check_count(&self, motions: &[Motion]) -> Result<(), BlobError> {
        let (found, expected) = (motions.len(), self.0.joints.len());
        if found == expected {
            return Ok(());
        }
        Err(BlobError::Memory {
            section: SectionKind::Joints,
            found,
            needed: expected,
        })
    }

    /// The own motion of a joint.
    fn own_motion(&self, number: u32, joint: &Joint, time: i32) -> Motion {
        let pivot = Position(joint.pivot);
        let mut own = Motion::REST;
        if let Some([scale]) = self.numbered(TrackTarget::JointScale, number, time) {
            own = Motion::scale(pivot, scale);
        }
        if let Some(rotation) = self.numbered(TrackTarget::JointRotation, number, time) {
            let turn = Motion::rotation(pivot, rotation);
            own = turn.map_or(own, |turn| own.then(&turn));
        }
        if let Some(shift) = self.numbered(TrackTarget::JointShift, number, time) {
            own = own.then(&Motion::shift(shift));
        }
        own
    }
}
