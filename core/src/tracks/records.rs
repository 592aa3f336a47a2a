//! The sections of tracks.

use crate::format::track::{Timeline, Track};

/// The records of a blob's tracks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Records<'a> {
    pub(super) timeline: Timeline,
    pub(super) tracks: &'a [Track],
    pub(super) times: &'a [i32],
    pub(super) words: &'a [i32],
}
