//! The parsed manifest: every key is known, every value in its range.

mod board;
mod named;
mod values;

pub use board::{Board, Firmware, Program};
pub use named::Named;

use crate::compile::LATTICE_BITS;
use crate::measure::board::{BOARDS, Board as Target};
use crate::output::place;
use crate::scene::toml::source::{Source, Span};
use crate::scene::toml::value::{Fields, Value};
use crate::scene::{Instances, SceneError};
use gridel_core::format::limits::MAX_SAMPLES;
use gridel_core::{Format, Structure};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Display;
use std::path::{Path, PathBuf};
use values::{formats, hashes, instances, size, structure, target};

/// A manifest, and the text that it was read from.
#[derive(Clone, Debug)]
pub struct Manifest {
    pub path: PathBuf,
    pub(super) text: String,
    pub checks: Vec<Check>,
}

/// One scene, and the expected figures.
#[derive(Clone, Debug)]
pub struct Check {
    pub name: String,
    pub scene: Named,
    pub accel: Option<Structure>,
    pub lattice_bits: Option<u8>,
    /// True if the scene file may name files outside of its folder.
    pub allow_outside: bool,
    /// The treatment of instances; `None` for a blob, which has them or not.
    pub instances: Option<Instances>,
    /// The assembly of a PDB or mmCIF file.
    pub assembly: Option<String>,
    pub formats: Vec<Format>,
    pub size: Option<[u16; 2]>,
    pub samples: Option<u16>,
    /// The time in seconds at which a scene that moves is shown.
    pub time: Option<f64>,
    /// The recorded hash of each format; `None` where pictures are not hashed.
    pub hash: Option<BTreeMap<String, String>>,
    pub reference: Option<Reference>,
    pub budget: Budget,
    /// The least part of pixels that is proved by exact arithmetic.
    pub certified: Option<f64>,
    /// The largest proved error of a format, in 255ths.
    pub max_proved_error: Option<u64>,
    /// The board whose memory the scene must fit.
    pub target: Option<&'static Target>,
    pub boards: Vec<Board>,
    /// Names for pictures of failures: of each format, and then of each board.
    pub(super) evidence: Vec<String>,
}

/// A picture that others must look like.
#[derive(Clone, Debug)]
pub struct Reference {
    pub picture: Named,
    /// Codes of 255 that a channel may differ.
    pub channel: u8,
    /// Pixels that may differ by more.
    pub pixels: u64,
}

/// The most of each that is allowed.
#[derive(Clone, Copy, Debug, Default)]
pub struct Budget {
    pub blob_bytes: Option<u64>,
    pub working_bytes: Option<u64>,
    pub stack_entries: Option<u64>,
    pub tests_per_ray: Option<f64>,
    /// Bytes on the `target`, as are the following.
    pub flash: Option<u64>,
    pub ram: Option<u64>,
    pub call_stack: Option<u64>,
}

impl Manifest {
    /// Reads a manifest.
    ///
    /// # Errors
    /// If it cannot be read, is not TOML, or has an unknown key or an invalid value. Also if a
    /// reference would be recorded over another file that is read. The error shows file, line and
    /// remedy.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        let source = Source::read(path)?;
        let document = source.parse()?;
        let (span, table) = (document.span(), document.get_ref());
        let root = Fields::new(&source, span, table, "manifest", &[&["check"]])?;
        let idle = || {
            let (cause, remedy) = (
                "this manifest has no `[[check]]`",
                "add a line `[[check]]`, and below it `scene = \"...\"` and what is expected of it",
            );
            source.error(&root.span, cause, remedy)
        };
        let list = root.get("check").ok_or_else(idle)?;
        let tables = list.items("`[[check]]` above the keys of each")?;
        if tables.len() == 0 {
            return Err(idle());
        }
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut names = BTreeSet::new();
        let checks = tables.map(|table| {
            let check = Check::read(table, folder)?;
            if !names.insert(check.name.clone()) {
                return Err(table.error(
                    format!("two checks have the name {:?}", check.name),
                    "give one of them another `name`",
                ));
            }
            Ok(check)
        });
        let mut checks = checks.collect::<Result<Vec<_>, _>>()?;
        name_evidence(&mut checks);
        let manifest = Self {
            path: path.to_owned(),
            text: source.text().to_owned(),
            checks,
        };
        manifest.reject_lost_files()?;
        manifest.reject_other_pictures()?;
        Ok(manifest)
    }

    /// Rejects references that are also something else, which recording a picture would destroy.
    fn reject_lost_files(&self) -> Result<(), SceneError> {
        let others: BTreeSet<_> = self.sources().map(place).collect();
        let mut pictures = self.references();
        match pictures.find(|picture| others.contains(&place(&picture.path))) {
            None => Ok(()),
            Some(picture) => Err(self.error(
                picture,
                "is a scene or a program of this manifest, or the manifest itself: a reference \
                 that is recorded would be written over it",
                "give the reference another name",
            )),
        }
    }

    /// Rejects references in formats other than PNG, as PNG files are recorded.
    fn reject_other_pictures(&self) -> Result<(), SceneError> {
        let is_png = |it: &&Named| {
            let extension = it.path.extension();
            extension.is_some_and(|it| it.eq_ignore_ascii_case("png"))
        };
        match self.references().find(|it| !is_png(it)) {
            None => Ok(()),
            Some(picture) => Err(self.error(
                picture,
                "is no PNG file, as references must be",
                "write a path that ends in `.png`; `--bless` creates the picture",
            )),
        }
    }

    fn references(&self) -> impl Iterator<Item = &Named> {
        let references = self.checks.iter().flat_map(|check| &check.reference);
        references.map(|reference| &reference.picture)
    }

    /// The files that are read and never recorded, and the manifest.
    fn sources(&self) -> impl Iterator<Item = &Path> {
        let scenes = self.checks.iter().map(|check| &check.scene);
        let boards = self.checks.iter().flat_map(|check| &check.boards);
        let programs = boards.filter_map(|board| match &board.program {
            Program::Elf(file) => Some(file),
            Program::Firmware(_) => None,
        });
        let named = scenes.chain(programs).map(|named| named.path.as_path());
        std::iter::once(self.path.as_path()).chain(named)
    }

    /// Returns all files that are read: the manifest, and those that it names.
    pub fn inputs(&self) -> impl Iterator<Item = &Path> {
        self.sources().chain(self.pictures())
    }

    /// Returns the reference pictures, which may be recorded.
    pub fn pictures(&self) -> impl Iterator<Item = &Path> {
        self.references().map(|picture| picture.path.as_path())
    }

    /// Returns the names of all [evidence](super::Evidence) that a run may find; no two are equal.
    pub fn evidence(&self) -> impl Iterator<Item = &str> {
        let names = self.checks.iter().flat_map(|check| &check.evidence);
        names.map(String::as_str)
    }

    /// Returns an error about a file, at the place where the manifest names it.
    pub(super) fn error(&self, named: &Named, cause: impl Display, remedy: &str) -> SceneError {
        let Span { start, end } = named.span;
        let cause = format!("{} {cause}", named.path.display());
        SceneError::new(&self.path, cause, remedy).at_span(&self.text, start, end - start)
    }

    /// Returns the number of steps of [`run`](super::run): pictures, proofs of them, and programs on boards.
    pub fn steps(&self) -> usize {
        let steps = |check: &Check| {
            check.formats.len() + usize::from(check.is_certified()) + check.boards.len()
        };
        self.checks.iter().map(steps).sum()
    }
}

/// The keys of a check.
const KEYS: [&str; 19] = [
    "name",
    "scene",
    "accel",
    "lattice_bits",
    "allow_outside",
    "instances",
    "assembly",
    "formats",
    "size",
    "samples",
    "time",
    "hash",
    "reference",
    "tolerance",
    "budget",
    "certified",
    "max_proved_error",
    "target",
    "board",
];

impl Check {
    /// Returns whether its pictures are compared with the exact one.
    pub(super) fn is_certified(&self) -> bool {
        self.certified.is_some() || self.max_proved_error.is_some()
    }

    fn read(table: Value<'_>, folder: &Path) -> Result<Self, SceneError> {
        let fields = table.fields("check", &[&KEYS])?;
        let target = fields.or("target", None, |value| target(value).map(Some))?;
        let value = fields.require("scene")?;
        let scene = Named::read(value, folder)?;
        let stem = match scene.path.file_stem() {
            Some(stem) if !scene.path.is_dir() => stem.display().to_string(),
            _ => {
                return Err(value.error(
                    format!("{} is a folder, and no scene", scene.path.display()),
                    "write the path of a scene file or of a blob",
                ));
            }
        };
        let formats = fields.or("formats", vec![Format::F32], formats)?;
        let reference = match [fields.get("reference"), fields.get("tolerance")] {
            [Some(path), tolerance] => Some(Reference::read(path, tolerance, folder)?),
            [None, Some(tolerance)] => {
                return Err(tolerance.error(
                    "a tolerance without a `reference` allows nothing",
                    "add the path of a picture as `reference`, or remove the tolerance",
                ));
            }
            [None, None] => None,
        };
        let check = Self {
            name: match fields.get("name") {
                Some(name) => name.filled()?.to_owned(),
                None => stem,
            },
            accel: fields.or("accel", None, |value| structure(value).map(Some))?,
            lattice_bits: fields.or("lattice_bits", None, |value| {
                let [fewest, most] =
                    [LATTICE_BITS.start(), LATTICE_BITS.end()].map(|&it| it.into());
                Ok(Some(value.integer_in(fewest..=most)? as u8))
            })?,
            allow_outside: fields.or("allow_outside", false, Value::boolean)?,
            instances: fields.or("instances", None, |value| instances(value).map(Some))?,
            assembly: fields.or("assembly", None, |value| {
                Ok(Some(value.filled()?.to_owned()))
            })?,
            size: fields.or("size", None, |value| size(value).map(Some))?,
            samples: fields.or("samples", None, |value| {
                Ok(Some(value.integer_in(1..=MAX_SAMPLES.into())? as u16))
            })?,
            time: fields.or("time", None, |value| value.number().map(Some))?,
            hash: fields.or("hash", None, |value| hashes(value, &formats).map(Some))?,
            reference,
            budget: fields.or("budget", Budget::default(), |table| {
                Budget::read(table, target.is_some())
            })?,
            certified: fields.or("certified", None, |value| {
                value.number_in(0.0..=1.0).map(Some)
            })?,
            max_proved_error: fields.or("max_proved_error", None, |value| {
                Ok(Some(value.integer_in(0..=255)? as u64))
            })?,
            target,
            boards: fields.or("board", Vec::new(), |list| {
                list.items("`[[check.board]]` above the keys of each")?
                    .map(|table| Board::read(table, folder))
                    .collect()
            })?,
            formats,
            scene,
            evidence: Vec::new(),
        };
        if check.expects_nothing() {
            return Err(table.error(
                "this check tests nothing: it states no expected result",
                "add `hash = {}` and let `gridel check --bless` record it, or add `reference`, `certified`, \
                 `max_proved_error`, `target`, `[check.budget]` or `[[check.board]]`",
            ));
        }
        Ok(check)
    }

    /// Returns whether no expectation could pass or fail.
    fn expects_nothing(&self) -> bool {
        let Budget {
            blob_bytes,
            working_bytes,
            stack_entries,
            tests_per_ray,
            // These need a target, which alone is an expectation.
            flash: _,
            ram: _,
            call_stack: _,
        } = self.budget;
        let bytes = [blob_bytes, working_bytes, stack_entries];
        self.hash.is_none()
            && self.reference.is_none()
            && bytes.iter().all(Option::is_none)
            && tests_per_ray.is_none()
            && self.certified.is_none()
            && self.max_proved_error.is_none()
            && self.target.is_none()
            && self.boards.is_empty()
    }
}

impl Reference {
    fn read(
        path: Value<'_>,
        tolerance: Option<Value<'_>>,
        folder: &Path,
    ) -> Result<Self, SceneError> {
        let mut reference = Self {
            picture: Named::read(path, folder)?,
            channel: 0,
            pixels: 0,
        };
        if let Some(table) = tolerance {
            let fields = table.fields("tolerance", &[&["channel", "pixels"]])?;
            let channel = |value: Value<'_>| Ok(value.integer_in(0..=255)? as u8);
            reference.channel = fields.or("channel", 0, channel)?;
            reference.pixels = fields.or("pixels", 0, Value::count)?;
        }
        Ok(reference)
    }
}

impl Budget {
    fn read(table: Value<'_>, has_target: bool) -> Result<Self, SceneError> {
        const OF_TARGET: [&str; 3] = ["flash", "ram", "call_stack"];
        let keys = [
            "blob_bytes",
            "working_bytes",
            "stack_entries",
            "tests_per_ray",
        ];
        let fields = table.fields("budget", &[&keys, &OF_TARGET])?;
        let homeless = OF_TARGET.into_iter().find_map(|key| fields.get(key));
        if let Some(value) = homeless.filter(|_| !has_target) {
            return Err(value.error(
                format!(
                    "`{}` is a budget on a board, and this check has none",
                    value.key
                ),
                format!(
                    "add a line `target = ...` to the check, with one of {}",
                    BOARDS.map(|board| board.name).join(", ")
                ),
            ));
        }
        let count = |value: Value<'_>| value.count().map(Some);
        Ok(Self {
            blob_bytes: fields.or("blob_bytes", None, count)?,
            working_bytes: fields.or("working_bytes", None, count)?,
            stack_entries: fields.or("stack_entries", None, count)?,
            tests_per_ray: fields.or("tests_per_ray", None, |value| {
                value.number_in(0.0..=1e15).map(Some)
            })?,
            flash: fields.or("flash", None, count)?,
            ram: fields.or("ram", None, count)?,
            call_stack: fields.or("call_stack", None, count)?,
        })
    }
}

/// Names the pictures that show what is broken, by the check and what it runs on. A number is
/// appended where two names would be equal.
fn name_evidence(checks: &mut [Check]) {
    let mut taken = BTreeSet::new();
    let plain = |c: char| match c {
        '-' | '_' => c,
        _ if c.is_alphanumeric() => c,
        _ => '-',
    };
    for check in checks {
        let formats = check.formats.iter().map(|format| format.name());
        let boards = check.boards.iter().map(|board| board.machine.as_str());
        let names = formats.chain(boards).map(|on| {
            // Names of files are limited to some 255 bytes.
            let short = check.name.chars().take(50);
            let name: String = short.chain(['-']).chain(on.chars()).map(plain).collect();
            let numbered = (2..).map(|number| format!("{name}-{number}"));
            std::iter::once(name.clone())
                .chain(numbered)
                // There are folders in which `A` and `a` are one file.
                .find(|name| taken.insert(name.to_lowercase()))
                .unwrap_or_default()
        });
        check.evidence = names.collect();
    }
}
