use super::*;
use crate::scene::tests::samples::{self, load, mesh};

const SQUARE: &str = "4 1 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";

fn read(text: &str) -> Result<Imported, SceneError> {
    samples::read("thing.off", text)
}

#[track_caller]
fn holds_the_square(text: &str, warnings: &[&str]) {
    let imported = read(text).unwrap_or_else(|error| panic!("{text:?}: {error}"));
    let (vertices, triangles) = mesh(&imported.scene.objects[0]);
    assert_eq!(vertices[2], DVec3::new(1.0, 1.0, 0.0), "{text:?}");
    assert_eq!(
        (vertices.len(), triangles),
        (4, &[[0, 1, 2], [0, 2, 3]][..]),
        "{text:?}"
    );
    assert_eq!(imported.warnings, warnings, "{text:?}");
    assert_eq!(imported.scene.objects[0].name, "thing");
}

#[track_caller]
fn fault(text: &str) -> (String, Option<usize>) {
    let error = read(text).unwrap_err();
    assert!(!error.remedy.is_empty());
    (error.cause, error.line)
}

#[test]
fn keyword_counts_and_comments_are_read_in_every_layout() {
    for text in [
        format!("OFF\n{SQUARE}"),
        format!("OFF {SQUARE}"),
        format!("OFF{SQUARE}"),
        SQUARE.to_owned(),
        format!("# made by hand\n\nOFF # the keyword\n\n{SQUARE}# end\n"),
        format!("OFF\r\n{}", SQUARE.replace('\n', "\r\n")),
        // Counts on lines of their own, and without the edges.
        SQUARE.replace("4 1 4\n", "OFF\n4\n1\n4\n"),
        SQUARE.replace("4 1 4\n", "OFF\n4 1\n4\n"),
        SQUARE.replace("4 1 4\n", "OFF\n4 1\n"),
        SQUARE.replace("4 1 4\n", "OFF\n4 1 # no edges\n# none\n"),
        // Vertices and corners wherever lines end.
        String::from("OFF 4 1 0 0 0 0 1 0\n0 1 1 0 0 1 0 4\n0 1\n2 3\n"),
        SQUARE.trim_end().to_owned(),
    ] {
        holds_the_square(&text, &[]);
    }
}

#[test]
#[rustfmt::skip]
fn attributes_of_vertices_are_ignored_with_a_warning_each() {
    let with = |keyword: &str, attributes: &str| {
        let vertices = ["0 0 0", "1 0 0", "1 1 0", "0 1 0"];
        let lines = vertices.map(|vertex| format!("{vertex} {attributes}\n"));
        format!("{keyword}\n4 1 4\n{}4 0 1 2 3\n", lines.concat())
    };
    let color = "thing.off:3: the color of a vertex is ignored; the surface has one color (and 3 times more)";
    let normal = "thing.off:3: the normal of a vertex is ignored; for smooth normals use `--normals smooth=40` (and 3 times more)";
    let texture = "thing.off:3: the texture coordinates of a vertex are ignored, as no image can be named; export glTF or OBJ to show one (and 3 times more)";
    holds_the_square(&with("COFF", "1 0 0 1"), &[color]);
    holds_the_square(&with("COFF", "255 0 0"), &[color]);
    holds_the_square(&with("NOFF", "0 0 1"), &[normal]);
    holds_the_square(&with("CNOFF", "0 0 1 255 0 0 255"), &[color, normal]);
    holds_the_square(&with("STCNOFF", "0 0 1 1 0 0 1 0 0"), &[color, normal, texture]);
    // As MeshLab writes them: the prefixes in other order, and the color before the normal.
    holds_the_square(&with("NCOFF", "255 0 0 255 0 0 1"), &[color, normal]);
    holds_the_square(&with("CSTOFF", "255 0 0 255 0.5 1"), &[color, texture]);
    holds_the_square(&with("NSTOFF", "0 0 1 0.5 1"), &[normal, texture]);
    holds_the_square(&with("NCSTOFF", "255 0 0 255 0 0 1 0.5 1"), &[color, normal, texture]);
    holds_the_square(&with("ncstoff", "255 0 0 255 0 0 1 0.5 1"), &[color, normal, texture]);
    holds_the_square(&with("noff", "0 0 1"), &[normal]);
    holds_the_square(&with("off", ""), &[]);
    assert_eq!(
        fault(&with("NOFF", "")),
        (
            String::from("vertex 0 (from 0) has 3 numbers, and 6 are announced"),
            Some(3)
        )
    );
}

#[test]
fn numbers_of_vertices_that_are_not_announced_are_ignored_with_a_warning() {
    let warning = "thing.off:3: the numbers behind the coordinates of a vertex are ignored; the keyword does not \
                   announce them (and 3 times more)";
    for (keyword, numbers) in [
        ("OFF\n", "255 0 0"),
        ("OFF\n", "255 0 0 255 # red"),
        ("OFF\n", "1.0 .5 0 1"),
        ("# no keyword\n", "0 0 1"),
    ] {
        let vertices = ["0 0 0", "1 0 0", "1 1 0", "0 1 0"];
        let lines = vertices.map(|vertex| format!("{vertex} {numbers}\n"));
        let text = format!("{keyword}4 1 4\n{}4 0 1 2 3\n", lines.concat());
        holds_the_square(&text, &[warning]);
    }
    // Two vertices on a line are two.
    let pairs = "OFF\n4 2 0\n0 0 0 1 0 0\n1 1 0 0 1 0\n3 0 1 2\n3 0 2 3\n";
    holds_the_square(pairs, &[]);
}

#[test]
fn colors_of_faces_are_ignored_with_a_warning() {
    let warning = "thing.off:7: the color of a face is ignored; the surface has one color";
    for color in [
        "7",
        "255 0 0",
        "255 0 0 128",
        "1.0 0.5 0",
        "1 .5 0 .25 # red",
    ] {
        holds_the_square(&format!("OFF\n{} {color}\n", SQUARE.trim_end()), &[warning]);
    }
}

#[test]
fn concave_faces_are_covered_and_faces_that_cross_themselves_are_warned_of() {
    let arrow = read(IMPORTER.example).unwrap();
    let (vertices, triangles) = mesh(&arrow.scene.objects[0]);
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|corner| vertices[corner as usize]);
        (b - a).cross(c - a).z / 2.0
    };
    assert_eq!(triangles.iter().map(area).sum::<f64>(), 1.5);
    assert!(triangles.iter().all(|it| area(it) > 0.0));
    let bow = read("OFF\n4 2 0\n0 0 0\n1 1 0\n1 0 0\n0 2 0\n4 0 1 2 3\n2 0 1\n").unwrap();
    assert_eq!(
        bow.warnings,
        [
            "thing.off:7: a face crosses itself; its triangles cover more than it encloses",
            "thing.off:8: a face has fewer than three vertices and is left out",
        ]
    );
}

#[test]
#[rustfmt::skip]
fn faults_name_line_cause_and_remedy() {
    let square = |from: &str, to: &str| format!("OFF\n{}", SQUARE.replacen(from, to, 1));
    for (text, cause, line) in [
        (String::new(), "the file ends where the keyword `OFF` is expected", None),
        (String::from("OFF"), "the file ends where the number of vertices is expected", None),
        (String::from("OFF BINARY\n\0\0\0\x04"), "the file is binary OFF, which is not read", Some(1)),
        (String::from("4OFF\n1 1 1\n"), "the vertices of 4OFF have not three coordinates", Some(1)),
        (String::from("nOFF 3\n1 1 1\n"), "the vertices of nOFF have not three coordinates", Some(1)),
        (String::from("CNCOFF\n1 1 1\n"), "the keyword \"CNCOFF\" is unknown", Some(1)),
        (String::from("XOFF\n1 1 1\n"), "the keyword \"XOFF\" is unknown", Some(1)),
        (String::from("4off\n1 1 1\n"), "the vertices of 4off have not three coordinates", Some(1)),
        (String::from("NCnOFF 3\n1 1 1\n"), "the vertices of NCnOFF have not three coordinates", Some(1)),
        (String::from("PLY\n"), "the number of vertices is \"PLY\", which is not a whole number", Some(1)),
        (square("4 1 4", "4 -1 4"), "the number of faces is \"-1\", which is not a whole number", Some(2)),
        (square("4 1 4", "4 0 0"), "the file has no faces", None),
        (square("1 1 0", "1 nan 0"), "the y coordinate of vertex 2 (from 0) is \"nan\", which is not a finite number", Some(5)),
        (square("1 1 0", "1 a 0"), "the y coordinate of vertex 2 (from 0) is \"a\", which is not a number", Some(5)),
        (square("4 0 1 2 3", "4 0 1 2 4"), "face 0 (from 0) uses vertex 4, and there are 4 vertices", Some(7)),
        (square("4 0 1 2 3", "4 0 1 2 -1"), "a vertex of face 0 (from 0) is \"-1\", which is not a whole number", Some(7)),
        (square("4 0 1 2 3", "4 0 1 2"), "the file ends where a vertex of face 0 (from 0) is expected", None),
        (square("4 1 4", "4 2 4"), "the file ends where the number of vertices of face 1 (from 0) is expected", None),
        (square("4 0 1 2 3", "2 0 1"), "no face of the file has three vertices", None),
        (square("4 1 4", "4294967295 99999999999 0"), "the file ends where the z coordinate of vertex 5 (from 0) is expected", None),
    ] {
        let (found, at) = fault(&text);
        assert!(found.contains(cause), "{text:?}: {found}");
        assert_eq!(at, line, "{text:?}: {found}");
    }
    let extra = read(&format!("OFF\n{SQUARE}3 0 1 2\n3 0 1 2\n")).unwrap();
    assert_eq!(
        extra.warnings,
        ["thing.off:8: lines behind the last face are ignored"]
    );
}

#[test]
fn real_meshes_have_the_vertices_and_triangles_that_trimesh_finds() {
    for (name, vertices, triangles, area) in [
        ("ballA", 1900, 3796, 605.909413),
        ("decimated-knight", 502, 1000, 0.90702354),
        ("planexy", 25, 32, 4.0),
    ] {
        let Some(path) = samples::find(&format!("meshes/{name}.off")) else {
            continue;
        };
        let imported = load(&path).unwrap();
        assert_eq!(imported.warnings, [] as [&str; 0]);
        let (points, corners) = mesh(&imported.scene.objects[0]);
        assert_eq!(
            (points.len(), corners.len()),
            (vertices, triangles),
            "{name}"
        );
        let doubled = corners.iter().map(|t| {
            let [a, b, c] = t.map(|corner| points[corner as usize]);
            (b - a).cross(c - a).length()
        });
        let found = doubled.sum::<f64>() / 2.0;
        assert!((found - area).abs() < 1e-8 * area, "{name}: {found}");
    }
}
