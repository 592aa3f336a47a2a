//! The changelog has the form of Keep a Changelog: a merge cannot bring old sections or lines back.

use super::text;
use std::collections::BTreeSet;

/// Headings of a version, in their order.
const HEADINGS: [&str; 6] = [
    "Added",
    "Changed",
    "Deprecated",
    "Removed",
    "Fixed",
    "Security",
];

/// Deviations from the form, each with its line.
fn faults(page: &str) -> Vec<String> {
    let mut faults = Vec::new();
    let mut lines = BTreeSet::new();
    let mut next = None;
    for (index, line) in page.lines().enumerate() {
        let mut fault = |what: &str| faults.push(format!("line {}: {what}: {line}", index + 1));
        if line.starts_with("## ") {
            next = Some(0);
        } else if let Some(heading) = line.strip_prefix("### ") {
            let place = HEADINGS.iter().position(|it| *it == heading);
            match (place, next) {
                (None, _) => fault("no heading of Keep a Changelog"),
                (Some(place), Some(first)) if place >= first => next = Some(place + 1),
                _ => fault("a heading out of its order, twice or of no version"),
            }
        } else if next == Some(0) && line.starts_with("- ") {
            fault("a change below no heading");
        }
        if line.starts_with("- ") && !lines.insert(line) {
            fault("a line twice");
        }
    }
    faults
}

#[test]
fn changelog_has_the_form_of_keep_a_changelog() {
    let page = text("CHANGELOG.md");
    assert!(page.matches("\n- ").count() > 80);
    assert_eq!(faults(&page), Vec::<String>::new());
}

#[test]
fn changelog_faults_are_found() {
    let good =
        "## Unreleased\n\n### Added\n- A.\n\n### Fixed\n- B.\n\n## 1.0.0\n\n### Added\n- C.\n";
    assert_eq!(faults(good), Vec::<String>::new());
    for (bad, found) in [
        ("## U\n### Core\n- A.\n", "line 2: no heading"),
        ("## U\n### Fixed\n### Added\n", "line 3: a heading out of"),
        ("## U\n### Added\n### Added\n", "line 3: a heading out of"),
        ("### Added\n- A.\n", "line 1: a heading out of"),
        ("## U\n- A.\n", "line 2: a change below"),
        (
            "## U\n### Added\n- A.\n### Fixed\n- A.\n",
            "line 5: a line twice",
        ),
    ] {
        let faults = faults(bad);
        assert!(faults[0].starts_with(found), "{faults:?}");
    }
}
