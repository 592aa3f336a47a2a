//! Records the found figures in place of the expected ones, where these are broken.

use super::manifest::Manifest;
use super::report::{Figure, Finding, Key, Outcome, Record, Report};
use crate::output::{Files, place};
use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};
use toml_edit::{DocumentMut, InlineTable, Item, Value};

/// The byte order mark.
const MARK: &str = "\u{feff}";

/// A manifest with the new records.
#[derive(Clone, Debug)]
pub struct Recorded {
    path: PathBuf,
    old: String,
    new: String,
    references: Vec<(PathBuf, super::Image)>,
    /// References that are left, and why.
    mixed: Vec<(PathBuf, String)>,
    /// Failures that cannot be recorded: names of checks, the key of each, and why, where the table does not say it.
    pub left: Vec<String>,
}

/// Replaces figures of the manifest that failed by those that were found. Figures that passed, comments and layout
/// stay.
///
/// ```
/// use gridel_host::check::{Manifest, record, run};
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("check.toml");
/// std::fs::write(
///     folder.path().join("ball.toml"),
///     "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n",
/// )?;
/// std::fs::write(&path, "[[check]]\nscene = 'ball.toml'\nsize = [16, 12]\nhash = {}\n")?;
///
/// let manifest = Manifest::read(&path)?;
/// let report = run(&manifest, &|| ());
/// let recorded = record(&manifest, &report);
/// recorded.files().map_err(|(_, error)| error)?.keep().map_err(|(_, error)| error)?;
/// assert_eq!(run(&Manifest::read(&path)?, &|| ()).failed(), 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn record(manifest: &Manifest, report: &Report) -> Recorded {
    let mut recorded = Recorded {
        path: manifest.path.clone(),
        old: manifest.text.clone(),
        new: manifest.text.clone(),
        references: Vec::new(),
        mixed: Vec::new(),
        left: Vec::new(),
    };
    // It was read before, so it is TOML.
    let Ok(mut document) = manifest.text.parse::<DocumentMut>() else {
        return recorded;
    };
    let mut values = Vec::<((usize, &[Key]), &Figure)>::new();
    for finding in &report.findings {
        match &finding.record {
            Some(Record::Value {
                check,
                keys,
                figure,
            }) => {
                // The formats of a check share its budgets: the largest figure counts.
                let place = (*check, keys.as_slice());
                match values.iter_mut().find(|(other, _)| *other == place) {
                    Some((_, largest)) if largest.within(figure) => *largest = figure,
                    Some(_) => {}
                    None => values.push((place, figure)),
                }
            }
            None if matches!(finding.outcome, Outcome::Failed(_)) => {
                let what = format!("{}: {}", finding.check, finding.what);
                // In several formats it is still one thing.
                if !recorded.left.contains(&what) {
                    recorded.left.push(what);
                }
            }
            Some(Record::Picture(_)) | None => {}
        }
    }
    recorded.record_pictures(report);
    if values.is_empty() {
        return recorded;
    }
    for ((check, keys), figure) in values {
        let checks = document.get_mut("check");
        if let Some(table) = checks.and_then(|checks| checks.get_mut(check)) {
            set(table, keys, value(figure));
        }
    }
    // A byte order mark is no part of the document, and stays.
    let (mark, old) = match manifest.text.strip_prefix(MARK) {
        Some(old) => (MARK, old),
        None => ("", manifest.text.as_str()),
    };
    let new = document.to_string();
    let new = super::diff::with_line_ends(old, new.strip_prefix(MARK).unwrap_or(&new));
    recorded.new = mark.to_owned() + &new;
    recorded
}

impl Recorded {
    /// Records a picture for each reference that is broken: the first that differs from it. All pictures with this
    /// reference must be like the recorded one; else it is left.
    fn record_pictures(&mut self, report: &Report) {
        let all = || {
            report.findings.iter().filter_map(|it| match &it.record {
                Some(Record::Picture(picture)) => Some((it, picture)),
                _ => None,
            })
        };
        let broken = all().filter(|(it, _)| matches!(it.outcome, Outcome::Failed(_)));
        let mut judged = BTreeSet::new();
        for (_, new) in broken.filter(|(_, it)| judged.insert(place(&it.path))) {
            let here = place(&new.path);
            let mut others = all().filter(|(_, other)| place(&other.path) == here);
            match others.find(|(_, other)| !other.is_like(&new.image)) {
                Some((it, other)) => {
                    let on = it.on.as_deref().unwrap_or_default();
                    let (how, remedy) = match other.image.size == new.image.size {
                        true => (
                            "differs from another one by more than the `tolerance`",
                            ", or allow more",
                        ),
                        false => ("has another size than another one", ""),
                    };
                    let why = format!(
                        "the reference is not recorded, because the picture on {on} {how}; name a file for each{remedy}"
                    );
                    self.mixed.push((here, why));
                    self.left.push(format!(
                        "{}: {} on {on} (it {how} with the same reference; name a file for each)",
                        it.check, it.what
                    ));
                }
                None => self.references.push((new.path.clone(), new.image.clone())),
            }
        }
    }

    fn records(&self, reference: &Path) -> bool {
        let here = place(reference);
        self.references.iter().any(|(path, _)| place(path) == here)
    }

    /// Returns the reason why a missing reference is not recorded.
    fn why_missing(&self, finding: &Finding) -> Option<String> {
        let Some(Record::Picture(picture)) = &finding.record else {
            return None;
        };
        let is_missing = finding.evidence.as_ref()?.expected.is_none();
        let here = place(&picture.path);
        let mut mixed = self.mixed.iter().filter(|_| is_missing);
        mixed
            .find(|(path, _)| *path == here)
            .map(|(_, why)| why.clone())
    }

    /// Notes in a report which findings hold once this is recorded.
    pub fn note_in(&self, report: &mut Report) {
        for finding in &mut report.findings {
            let is_mended = match &finding.record {
                Some(Record::Value { .. }) => true,
                Some(Record::Picture(picture)) => self.records(&picture.path),
                None => false,
            };
            if !matches!(finding.outcome, Outcome::Failed(_)) {
                continue;
            }
            if is_mended {
                finding.outcome = Outcome::Recorded;
            } else if let Some(why) = self.why_missing(finding) {
                finding.outcome = Outcome::Failed(why);
            }
        }
    }

    /// Returns the change of the manifest as a unified diff, and the references that are written; empty if
    /// nothing changes.
    pub fn diff(&self) -> String {
        let name = self.path.display().to_string();
        let mut text = super::diff::unified(&name, &self.old, &self.new);
        for (path, _) in &self.references {
            text += &format!("new reference {}\n", path.display());
        }
        text
    }

    /// Returns the references and the manifest, complete: [`Files::keep`] gives them their names.
    ///
    /// # Errors
    /// If a file cannot be written, or the manifest has changed since it was read; with its path.
    pub fn files(&self) -> Result<Files, (PathBuf, io::Error)> {
        let mut files = Files::default();
        for (path, image) in &self.references {
            let added = files.add(path, |out| image.write(out));
            added.map_err(|error| (path.clone(), error))?;
        }
        if self.old != self.new {
            let here = |error| (self.path.clone(), error);
            let now = std::fs::read_to_string(&self.path).map_err(here)?;
            if now != self.old {
                let why = "it has changed while the checks ran, so nothing is recorded; run the command again";
                return Err(here(io::Error::other(why)));
            }
            let added = files.add(&self.path, |out| out.write_all(self.new.as_bytes()));
            added.map_err(here)?;
        }
        Ok(files)
    }
}

fn value(figure: &Figure) -> Value {
    match figure {
        // Above what TOML's integers hold there are no files either.
        Figure::Count(count) => i64::try_from(*count).unwrap_or(i64::MAX).into(),
        // Rounded up, so that the figure itself is within.
        Figure::Mean(mean) => ((mean * 1000.0).ceil() / 1000.0).into(),
        Figure::Hash(hash) => hash.as_str().into(),
    }
}

/// Sets a value below a table. Comments and spaces around it stay.
fn set(table: &mut Item, keys: &[Key], new: Value) {
    let [key, rest @ ..] = keys else {
        // Comments and spaces around the old value.
        let decor = table.as_value().map(|old| old.decor().clone());
        *table = Item::Value(new);
        if let (Some(decor), Some(value)) = (decor, table.as_value_mut()) {
            *value.decor_mut() = decor;
        }
        return;
    };
    match key {
        Key::Item(index) => {
            if let Some(item) = table.get_mut(*index) {
                set(item, rest, new);
            }
        }
        Key::Name(name) => {
            if let Some(item) = table.get_mut(name.as_str()) {
                set(item, rest, new);
            } else if let Some(table) = table.as_table_like_mut() {
                let mut item = match rest {
                    [] => Item::Value(new.clone()),
                    _ => Item::Value(InlineTable::new().into()),
                };
                if !rest.is_empty() {
                    set(&mut item, rest, new);
                }
                table.insert(name, item);
            }
        }
    }
}
