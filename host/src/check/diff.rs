//! Unified diffs of texts that differ in a few lines.

use std::fmt::Write;

/// Lines around a change that are shown.
const CONTEXT: usize = 2;

/// A line of a diff: kept, only in the old text, or only in the new one.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Tag {
    Kept,
    Old,
    New,
}

/// Returns the unified diff of two versions of the file `name`; empty if they are equal.
pub(super) fn unified(name: &str, old: &str, new: &str) -> String {
    let lines = changes(
        &old.split_inclusive('\n').collect::<Vec<_>>(),
        &new.split_inclusive('\n').collect::<Vec<_>>(),
    );
    let changed: Vec<usize> = (0..lines.len())
        .filter(|&index| lines[index].0 != Tag::Kept)
        .collect();
    let mut text = String::new();
    // Changes whose contexts touch share a hunk.
    for hunk in changed.chunk_by(|a, b| b - a <= 2 * CONTEXT + 1) {
        let (Some(&first), Some(&last)) = (hunk.first(), hunk.last()) else {
            continue;
        };
        if text.is_empty() {
            let _ = write!(text, "--- {name}\n+++ {name}\n");
        }
        let start = first.saturating_sub(CONTEXT);
        let end = (last + 1 + CONTEXT).min(lines.len());
        let range = |without: Tag| {
            let count = |lines: &[(Tag, &str)]| {
                let within = lines.iter().filter(|(tag, _)| *tag != without);
                within.count()
            };
            match (count(&lines[..start]), count(&lines[start..end])) {
                // An empty range begins at the line before it.
                (before, 0) => format!("{before},0"),
                (before, 1) => format!("{}", before + 1),
                (before, length) => format!("{},{length}", before + 1),
            }
        };
        let _ = writeln!(text, "@@ -{} +{} @@", range(Tag::New), range(Tag::Old));
        for (tag, line) in &lines[start..end] {
            text.push(match tag {
                Tag::Kept => ' ',
                Tag::Old => '-',
                Tag::New => '+',
            });
            text.push_str(line);
            if !line.ends_with('\n') {
                text.push_str("\n\\ No newline at end of file\n");
            }
        }
    }
    text
}

/// Returns the new text with the line ends of the old one. Those of new lines are as those before them.
pub(super) fn with_line_ends(old: &str, new: &str) -> String {
    if !old.contains('\r') {
        return new.to_owned();
    }
    let plain = |text: &str| text.replace("\r\n", "\n");
    let (old_plain, new_plain) = (plain(old), plain(new));
    let lines = changes(
        &old_plain.split_inclusive('\n').collect::<Vec<_>>(),
        &new_plain.split_inclusive('\n').collect::<Vec<_>>(),
    );
    let mut ends = old.split_inclusive('\n').map(|line| line.ends_with("\r\n"));
    let mut returns = ends.clone().next().unwrap_or_default();
    let mut text = String::with_capacity(new.len() + lines.len());
    for (tag, line) in lines {
        if tag != Tag::New {
            returns = ends.next().unwrap_or(returns);
        }
        if tag != Tag::Old {
            match line.strip_suffix('\n') {
                Some(line) if returns => text.extend([line, "\r\n"]),
                _ => text.push_str(line),
            }
        }
    }
    text
}

/// The lines of both texts in order. After a difference, the texts meet again at the nearest pair of
/// equal lines.
fn changes<'a>(mut old: &[&'a str], mut new: &[&'a str]) -> Vec<(Tag, &'a str)> {
    let mut lines = Vec::with_capacity(old.len().max(new.len()));
    while !old.is_empty() || !new.is_empty() {
        let same = old.iter().zip(new).take_while(|(a, b)| a == b).count();
        lines.extend(old[..same].iter().map(|line| (Tag::Kept, *line)));
        (old, new) = (&old[same..], &new[same..]);
        let meeting = (0..old.len() + new.len())
            .flat_map(|apart| (0..=apart).map(move |a| (a, apart - a)))
            .find(|&(a, b)| old.get(a).is_some_and(|line| new.get(b) == Some(line)));
        let (a, b) = meeting.unwrap_or((old.len(), new.len()));
        lines.extend(old[..a].iter().map(|line| (Tag::Old, *line)));
        lines.extend(new[..b].iter().map(|line| (Tag::New, *line)));
        (old, new) = (&old[a..], &new[b..]);
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_texts_have_no_diff() {
        assert_eq!(unified("f", "a\nb", "a\nb"), "");
        assert_eq!(unified("f", "", ""), "");
    }

    #[test]
    fn distant_changes_have_their_own_hunks() {
        let old = "0\n1\n2\n3\n4\n5\n6\n7\n8\n9\n";
        let new = "0\n1\ntwo\n3\n4\n5\n6\n7\n8\nnew\n9\n";
        assert_eq!(
            unified("f", old, new),
            "--- f\n+++ f\n@@ -1,5 +1,5 @@\n 0\n 1\n-2\n+two\n 3\n 4\n\
             @@ -8,3 +8,4 @@\n 7\n 8\n+new\n 9\n"
        );
    }

    #[test]
    fn near_changes_share_a_hunk() {
        assert_eq!(
            unified("f", "a\n1\n2\n3\n4\nb\n", "A\n1\n2\n3\n4\nB\n"),
            "--- f\n+++ f\n@@ -1,6 +1,6 @@\n-a\n+A\n 1\n 2\n 3\n 4\n-b\n+B\n"
        );
    }

    #[test]
    fn whole_texts_come_and_go() {
        assert_eq!(unified("f", "", "a\n"), "--- f\n+++ f\n@@ -0,0 +1 @@\n+a\n");
        assert_eq!(
            unified("f", "a\nb", ""),
            "--- f\n+++ f\n@@ -1,2 +0,0 @@\n-a\n-b\n\\ No newline at end of file\n"
        );
    }
}
