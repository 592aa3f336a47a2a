//! Lines of OBJ and MTL files that continue on further ones.

use crate::scene::size::MOST_PRIMITIVES;
use crate::scene::text::Source;

/// The most words of a line, or parts that it is continued by: those of a face with as many triangles as a scene holds.
pub(super) const MOST_WORDS: usize = MOST_PRIMITIVES as usize + 3;

/// The statements of numbers.
pub(super) const NUMBERS: [&str; 4] = ["v", "vt", "vn", "f"];

/// Returns a file in which no line continues on further ones. Each such line is joined, and blank lines follow it, so
/// that the others keep their numbers.
pub(super) fn joined(source: Source) -> Source {
    let whole = || WholeLines(source.lines());
    if !whole().any(|(_, _, parts)| parts.len() > 1) {
        return source;
    }
    let lines = whole().map(|(_, _, parts)| parts.join(" ") + &"\n".repeat(parts.len()));
    let text = lines.collect();
    Source { text, ..source }
}

/// Returns the statements other than vertices and faces that continue on further lines, each as one line. The parser
/// takes names from them.
pub(super) fn continued(source: &Source) -> Vec<String> {
    let lines = WholeLines(source.lines());
    let continued = lines.filter_map(|(_, _, parts)| match parts[..] {
        [] | [_] => None,
        _ => Some(parts.join(" ")),
    });
    continued.filter(|line| !is_of_numbers(line)).collect()
}

/// Returns whether a line is read by the parser word by word, so that it needs not be joined.
fn is_of_numbers(line: &str) -> bool {
    let keyword = line.split_whitespace().next();
    keyword.is_some_and(|word| NUMBERS.contains(&word))
}

/// The lines of a file, of which a backslash at the end continues one on the next, unless a comment ends so: number, the
/// first line itself, and the parts without backslashes.
pub(super) struct WholeLines<I>(pub(super) I);

impl<'a, I: Iterator<Item = (usize, &'a str)>> Iterator for WholeLines<I> {
    type Item = (usize, &'a str, Vec<&'a str>);

    fn next(&mut self) -> Option<Self::Item> {
        let (number, line) = self.0.next()?;
        let mut parts = Vec::new();
        let mut rest = line.trim();
        while parts.len() <= MOST_WORDS
            && let Some(part) = rest.strip_suffix('\\').filter(|it| !has_comment(it))
        {
            parts.push(part.trim());
            rest = self.0.next().map_or("", |(_, line)| line.trim());
        }
        parts.push(rest);
        Some((number, line.trim(), parts))
    }
}

/// Returns whether a word of a line begins a comment.
fn has_comment(line: &str) -> bool {
    line.split_whitespace().any(|word| word.starts_with('#'))
}
