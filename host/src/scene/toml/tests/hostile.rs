//! Files that are broken at random, or made to cost without end.

use super::{example, load, load_in, rejection};
use miette::{GraphicalReportHandler, GraphicalTheme};
use std::fmt::Write;

/// Loads a text and, where it is rejected, renders the error as the program would.
fn survive(folder: &std::path::Path, text: &str) {
    if let Err(error) = load_in(folder, text) {
        assert!(!error.cause.is_empty() && !error.remedy.is_empty());
        let handler = GraphicalReportHandler::new_themed(GraphicalTheme::unicode_nocolor());
        handler.render_report(&mut String::new(), &error).unwrap();
    }
}

#[test]
fn the_example_cut_off_at_every_byte_loads_or_fails_with_a_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let text = example();
    for end in (0..text.len()).filter(|&end| text.is_char_boundary(end)) {
        survive(folder.path(), &text[..end]);
    }
}

#[test]
fn the_example_with_characters_exchanged_loads_or_fails_with_a_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let text = example();
    let replacements = [
        "", "-", "0", "9e999", "[", "]]", "{", "}", "\"", "=", "\n", ".", ",", "#", "é", "\0",
        "nan", "-inf",
    ];
    let mut choice = 0;
    for (offset, character) in text.char_indices() {
        for step in [0, 7, 12] {
            choice += 1;
            let with = replacements[(choice + step) % replacements.len()];
            let rest = &text[offset + character.len_utf8()..];
            survive(folder.path(), &format!("{}{with}{rest}", &text[..offset]));
        }
    }
}

#[test]
fn bytes_that_are_no_text_are_rejected() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, b"background = 0\n# \xff\xfe\n").unwrap();
    let error = crate::scene::load(&path, &Default::default()).unwrap_err();
    assert_eq!(
        (error.cause.as_str(), error.line),
        ("the text is not UTF-8", Some(2))
    );
    let missing = crate::scene::load(&folder.path().join("none.toml"), &Default::default());
    assert!(missing.unwrap_err().cause.starts_with("cannot be read: "));
}

const DOT: &str = "object = [{ kind = \"sphere\", center = [0, 0, 0], radius = 1 }]\n";

/// Groups that each hold the one before `times` times, and an instance of the last.
fn tower(floors: usize, times: usize, ground: &str) -> String {
    let mut text = format!("[group.g0]\n{ground}");
    for floor in 1..=floors {
        let below = floor - 1;
        let instance = format!("{{ kind = \"instance\", group = \"g{below}\" }},");
        writeln!(
            text,
            "[group.g{floor}]\nobject = [{}]",
            instance.repeat(times)
        )
        .unwrap();
    }
    write!(
        text,
        "[[object]]\nkind = \"instance\"\ngroup = \"g{floors}\"\n"
    )
    .unwrap();
    text
}

#[test]
fn groups_that_multiply_beyond_all_memory_are_rejected_before() {
    let error = rejection(&tower(40, 10, DOT));
    assert!(error.cause.contains("GB of memory, for"), "{error}");
    assert!(error.cause.contains("the limit is 3.8 GB"), "{error}");
    assert!(error.line.is_some());
    assert_eq!(
        load(&tower(4, 10, DOT)).unwrap().scene.objects.len(),
        10_000
    );
}

#[test]
fn vertices_without_faces_do_not_multiply_for_free() {
    let vertices = "[0, 0, 0], ".repeat(3000);
    let ground = format!(
        "object = [{{ kind = \"mesh\", vertices = [{vertices} [1, 0, 0], [0, 1, 0]], faces = [[0, 3000, 3001]] }}]\n"
    );
    let error = rejection(&tower(5, 10, &ground));
    assert!(
        error.cause.contains("more than 16777216 primitives"),
        "{error}"
    );
}

/// The spheres fit into a blob, but not into 4 GB.
#[test]
fn two_to_the_23_instances_are_rejected_with_the_figure() {
    let error = rejection(&tower(23, 2, DOT));
    assert!(
        error
            .cause
            .starts_with("with this object the scene takes about "),
        "{error}"
    );
    assert!(
        error.cause.contains(" objects with 0 triangles and "),
        "{error}"
    );
    assert!(error.remedy.contains("use fewer instances"));
    // Long names multiply as well.
    let named = DOT.replace("kind", &format!("name = \"{}\", kind", "n".repeat(100_000)));
    let error = rejection(&tower(5, 10, &named));
    assert!(error.cause.contains("of memory, for"), "{error}");
}

#[test]
fn towers_of_groups_end_at_a_depth() {
    assert_eq!(load(&tower(63, 1, DOT)).unwrap().scene.objects.len(), 1);
    let error = rejection(&tower(64, 1, DOT));
    assert!(error.cause.contains("nested deeper than 64"), "{error}");
    assert!(
        rejection(&tower(20_000, 1, DOT))
            .cause
            .contains("nested deeper than 64")
    );
}

#[test]
fn brackets_without_end_are_rejected() {
    for open in ["[", "{a=", "[{a="] {
        let error = rejection(&format!("object = {}", open.repeat(100_000)));
        assert!(error.cause.starts_with("this is not TOML"), "{error}");
    }
    let dotted = rejection(&format!("{}a = 1", "a.".repeat(100_000)));
    assert!(dotted.cause.starts_with("this is not TOML"), "{dotted}");
    let nested = "{ kind = \"group\", object = [".repeat(30) + &"] }".repeat(30);
    assert!(
        rejection(&format!("object = [{nested}]"))
            .cause
            .contains("holds no object")
    );
}

/// Groups nested by headings and then inline around one object.
fn burrow(headings: usize, inline: usize, object: &str) -> String {
    let mut text = String::new();
    for depth in 0..headings {
        writeln!(
            text,
            "[[{}object]]\nkind = \"group\"",
            "object.".repeat(depth)
        )
        .unwrap();
    }
    let (open, close) = ("{ kind = \"group\", object = [", "] }");
    writeln!(
        text,
        "object = [{}{object}{}]",
        open.repeat(inline),
        close.repeat(inline)
    )
    .unwrap();
    text
}

/// The groups are as deep as TOML allows; reading must not run out of stack before it is rejected.
#[test]
fn deep_groups_are_rejected() {
    let dot = "{ kind = \"sphere\", center = [0, 0, 0], radius = 1 }";
    let error = rejection(&burrow(75, 35, dot));
    assert!(
        error.cause.contains("groups are nested deeper than 64"),
        "{error}"
    );
    assert_eq!(load(&burrow(40, 24, dot)).unwrap().scene.objects.len(), 1);
}

#[test]
fn deep_groups_in_deep_imports_are_rejected() {
    for (depth, cause) in [
        (5, "groups are nested deeper than 64"),
        (3, "nested deeper than 16 files"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let text = |file| {
            burrow(
                1,
                depth - 1,
                &format!("{{ kind = \"import\", file = \"{file}.toml\" }}"),
            )
        };
        for file in 0..20 {
            std::fs::write(folder.path().join(format!("{file}.toml")), text(file + 1)).unwrap();
        }
        let error = load_in(folder.path(), &text(0)).unwrap_err();
        assert!(error.cause.contains(cause), "{error}");
    }
}
