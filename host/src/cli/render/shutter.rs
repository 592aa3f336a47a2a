//! Motion blur: the moments of a scene that moves while a shutter is open.

use crate::cli::arguments;
use crate::cli::changes::Changes;
use crate::cli::failure::Failure;
use crate::cli::source::Source;
use clap::Args;
use gridel_core::{Scene, Tracks};
use gridel_host::picture::Exposure;
use gridel_host::state::{exposed, ticks};
use gridel_host::table::{counted, grouped};

/// How long the shutter is open.
#[derive(Args, Clone, Debug)]
pub struct ShutterOptions {
    /// Blur what moves: the shutter is open for so many seconds from each time on
    #[arg(long, value_name = "SECONDS", value_parser = arguments::open_seconds,
        allow_hyphen_values = true)]
    pub shutter: Option<f64>,

    /// Moments while the shutter is open, evenly apart. Samples are shared out among them, so there are at most as many
    /// as samples per pixel [default: 16, or else one per sample]
    #[arg(long, value_name = "N", requires = "shutter",
        value_parser = clap::value_parser!(u16).range(1..=256))]
    pub moments: Option<u16>,
}

/// Moments of a shutter by default.
const USUAL: u16 = 16;

/// The most bytes that instances of all moments take.
const MOST_BYTES: usize = 1 << 30;

impl ShutterOptions {
    /// For how many ticks the shutter is open, and over how many moments; `None` without one.
    ///
    /// # Errors
    /// If it is open for less than a tick.
    pub fn exposure(&self, tracks: &Tracks<'_>, samples: u16) -> Result<Option<Exposure>, Failure> {
        let Some(seconds) = self.shutter else {
            return Ok(None);
        };
        let open = u32::try_from(ticks(tracks, seconds)).unwrap_or(0);
        if open == 0 {
            let most = tracks.ticks_per_second();
            return Err(Failure::usage(
                format!("a shutter of {seconds} s is open for less than a tick, 1/{most} s"),
                "leave it out, or let it be open for longer",
            ));
        }
        let moments = self.moments.unwrap_or(USUAL.min(samples));
        if moments > samples {
            return Err(Failure::usage(
                format!(
                    "{} cannot be shared out among {}",
                    counted(samples.into(), "sample"),
                    counted(moments.into(), "moment")
                ),
                format!("ask for `--samples {moments}`, or for `--moments {samples}`"),
            ));
        }
        Ok(Some(Exposure { open, moments }))
    }
}

/// Returns the changes of a scene at each moment from a time on.
pub fn changes(
    source: &Source,
    (scene, tracks): (&Scene<'_>, &Tracks<'_>),
    time: i32,
    exposure: Option<Exposure>,
) -> Result<Vec<Changes>, Failure> {
    let Some(Exposure { open, moments }) = exposure else {
        return Ok(vec![source.changes_at(scene, tracks, time)?]);
    };
    let bytes = size_of_val(scene.instances()) * usize::from(moments);
    if bytes > MOST_BYTES {
        return Err(Failure::usage(
            format!(
                "{} at {} do not fit in memory at once",
                counted(scene.instances().len(), "instance"),
                counted(moments.into(), "moment")
            ),
            format!(
                "ask for fewer moments: {} bytes are the most",
                grouped(MOST_BYTES)
            ),
        ));
    }
    let times = exposed(time, open, moments);
    times
        .map(|time| source.changes_at(scene, tracks, time))
        .collect()
}

/// The scene with each of some changes.
pub fn scenes<'a>(changes: &'a [Changes], scene: &Scene<'a>) -> Result<Vec<Scene<'a>>, Failure> {
    changes.iter().map(|it| it.apply(scene)).collect()
}

/// Returns the text of a report about moments.
pub fn of_moments(number: Option<u16>) -> String {
    let said = |number: u16| format!(" at {}", counted(number.into(), "moment"));
    number.map_or(String::new(), said)
}
