//! The tracks of a blob, a line each.

use gridel_core::Tracks;
use gridel_core::format::track::{self as record, Timeline};
use gridel_host::table::counted;
use serde::Serialize;

/// All that moves in a blob.
#[derive(Serialize)]
pub struct TrackList {
    ticks_per_second: u32,
    /// Seconds of the first and of the last key.
    pub first: f64,
    pub last: f64,
    /// Bytes of their sections.
    pub bytes: usize,
    pub tracks: Vec<TrackLine>,
}

#[derive(Serialize)]
pub struct TrackLine {
    target: &'static str,
    /// The number of the light, material, joint or morph target; 0 for the camera.
    index: u32,
    interpolation: &'static str,
    keys: u32,
}

impl TrackList {
    pub fn of(blob: &[u8]) -> Option<Self> {
        // They were checked with the scene.
        let tracks = Tracks::from_bytes(blob).ok().filter(|it| !it.is_empty())?;
        let seconds = |ticks: i32| f64::from(ticks) / f64::from(tracks.ticks_per_second());
        let [first, last] = tracks.span().map(seconds);
        let lines = tracks.tracks().iter().filter_map(|track| {
            Some(TrackLine {
                target: track.target()?.name(),
                index: track.index,
                interpolation: track.interpolation()?.name(),
                keys: track.keys,
            })
        });
        let words = tracks.tracks().iter().filter_map(|track| {
            let words = record::Track::words(track.target()?.kind(), track.interpolation()?);
            Some(track.keys as usize * (1 + words) * size_of::<i32>())
        });
        let records = size_of::<Timeline>() + size_of_val(tracks.tracks());
        Some(Self {
            ticks_per_second: tracks.ticks_per_second(),
            first,
            last,
            bytes: records + words.sum::<usize>(),
            tracks: lines.collect(),
        })
    }
}

impl TrackLine {
    pub fn text(&self) -> String {
        let Self {
            target,
            index,
            interpolation,
            keys,
        } = self;
        let keys = counted(*keys as usize, "key");
        match target.split_once('.') {
            Some((owner @ ("light" | "material" | "joint" | "morph"), property)) => {
                format!("{owner} {index}, {property}: {keys}, {interpolation}")
            }
            _ => format!("{target}: {keys}, {interpolation}"),
        }
    }
}
