//! CONTRIBUTING.md lists every environment variable that the project reads.

use super::{repository, sources, text};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Names that begin with `GRIDEL_`.
fn names(source: &str, into: &mut BTreeSet<String>) {
    for rest in source.split("GRIDEL_").skip(1) {
        let end = rest.find(|c: char| !c.is_ascii_uppercase() && c != '_');
        let name = &rest[..end.unwrap_or(rest.len())];
        if !name.is_empty() {
            into.insert(format!("GRIDEL_{name}"));
        }
    }
}

/// Names of the C library's constants begin as those of variables do. Neither the library nor the test of its header
/// reads variables of the project.
fn is_of_the_c_library(path: &Path) -> bool {
    let library = repository().join("core/c");
    path.starts_with(library) || path.ends_with("tests/tests/c_header.rs")
}

#[test]
fn contributing_page_lists_exactly_the_environment_variables() {
    let mut used = BTreeSet::new();
    for folder in ["core", "host", "tests"] {
        let sources = sources(&repository().join(folder)).into_iter();
        for path in sources.filter(|path| !is_of_the_c_library(path)) {
            names(&fs::read_to_string(&path).expect("a source"), &mut used);
        }
    }
    names(&text(".ci/run"), &mut used);
    let page = text("CONTRIBUTING.md");
    let rows = page
        .lines()
        .filter_map(|line| line.strip_prefix("| `GRIDEL_"));
    let listed = rows.filter_map(|row| row.split_once('`'));
    let listed: BTreeSet<_> = listed.map(|(name, _)| format!("GRIDEL_{name}")).collect();
    assert_eq!(listed, used);
}
