//! The text of a TOML file, and errors and places in it.

use crate::scene::access::Access;
use crate::scene::text::check_encoding;
use crate::scene::{SceneError, SourceSpan};
use crate::table::shortened;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toml::Spanned;
use toml::de::DeTable;

/// Byte offsets into the text of a scene file.
pub(crate) type Span = Range<usize>;

/// A file that was read.
pub(crate) struct Source {
    pub(crate) path: Arc<PathBuf>,
    text: String,
    /// The offset at which each line starts. Counting lines again for every object would take
    /// quadratic time for long files.
    line_starts: Vec<usize>,
}

/// A name that refers to something else in the file, and where it stands.
#[derive(Clone, Debug)]
pub(crate) struct Name {
    pub(crate) text: String,
    pub(crate) span: Span,
}

impl Source {
    pub(crate) fn read(path: &Path) -> Result<Self, SceneError> {
        Self::new(path, Access::of(path, true).read(path)?)
    }

    pub(crate) fn new(path: &Path, bytes: Vec<u8>) -> Result<Self, SceneError> {
        check_encoding(path, &bytes)?;
        let text = String::from_utf8(bytes).map_err(|error| {
            let good = error.utf8_error().valid_up_to();
            let line = 1 + error.as_bytes()[..good]
                .iter()
                .filter(|&&b| b == b'\n')
                .count();
            SceneError::new(
                path,
                "the text is not UTF-8",
                "save the file in the encoding UTF-8",
            )
            .at_line(line)
        })?;
        let newlines = text.match_indices('\n').map(|(offset, _)| offset + 1);
        let line_starts = std::iter::once(0).chain(newlines).collect();
        Ok(Self {
            path: Arc::new(path.to_owned()),
            text,
            line_starts,
        })
    }

    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    pub(crate) fn parse(&self) -> Result<Spanned<DeTable<'_>>, SceneError> {
        DeTable::parse(&self.text).map_err(|error| {
            self.error(
                &error.span().unwrap_or(0..0),
                format!("this is not TOML: {}", error.message().replace('\n', ", ")),
                "write `key = value` lines below `[table]` headings; text needs quotes, lists need \
                 brackets and commas",
            )
        })
    }

    pub(crate) fn error(
        &self,
        span: &Span,
        cause: impl Into<String>,
        remedy: impl Into<String>,
    ) -> SceneError {
        SceneError::new(&self.path, cause, remedy).at_span(
            &self.text,
            span.start,
            span.end.saturating_sub(span.start),
        )
    }

    pub(crate) fn place(&self, span: &Span) -> SourceSpan {
        let line = self
            .line_starts
            .partition_point(|&start| start <= span.start);
        SourceSpan {
            file: Arc::clone(&self.path),
            line,
        }
    }
}

/// A name as a key of a table for messages: in quotes where it needs them.
pub(super) fn key(name: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    match !name.is_empty() && name.chars().all(is_plain) {
        true => shortened(name).into_owned(),
        false => format!("{:?}", shortened(name)),
    }
}

/// Returns the name among `known` that is most similar to `wanted`.
pub(crate) fn nearest<'k>(wanted: &str, known: impl Iterator<Item = &'k str>) -> Option<&'k str> {
    // Of long names, the beginning: the time is the product of the lengths.
    let wanted = shortened(wanted);
    let likeness = |name: &str| strsim::jaro_winkler(&wanted, &shortened(name));
    known.max_by(|a, b| likeness(a).total_cmp(&likeness(b)))
}

/// Returns the remedy for a name that nothing in the file has. It proposes the most similar of the `known` names and
/// the `definition`; where nothing is known, it is `first`, which says how to define the first one.
pub(super) fn undefined<'k>(
    wanted: &str,
    known: impl Iterator<Item = &'k str>,
    definition: &str,
    first: impl FnOnce() -> String,
) -> String {
    match nearest(wanted, known) {
        Some(near) => {
            let near = shortened(near);
            format!("did you mean {near:?}? Or define {definition}")
        }
        None => first(),
    }
}

#[cfg(test)]
mod tests {
    use super::key;

    #[test]
    fn names_are_keys_that_can_be_written() {
        for (name, expected) in [
            ("gold", "gold"),
            ("gold-2_b", "gold-2_b"),
            ("I/rise", "\"I/rise\""),
            ("", "\"\""),
            ("a\"b", "\"a\\\"b\""),
        ] {
            assert_eq!(key(name), expected);
            let text = format!("[morph.{}]", key(name));
            assert!(toml::de::DeTable::parse(&text).is_ok(), "{text}");
        }
    }
}
