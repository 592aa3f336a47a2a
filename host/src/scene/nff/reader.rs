//! The lines of an NFF file as words, and the numbers on them.

use crate::scene::SceneError;
use crate::scene::text::{Source, Warnings};
use std::str::Lines as TextLines;

/// The most words of a line that are kept. No entity has as many, and a line of one letter each would take more memory
/// than the file.
const MOST_WORDS: usize = 64;

/// A line that is neither empty nor a comment.
pub(super) struct Line<'a> {
    /// Counted from 1.
    pub(super) number: usize,
    /// Without comment and surrounding space.
    pub(super) text: &'a str,
    /// The first [`MOST_WORDS`].
    pub(super) words: Vec<&'a str>,
}

impl<'a> Line<'a> {
    /// A word of the line, or an empty one beyond its end.
    pub(super) fn word(&self, index: usize) -> &'a str {
        self.words.get(index).copied().unwrap_or("")
    }

    /// Returns the number of consecutive numbers from word `from` on.
    pub(super) fn numbers_from(&self, from: usize) -> usize {
        self.words
            .iter()
            .skip(from)
            .take_while(|word| word.parse::<f64>().is_ok())
            .count()
    }

    /// Reads `N` finite numbers from word `from` on. Further words are ignored with a warning, as
    /// dialects of the format add texture names and subdivision counts there.
    pub(super) fn numbers<const N: usize>(
        &self,
        source: &Source,
        warnings: &mut Warnings,
        from: usize,
        format: &str,
    ) -> Result<[f64; N], SceneError> {
        let given = self.words.len().saturating_sub(from);
        if given < N {
            return Err(source.error_at(
                self.text,
                format!("the line has {given} of {N} numbers"),
                format!("write `{format}`"),
            ));
        }
        let mut numbers = [0.0; N];
        for (number, word) in numbers.iter_mut().zip(&self.words[from..]) {
            *number = source.number(word, &format!("a number of `{format}`"))?;
        }
        if given > N {
            warnings.add(
                source,
                self.number,
                format!("what follows the {N} numbers of `{format}` is ignored"),
            );
        }
        Ok(numbers)
    }
}

/// Walks over the lines; it can look at a line before taking it.
pub(super) struct Lines<'a> {
    lines: TextLines<'a>,
    number: usize,
    waiting: Option<Line<'a>>,
}

impl<'a> Lines<'a> {
    pub(super) fn new(source: &'a Source) -> Self {
        Self {
            lines: source.text.lines(),
            number: 0,
            waiting: None,
        }
    }

    /// Takes the next line.
    pub(super) fn next(&mut self) -> Option<Line<'a>> {
        if let Some(line) = self.waiting.take() {
            return Some(line);
        }
        loop {
            let line = self.lines.next()?;
            self.number += 1;
            let text = line.split('#').next().unwrap_or("").trim();
            if !text.is_empty() {
                let words = text.split_whitespace().take(MOST_WORDS).collect();
                return Some(Line {
                    number: self.number,
                    text,
                    words,
                });
            }
        }
    }

    /// Takes the next line if it starts with one of these keywords.
    pub(super) fn next_if(&mut self, keywords: &[&str]) -> Option<Line<'a>> {
        let line = self.next()?;
        if keywords.contains(&line.word(0)) {
            return Some(line);
        }
        self.waiting = Some(line);
        None
    }
}
