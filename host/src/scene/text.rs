//! Text files as the importers read them: words that know their place, finite numbers, and
//! warnings that do not flood.

use super::access::Access;
use super::{SceneError, SourceSpan, gzip};
use crate::table::{clipped, grouped, shortened};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::string::FromUtf8Error;
use std::sync::Arc;

/// A text file in memory. Bytes that are not UTF-8 become U+FFFD. That is harmless in a comment or
/// a name. Where a number or a keyword is expected, it is an error with its line.
pub(super) struct Source {
    pub(super) path: Arc<PathBuf>,
    pub(super) text: String,
}

impl Source {
    pub(super) fn read(path: &Path, access: &Access) -> Result<Self, SceneError> {
        let bytes = gzip::inflate(path, access.read(path)?)?;
        check_encoding(path, &bytes)?;
        Ok(Self::from_bytes(path, bytes))
    }

    pub(super) fn from_bytes(path: &Path, bytes: Vec<u8>) -> Self {
        let lossy = |error: FromUtf8Error| String::from_utf8_lossy(error.as_bytes()).into_owned();
        let mut text = String::from_utf8(bytes).unwrap_or_else(lossy);
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

    pub(super) fn place(&self, line: usize) -> SourceSpan {
        SourceSpan {
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
                format!(
                    "{what} is {word:?}, which is not a finite number",
                    word = shortened(word)
                ),
                "write a finite decimal number, such as 1.5 or -2e3",
            )),
            Err(_) => Err(self.error_at(
                word,
                format!(
                    "{what} is {word:?}, which is not a number",
                    word = shortened(word)
                ),
                "write a decimal number, such as 1.5 or -2e3",
            )),
        }
    }
}

/// Rejects text in UTF-16 and UTF-32, which no scene format has. Read as bytes, errors would quote
/// words that are not in the file.
pub(crate) fn check_encoding(path: &Path, bytes: &[u8]) -> Result<(), SceneError> {
    // Without a mark, every second byte of plain text is 0; other text has no such byte.
    let head = &bytes[..bytes.len().min(64)];
    let zeros = |odd: usize| {
        let bytes = head.iter().skip(odd).step_by(2);
        (
            bytes.clone().count(),
            bytes.filter(|&&byte| byte == 0).count(),
        )
    };
    let ((even, even_zeros), (odd, odd_zeros)) = (zeros(0), zeros(1));
    let name = match bytes {
        [0xff, 0xfe, 0, 0, ..] | [0, 0, 0xfe, 0xff, ..] => "UTF-32",
        [0xff, 0xfe, ..] => "UTF-16LE",
        [0xfe, 0xff, ..] => "UTF-16BE",
        _ if odd >= 2 && odd_zeros == odd && even_zeros == 0 => "UTF-16LE",
        _ if even >= 2 && even_zeros == even && odd_zeros == 0 => "UTF-16BE",
        _ => return Ok(()),
    };
    Err(SceneError::new(
        path,
        format!("the text is in {name}; UTF-8 is required"),
        format!("save it in UTF-8, or convert it: `iconv -f {name} -t UTF-8 OLD > NEW`"),
    ))
}

/// The most sentences of a file that are kept.
const MOST_SENTENCES: usize = 40;

/// Warnings of an importer. A sentence is kept once, with the first line it applies to and the
/// number of further lines. Of further sentences of a file with many, which name a word each, the number is kept. So the
/// warnings of a file with a million faults stay readable.
#[derive(Default)]
pub(super) struct Warnings {
    /// Sentence, first place, and the number of further places.
    found: Vec<(String, SourceSpan, usize)>,
    index: HashMap<String, usize>,
    files: HashMap<Arc<PathBuf>, OfFile>,
}

/// The warnings of a file.
#[derive(Default)]
struct OfFile {
    /// The number of sentences.
    kept: usize,
    /// The place of the first warning that is not kept, and the number of all such.
    more: Option<(SourceSpan, usize)>,
}

impl Warnings {
    /// `sentence` has neither capital nor full stop; a line of 0 means the whole file.
    pub(super) fn add(&mut self, source: &Source, line: usize, sentence: impl Into<String>) {
        self.add_times(source.place(line), 1, sentence);
    }

    /// Adds a sentence with the first place it applies to, and the number of times in all, at least
    /// once.
    pub(super) fn add_times(
        &mut self,
        place: SourceSpan,
        times: usize,
        sentence: impl Into<String>,
    ) {
        let sentence = clipped(sentence.into());
        if let Some(&index) = self.index.get(&sentence) {
            self.found[index].2 += times;
            return;
        }
        let file = self.files.entry(Arc::clone(&place.file)).or_default();
        if file.kept == MOST_SENTENCES {
            file.more.get_or_insert((place, 0)).1 += times.max(1);
            return;
        }
        file.kept += 1;
        self.index.insert(sentence.clone(), self.found.len());
        self.found.push((sentence, place, times.saturating_sub(1)));
    }

    pub(super) fn into_sentences(self) -> Vec<String> {
        let found = self.found.into_iter();
        let found = found.map(|(sentence, place, more)| match more {
            0 => format!("{place}: {sentence}"),
            1 => format!("{place}: {sentence} (and once more)"),
            _ => format!("{place}: {sentence} (and {more} times more)"),
        });
        let mut more: Vec<_> = self.files.into_values().filter_map(|it| it.more).collect();
        more.sort_by(|(a, _), (b, _)| a.file.cmp(&b.file));
        let more = more.into_iter().map(|(place, count)| match count {
            1 => format!("{place}: 1 further warning, of this place, is not listed"),
            _ => {
                let count = grouped(count);
                format!("{place}: {count} further warnings, from this place on, are not listed")
            }
        });
        found.chain(more).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_underlines_the_word_and_names_its_line() {
        let source = Source::from_bytes(Path::new("a.nff"), b"one\ntwo nan\n".to_vec());
        let word = source.lines().nth(1).map(|(_, line)| &line[4..]).unwrap();
        let error = source.number(word, "the radius").unwrap_err();
        assert_eq!(
            error.to_string(),
            "a.nff:2: the radius is \"nan\", which is not a finite number"
        );
    }

    #[test]
    fn utf16_and_utf32_are_named_with_or_without_a_mark() {
        let text = "solid a\nendsolid\n";
        let wide = |mark: &[u8], unit: fn(u16) -> [u8; 2]| {
            [
                mark,
                &text.encode_utf16().flat_map(unit).collect::<Vec<u8>>(),
            ]
            .concat()
        };
        let cases = [
            (wide(b"\xff\xfe", u16::to_le_bytes), "UTF-16LE"),
            (wide(b"\xfe\xff", u16::to_be_bytes), "UTF-16BE"),
            (wide(b"", u16::to_le_bytes), "UTF-16LE"),
            (wide(b"", u16::to_be_bytes), "UTF-16BE"),
            (b"\xff\xfe\0\0s\0\0\0".to_vec(), "UTF-32"),
        ];
        for (bytes, name) in cases {
            let error = check_encoding(Path::new("a"), &bytes).unwrap_err();
            assert!(error.cause.contains(name), "{error}");
            assert!(error.remedy.contains("iconv"), "{}", error.remedy);
        }
        for bytes in [
            &b""[..],
            b"\0",
            b"a",
            b"a\0",
            b"caf\xe9 and more",
            b"\xef\xbb\xbfa",
        ] {
            assert!(check_encoding(Path::new("a"), bytes).is_ok());
        }
    }

    #[test]
    fn all_line_ends_count() {
        for bytes in [
            &b"a\nb\nc"[..],
            b"a\r\nb\r\nc\r\n",
            b"a\rb\rc",
            b"\xef\xbb\xbfa\nb\nc",
        ] {
            let source = Source::from_bytes(Path::new("a"), bytes.to_vec());
            let lines: Vec<_> = source.lines().collect();
            assert_eq!(lines, [(1, "a"), (2, "b"), (3, "c")]);
        }
    }

    #[test]
    fn equal_warnings_are_counted() {
        let source = Source::from_bytes(Path::new("a.obj"), Vec::new());
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

    #[test]
    fn warnings_that_name_a_word_each_are_counted() {
        let [objects, materials] =
            ["a.obj", "a.mtl"].map(|name| Source::from_bytes(Path::new(name), Vec::new()));
        let mut warnings = Warnings::default();
        for line in 1..=100_000 {
            warnings.add(&objects, line, format!("the statement {line} is unknown"));
        }
        warnings.add(&objects, 100_001, "the statement 7 is unknown");
        for line in 1..=41 {
            warnings.add(&materials, line, format!("the color {line} is unknown"));
        }
        let sentences = warnings.into_sentences();
        assert_eq!(sentences.len(), 2 * MOST_SENTENCES + 2);
        assert_eq!(
            sentences[6],
            "a.obj:7: the statement 7 is unknown (and once more)"
        );
        assert_eq!(
            sentences[2 * MOST_SENTENCES..],
            [
                "a.mtl:41: 1 further warning, of this place, is not listed",
                "a.obj:41: 99,960 further warnings, from this place on, are not listed"
            ]
        );
    }
}
