//! CONTRIBUTING.md names files, features and commits that exist.

use super::{repository, text};

/// Words in capitals that the reader replaces by a name.
const PLACEHOLDERS: [&str; 6] = ["SHAPE", "EFFECT", "FAMILY", "NAME", "FORMAT", "SCENE"];

/// Text in backticks that has the form of a path. A path with a placeholder is cut at that part.
fn paths(page: &str) -> Vec<String> {
    let mut fenced = false;
    let prose = page.lines().filter(|line| {
        let is_fence = line.starts_with("```");
        fenced ^= is_fence;
        !fenced && !is_fence
    });
    let quoted = prose.flat_map(|line| line.split('`').skip(1).step_by(2));
    let is_path = |text: &&str| {
        let endings = [".rs", ".md", ".toml", ".json", ".svg", ".png"];
        let is_file = endings.iter().any(|ending| text.ends_with(ending));
        !text.contains([' ', '=', '<']) && (is_file || text.contains('/'))
    };
    let cut = |path: &str| {
        let known = path.split('/').take_while(|part| {
            let stem = part.split('.').next().unwrap_or(part);
            !PLACEHOLDERS.contains(&stem) || *part == "FORMAT.md" || *part == "SCENE.md"
        });
        known.collect::<Vec<_>>().join("/")
    };
    quoted.filter(is_path).map(cut).collect()
}

#[test]
fn contributing_page_names_paths_that_exist() {
    let paths = paths(&text("CONTRIBUTING.md"));
    assert!(paths.len() > 40, "{paths:?}");
    // The real scenes lie next to the repository.
    let own = paths.iter().filter(|path| *path != "shared/scenes");
    let missing: Vec<_> = own
        .filter(|path| !repository().join(path).exists())
        .collect();
    assert!(missing.is_empty(), "{missing:?}");
}

#[test]
fn paths_are_found_in_prose_alone() {
    let page = "`a/b.rs`: `x == y/z`, `C.md`\n```text\n`no/path`\n```\n| `a/FAMILY/NAME.rs` | `b/SCENE.md` |\n";
    assert_eq!(paths(page), ["a/b.rs", "C.md", "a", "b/SCENE.md"]);
}
