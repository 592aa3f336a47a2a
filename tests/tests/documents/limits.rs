//! Documents stay short enough to be read, and their links lead somewhere.

use super::{BENCHMARKS, MEMORY, PAPER, README, STRUCTURES, repository, text};
use std::path::Path;

const DOCUMENTS: [&str; 16] = [
    README,
    "core/README.md",
    "core/cpu/README.md",
    "host/README.md",
    "CONTRIBUTING.md",
    "CHANGELOG.md",
    "host/docs/SCENE.md",
    "host/docs/CHECK.md",
    "host/docs/EXACT.md",
    "host/docs/PYTHON.md",
    "host/docs/WEB.md",
    "host/python/README.md",
    STRUCTURES,
    MEMORY,
    BENCHMARKS,
    PAPER,
];

/// Tables of a document, each as the numbers of its columns and of its rows.
fn tables(page: &str) -> Vec<[usize; 2]> {
    let mut tables: Vec<[usize; 2]> = Vec::new();
    let mut inside = false;
    for line in page.lines() {
        let is_row = line.starts_with('|');
        match tables.last_mut() {
            Some([_, rows]) if is_row && inside => *rows += 1,
            _ if is_row => tables.push([line.matches('|').count() - 1, 0]),
            _ => {}
        }
        inside = is_row;
    }
    // The line below the headings is no row.
    tables
        .iter()
        .map(|&[columns, rows]| [columns, rows - 1])
        .collect()
}

#[test]
fn readme_has_at_most_8_kib() {
    assert!(text(README).len() <= 8192, "{}", text(README).len());
}

#[test]
fn readme_has_tables_of_at_most_six_rows() {
    let tables = tables(&text(README));
    assert!(tables.len() >= 3);
    assert!(tables.iter().all(|&[_, rows]| rows <= 6), "{tables:?}");
}

#[test]
fn documents_have_tables_of_at_most_eight_columns() {
    for document in DOCUMENTS {
        for [columns, _] in tables(&text(document)) {
            assert!(columns <= 8, "{document}: a table of {columns} columns");
        }
    }
}

#[test]
fn documents_link_to_files_that_exist() {
    for document in DOCUMENTS {
        let page = text(document);
        let folder = repository().join(document);
        let folder = folder.parent().unwrap_or(Path::new("."));
        let targets = page.split("](").skip(1);
        for target in targets.filter_map(|rest| rest.split(')').next()) {
            let path = target.split('#').next().unwrap_or_default();
            if path.is_empty() || path.contains("://") {
                continue;
            }
            assert!(folder.join(path).exists(), "{document}: {target}");
        }
    }
}

/// A package holds its own folder alone: its page cannot link to files of the repository.
#[test]
fn pages_of_packages_have_no_relative_links() {
    for package in ["core", "core/cpu", "host"] {
        let manifest = text(&format!("{package}/Cargo.toml"));
        assert!(manifest.contains("\nreadme = \"README.md\"\n"), "{package}");
        let page = text(&format!("{package}/README.md"));
        let targets: Vec<_> = page.split("](").skip(1).collect();
        assert!(!targets.is_empty(), "{package}");
        assert!(
            targets.iter().all(|it| it.starts_with("https://")),
            "{package}"
        );
    }
}
