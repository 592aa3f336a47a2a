//! The tokens of CIF 1.1, the syntax of mmCIF (S. Hall et al., *International Tables for
//! Crystallography* G, 2.2).

use crate::scene::SceneError;
use crate::scene::text::Source;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Token<'a> {
    /// `data_` and the name of the block.
    Block(&'a str),
    Loop,
    /// The name of an item, without its underscore.
    Tag(&'a str),
    /// A value; one that the file leaves open (`.` or `?`) is empty.
    Value(&'a str),
    /// `save_`, `global_` or `stop_`, which mmCIF files of atoms do not use.
    Reserved,
}

pub(super) struct Tokens<'a> {
    source: &'a Source,
    /// The rest of the text.
    rest: &'a str,
    /// The line of the last token, counted from 1.
    pub(super) line: usize,
    at_line_start: bool,
}

impl<'a> Tokens<'a> {
    pub(super) fn new(source: &'a Source) -> Self {
        Self {
            source,
            rest: &source.text,
            line: 1,
            at_line_start: true,
        }
    }

    /// Takes the next token.
    ///
    /// # Errors
    /// If a quoted value has no end.
    pub(super) fn next(&mut self) -> Result<Option<Token<'a>>, SceneError> {
        self.skip_space();
        let Some(first) = self.rest.chars().next() else {
            return Ok(None);
        };
        if first == ';' && self.at_line_start {
            return self.text_field().map(Some);
        }
        if first == '\'' || first == '"' {
            return self.quoted(first).map(Some);
        }
        let end = self
            .rest
            .find(|c: char| c.is_ascii_whitespace())
            .unwrap_or(self.rest.len());
        let word = self.take(end);
        if let Some(tag) = word.strip_prefix('_') {
            return Ok(Some(Token::Tag(tag)));
        }
        Ok(Some(match word {
            "." | "?" => Token::Value(""),
            _ if word.eq_ignore_ascii_case("loop_") => Token::Loop,
            _ if starts_with(word, "data_") => Token::Block(&word[5..]),
            _ if ["save_", "global_", "stop_"]
                .iter()
                .any(|reserved| starts_with(word, reserved)) =>
            {
                Token::Reserved
            }
            _ => Token::Value(word),
        }))
    }

    fn take(&mut self, length: usize) -> &'a str {
        let (token, rest) = self.rest.split_at(length);
        self.rest = rest;
        self.at_line_start = false;
        token
    }

    fn skip_space(&mut self) {
        loop {
            match self.rest.as_bytes().first() {
                Some(b'\n') => {
                    self.line += 1;
                    self.take(1);
                    self.at_line_start = true;
                }
                Some(byte) if byte.is_ascii_whitespace() => {
                    self.take(1);
                }
                Some(b'#') => {
                    let end = self.rest.find('\n').unwrap_or(self.rest.len());
                    self.take(end);
                }
                _ => return,
            }
        }
    }

    /// Lines from one that starts with a semicolon to the next one that does.
    fn text_field(&mut self) -> Result<Token<'a>, SceneError> {
        let Some(end) = self.rest.find("\n;") else {
            return Err(self.unclosed(
                "text field",
                "end it with a line that starts with a semicolon",
            ));
        };
        let token = self.take(end + 2);
        self.line += token.bytes().filter(|&byte| byte == b'\n').count();
        let text = &token[1..end];
        // The last line ends before the semicolon, also where lines end as on Windows.
        Ok(Token::Value(text.strip_suffix('\r').unwrap_or(text)))
    }

    /// A value in quotes; a quote inside it that no space follows does not end it.
    fn quoted(&mut self, quote: char) -> Result<Token<'a>, SceneError> {
        let line = &self.rest[..self.rest.find('\n').unwrap_or(self.rest.len())];
        let end = line.char_indices().skip(1).find(|&(offset, c)| {
            c == quote
                && line[offset + 1..]
                    .chars()
                    .next()
                    .is_none_or(|next| next.is_ascii_whitespace())
        });
        match end {
            Some((end, _)) => Ok(Token::Value(&self.take(end + 1)[1..end])),
            None => Err(self.unclosed(
                "quoted value",
                "end it with the same quote on the same line",
            )),
        }
    }

    fn unclosed(&self, what: &str, remedy: &str) -> SceneError {
        let line = self.rest.lines().next().unwrap_or("");
        self.source
            .error_at(line, format!("a {what} has no end"), remedy)
    }
}

fn starts_with(word: &str, keyword: &str) -> bool {
    word.get(..keyword.len())
        .is_some_and(|start| start.eq_ignore_ascii_case(keyword))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn tokens_have_the_lines_where_they_end() {
        let text = "data_1ABC # c\nloop_\n_a.b _a.c\n'it''s' \"C1'\" . ?\n;two\nlines\n;\nDATA_x save_f a#b ;c";
        let source = Source::from_bytes(Path::new("t.cif"), text.into());
        let mut tokens = Tokens::new(&source);
        let mut found = Vec::new();
        while let Some(token) = tokens.next().unwrap() {
            found.push((tokens.line, token));
        }
        use Token::{Block, Loop, Reserved, Tag, Value};
        let expected = [
            (1, Block("1ABC")),
            (2, Loop),
            (3, Tag("a.b")),
            (3, Tag("a.c")),
            (4, Value("it''s")),
            (4, Value("C1'")),
            (4, Value("")),
            (4, Value("")),
            (7, Value("two\nlines")),
            (8, Block("x")),
            (8, Reserved),
            (8, Value("a#b")),
            (8, Value(";c")),
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn text_fields_hold_no_part_of_their_last_line_end() {
        for (text, expected) in [
            (";N\r\n;\r\n", "N"),
            (";\r\n;\r\n", ""),
            (";a\r\nb\r\n;\r\n", "a\r\nb"),
            (";N\n;\n", "N"),
        ] {
            let source = Source::from_bytes(Path::new("t.cif"), text.into());
            let token = Tokens::new(&source).next().unwrap();
            assert_eq!(token, Some(Token::Value(expected)), "{text:?}");
        }
    }

    #[test]
    fn values_without_an_end_are_rejected_with_their_line() {
        for (text, message) in [
            ("a\n'b c\n", "t.cif:2: a quoted value has no end"),
            ("a\n\n;b\nc;\n", "t.cif:3: a text field has no end"),
        ] {
            let source = Source::from_bytes(Path::new("t.cif"), text.into());
            let mut tokens = Tokens::new(&source);
            tokens.next().unwrap();
            assert_eq!(tokens.next().unwrap_err().to_string(), message);
        }
    }
}
