//! Measures the figures that a manifest requires.

use super::board::{self, BoardRun};
use super::image::Image;
use super::manifest::{Check, Manifest, Reference};
use super::report::{Evidence, Figure, Finding, Key, Outcome, Record, ReferencePicture, Report};
use crate::blob::{Blob, is_blob};
use crate::compile::{self, Options};
use crate::explained;
use crate::measure::{Deforming, Rendered};
use crate::picture::hash;
use crate::render::MOST_PIXELS;
use crate::scene::{self, ImportOptions, Posed};
use crate::state::{State, ticks};
use crate::table::grouped;
use gridel_core::{Format, Scene, Settings, Structure, Tracks};
use std::io;

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
    manifest: &'r Manifest,
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
        let invalid = |error| format!("{}: {error}", check.scene.path.display());
        let scene = blob.scene().map_err(invalid)?;
        let state = self.state(&blob, &scene)?;
        let shown = match &state {
            Some(state) => state.apply(&scene).map_err(|error| error.to_string())?,
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
        let path = self.check.scene.path.display();
        let tracks =
            Tracks::from_bytes(blob.bytes()).map_err(|error| format!("{path}: {error}"))?;
        if tracks.is_empty() && matches!(self.posed, Some(Posed::AtTime | Posed::Always)) {
            return Ok(None);
        }
        if tracks.is_empty() {
            return Err(format!("{path}: nothing moves, so there is no `time`"));
        }
        let state = State::at(blob, scene, &tracks, ticks(&tracks, seconds));
        state.map(Some).map_err(|error| format!("{path}: {error}"))
    }

    /// Reads the blob, or compiles the scene for it.
    fn blob(&mut self) -> Result<Blob, String> {
        let check = self.check;
        let path = &check.scene.path;
        let unreadable = |error| {
            let cause = format!("cannot be read: {error}");
            let remedy = "write the path of a scene file or of a blob, relative to the manifest";
            explained(&self.manifest.error(&check.scene, cause, remedy))
        };
        if is_blob(path).map_err(unreadable)? {
            let keys = [
                ("lattice_bits", check.lattice_bits.is_some()),
                ("instances", check.instances.is_some()),
                ("assembly", check.assembly.is_some()),
                ("allow_outside", check.allow_outside),
            ];
            if let Some((key, _)) = keys.into_iter().find(|&(_, given)| given) {
                return Err(format!(
                    "`{key}` is for scene files, and {} is a blob",
                    path.display()
                ));
            }
            return Blob::read(path).map_err(unreadable);
        }
        let options = ImportOptions {
            allow_outside: check.allow_outside,
            instances: check.instances.unwrap_or_default(),
            assembly: check.assembly.clone(),
            at: check.time,
            ..ImportOptions::default()
        };
        let imported = scene::load_with(path, &options).map_err(|error| explained(&error))?;
        if check.assembly.is_some() && !imported.assemblies {
            return Err(format!(
                "`assembly` is for PDB and mmCIF files, and {} has none; leave it out",
                path.display()
            ));
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

    /// Measures the scene in one number format.
    fn format(
        &mut self,
        scene: &Scene<'_>,
        (structure, blob): (Structure, &[u8]),
        format: Format,
        name: &str,
    ) -> Result<(), String> {
        let check = self.check;
        let on = Some(format.name().to_owned());
        self.working_memory(scene, format, blob);
        let tests = check.budget.tests_per_ray;
        if check.hash.is_none() && check.reference.is_none() && tests.is_none() {
            return Ok(());
        }
        let settings = self.settings(scene, MOST_PIXELS)?;
        let with = (structure, format);
        let rendered = self.render(scene, with, settings, tests.is_some())?;
        if let Some(most) = tests {
            let mean = Figure::Mean(rendered.tests_per_ray());
            self.budget(on.clone(), "tests_per_ray", mean, Some(Figure::Mean(most)));
        }
        let picture = &rendered.picture;
        let image = Image::of(picture);
        let reference = check
            .reference
            .as_ref()
            .map(|reference| (reference, Image::read(&reference.picture.path)));
        if let Some(hashes) = &check.hash {
            let expected = reference
                .as_ref()
                .and_then(|(_, image)| image.as_ref().ok().cloned());
            let recorded = hashes.get(format.name()).cloned().map(Figure::Hash);
            let found = Figure::Hash(hash(&picture.pixels));
            let evidence = Evidence::new(name, &image, expected);
            self.hash(format, found, recorded, evidence);
        }
        if let Some((reference, expected)) = reference {
            self.reference(format, reference, expected, image, name);
        }
        Ok(())
    }

    /// The width and the height of pictures.
    pub(super) fn size(&self, scene: &Scene<'_>) -> [u16; 2] {
        let Settings { width, height, .. } = Settings::of(scene);
        self.check.size.unwrap_or([width, height])
    }

    /// The settings of pictures, unless they have too many pixels.
    pub(super) fn settings(&self, scene: &Scene<'_>, most: usize) -> Result<Settings, String> {
        let [width, height] = self.size(scene);
        let pixels = usize::from(width) * usize::from(height);
        if pixels > most {
            let [pixels, most] = [pixels, most].map(grouped);
            return Err(format!(
                "{pixels} pixels exceed the largest size of {most}; choose a smaller `size`"
            ));
        }
        let own = Settings::of(scene);
        Ok(Settings {
            width,
            height,
            samples: self.check.samples.unwrap_or(own.samples),
            ..own
        })
    }

    fn render(
        &self,
        scene: &Scene<'_>,
        with: (Structure, Format),
        settings: Settings,
        count: bool,
    ) -> Result<Rendered, String> {
        Rendered::new(scene, with, settings, count)
            .map_err(|error| format!("{}: {error}", self.check.scene.path.display()))
    }

    fn hash(
        &mut self,
        format: Format,
        found: Figure,
        recorded: Option<Figure>,
        evidence: Evidence,
    ) {
        let outcome = match &recorded {
            Some(recorded) if found.within(recorded) => Outcome::Passed,
            Some(_) => Outcome::Failed(String::from("the picture is not the recorded one")),
            None => Outcome::Failed(String::from("no hash is recorded for this format")),
        };
        let keys = vec![Key::Name("hash".into()), Key::Name(format.name().into())];
        let broken = outcome != Outcome::Passed;
        let record = self.value(keys, &found);
        let on = Some(format.name().to_owned());
        let finding = self.push(on, "hash", Some(found), recorded, outcome);
        if broken {
            finding.record = Some(record);
            finding.evidence = Some(evidence);
        }
    }

    fn reference(
        &mut self,
        format: Format,
        reference: &Reference,
        expected: io::Result<Image>,
        image: Image,
        name: &str,
    ) {
        let has_folder = reference.picture.has_folder();
        let not_found = |error: &io::Error| error.kind() == io::ErrorKind::NotFound;
        // A file that exists and is not a picture was not meant to become one.
        let may_be_recorded = has_folder && expected.as_ref().map_or_else(not_found, |_| true);
        let to_expected = |expected| image.difference(expected, reference.channel);
        let difference = expected.as_ref().map(to_expected);
        let (found, outcome) = match difference {
            Err(error) => {
                let remedy = if may_be_recorded {
                    "check the path, or let `gridel check --bless` record the picture there"
                } else if !has_folder {
                    "check the path, or create its folder, and let `gridel check --bless` record the picture there"
                } else {
                    "write the path of an RGB or gray PNG with 8 bits per channel; `--bless` overwrites no others"
                };
                let cause = format!("cannot be read: {error}");
                let error = self.manifest.error(&reference.picture, cause, remedy);
                (None, Outcome::Failed(explained(&error)))
            }
            Ok(None) => {
                let [width, height] = image.size;
                let why = format!("the reference is not {width} by {height} pixels large");
                (None, Outcome::Failed(why))
            }
            Ok(Some(difference)) => {
                let outcome = if difference.beyond <= reference.pixels {
                    Outcome::Passed
                } else {
                    Outcome::Failed(format!(
                        "{} pixels differ by more than {} of 255, and the largest difference is {}",
                        difference.beyond, reference.channel, difference.largest
                    ))
                };
                (Some(Figure::Count(difference.beyond)), outcome)
            }
        };
        let broken = outcome != Outcome::Passed;
        let evidence = Evidence::new(name, &image, expected.ok());
        let (on, allowed) = (
            Some(format.name().to_owned()),
            Some(Figure::Count(reference.pixels)),
        );
        let finding = self.push(on, "reference", found, allowed, outcome);
        if broken {
            finding.evidence = Some(evidence);
        }
        finding.record =
            may_be_recorded.then(|| Record::Picture(ReferencePicture::new(reference, image)));
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
                .map(|(figures, _)| figures.get(name).copied());
            match (found, &broken) {
                (Some(Some(found)), _) => {
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
                (Some(None), _) => {
                    let why = format!("the program does not print the figure {name:?}");
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

    fn value(&self, keys: Vec<Key>, figure: &Figure) -> Record {
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
