//! Summaries of documentation say plainly what an item is or does.

use super::{repository, sources};
use std::fs;

/// Words with which no summary begins.
const BEGINNINGS: [&str; 4] = ["What", "Whether", "Of", "The same"];

/// The marks of comments of documentation.
const MARKS: [&str; 2] = ["///", "//!"];

/// The summaries of a source: the first line of each comment of documentation, with its number.
fn summaries(source: &str) -> impl Iterator<Item = (usize, &str)> {
    let behind_mark = |line| MARKS.iter().find_map(|mark| str::strip_prefix(line, mark));
    let lines = [""].into_iter().chain(source.lines()).map(str::trim_start);
    let pairs = lines.clone().zip(lines.skip(1)).zip(1..);
    pairs.filter_map(move |((before, line), number)| {
        let summary = behind_mark(line)?.strip_prefix(' ')?;
        behind_mark(before).is_none().then_some((number, summary))
    })
}

/// Returns true if a summary begins with one of [`BEGINNINGS`].
fn is_indirect(summary: &str) -> bool {
    let rest = BEGINNINGS.iter().find_map(|it| summary.strip_prefix(it));
    rest.is_some_and(|rest| !rest.starts_with(char::is_alphanumeric))
}

#[test]
fn summaries_begin_with_the_thing_or_a_verb() {
    let mut count = 0;
    let mut faults = Vec::new();
    let tops = ["core", "host", "tests"].map(|top| sources(&repository().join(top)));
    for path in tops.into_iter().flatten() {
        let source = fs::read_to_string(&path).expect("a source");
        for (number, summary) in summaries(&source) {
            count += 1;
            if is_indirect(summary) {
                faults.push(format!("{}:{number}: {summary}", path.display()));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(count > 5000, "{count}");
}

#[test]
fn summaries_that_begin_otherwise_are_found() {
    let source = "//! The same light.\n//! What follows is no summary.\n\n    /// Whether it is.\n    /// Of it.\n    b: bool,\n\
                  /// Offers more.\nfn c() {}\n/// What?\n// /// Of a comment.\nfn d() {}\n";
    let found = summaries(source).filter(|(_, summary)| is_indirect(summary));
    assert_eq!(
        found.collect::<Vec<_>>(),
        [(1, "The same light."), (4, "Whether it is."), (9, "What?")]
    );
}
