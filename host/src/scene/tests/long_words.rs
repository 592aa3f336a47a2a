//! Tests that messages stay short where words, lines and names of a file are long.

use crate::scene::{ImportOptions, read};
use miette::{GraphicalReportHandler, GraphicalTheme};

/// Name and content of files with a word `@`, which an error or a warning quotes.
const FILES: [(&str, &str); 34] = [
    ("a.obj", "v 0 0 @\n"),
    ("a.obj", "v 0 0 0\nf 1 2 @\n"),
    ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n@ 1\nf 1 2 3\n"),
    ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl @\nf 1 2 3\n"),
    (
        "a.obj",
        "mtllib @\nv 0 0 0\nv 1 0 0\nv 0 1 0\ng @\nf 1 2 3\n",
    ),
    ("a.off", "OFF\n3 @ 0\n"),
    ("a.off", "@\n3 1 0\n"),
    ("a.off", "OFF\n3 1 0\n0 0 0\n1 0 @\n"),
    ("a.xyz", "@\n\nC 0 0 0\n"),
    ("a.xyz", "1\n\nC 0 0 @\n"),
    ("a.xyz", "1\n\n@ 0 0 0\n"),
    ("a.nff", "@ 1 2\n"),
    ("a.nff", "p @\n"),
    ("a.nff", "s 0 0 0 @\n"),
    ("a.stl", "solid a\nfacet normal 0 0 1\nvertex 0 @ 0\n"),
    ("a.stl", "solid a\n@ b\nfacet\nfacet\n"),
    ("a.ply", "ply\n@\n"),
    (
        "a.ply",
        "ply\nformat ascii 1.0\nelement @ 9999\nend_header\n",
    ),
    (
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float @\nend_header\n1 @\n",
    ),
    ("a.cif", "data_@\n_@ '\n"),
    (
        "a.cif",
        "data_a\nloop_\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n_atom_site.type_symbol\n@ 0 0 C\n",
    ),
    ("a.toml", "@ = 1\n"),
    ("a.toml", "[camera]\n@ = 1\n"),
    ("a.toml", "background = \"@\"\n"),
    ("a.toml", "background = '@\n"),
    ("a.toml", "material.\"@\" = 1\n"),
    (
        "a.toml",
        "[material.\"@\"]\n[[object]]\nmaterial = \"b@\"\nsphere = { center = [0, 0, 0], radius = 1 }\n",
    ),
    ("a.toml", "[[object]]\nimport = \"@.obj\"\n"),
    ("a.toml", "[[object]]\nimport = \"a.@\"\n"),
    ("a.toml", "[[object]]\ngroup = \"@\"\n"),
    ("a.toml", "[[track]]\ntarget = \"@\"\n"),
    (
        "a.toml",
        "background = [0, 0,                                        @]\n",
    ),
    ("a.gltf", "{\"asset\": {\"version\": \"@\"}}"),
    (
        "a.gltf",
        "{\"asset\": {\"version\": \"2.0\"}, \"extensionsRequired\": [\"@\"]}",
    ),
];

/// The length of what is said of a file.
fn said(name: &str, text: &str) -> (usize, String) {
    match read(name.as_ref(), text.into(), &ImportOptions::default()) {
        Ok(imported) => {
            assert!(!imported.warnings.is_empty(), "{name}: nothing is said");
            let all = imported.warnings.concat();
            (all.len(), all)
        }
        Err(error) => {
            let mut report = String::new();
            let handler = GraphicalReportHandler::new_themed(GraphicalTheme::unicode_nocolor());
            handler.render_report(&mut report, &error).unwrap();
            let all = format!("{error}; {}\n{report}", error.remedy);
            (all.len(), all)
        }
    }
}

#[test]
fn messages_stay_short_where_words_are_long() {
    let mut wrong = Vec::new();
    for (name, text) in FILES {
        let file = |letters: usize| text.replace('@', &"w".repeat(letters));
        let [(few, short), (many, long)] = [3, 300_000].map(|it| said(name, &file(it)));
        // The names of materials and files are given twice.
        if many > few + 1200 {
            let long = long.get(..2000).unwrap_or(&long);
            wrong.push(format!("{text}: {few} and {many} bytes\n{short}\n{long}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
