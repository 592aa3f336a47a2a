//! The words of a text file in which line ends mean little, and comments begin with `#`.

use super::SceneError;
use super::text::Source;
use crate::table::shortened;
use std::fmt::Display;
use std::iter::{Enumerate, Peekable};
use std::str::Lines;

/// The words of a file, without comments.
pub(super) struct Words<'a> {
    source: &'a Source,
    lines: Peekable<Enumerate<Lines<'a>>>,
    /// The rest of the line.
    rest: &'a str,
    /// Comes before the rest of the line.
    put_back: Option<&'a str>,
    /// The line of the last word, counted from 1.
    pub(super) line: usize,
}

impl<'a> Words<'a> {
    pub(super) fn new(source: &'a Source) -> Self {
        Self {
            source,
            lines: source.text.lines().enumerate().peekable(),
            rest: "",
            put_back: None,
            line: 0,
        }
    }

    /// The next word, of this line or one that follows.
    pub(super) fn next(&mut self) -> Option<&'a str> {
        if let Some(word) = self.put_back.take() {
            return Some(word);
        }
        loop {
            let rest = self.rest.trim_start();
            let end = rest.find(char::is_whitespace).unwrap_or(rest.len());
            let (word, rest) = rest.split_at(end);
            if !word.is_empty() {
                self.rest = rest;
                return Some(word);
            }
            let (index, line) = self.lines.next()?;
            self.line = index + 1;
            self.rest = plain(line);
        }
    }

    /// Makes this the next word.
    pub(super) fn put_back(&mut self, word: &'a str) {
        self.put_back = Some(word);
    }

    /// Returns the rest of the line.
    pub(super) fn rest_of_line(&self) -> &'a str {
        self.rest.trim()
    }

    /// Passes over the rest of the line, and counts its words.
    pub(super) fn skip_line(&mut self) -> usize {
        let rest = std::mem::take(&mut self.rest);
        rest.split_whitespace().count()
    }

    /// Returns the number of words of the next line that has any.
    pub(super) fn count_of_next_line(&mut self) -> usize {
        let count = |line: &str| plain(line).split_whitespace().count();
        while self.lines.next_if(|(_, line)| count(line) == 0).is_some() {}
        self.lines.peek().map_or(0, |(_, line)| count(line))
    }

    /// The lines behind this one that have words.
    pub(super) fn lines_ahead(&self) -> impl Iterator<Item = &'a str> {
        let lines = self.lines.clone().map(|(_, line)| plain(line).trim());
        lines.filter(|line| !line.is_empty())
    }

    /// Returns the next word; `what` names it in the message.
    pub(super) fn expect(&mut self, what: impl Display) -> Result<&'a str, SceneError> {
        self.next().ok_or_else(|| {
            self.source.error(
                format!("the file ends where {what} is expected"),
                "copy the file again, or export it again",
            )
        })
    }

    /// Reads a whole number, 0 or above.
    pub(super) fn count(&mut self, what: impl Display) -> Result<usize, SceneError> {
        let word = self.expect(&what)?;
        word.parse().map_err(|_| {
            self.source.error_at(
                word,
                format!(
                    "{what} is {word:?}, which is not a whole number",
                    word = shortened(word)
                ),
                "write a whole number, such as 3, and check that none is missing before it",
            )
        })
    }

    /// Reads a finite number.
    pub(super) fn number(&mut self, what: impl Display) -> Result<f64, SceneError> {
        let word = self.expect(&what)?;
        match word.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => self.source.number(word, &what.to_string()),
        }
    }
}

/// A line without its comment.
fn plain(line: &str) -> &str {
    line.split('#').next().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn words_know_their_lines_and_comments_are_none() {
        let source = Source::from_bytes(Path::new("a"), b"a b # c\n\n #d\n e  f\r\ng".to_vec());
        let mut words = Words::new(&source);
        assert_eq!((words.next(), words.line), (Some("a"), 1));
        assert_eq!((words.rest_of_line(), words.count_of_next_line()), ("b", 2));
        words.put_back("x");
        assert_eq!(
            (words.next(), words.next(), words.line),
            (Some("x"), Some("b"), 1)
        );
        assert_eq!((words.next(), words.line), (Some("e"), 4));
        assert_eq!((words.skip_line(), words.skip_line()), (1, 0));
        assert_eq!(
            (words.next(), words.next(), words.line),
            (Some("g"), None, 5)
        );
        assert_eq!(words.count_of_next_line(), 0);
        let error = words.count("the number").unwrap_err();
        assert_eq!(
            error.to_string(),
            "a: the file ends where the number is expected"
        );
    }
}
