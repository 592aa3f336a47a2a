//! The lines that an error shows: those around a place of a file, cut to a width that terminals have.

use miette::{MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};
use std::ops::Range;

/// Most characters of a line that is shown.
const WIDTH: usize = 100;
/// Characters of a long line that are shown in front of the place.
const LEAD: usize = 40;
/// Most lines of the place that are shown.
const MOST_LINES: usize = 8;
/// Stands for what a line is without.
const CUT: &str = "...";

/// The lines around a place, and the span (byte offset, length) to underline in them.
#[derive(Debug)]
pub(super) struct Excerpt {
    file: String,
    text: String,
    pub(super) span: (usize, usize),
    /// The lines of the file before this text.
    lines_before: usize,
    /// Line and column of the place in the file, counted from 0; columns are bytes.
    place: (usize, usize),
}

impl Excerpt {
    /// Takes the lines of `text` around the bytes of `span`, with one line before and one behind.
    pub(super) fn new(file: String, text: &str, span: Range<usize>) -> Self {
        let start = text.floor_char_boundary(span.start);
        let end = text.floor_char_boundary(span.end).max(start);
        let line_start = |offset: usize| text[..offset].rfind('\n').map_or(0, |it| it + 1);
        let of_place = line_start(start);
        let first = line_start(of_place.saturating_sub(1));
        let breaks = |part: &str| part.bytes().filter(|&byte| byte == b'\n').count();
        let lines_before = breaks(&text[..first]);
        let line = lines_before + breaks(&text[first..of_place]);
        let mut excerpt = Self {
            file,
            text: String::new(),
            span: (0, 0),
            lines_before,
            place: (line, start - of_place),
        };
        excerpt.fill(text, first, start..end);
        excerpt
    }

    /// Adds the lines from the one at `first` on.
    fn fill(&mut self, text: &str, first: usize, place: Range<usize>) {
        let (mut from, mut to) = (0, None);
        let (mut at, mut of_place) = (first, 0);
        for (number, line) in text[first..].split('\n').enumerate() {
            if number > 0 {
                self.text.push('\n');
            }
            let line_end = at + line.len();
            let holds_start = (at..=line_end).contains(&place.start);
            let anchor = if holds_start { place.start - at } else { 0 };
            let shown = self.push(line, anchor);
            if to.is_some() {
                break;
            }
            if holds_start {
                from = shown(place.start - at);
            }
            of_place += usize::from(place.start <= line_end);
            if (of_place > 0 && place.end <= line_end) || of_place == MOST_LINES {
                to = Some(shown(place.end.min(line_end) - at));
            }
            at = line_end + 1;
        }
        self.span = (from, to.unwrap_or(from) - from);
    }

    /// Adds a line, of which the part around `anchor` is shown. Returns where its bytes are in the
    /// text.
    fn push(&mut self, line: &str, anchor: usize) -> impl Fn(usize) -> usize + use<> {
        let line = line.strip_suffix('\r').unwrap_or(line);
        let mut range = 0..line.len();
        if let Some((width, _)) = line.char_indices().nth(WIDTH) {
            let mut before = line[..anchor.min(line.len())].char_indices().rev();
            range.start = before.nth(LEAD - 1).map_or(0, |(start, _)| start);
            let mut behind = line[range.start..].char_indices();
            range.end = match range.start {
                0 => width,
                start => behind.nth(WIDTH).map_or(line.len(), |(end, _)| start + end),
            };
        }
        if range.start > 0 {
            self.text.push_str(CUT);
        }
        let base = self.text.len();
        for letter in line[range.clone()].chars() {
            // Terminals obey control characters. As many bytes stand for each.
            match letter.is_control() && letter != '\t' {
                true => self.text.extend((0..letter.len_utf8()).map(|_| ' ')),
                false => self.text.push(letter),
            }
        }
        if range.end < line.len() {
            self.text.push_str(CUT);
        }
        move |offset| base + offset.clamp(range.start, range.end) - range.start
    }
}

impl SourceCode for Excerpt {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        before: usize,
        behind: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let found = self.text.read_span(span, before, behind)?;
        // Without lines around it, the place itself is asked for.
        let (line, column) = match before {
            0 => self.place,
            _ => (self.lines_before + found.line(), found.column()),
        };
        Ok(Box::new(MietteSpanContents::new_named(
            self.file.clone(),
            found.data(),
            *found.span(),
            line,
            column,
            found.line_count(),
        )))
    }
}

#[cfg(test)]
mod tests {
    use crate::scene::SceneError;
    use miette::{GraphicalReportHandler, GraphicalTheme};
    use std::ops::Range;

    /// The lines that an error at a span shows.
    fn shown(text: &str, span: Range<usize>) -> String {
        let error = SceneError::new("a.obj".as_ref(), "wrong", "mend it");
        let error = error.at_span(text, span.start, span.len());
        let mut report = String::new();
        let handler = GraphicalReportHandler::new_themed(GraphicalTheme::unicode_nocolor());
        handler.render_report(&mut report, &error).unwrap();
        report
    }

    #[test]
    fn places_beyond_column_65535_are_shown() {
        let text = format!("v 0 0 0\nf 1 2{}9x\nf 1 2 3\n", " ".repeat(70_000));
        let report = shown(&text, 70_013..70_015);
        assert!(report.contains("[a.obj:2:70006]"), "{report}");
        let lines: Vec<_> = report.lines().map(str::trim_end).collect();
        let gap = " ".repeat(40);
        assert!(lines.contains(&" 1 │ v 0 0 0"), "{report}");
        assert!(lines.contains(&&*format!(" 2 │ ...{gap}9x")), "{report}");
        assert!(lines.contains(&&*format!("   ·    {gap}──")), "{report}");
        assert!(lines.contains(&" 3 │ f 1 2 3"), "{report}");
    }

    #[test]
    fn long_lines_around_a_place_are_cut() {
        let long = "ä".repeat(1_000_000);
        let text = format!("{long}\nab{long}\n{long}");
        for span in [2_000_001..2_000_003, 2_000_001..4_000_003, 0..text.len()] {
            let report = shown(&text, span);
            assert!(report.len() < 2000, "{} bytes", report.len());
            let cut = format!("ab{}...", "ä".repeat(98));
            assert!(report.contains(&cut), "{report}");
        }
    }

    #[test]
    fn many_lines_are_cut() {
        let text = "a b\n".repeat(1000);
        let report = shown(&text, 400..4000);
        assert!(report.contains("[a.obj:101:1]"), "{report}");
        assert!(report.contains("109 │"), "{report}");
        assert!(!report.contains("110 │"), "{report}");
    }

    #[test]
    fn control_characters_are_not_shown() {
        let report = shown("a\u{1b}[31m\rb\r\nc\u{85}d\r\n", 0..1);
        assert!(report.contains("1 │ a [31m b\n"), "{report}");
        assert!(report.contains("2 │ c  d\n"), "{report}");
    }

    #[test]
    fn every_span_of_a_text_is_shown() {
        let text = "a\r\n\nbß\rc\n";
        for start in 0..=text.len() + 1 {
            for end in start..=text.len() + 1 {
                assert!(shown(text, start..end).contains("a.obj:"), "{start}..{end}");
            }
        }
        assert!(shown("", 0..0).contains("[a.obj:1:1]"));
    }
}
