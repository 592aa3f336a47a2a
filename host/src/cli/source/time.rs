//! Times of a scene that moves.

use crate::cli::failure::Failure;
use gridel_core::Tracks;

/// Rejects a time beyond the first or the last tick, whose picture it would show.
pub fn check(tracks: &Tracks<'_>, seconds: f64) -> Result<(), Failure> {
    let end = f64::from(i32::MAX) / f64::from(tracks.ticks_per_second());
    if seconds.abs() <= end {
        return Ok(());
    }
    Err(Failure::usage(
        format!("the time {seconds} s is beyond the end of time"),
        format!("give a time from -{0} to {0}", end.floor()),
    ))
}
