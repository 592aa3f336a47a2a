//! CONTRIBUTING.md names files, features and commits that exist, and where effects attach.

use super::{repository, text};
use gridel_core::Effects;

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

/// Effects stand in the order of their registry, in which they act.
#[test]
fn contributing_page_lists_the_effects_at_every_place() {
    let sources = Effects::NAMED.map(|(_, name)| {
        let path = format!("core/src/shade/{}.rs", name.replace('-', "_"));
        (name.replace('-', " "), text(&path))
    });
    let page = text("CONTRIBUTING.md");
    let (_, table) = page
        .split_once("\n| place | what happens | effects |\n")
        .expect("the table");
    let rows = table.lines().skip(1);
    let mut places = 0;
    for row in rows.take_while(|line| line.starts_with('|')) {
        let cells: Vec<_> = row.split('|').map(str::trim).collect();
        let [_, place, _, listed, _] = cells[..] else {
            panic!("{row}")
        };
        let place = place.trim_matches('`');
        let method = format!("    fn {place}<'s, N: Number, X: Tracer<'s, N>>(");
        let acting = sources.iter().filter(|(_, code)| code.contains(&method));
        let acting: Vec<_> = acting.map(|(name, _)| name.as_str()).collect();
        assert_eq!(listed, acting.join(", "), "{place}");
        places += 1;
    }
    let interface = text("core/src/shade/effect.rs");
    let (_, declared) = interface.split_once("\nplaces! {\n").expect("places");
    assert_eq!(places, declared.matches("    fn ").count());
}

#[test]
fn paths_are_found_in_prose_alone() {
    let page = "`a/b.rs`: `x == y/z`, `C.md`\n```text\n`no/path`\n```\n| `a/FAMILY/NAME.rs` | `b/SCENE.md` |\n";
    assert_eq!(paths(page), ["a/b.rs", "C.md", "a", "b/SCENE.md"]);
}
