//! Times of a scene that moves.

use super::{Source, warn_of_file};
use crate::cli::changes::Changes;
use crate::cli::failure::Failure;
use gridel_core::format::track::Track;
use gridel_core::{Scene, Tracks};
use gridel_host::morphed::MorphError;
use gridel_host::scene::Posed;
use gridel_host::state::{State, StateError, ticks};
use gridel_host::table::shortened;
use gridel_host::view::Notes;

/// Returns the tick of a time in seconds.
pub fn tick(tracks: &Tracks<'_>, seconds: f64) -> Result<i32, Failure> {
    ticks(tracks, seconds)
        .map_err(|error| Failure::usage(error.to_string(), "choose a time in this range"))
}

impl Source {
    /// Returns whether a time concerns more than instances that were copied at their places at that time, and tracks
    /// that do nothing. It does where there is an error to report.
    pub(super) fn moves_otherwise(&self) -> bool {
        match self.tracks() {
            Ok(tracks) => !tracks.is_empty(),
            Err(_) => !matches!(self.posed, Some(Posed::AtTime | Posed::Always)),
        }
    }

    /// Returns the tracks of a scene that moves; none where all of the scene file's do nothing.
    pub fn tracks(&self) -> Result<Tracks<'_>, Failure> {
        let tracks = Tracks::from_bytes(self.blob.bytes()).map_err(|error| self.invalid(error))?;
        if !tracks.is_empty() || !self.tracked.is_empty() {
            return Ok(tracks);
        }
        let file = self.input.path().display();
        Err(match self.posed {
            None | Some(Posed::Always) => Failure::usage(
                format!(
                    "nothing in {file} moves: it has no tracks, or none that Gridel can follow"
                ),
                "leave the time out; a `[[track]]` of a TOML file moves a scene (see `gridel help scene`), and so does an \
                 animation of a glTF file",
            ),
            Some(Posed::AtTime) => Failure::usage(
                format!("instances alone move in {file}, and copies of them are not blurred"),
                "leave out `--instances flatten` or `--shutter`",
            ),
            Some(Posed::AtRest) => Failure::usage(
                format!("instances alone move in {file}, and copies of them do not"),
                "leave out `--instances flatten`, or ask for one picture after the other with `--time`",
            ),
        })
    }

    /// Warns of instances that move and are not blurred, because they were copied where they are at one time. Returns
    /// all warnings.
    pub fn warn_of_unblurred(&self) -> Vec<String> {
        let mut warnings = self.warnings.clone();
        if self.posed == Some(Posed::AtTime) {
            let sentence =
                "instances are copied where they are as the shutter opens, and are not blurred";
            warn_of_file(self.input.path(), vec![sentence.into()], &mut warnings);
        }
        warnings
    }

    /// Returns what a saved camera says about the scene besides.
    pub fn notes(&self) -> Notes {
        let all = match &self.report {
            Some(_) => self.tracked.clone(),
            None => {
                let tracks = Tracks::from_bytes(self.blob.bytes());
                let tracks = tracks.map_or(&[][..], |tracks| tracks.tracks());
                // The others keep what stands still of a camera that moves.
                let moving = tracks.iter().filter(|track| track.keys > 1);
                moving.filter_map(Track::target).collect()
            }
        };
        let of_camera = all.iter().filter(|it| it.is_of_camera());
        let mut tracks: Vec<&str> = of_camera.map(|it| it.name()).collect();
        tracks.dedup();
        Notes {
            tracks,
            unstated: self
                .report
                .as_ref()
                .map_or_else(Default::default, |it| it.unstated),
        }
    }

    /// Returns the changes of the scene at a time in seconds.
    pub(super) fn changes_at_time(&self, seconds: f64) -> Result<Changes, Failure> {
        let tracks = self.tracks()?;
        let time = tick(&tracks, seconds)?;
        self.changes_at(&self.scene()?, &tracks, time)
    }

    /// Returns the changes of a scene at a time of its tracks. Given options take precedence over the tracks.
    pub fn changes_at(
        &self,
        scene: &Scene<'_>,
        tracks: &Tracks<'_>,
        time: i32,
    ) -> Result<Changes, Failure> {
        let at = || {
            let state = State::at(&self.blob, scene, tracks, time)?;
            state.apply(scene)?;
            Ok(state)
        };
        let mut state = at().map_err(|error: StateError| {
            let what = self.named(scene, &error);
            let cause = format!("{}: {what}", self.input.path().display());
            Failure::failed(cause, "change the tracks, or ask for other times")
        })?;
        if let Some(options) = &self.for_pictures {
            let chosen = Changes::of(&state.apply(scene).map_err(Failure::fault)?, options)?;
            (state.view, state.lights) = (chosen.state.view, chosen.state.lights);
        }
        Ok(Changes {
            state,
            time: Some(time),
        })
    }

    /// Returns the sentence of an error, with the name of the object that it is about.
    fn named(&self, scene: &Scene<'_>, error: &StateError) -> String {
        let StateError::Mesh { seconds, source } = error else {
            return error.to_string();
        };
        let MorphError::Collapsed { object, primitive } = source else {
            return error.to_string();
        };
        let names = self.names(scene);
        let name = names.object(*object).map(shortened);
        let name = name.map_or_else(|| object.to_string(), |name| format!("{name:?}"));
        format!(
            "at {seconds} s object {name} cannot take its shape: the corners of primitive {primitive}, a triangle, lie \
             on a line"
        )
    }

    /// Returns the time that the scene is shown at, in ticks; `None` for one without a time.
    pub fn time(&self) -> Option<i32> {
        self.changes.as_ref()?.time
    }
}
