//! Plain text tables.

use std::borrow::Cow;
use std::fmt;

/// The alignment of a column's cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    Left,
    Right,
}

/// A table whose columns are as wide as their widest cells, with two spaces between them.
///
/// ```
/// use gridel_host::table::{Align, Table};
///
/// let mut table = Table::new([("part", Align::Left), ("bytes", Align::Right)]);
/// table.row([String::from("header"), String::from("96")]);
/// assert_eq!(table.to_string(), "part    bytes\nheader     96\n");
/// ```
#[derive(Clone, Debug)]
pub struct Table {
    columns: Vec<Align>,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// Returns a table with a line of titles.
    pub fn new<'c>(columns: impl IntoIterator<Item = (&'c str, Align)>) -> Self {
        let columns = columns.into_iter();
        let (titles, columns) = columns
            .map(|(title, align)| (title.to_owned(), align))
            .unzip();
        Self {
            columns,
            rows: vec![titles],
        }
    }

    /// Returns a table without a title row.
    pub fn untitled<const N: usize>(columns: [Align; N]) -> Self {
        Self {
            columns: columns.to_vec(),
            rows: Vec::new(),
        }
    }

    /// Adds a row; cells beyond the columns line up on the left.
    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut widths = vec![0; self.columns.len()];
        for row in &self.rows {
            for (width, cell) in widths.iter_mut().zip(row) {
                *width = cell.chars().count().max(*width);
            }
        }
        for row in &self.rows {
            let mut line = String::new();
            for ((cell, align), &width) in row.iter().zip(&self.columns).zip(&widths) {
                match align {
                    Align::Left => line.push_str(&format!("{cell:<width$}  ")),
                    Align::Right => line.push_str(&format!("{cell:>width$}  ")),
                }
            }
            writeln!(f, "{}", line.trim_end())?;
        }
        Ok(())
    }
}

/// Formats a whole number, not negative, with a comma before every third digit from its end.
///
/// ```
/// assert_eq!(gridel_host::table::grouped(1_234_567), "1,234,567");
/// ```
pub fn grouped(number: impl ToString) -> String {
    let digits = number.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// Formats a number of things: `1 thread`, `2 threads`, `3 meshes`, `4 entries`.
///
/// ```
/// assert_eq!(gridel_host::table::counted(2, "mesh"), "2 meshes");
/// ```
pub fn counted(number: usize, thing: &str) -> String {
    let things = if number == 1 {
        thing.to_owned()
    } else if let Some(stem) = thing.strip_suffix("ry") {
        format!("{stem}ries")
    } else if thing.ends_with("sh") || thing.ends_with('x') {
        format!("{thing}es")
    } else {
        format!("{thing}s")
    };
    format!("{} {things}", grouped(number))
}

/// Formats a power of two, so that it can be recognized, and its size: `2^-20 = 9.537e-7`.
pub fn power_of_two(power: f64) -> String {
    format!("2^{} = {power:.3e}", power.log2().round())
}

/// Most characters of a name that texts show.
const MAX_SHOWN: usize = 80;
/// Most bytes of a sentence that is shown whole, and those of its two ends that are shown of others.
const MAX_SENTENCE: usize = 1500;
const SHOWN_ENDS: [usize; 2] = [800, 400];

/// Returns the beginning of a text, for messages that quote it: at most 80 characters, and `...` for the rest.
///
/// ```
/// assert_eq!(gridel_host::table::shortened(&"a".repeat(100)).len(), 83);
/// ```
pub fn shortened(text: &str) -> Cow<'_, str> {
    match text.char_indices().nth(MAX_SHOWN) {
        Some((end, _)) => Cow::Owned(format!("{}...", &text[..end])),
        None => Cow::Borrowed(text),
    }
}

/// Returns text as a terminal can show it: control characters but line feeds are escaped as in Rust.
///
/// ```
/// assert_eq!(gridel_host::table::shown("a\u{1b}[31mb"), "a\\u{1b}[31mb");
/// ```
pub fn shown(text: &str) -> Cow<'_, str> {
    let is_kept = |c: char| !c.is_control() || c == '\n';
    if text.chars().all(is_kept) {
        return Cow::Borrowed(text);
    }
    let escaped = text.chars().map(|c| match is_kept(c) {
        true => String::from(c),
        false => c.escape_debug().to_string(),
    });
    Cow::Owned(escaped.collect())
}

/// Returns a sentence as a terminal can show it, and without its middle if it is too long to be read, because it lists
/// what a file has.
pub(crate) fn clipped(sentence: String) -> String {
    let sentence = shown(&sentence).into_owned();
    if sentence.len() <= MAX_SENTENCE {
        return sentence;
    }
    let [head, tail] = SHOWN_ENDS;
    let head = sentence.floor_char_boundary(head);
    let tail = sentence.ceil_char_boundary(sentence.len() - tail);
    format!("{} ... {}", &sentence[..head], &sentence[tail..])
}

/// Returns a name of a scene file as a terminal can show it: on one line, at most 80 characters.
/// Control characters are escaped as in Rust.
///
/// ```
/// assert_eq!(gridel_host::table::printable("a\nb"), "a\\nb");
/// ```
pub fn printable(name: &str) -> String {
    let escaped = shortened(name).escape_debug().to_string();
    escaped.replace("\\\"", "\"").replace("\\'", "'")
}

/// Formats a number with six significant digits, without trailing zeros. Numbers of up to nine digits before the point
/// keep all of these.
///
/// ```
/// assert_eq!(gridel_host::table::significant(0.1 + 0.2), "0.3");
/// ```
pub fn significant(number: f64) -> String {
    if number == 0.0 {
        return String::from("0");
    }
    if !number.is_finite() {
        return number.to_string();
    }
    let exponent = number.abs().log10().floor();
    if !(-5.0..9.0).contains(&exponent) {
        return format!("{number:.5e}");
    }
    let decimals = (5.0 - exponent).max(0.0) as usize;
    let text = format!("{number:.decimals$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn printable_escapes_control_characters_and_shortens() {
        assert_eq!(printable("Käse \"gelb\" d'or"), "Käse \"gelb\" d'or");
        assert_eq!(printable("a\nb\u{1b}[31m\0"), "a\\nb\\u{1b}[31m\\0");
        assert_eq!(printable("left\u{202e}right"), "left\\u{202e}right");
        assert_eq!(printable("a\\'b"), "a\\\\'b");
        assert_eq!(printable(&"ä".repeat(80)), "ä".repeat(80));
        assert_eq!(printable(&"ä".repeat(81)), "ä".repeat(80) + "...");
    }

    #[test]
    fn long_sentences_lose_their_middle() {
        let sentence = format!("a{}z", "ä".repeat(1_000_000));
        let shown = clipped(sentence);
        assert!(shown.len() <= 1206, "{} bytes", shown.len());
        assert!(shown.starts_with("aä") && shown.ends_with("äz"));
        assert!(shown.contains("ä ... ä"));
        assert_eq!(clipped("ä".repeat(750)), "ä".repeat(750));
    }

    #[test]
    fn columns_line_up() {
        let mut table = Table::new([("what", Align::Left), ("bytes", Align::Right)]);
        table.row(["header".to_owned(), "96".to_owned()]);
        table.row(["a".to_owned(), "1,234".to_owned()]);
        assert_eq!(
            table.to_string(),
            "what    bytes\nheader     96\na       1,234\n"
        );
    }

    #[test]
    fn digits_are_grouped() {
        let numbers = [0_u64, 999, 1000, 123_456, 1_234_567];
        assert_eq!(
            numbers.map(grouped),
            ["0", "999", "1,000", "123,456", "1,234,567"]
        );
    }

    #[test]
    fn one_thing_is_no_plural() {
        assert_eq!(counted(1, "ray"), "1 ray");
        assert_eq!(counted(0, "ray"), "0 rays");
        assert_eq!(counted(4096, "gridel"), "4,096 gridels");
        assert_eq!(counted(2, "closed mesh"), "2 closed meshes");
        assert_eq!(counted(1, "entry"), "1 entry");
        assert_eq!(counted(0, "entry"), "0 entries");
    }

    #[test]
    fn six_digits_count() {
        assert_eq!(significant(0.0), "0");
        assert_eq!(significant(-0.0), "0");
        assert_eq!(significant(12.5), "12.5");
        assert_eq!(significant(-1.0 / 3.0), "-0.333333");
        assert_eq!(significant(1234567.0), "1234567");
        assert_eq!(significant(1.25e-7), "1.25000e-7");
        assert_eq!(significant(f64::INFINITY), "inf");
        assert_eq!(significant(f64::NEG_INFINITY), "-inf");
    }

    #[test]
    fn powers_of_two_are_recognized() {
        assert_eq!(power_of_two(1.0), "2^0 = 1.000e0");
        assert_eq!(power_of_two(f64::powi(2.0, -20)), "2^-20 = 9.537e-7");
    }
}
