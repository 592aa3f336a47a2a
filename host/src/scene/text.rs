//! Text files as the importers read them: words that know their place, finite numbers, and
//! warnings that do not flood.

use super::{Place, SceneError};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A text file in memory. Bytes that are not UTF-8 become U+FFFD: harmless in a comment or a
/// name, and an error with its line wherever a number or a keyword is expected.
pub(super) struct Source {
    pub(super) path: Arc<PathBuf>,
    pub(super) text: String,
}

impl Source {
    pub(super) fn read(path: &Path) -> Result<Self, SceneError> {
        Ok(Self::from_bytes(path, &read_file(path)?))
    }

    pub(super) fn from_bytes(path: &Path, bytes: &[u8]) -> Self {
        let mut text = String::from_utf8_lossy(bytes).into_owned();
        if text.starts_with('\u{feff}') {
            text.remove(0);
        }
        // Files from before Mac OS X end their lines with a carriage return alone.
        if !text.contains('\n') {
            text = text.replace('\r', "\n");
        }
        Self {
            path: Arc::new(path.to_owned()),
            text,
        }
    }

    /// The lines and their numbers, counted from 1, without their line ends.
    pub(super) fn lines(&self) -> impl Iterator<Item = (usize, &str)> {
        self.text
            .lines()
            .enumerate()
            .map(|(index, line)| (index + 1, line))
    }

    pub(super) fn place(&self, line: usize) -> Place {
        Place {
            file: Arc::clone(&self.path),
            line,
        }
    }

    /// An error about the file as a whole.
    pub(super) fn error(&self, cause: impl Into<String>, remedy: impl Into<String>) -> SceneError {
        SceneError::new(&self.path, cause, remedy)
    }

    /// An error that underlines `part`, which is a slice of [`Source::text`].
    pub(super) fn error_at(
        &self,
        part: &str,
        cause: impl Into<String>,
        remedy: impl Into<String>,
    ) -> SceneError {
        let offset = (part.as_ptr() as usize).saturating_sub(self.text.as_ptr() as usize);
        self.error(cause, remedy)
            .at_span(&self.text, offset, part.len())
    }

    /// Reads a finite number; `what` names it in the message.
    pub(super) fn number(&self, word: &str, what: &str) -> Result<f64, SceneError> {
        match word.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            Ok(_) => Err(self.error_at(
                word,
                format!("{what} is {word:?}, which is not a finite number"),
                "write a finite decimal number, such as 1.5 or -2e3",
            )),
            Err(_) => Err(self.error_at(
                word,
                format!("{what} is {word:?}, which is not a number"),
                "write a decimal number, such as 1.5 or -2e3",
            )),
        }
    }
}

/// Reads a file; not a device, which may have no end.
pub(super) fn read_file(path: &Path) -> Result<Vec<u8>, SceneError> {
    let bytes = std::fs::metadata(path).and_then(|metadata| match metadata.is_file() {
        true => std::fs::read(path),
        false => Err(std::io::Error::other("it is not a file")),
    });
    bytes.map_err(|error| {
        SceneError::new(
            path,
            format!("cannot be read: {error}"),
            "check that the path names a file you may read",
        )
    })
}

/// What an importer passed over. The same sentence is kept once, with the first line it applies
/// to and how many lines follow it, so that a file of a million equal faults stays readable.
#[derive(Default)]
pub(super) struct Warnings {
    /// Sentence, first place, and the number of further places.
    found: Vec<(String, Place, usize)>,
    index: HashMap<String, usize>,
}

impl Warnings {
    /// `sentence` has neither capital nor full stop; a line of 0 stands for the whole file.
    pub(super) fn add(&mut self, source: &Source, line: usize, sentence: impl Into<String>) {
        let sentence = sentence.into();
        if let Some(&index) = self.index.get(&sentence) {
            self.found[index].2 += 1;
            return;
        }
        self.index.insert(sentence.clone(), self.found.len());
        self.found.push((sentence, source.place(line), 0));
    }

    pub(super) fn into_sentences(self) -> Vec<String> {
        self.found
            .into_iter()
            .map(|(sentence, place, more)| match more {
                0 => format!("{place}: {sentence}"),
                1 => format!("{place}: {sentence} (and once more)"),
                _ => format!("{place}: {sentence} (and {more} times more)"),
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_underlines_the_word_and_names_its_line() {
        let source = Source::from_bytes(Path::new("a.nff"), b"one\ntwo nan\n");
        let word = source.lines().nth(1).map(|(_, line)| &line[4..]).unwrap();
        let error = source.number(word, "the radius").unwrap_err();
        assert_eq!(
            error.to_string(),
            "a.nff:2: the radius is \"nan\", which is not a finite number"
        );
    }

    #[test]
    fn all_line_ends_count() {
        for bytes in [
            &b"a\nb\nc"[..],
            b"a\r\nb\r\nc\r\n",
            b"a\rb\rc",
            b"\xef\xbb\xbfa\nb\nc",
        ] {
            let source = Source::from_bytes(Path::new("a"), bytes);
            let lines: Vec<_> = source.lines().collect();
            assert_eq!(lines, [(1, "a"), (2, "b"), (3, "c")]);
        }
    }

    #[test]
    fn equal_warnings_are_counted() {
        let source = Source::from_bytes(Path::new("a.obj"), b"");
        let mut warnings = Warnings::default();
        for line in [3, 5, 9] {
            warnings.add(&source, line, "a face is skipped");
        }
        warnings.add(&source, 0, "there is no light");
        assert_eq!(
            warnings.into_sentences(),
            [
                "a.obj:3: a face is skipped (and 2 times more)",
                "a.obj: there is no light"
            ]
        );
    }
}
