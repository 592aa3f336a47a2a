//! The joints of a blob, and what hangs on them.

use glam::DVec3;
use gridel_core::format::track::Joint;
use gridel_core::{Scene, Tracks};
use gridel_host::table::{counted, significant};
use serde::Serialize;

/// A joint of a blob.
#[derive(Serialize)]
pub struct JointLine {
    /// The number of the joint that it hangs on.
    parent: Option<u32>,
    /// In scene units.
    pivot: [f64; 3],
    /// Number of instances that hang on it and on no joint below it.
    instances: usize,
}

impl JointLine {
    /// Returns the joints of a blob, in their order.
    pub fn all(scene: &Scene<'_>, blob: &[u8]) -> Vec<Self> {
        // They were checked with the scene.
        let Ok(tracks) = Tracks::from_bytes(blob) else {
            return Vec::new();
        };
        let mut instances = vec![0; tracks.joints().len()];
        for instance in 0..scene.instances().len() {
            if let Some(joint) = tracks.joint_of(instance) {
                instances[joint] += 1;
            }
        }
        let header = scene.header();
        let origin = DVec3::from_array(header.coordinate_origin());
        let step = f64::powi(2.0, header.coordinate_exponent());
        let joints = tracks.joints().iter().zip(instances);
        let line = |(joint, instances): (&Joint, usize)| Self {
            parent: Some(joint.parent).filter(|parent| *parent != Joint::NONE),
            pivot: (origin + step * DVec3::from_array(joint.pivot.map(f64::from))).to_array(),
            instances,
        };
        joints.map(line).collect()
    }

    /// Returns its description.
    pub fn text(&self, number: usize) -> String {
        let [x, y, z] = self.pivot.map(significant);
        let parent = self.parent.map(|parent| format!(" on joint {parent}"));
        let instances = counted(self.instances, "instance");
        format!(
            "{number}{}: {instances}, pivot ({x}, {y}, {z})",
            parent.unwrap_or_default()
        )
    }
}
