//! Measures the figures that a manifest requires.

use super::board::{self, BoardRun};
use super::image::Image;
use super::manifest::{Check, Manifest};
use super::report::{Evidence, Figure, Finding, Key, Outcome, Record, Report};
use crate::blob::{Blob, is_blob, remedy_of};
use crate::compile::{self, Options};
use crate::explained;
use crate::measure::Deforming;
use crate::scene::{self, ImportOptions, Posed};
use crate::state::{State, ticks};
use gridel_core::{BlobError, Scene, Settings, Structure, Tracks};
use std::fmt::Display;

/// Measures everything. Calls `progress` after each of the [steps](Manifest::steps).
///
/// ```
/// use gridel_host::check::{Manifest, run};
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("check.toml");
/// std::fs::write(
///     folder.path().join("ball.toml"),
///     "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n",
/// )?;
/// std::fs::write(&path, "[[check]]\nscene = 'ball.toml'\nsize = [16, 12]\nhash = {}\n")?;
///
/// let report = run(&Manifest::read(&path)?, &|| ());
/// // No hash is recorded yet.
/// assert_eq!((report.passed(), report.failed()), (0, 1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn run(manifest: &Manifest, progress: &dyn Fn()) -> Report {
    let mut report = Report::default();
    for (index, check) in manifest.checks.iter().enumerate() {
        let mut run = Run {
            manifest,
            index,
            check,
            report: &mut report,
            posed: None,
        };
        if let Err(why) = run.all(progress) {
            run.push(None, "scene", None, None, Outcome::Failed(why));
        }
    }
    report.name_warnings_once();
    report
}

/// One check that is being run.
pub(super) struct Run<'r> {
    pub(super) manifest: &'r Manifest,
    index: usize,
    pub(super) check: &'r Check,
    report: &'r mut Report,
    /// The placements at which moving instances were copied, if they were.
    posed: Option<Posed>,
}

/// A figure, and the most that is allowed.
pub(super) struct Compared<'c> {
    pub(super) what: &'c str,
    pub(super) found: Figure,
    pub(super) most: Option<Figure>,
}

impl Run<'_> {
    /// Runs everything. An error is one after which nothing can be measured.
    fn all(&mut self, progress: &dyn Fn()) -> Result<(), String> {
        let check = self.check;
        let blob = self.blob()?;
        let scene = blob.scene().map_err(|error| self.invalid(&error))?;
        let state = self.state(&blob, &scene)?;
        let shown = match &state {
            Some(state) => state.apply(&scene).map_err(|error| self.invalid(&error))?,
            None => scene,
        };
        let structure = structure(check, &scene)?;
        let budget = check.budget;
        let bytes = Figure::Count(blob.bytes().len() as u64);
        self.budget(
            None,
            "blob_bytes",
            bytes,
            budget.blob_bytes.map(Figure::Count),
        );
        let entries = Figure::Count(scene.stack_depth() as u64);
        self.budget(
            None,
            "stack_entries",
            entries,
            budget.stack_entries.map(Figure::Count),
        );
        self.memory(&scene, structure, blob.bytes());
        for (&format, name) in check.formats.iter().zip(&check.evidence) {
            self.format(&shown, (structure, blob.bytes()), format, name)?;
            progress();
        }
        self.certify(&shown, structure, progress)?;
        for number in 0..check.boards.len() {
            self.board(number, &blob, &scene, structure)?;
            progress();
        }
        Ok(())
    }

    /// The state of the scene at the check's time.
    fn state(&self, blob: &Blob, scene: &Scene<'_>) -> Result<Option<State>, String> {
        let Some(seconds) = self.check.time else {
            return Ok(None);
        };
        let tracks = Tracks::from_bytes(blob.bytes()).map_err(|error| self.invalid(&error))?;
        if tracks.is_empty() && matches!(self.posed, Some(Posed::AtTime | Posed::Always)) {
            return Ok(None);
        }
        if tracks.is_empty() {
            let cause = "has nothing that moves, and the check states a `time`";
            return Err(self.fault(cause, "leave `time` out, or give the scene tracks"));
        }
        let at_no_time = |error: &dyn Display| {
            let cause = format!("cannot be shown at the `time`: {error}");
            self.fault(cause, "write another `time`")
        };
        let time = ticks(&tracks, seconds).map_err(|error| at_no_time(&error))?;
        let state = State::at(blob, scene, &tracks, time);
        state.map(Some).map_err(|error| at_no_time(&error))
    }

    /// Returns an error about the scene, at the place where the manifest names it.
    fn fault(&self, cause: impl Display, remedy: &str) -> String {
        explained(&self.manifest.error(&self.check.scene, cause, remedy))
    }

    /// Returns the error of a blob that is invalid.
    fn invalid(&self, error: &BlobError) -> String {
        self.fault(format!("is an invalid blob: {error}"), remedy_of(error))
    }

    /// Reads the blob, or compiles the scene for it.
    fn blob(&mut self) -> Result<Blob, String> {
        let check = self.check;
        let path = &check.scene.path;
        let unreadable = |error| {
            self.fault(
                format!("cannot be read: {error}"),
                "write the path of a scene file or of a blob, relative to the manifest",
            )
        };
        if is_blob(path).map_err(unreadable)? {
            let keys = [
                ("lattice_bits", check.lattice_bits.is_some()),
                ("instances", check.instances.is_some()),
                ("assembly", check.assembly.is_some()),
                ("allow_outside", check.allow_outside),
            ];
            if let Some((key, _)) = keys.into_iter().find(|&(_, given)| given) {
                return Err(self.fault(
                    format!("is a blob, and `{key}` is for scene files"),
                    "leave the key out, or name the scene file that the blob was built from",
                ));
            }
            return Blob::read(path).map_err(unreadable);
        }
        let options = ImportOptions {
            allow_outside: check.allow_outside,
            instances: check.instances.unwrap_or_default(),
            assembly: check.assembly.clone(),
            time: check.time,
            ..ImportOptions::default()
        };
        let imported = scene::load_with(path, &options).map_err(|error| explained(&error))?;
        if check.assembly.is_some() && !imported.kinds.assemblies {
            let cause = "has no assemblies: `assembly` is for PDB and mmCIF files";
            return Err(self.fault(cause, "leave the key out"));
        }
        self.posed = imported.posed;
        self.report.warnings.extend(imported.warnings);
        self.report.files.extend(imported.files);
        let mut scene = imported.scene;
        // As part of the blob, so that a board renders the same picture.
        if let Some([width, height]) = check.size {
            (scene.render.width, scene.render.height) = (width.into(), height.into());
        }
        scene.render.samples = check.samples.unwrap_or(scene.render.samples);
        let mut options = Options::default();
        if let Some(structure) = check.accel {
            options.structures = vec![structure];
        } else if !scene.morph_targets.is_empty() {
            options.structures = Deforming::STRUCTURES.to_vec();
        }
        options.lattice_bits = check.lattice_bits.unwrap_or(options.lattice_bits);
        let compiled = compile::compile(&scene, &options)
            .map_err(|error| format!("{}: {}", path.display(), explained(&error)))?;
        let warnings = compiled.report.warnings(options.lattice_bits);
        let named = |warning| format!("{}: {warning}", path.display());
        self.report.warnings.extend(warnings.into_iter().map(named));
        Ok(compiled.blob)
    }

    /// Runs a program on a board and compares its figures.
    fn board(
        &mut self,
        number: usize,
        blob: &Blob,
        scene: &Scene<'_>,
        structure: Structure,
    ) -> Result<(), String> {
        let check = self.check;
        let board = &check.boards[number];
        let on = || Some(board.machine.clone());
        let ran = board::run(self.manifest, board, blob);
        let broken = match &ran {
            BoardRun::Printed(..) => None,
            BoardRun::NotRun(why) => Some(Outcome::NotRun(why.clone())),
            BoardRun::Failed(why) => Some(Outcome::Failed(why.clone())),
        };
        let printed = match ran {
            BoardRun::Printed(figures, picture) => Some((figures, picture)),
            BoardRun::NotRun(_) | BoardRun::Failed(_) => None,
        };
        for (name, &most) in &board.budget {
            let most = Some(Figure::Count(most));
            let found = printed
                .as_ref()
                .map(|(figures, _)| figures.get(name).cloned());
            match (found, &broken) {
                (Some(Some(Ok(found))), _) => {
                    let board = [Key::Name("board".into()), Key::Item(number)];
                    let entry = ["budget", name].map(|name| Key::Name(name.into()));
                    let keys = board.into_iter().chain(entry).collect();
                    let found = Figure::Count(found);
                    let compared = Compared {
                        what: name,
                        found,
                        most,
                    };
                    self.held_to(on(), compared, keys, None);
                }
                (Some(other), _) => {
                    let why = match other {
                        Some(Err(text)) => format!(
                            "the program prints {text:?} as the figure {name:?}: no whole number below 2^64"
                        ),
                        _ => format!("the program does not print the figure {name:?}"),
                    };
                    self.push(on(), name, None, most, Outcome::Failed(why));
                }
                (None, Some(outcome)) => {
                    let outcome = outcome.clone();
                    self.push(on(), name, None, most, outcome);
                }
                (None, None) => {}
            }
        }
        if board.picture.is_none() {
            return Ok(());
        }
        let Some((_, bytes)) = printed else {
            let outcome = broken.unwrap_or(Outcome::Passed);
            self.push(on(), "picture", None, None, outcome);
            return Ok(());
        };
        // As the blob says, because that is all that the board knows.
        let with = (structure, board.format);
        let rendered = self.render(scene, with, Settings::of(scene), false)?;
        let expected = Image::of(&rendered.picture);
        if bytes.as_ref().is_ok_and(|bytes| *bytes == expected.pixels) {
            self.push(on(), "picture", None, None, Outcome::Passed);
            return Ok(());
        }
        let (why, evidence) = match bytes {
            Ok(pixels) if pixels.len() == expected.pixels.len() => {
                let size = expected.size;
                let rendered = Image { size, pixels };
                let why = "the board's picture is not the host's";
                let name = &check.evidence[check.formats.len() + number];
                let evidence = Evidence::new(name, &rendered, Some(expected));
                (String::from(why), Some(evidence))
            }
            Ok(pixels) => {
                let (found, expected) = (pixels.len(), expected.pixels.len());
                (
                    format!("the board's picture has {found} bytes and the host's {expected}"),
                    None,
                )
            }
            Err(why) => (why, None),
        };
        self.push(on(), "picture", None, None, Outcome::Failed(why))
            .evidence = evidence;
        Ok(())
    }

    /// Compares a figure with a key of `[check.budget]`, if that is there.
    pub(super) fn budget(
        &mut self,
        on: Option<String>,
        what: &str,
        found: Figure,
        most: Option<Figure>,
    ) {
        if most.is_some() {
            let keys = vec![Key::Name("budget".into()), Key::Name(what.into())];
            self.held_to(on, Compared { what, found, most }, keys, None);
        }
    }

    /// Compares a figure with the most that is allowed; `help` says what would make it smaller.
    pub(super) fn held_to(
        &mut self,
        on: Option<String>,
        compared: Compared<'_>,
        keys: Vec<Key>,
        help: Option<String>,
    ) {
        let Compared { what, found, most } = compared;
        let within = most.as_ref().is_none_or(|most| found.within(most));
        let record = (!within).then(|| self.value(keys, &found));
        let outcome = if within {
            Outcome::Passed
        } else {
            let (found, most) = found.beside(most.as_ref());
            let help = help.map_or(String::new(), |help| format!("; what helps: {help}"));
            Outcome::Failed(format!(
                "{what} is {found}, and at most {most} is allowed{help}"
            ))
        };
        self.push(on, what, Some(found), most, outcome).record = record;
    }

    pub(super) fn value(&self, keys: Vec<Key>, figure: &Figure) -> Record {
        Record::Value {
            check: self.index,
            keys,
            figure: figure.clone(),
        }
    }

    pub(super) fn push(
        &mut self,
        on: Option<String>,
        what: &str,
        found: Option<Figure>,
        allowed: Option<Figure>,
        outcome: Outcome,
    ) -> &mut Finding {
        self.report.findings.push_mut(Finding {
            check: self.check.name.clone(),
            on,
            what: what.to_owned(),
            found,
            allowed,
            outcome,
            record: None,
            evidence: None,
        })
    }
}

/// Returns the requested structure, or else the best that the blob holds.
fn structure(check: &Check, scene: &Scene<'_>) -> Result<Structure, String> {
    match check.accel {
        None => Ok(scene.best_structure()),
        Some(structure) if scene.holds(structure) => Ok(structure),
        Some(structure) => Err(format!(
            "{} has no structure {name}: build it with `--accel {name}`",
            check.scene.path.display(),
            name = structure.name()
        )),
    }
}
