//! Motion blur: the moments of a scene that moves while a shutter is open.

use crate::cli::arguments;
use crate::cli::changes::Changes;
use crate::cli::failure::Failure;
use crate::cli::output::warn;
use crate::cli::source::Source;
use clap::Args;
use gridel_core::format::limits::MAX_SAMPLES;
use gridel_core::{Scene, Tracks};
use gridel_host::picture::Exposure;
use gridel_host::state::{TimeError, exposed, ticks};
use gridel_host::table::{counted, grouped};

/// Options for the time that the shutter is open.
#[derive(Args, Clone, Debug)]
pub struct ShutterOptions {
    /// Blur what moves: the shutter is open for so many seconds from each time on
    #[arg(long, value_name = "SECONDS", value_parser = arguments::open_seconds,
        allow_hyphen_values = true)]
    pub shutter: Option<f64>,

    /// Moments while the shutter is open, evenly apart, 1 to 256. Samples are shared out among them, so their number
    /// should divide that of the samples per pixel [default: 16, or another number near it that divides the samples]
    #[arg(long, value_name = "N", requires = "shutter",
        value_parser = clap::value_parser!(u16).range(1..=256))]
    pub moments: Option<u16>,
}

/// Moments of a shutter by default.
const USUAL: u16 = 16;

/// The fewest moments of a shutter by default, where there are as many samples.
const FEWEST: u16 = 8;

/// The most moments of a shutter by default: each takes memory and time of its own.
const MOST_USUAL: u16 = 32;

/// The usual number of moments of some samples: one near 16 that divides them, as every moment then has as many; 16 if
/// there is none.
fn usual(samples: u16) -> u16 {
    let divides = |moments: &u16| samples.is_multiple_of(*moments);
    let fewer = (1..=USUAL.min(samples)).rev().find(divides);
    let more = || (USUAL..=MOST_USUAL.min(samples)).find(divides);
    let enough = fewer.filter(|&it| it >= FEWEST.min(samples));
    enough.or_else(more).unwrap_or(USUAL.min(samples))
}

/// Returns an error text if the moments do not have the same number of samples; `None` if they have.
fn unevenness(samples: u16, moments: u16) -> Option<String> {
    if samples.is_multiple_of(moments) {
        return None;
    }
    let few = samples / moments;
    let next = (few + 1)
        .checked_mul(moments)
        .filter(|&it| it <= MAX_SAMPLES);
    let next = next.unwrap_or(few * moments);
    let even = Some(usual(samples)).filter(|it| samples.is_multiple_of(*it));
    let fewer = even.map_or(String::new(), |it| format!(" or `--moments {it}`"));
    Some(format!(
        "some of the {moments} moments have {} and some {}, and so count for more: let the moments divide the samples, \
         such as `--samples {next}`{fewer}",
        counted(few.into(), "sample"),
        few + 1,
    ))
}

/// The most bytes that instances, meshes, lights and materials of all moments take.
const MOST_BYTES: usize = 1 << 30;

impl ShutterOptions {
    /// Returns the ticks for which the shutter is open, and the number of moments; `None` without one, or if nothing
    /// moves. Adds a warning if some moments count for more than others.
    ///
    /// # Errors
    /// If it is open for less than a tick, or for longer than there are ticks.
    pub fn exposure(
        &self,
        tracks: &Tracks<'_>,
        samples: u16,
        warnings: &mut Vec<String>,
    ) -> Result<Option<Exposure>, Failure> {
        // Where no track does anything, nothing is blurred.
        let Some(seconds) = self.shutter.filter(|_| !tracks.is_empty()) else {
            return Ok(None);
        };
        let open = ticks(tracks, seconds).map_err(|TimeError { end, .. }| {
            Failure::usage(
                format!(
                    "a shutter of {seconds} s is open for longer than the {end} s that there are"
                ),
                "let it be open for less time",
            )
        })?;
        let open = open.unsigned_abs();
        if open == 0 {
            let most = tracks.ticks_per_second();
            return Err(Failure::usage(
                format!("a shutter of {seconds} s is open for less than a tick, 1/{most} s"),
                "leave it out, or let it be open for longer",
            ));
        }
        let moments = self.moments.unwrap_or_else(|| usual(samples));
        if moments > samples {
            return Err(Failure::usage(
                format!(
                    "{} cannot be divided among {}",
                    counted(samples.into(), "sample"),
                    counted(moments.into(), "moment")
                ),
                format!("ask for `--samples {moments}`, or for `--moments {samples}`"),
            ));
        }
        if let Some(sentence) = unevenness(samples, moments) {
            warn(&sentence);
            warnings.push(sentence);
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
    let mut times = exposed(time, open, moments);
    let first = times.next();
    let first = first.map(|time| source.changes_at(scene, tracks, time));
    let mut all = Vec::from_iter(first.transpose()?);
    // Where meshes morph, each moment has a blob of its own, but for those at rest.
    let meshes = match tracks.weights_at_rest() {
        [] => 0,
        _ => source.blob.bytes().len(),
    };
    let each = all
        .first()
        .map_or(0, |it| it.state.bytes_without_meshes() + meshes);
    let bytes = each.saturating_mul(moments.into());
    if bytes > MOST_BYTES {
        return Err(Failure::usage(
            format!(
                "instances, meshes, lights and materials do not fit in memory at {} at once",
                counted(moments.into(), "moment")
            ),
            format!(
                "ask for fewer moments: {} bytes are the most",
                grouped(MOST_BYTES)
            ),
        ));
    }
    for time in times {
        all.push(source.changes_at(scene, tracks, time)?);
    }
    Ok(all)
}

/// Returns the scene with each of some changes.
pub fn scenes<'a>(changes: &'a [Changes], scene: &Scene<'a>) -> Result<Vec<Scene<'a>>, Failure> {
    changes.iter().map(|it| it.apply(scene)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn usual_moments_divide_the_samples() {
        for (samples, moments) in [
            (1, 1),
            (4, 4),
            (16, 16),
            (17, 17),
            (20, 10),
            (24, 12),
            (64, 16),
            (22, 11),
            (26, 13),
            (34, 17),
        ] {
            assert_eq!(usual(samples), moments, "{samples} samples");
            assert_eq!(unevenness(samples, moments), None);
        }
        // Large primes have no such number. More moments would take too long.
        for samples in [37, 251, 257] {
            assert_eq!(usual(samples), 16, "{samples} samples");
            let sentence = unevenness(samples, 16).unwrap();
            assert!(!sentence.contains("--moments"), "{sentence}");
        }
        assert_eq!(usual(31), 31);
    }

    #[test]
    fn moments_that_do_not_divide_the_samples_are_warned_of() {
        let sentence = unevenness(17, 16).unwrap();
        assert!(
            sentence.contains("`--samples 32` or `--moments 17`"),
            "{sentence}"
        );
    }
}
