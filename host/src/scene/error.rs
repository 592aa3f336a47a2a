//! Errors in scene files: the file, the place, the cause and the remedy.

use super::excerpt::Excerpt;
use crate::table::clipped;
use miette::{Diagnostic, LabeledSpan, SourceCode};
use std::path::{Path, PathBuf};

/// The remedy of a file that is cut short or damaged.
pub(super) const COPY_AGAIN: &str = "copy the file again, as binary, or export it again";

/// The beginning of the cause of a file that cannot be read. It is a sentence with the name of the file.
pub(super) const UNREADABLE: &str = "cannot be read";

/// The reason why something in a scene cannot be used, for an error that names its place.
#[derive(Debug, PartialEq)]
pub(crate) struct CauseAndRemedy {
    pub(crate) cause: String,
    pub(crate) remedy: String,
}

impl CauseAndRemedy {
    pub(crate) fn new(cause: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self {
            cause: cause.into(),
            remedy: remedy.into(),
        }
    }
}

/// An error in a scene file (or in one that it imports), or in a manifest of checks.
#[derive(Debug)]
pub struct SceneError {
    /// The file that is at fault.
    pub file: PathBuf,
    /// Line, counted from 1, where the format has lines and the line is known.
    pub line: Option<usize>,
    /// The cause, in one sentence without a full stop.
    pub cause: String,
    /// The remedy, in one sentence without a full stop.
    pub remedy: String,
    /// Boxed, so that results stay small where nothing is wrong.
    excerpt: Option<Box<Excerpt>>,
}

impl SceneError {
    pub fn new(file: &Path, cause: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self {
            file: file.to_owned(),
            line: None,
            cause: clipped(cause.into()),
            remedy: clipped(remedy.into()),
            excerpt: None,
        }
    }

    /// Names the line, counted from 1.
    pub fn at_line(mut self, line: usize) -> Self {
        self.line = Some(line);
        self
    }

    /// Underlines `length` bytes at `offset` of `text` and derives the line from them.
    pub fn at_span(mut self, text: &str, offset: usize, length: usize) -> Self {
        let offset = offset.min(text.len());
        let before = &text.as_bytes()[..offset];
        self.line = Some(1 + before.iter().filter(|&&byte| byte == b'\n').count());
        let span = offset..offset + length.min(text.len() - offset);
        let file = clipped(self.file.display().to_string());
        self.excerpt = Some(Box::new(Excerpt::new(file, text, span)));
        self
    }
}

impl std::fmt::Display for SceneError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        // The name of a file that there is not can be of any length.
        f.write_str(&clipped(self.file.display().to_string()))?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        // "a.toml cannot be read", but "a.toml: the text is not UTF-8".
        let separator = match self.line {
            None if self.cause.starts_with(UNREADABLE) => " ",
            _ => ": ",
        };
        write!(f, "{separator}{}", self.cause)
    }
}

impl std::error::Error for SceneError {}

impl Diagnostic for SceneError {
    fn help<'a>(&'a self) -> Option<Box<dyn std::fmt::Display + 'a>> {
        Some(Box::new(&self.remedy))
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.excerpt
            .as_deref()
            .map(|excerpt| excerpt as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let span = self.excerpt.as_deref()?.span;
        Some(Box::new(std::iter::once(LabeledSpan::new_with_span(
            None, span,
        ))))
    }
}
