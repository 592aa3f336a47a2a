//! The sections of tracks.

use crate::format::track::{Joint, Timeline, Track};

/// The records of a blob's tracks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Records<'a> {
    pub(super) timeline: Timeline,
    pub(super) tracks: &'a [Track],
    pub(super) times: &'a [i32],
    pub(super) words: &'a [i32],
    pub(super) joints: &'a [Joint],
    /// For each instance, the joint on which it hangs.
    pub(super) instance_joints: &'a [u32],
    /// The weights of morph targets at rest.
    pub(super) weights: &'a [i32],
}
