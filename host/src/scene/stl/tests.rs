use super::*;
use crate::scene::tests::samples::{self, load, mesh};

/// Two solids, the second with a name of two words and keywords in capitals.
pub(in crate::scene) const TWO_SOLIDS: &str = "\
solid tip
facet normal 0 0 1
  outer loop
    vertex 0 0 0
    vertex 1 0 0
    vertex 0 1 -0
  endloop
endfacet
endsolid tip
SOLID The Other
FACET NORMAL 0 0 1
 OUTER LOOP
  VERTEX 0 0 2
  VERTEX 1e0 0 2
  VERTEX 0 1 2
 ENDLOOP
ENDFACET
FACET NORMAL 0 0 1
 OUTER LOOP
  VERTEX 1 0 2
  VERTEX 1 1 2
  VERTEX 0 1 2
 ENDLOOP
ENDFACET
ENDSOLID The Other
";

fn read(bytes: &[u8]) -> Result<Imported, SceneError> {
    samples::read("thing.stl", bytes)
}

/// A binary file of triangles.
fn file(triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let mut bytes = b"solid is how even binary files begin".to_vec();
    bytes.resize(80, b' ');
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for corners in triangles {
        let floats = [0.0; 3].iter().chain(corners.iter().flatten());
        bytes.extend(floats.flat_map(|float: &f32| float.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

#[test]
fn every_solid_of_a_text_is_an_object() {
    let imported = read(TWO_SOLIDS.as_bytes()).unwrap();
    let [tip, other] = &imported.scene.objects[..] else {
        panic!("{:?}", imported.scene.objects)
    };
    assert_eq!((tip.name.as_str(), tip.place.line), ("tip", 1));
    assert_eq!((other.name.as_str(), other.place.line), ("The Other", 10));
    assert_eq!(mesh(tip).1, [[0, 1, 2]]);
    // Corners at the same place are one vertex.
    assert_eq!(mesh(other).0.len(), 4);
    assert_eq!(mesh(other).1, [[0, 1, 2], [1, 3, 2]]);
    assert_eq!(imported.warnings, [""; 0]);
}

#[test]
fn texts_without_line_breaks_are_read() {
    let lines = read(TWO_SOLIDS.as_bytes()).unwrap();
    let text = TWO_SOLIDS.replace('\n', " ");
    let imported = read(text.as_bytes()).unwrap();
    assert_eq!(imported.warnings, [""; 0]);
    let shapes = |it: &Imported| {
        let objects = it.scene.objects.iter();
        let named = objects.map(|it| (it.name.clone(), it.shape.clone()));
        named.collect::<Vec<_>>()
    };
    assert_eq!(shapes(&imported), shapes(&lines));
    // Words of names are no statements.
    let text = TWO_SOLIDS.replace("solid tip", "solid outer facet vertex 1");
    let imported = read(text.as_bytes()).unwrap();
    assert_eq!(imported.scene.objects[0].name, "outer facet vertex 1");
    assert_eq!(imported.warnings, [""; 0]);
    let error = read(b"solid x facet normal 0 0 1 vertex 0 0 vertex 1 0 0").unwrap_err();
    assert!(error.cause.contains("fewer than three"), "{error}");
}

/// The time for a line is in proportion to its words.
#[test]
fn long_lines_of_a_text_are_read_at_once() {
    let start = std::time::Instant::now();
    for words in [
        "endsolid ",
        "solid ",
        "facet ",
        "solid facet ",
        "endsolid x ",
        "x solid ",
    ] {
        let text = format!("solid {}", words.repeat(100_000));
        assert!(read(text.as_bytes()).is_err(), "{words}");
    }
    assert!(start.elapsed().as_secs() < 10, "{:?}", start.elapsed());
}

#[test]
fn binary_files_share_vertices_and_say_what_is_too_much() {
    let [a, b, c, d] = [
        [0.0, 0.0, 0.0],
        [1.5, -0.0, 0.0],
        [0.0, 1.5, 0.0],
        [1.5, 1.5, 0.0],
    ];
    let mut bytes = file(&[[a, b, c], [[1.5, 0.0, 0.0], d, c]]);
    let imported = read(&bytes).unwrap();
    let (vertices, triangles) = mesh(&imported.scene.objects[0]);
    assert_eq!(
        (vertices.len(), triangles),
        (4, &[[0, 1, 2], [1, 3, 2]][..])
    );
    assert_eq!(imported.scene.objects[0].name, "thing");
    bytes.extend([7; 3]);
    for head in [
        &b"thing"[..],
        b"solid",
        b"solid fake\nfacet normal 0 0 1\nouter loop\n",
    ] {
        bytes[..head.len()].copy_from_slice(head);
        let imported = read(&bytes).unwrap();
        assert_eq!(mesh(&imported.scene.objects[0]).1.len(), 2);
        assert!(imported.warnings[0].contains("3 bytes behind the last triangle"));
    }
}

#[test]
fn binary_files_of_too_many_triangles_are_rejected_before_they_are_read() {
    let path = Path::new("thing.stl");
    let mut bytes = file(&[]);
    for (count, expected) in [
        (1 << 24, "the file has no triangles"),
        (17_000_000, "the file takes about 3.8 GB of memory"),
        (u32::MAX, "the file takes about 962.1 GB of memory"),
    ] {
        bytes[80..84].copy_from_slice(&count.to_le_bytes());
        let error = binary(path, &bytes, Warnings::default()).unwrap_err();
        assert!(error.cause.starts_with(expected), "{error}");
    }
}

#[test]
fn faults_name_line_or_triangle() {
    let cut = &file(&[[[0.0; 3]; 3]; 2])[..150];
    let solid = cut.to_vec();
    let mut named = cut.to_vec();
    named[..5].copy_from_slice(b"thing");
    let nan = file(&[[[0.0; 3]; 3], [[0.0; 3], [f32::NAN; 3], [0.0; 3]]]);
    let text = |from: &str, to: &str| TWO_SOLIDS.replacen(from, to, 1).into_bytes();
    for (bytes, line, cause) in [
        (
            solid,
            None,
            "announces 2 triangles, which take 184 bytes, and has 150",
        ),
        (
            named,
            None,
            "announces 2 triangles, which take 184 bytes, and has 150",
        ),
        (
            nan,
            None,
            "triangle 1 (from 0) has a corner that is not finite",
        ),
        (file(&[]), None, "has no triangles"),
        (b"solid\nendsolid\n".to_vec(), None, "has no triangles"),
        (
            b"short".to_vec(),
            None,
            "neither a binary STL file nor one of text",
        ),
        (
            text("vertex 1 0 0", "vertex 1 0"),
            Some(5),
            "fewer than three coordinates",
        ),
        (
            text("vertex 1 0 0", "vertex 1 0 x"),
            Some(5),
            "\"x\", which is not a number",
        ),
        (
            text("vertex 1 0 0", "vertex 1 0 inf"),
            Some(5),
            "not a finite number",
        ),
        (
            text("    vertex 1 0 0\n", ""),
            Some(7),
            "has not three vertices",
        ),
        (text("  endloop\nendfacet\n", ""), Some(7), "no `endfacet`"),
        (
            text("facet normal 0 0 1\n", ""),
            Some(3),
            "none of the three of a facet",
        ),
        (
            b"solid a\nfacet\nvertex 0 0 0".to_vec(),
            None,
            "ends inside a facet",
        ),
    ] {
        let error = read(&bytes).unwrap_err();
        assert!(error.cause.contains(cause), "{cause}: {error}");
        assert_eq!(error.line, line, "{error}");
    }
}

#[test]
fn stl_files_of_other_programs_keep_their_triangles() {
    for (name, objects, triangles) in [
        ("meshes/cylinder.stl", 1, 416),
        ("meshes/two_objects_mixed_case_names.stl", 2, 24),
        ("meshes/featuretype.STL", 1, 3476),
    ] {
        let Some(path) = samples::find(name) else {
            continue;
        };
        let scene = load(&path).unwrap().scene;
        let count: usize = scene
            .objects
            .iter()
            .map(|object| mesh(object).1.len())
            .sum();
        assert_eq!((scene.objects.len(), count), (objects, triangles), "{name}");
    }
}

#[test]
fn text_with_a_byte_order_mark_is_read() {
    let marked = [b"\xef\xbb\xbf", TWO_SOLIDS.as_bytes()].concat();
    let scene = samples::read("thing.stl", marked).unwrap().scene;
    assert_eq!(scene.objects.len(), 2);
}

#[test]
fn text_that_ends_without_endsolid_is_warned_of() {
    let cut = &TWO_SOLIDS[..TWO_SOLIDS.rfind("ENDSOLID").unwrap()];
    let imported = read(cut.as_bytes()).unwrap();
    assert_eq!(imported.scene.objects.len(), 2);
    let [warning] = &imported.warnings[..] else {
        panic!("{:?}", imported.warnings)
    };
    assert!(
        warning.ends_with(
            "thing.stl:24: the text ends behind this facet without `endsolid`; it may be cut off"
        ),
        "{warning}"
    );
    assert_eq!(
        read(TWO_SOLIDS.as_bytes()).unwrap().warnings,
        [] as [&str; 0]
    );
}

#[test]
fn numbers_behind_the_coordinates_of_a_vertex_are_warned_of() {
    let text = TWO_SOLIDS.replace("vertex 1 0 0", "vertex 1 0 0 7");
    let imported = read(text.as_bytes()).unwrap();
    let [warning] = &imported.warnings[..] else {
        panic!("{:?}", imported.warnings);
    };
    let expected = ":5: what follows the three coordinates of a vertex is ignored";
    assert!(warning.ends_with(expected), "{warning}");
    assert_eq!(imported.scene.objects.len(), 2);
}

#[test]
fn text_behind_a_comment_is_named() {
    let error = read(format!("; made by x\n\n{TWO_SOLIDS}").as_bytes()).unwrap_err();
    assert_eq!(
        error.cause,
        "the text begins with other lines; `solid`, with which STL begins, is in line 3"
    );
}

#[test]
fn colors_of_binary_headers_are_warned_of() {
    let mut bytes = file(&[[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]]);
    assert_eq!(read(&bytes).unwrap().warnings, [] as [&str; 0]);
    bytes[..10].copy_from_slice(b"COLOR=\xff\0\0\xff");
    let [warning] = &read(&bytes).unwrap().warnings[..] else {
        panic!("no warning")
    };
    assert!(warning.contains("`COLOR=`"), "{warning}");
}
