//! The findings of a run, for people and for programs.

use super::image::Image;
use super::manifest::Reference;
use crate::table::{Align, Table, grouped, printable, significant};
use serde::{Serialize, Serializer};
use std::collections::BTreeSet;
use std::fmt;
use std::path::PathBuf;

/// All findings, in the order of the manifest.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Report {
    pub findings: Vec<Finding>,
    /// Warnings of importers and of the compiler, each once.
    pub warnings: Vec<String>,
    /// The files from which scenes were read.
    #[serde(skip)]
    pub files: BTreeSet<PathBuf>,
}

/// One thing that was compared with what the manifest says.
#[derive(Clone, Debug, Serialize)]
pub struct Finding {
    /// Name of the check.
    pub check: String,
    /// Number format, or board: where the figure is from, if it depends on that.
    pub on: Option<String>,
    /// The manifest's key, or the name that the board's program gives the figure.
    pub what: String,
    pub found: Option<Figure>,
    /// The most that is allowed; for hashes the only one.
    pub allowed: Option<Figure>,
    #[serde(flatten)]
    pub outcome: Outcome,
    /// The record with which this check passes; that of a picture also where it passes already.
    #[serde(skip)]
    pub(super) record: Option<Record>,
    /// The picture that is not as it should be.
    #[serde(skip)]
    pub evidence: Option<Evidence>,
}

/// The outcome of a comparison.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(tag = "outcome", content = "why", rename_all = "kebab-case")]
pub enum Outcome {
    /// The figure is as the manifest says, or better.
    Passed,
    /// The figure is not as the manifest says, and why.
    Failed(String),
    /// The figure was not as the manifest said; the manifest has it now.
    Recorded,
    /// The figure could not be measured here, and why.
    NotRun(String),
}

/// A figure of a finding.
#[derive(Clone, Debug, PartialEq)]
pub enum Figure {
    Count(u64),
    Mean(f64),
    Hash(String),
}

/// A change of the manifest, or of a reference in its folder.
#[derive(Clone, Debug)]
pub(super) enum Record {
    /// A value in the manifest, below the check of this number.
    Value {
        check: usize,
        keys: Vec<Key>,
        figure: Figure,
    },
    /// A reference picture.
    Picture(ReferencePicture),
}

/// A picture that can become a reference, and how others may differ from it.
#[derive(Clone, Debug)]
pub(super) struct ReferencePicture {
    pub(super) path: PathBuf,
    pub(super) image: Image,
    /// Codes of 255 that a channel may differ.
    pub(super) channel: u8,
    /// Pixels that may differ by more.
    pub(super) pixels: u64,
}

impl ReferencePicture {
    /// A picture in place of a reference.
    pub(super) fn new(reference: &Reference, image: Image) -> Self {
        Self {
            path: reference.picture.path.clone(),
            image,
            channel: reference.channel,
            pixels: reference.pixels,
        }
    }

    /// Returns whether the picture would pass with another as its reference.
    pub(super) fn is_like(&self, reference: &Image) -> bool {
        let difference = self.image.difference(reference, self.channel);
        difference.is_some_and(|it| it.beyond <= self.pixels)
    }
}

/// A step of the path to a value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Key {
    Name(String),
    Item(usize),
}

/// Pictures that show a failure.
#[derive(Clone, Debug)]
pub struct Evidence {
    /// A name for the file, without extension; no other picture of the manifest has it.
    pub name: String,
    pub rendered: Image,
    pub expected: Option<Image>,
}

impl Evidence {
    pub(super) fn new(name: &str, rendered: &Image, expected: Option<Image>) -> Self {
        Self {
            name: name.to_owned(),
            rendered: rendered.clone(),
            expected,
        }
    }
}

impl Report {
    fn count(&self, kind: impl Fn(&Outcome) -> bool) -> usize {
        self.findings
            .iter()
            .filter(|finding| kind(&finding.outcome))
            .count()
    }

    /// Returns the number of comparisons that passed.
    pub fn passed(&self) -> usize {
        self.count(|outcome| *outcome == Outcome::Passed)
    }

    /// Returns the number of comparisons that failed.
    pub fn failed(&self) -> usize {
        self.count(|outcome| matches!(outcome, Outcome::Failed(_)))
    }

    /// Returns the number of findings that were recorded.
    pub fn recorded(&self) -> usize {
        self.count(|outcome| *outcome == Outcome::Recorded)
    }

    /// Keeps the first of warnings that checks of one scene have in common.
    pub(super) fn name_warnings_once(&mut self) {
        let mut seen = BTreeSet::new();
        self.warnings.retain(|it| seen.insert(it.clone()));
    }

    /// Returns the number of findings that could not be measured.
    pub fn not_run(&self) -> usize {
        self.count(|outcome| matches!(outcome, Outcome::NotRun(_)))
    }

    /// Returns a line for each finding.
    pub fn table(&self) -> Table {
        let mut table = Table::new([
            ("check", Align::Left),
            ("on", Align::Left),
            ("what", Align::Left),
            ("found", Align::Right),
            ("allowed", Align::Right),
            ("", Align::Left),
        ]);
        let figure =
            |figure: &Option<Figure>| figure.as_ref().map_or(String::from("-"), Figure::to_string);
        for finding in &self.findings {
            table.row([
                printable(&finding.check),
                finding.on.clone().unwrap_or_default(),
                finding.what.clone(),
                figure(&finding.found),
                figure(&finding.allowed),
                match &finding.outcome {
                    Outcome::Passed => String::from("passed"),
                    Outcome::Failed(_) => String::from("FAILED"),
                    Outcome::Recorded => String::from("recorded"),
                    Outcome::NotRun(_) => String::from("skipped"),
                },
            ]);
        }
        table
    }
}

impl Figure {
    /// Returns whether this is within a budget, or the same hash.
    pub(super) fn within(&self, allowed: &Self) -> bool {
        match (self, allowed) {
            (Self::Count(found), Self::Count(most)) => found <= most,
            (Self::Mean(found), Self::Mean(most)) => found <= most,
            (found, allowed) => found == allowed,
        }
    }

    /// Without separators.
    pub(super) fn plain(&self) -> String {
        match self {
            Self::Count(count) => count.to_string(),
            Self::Mean(mean) => mean.to_string(),
            Self::Hash(hash) => hash.clone(),
        }
    }
}

impl Figure {
    /// The figure and the most that is allowed, with as many digits as show which is larger.
    pub(super) fn beside(&self, most: Option<&Self>) -> (String, String) {
        let allowed = most.map(Self::to_string).unwrap_or_default();
        match (self, most) {
            (Self::Mean(found), Some(Self::Mean(most))) if self.to_string() == allowed => {
                (found.to_string(), most.to_string())
            }
            _ => (self.to_string(), allowed),
        }
    }
}

impl fmt::Display for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Count(count) => f.write_str(&grouped(count)),
            Self::Mean(mean) => f.write_str(&significant(*mean)),
            Self::Hash(hash) => f.write_str(hash),
        }
    }
}

impl Serialize for Figure {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Count(count) => serializer.serialize_u64(*count),
            Self::Mean(mean) => serializer.serialize_f64(*mean),
            Self::Hash(hash) => serializer.serialize_str(hash),
        }
    }
}
