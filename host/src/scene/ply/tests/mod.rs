mod limits;

use super::*;
use crate::scene::tests::samples::{self, load, mesh};

/// A square and a line, with colors and an unknown element.
pub(in crate::scene) const SQUARE: &str = "\
ply
format ascii 1.0
comment a square
element vertex 4
property float x
property double y
property short z
property uchar red
element face 2
property list uchar uint vertex_indices
element wheel 1
property int spokes
end_header
0 0 0 255
1 0 0 0
1 1.5 0 0
0 1.5 0 9
4 0 1 2 3
2 0 1
12
";

fn read(bytes: &[u8]) -> Result<Imported, SceneError> {
    samples::read("thing.ply", bytes)
}

#[test]
fn faces_become_triangles() {
    let imported = read(SQUARE.as_bytes()).unwrap();
    let (vertices, triangles) = mesh(&imported.scene.objects[0]);
    assert_eq!(vertices[2], DVec3::new(1.0, 1.5, 0.0));
    assert_eq!(triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(imported.scene.objects[0].name, "thing");
    assert_eq!(imported.warnings.len(), 3, "{:?}", imported.warnings);
    assert!(imported.warnings[0].contains("elements \"wheel\" are ignored"));
    assert!(imported.warnings[1].contains("colors of vertices without red, green or blue"));
    assert!(imported.warnings[2].contains("a face has fewer than three vertices"));
}

#[test]
fn both_orders_of_bytes_are_understood() {
    for (format, big) in [("binary_little_endian", false), ("binary_big_endian", true)] {
        let mut bytes = format!(
            "ply\nformat {format} 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
             property float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n"
        )
        .into_bytes();
        for float in [0.0_f32, 0.0, 1.0, 2.0, 0.0, 1.0, 0.0, 3.0, 1.0] {
            bytes.extend(if big {
                float.to_be_bytes()
            } else {
                float.to_le_bytes()
            });
        }
        bytes.push(3);
        for index in [0_i32, 1, 2] {
            bytes.extend(if big {
                index.to_be_bytes()
            } else {
                index.to_le_bytes()
            });
        }
        let imported = read(&bytes).unwrap();
        let (vertices, triangles) = mesh(&imported.scene.objects[0]);
        assert_eq!(vertices[1], DVec3::new(2.0, 0.0, 1.0));
        assert_eq!(triangles, [[0, 1, 2]]);
        let cut = read(&bytes[..bytes.len() - 2]).unwrap_err();
        assert!(!cut.cause.is_empty() && !cut.remedy.is_empty());
    }
}

#[test]
fn faults_name_line_vertex_or_face() {
    let text = |from: &str, to: &str| SQUARE.replacen(from, to, 1);
    for (text, line, cause) in [
        (
            text("4 0 1 2 3", "4 0 1 2 9"),
            None,
            "face 0 (from 0) uses vertex 9, and there are 4",
        ),
        (
            text("4 0 1 2 3", "4 0 1 2 -1"),
            Some(18),
            "entry 3 (from 0) of \"vertex_indices\" of face 0 (from 0) is `-1`; the header announces a whole number from 0 to 4294967295",
        ),
        (
            text("1 0 0 0", "1 nan 0 0"),
            Some(15),
            "\"y\" of vertex 1 (from 0) is `nan`, which is not a finite",
        ),
        (
            text("1 0 0 0", "1 word 0 0"),
            Some(15),
            "\"y\" of vertex 1 (from 0) is `word`, which is not a number",
        ),
        (
            text("property short z\n", "property short w\n"),
            None,
            "vertex 0 (from 0) has no x, y",
        ),
        (
            text("element vertex 4", "element vertex 4000000"),
            None,
            "announces 4000000 elements",
        ),
        (
            text("4 0 1 2 3", "2 1 0"),
            None,
            "no face and no triangle strip of the file has three vertices",
        ),
        (
            text("ply\n", "plx\n"),
            Some(1),
            "the file begins with `plx`; `ply` is required",
        ),
    ] {
        let error = read(text.as_bytes()).unwrap_err();
        assert!(error.cause.contains(cause), "{cause}: {error}");
        assert_eq!(error.line, line, "{error}");
    }
}

#[test]
fn numbers_are_read_as_c_reads_them() {
    for (number, value) in [
        (".5", 0.5),
        ("1.", 1.0),
        ("+.5e3", 500.0),
        ("-.25", -0.25),
        ("2.E-1", 0.2),
        ("+7", 7.0),
        ("1e+2", 100.0),
        ("007.50", 7.5),
    ] {
        let text = SQUARE.replacen("1 1.5 0 0", &format!("1\t{number} +0 1\r"), 1);
        let imported = read(text.as_bytes()).unwrap();
        let (vertices, _) = mesh(&imported.scene.objects[0]);
        assert_eq!(vertices[2].y, value, "{number}");
        // The x coordinate is announced as a `float`.
        let text = SQUARE.replacen("1 1.5 0 0", &format!("{number} 2 0 1"), 1);
        let imported = read(text.as_bytes()).unwrap();
        let (vertices, _) = mesh(&imported.scene.objects[0]);
        assert_eq!(vertices[2].x, f64::from(value as f32), "{number}");
    }
    for word in [
        ".", "+", "e5", "1.5.2", "1,5", "--1", "1e", "0x", "\u{fffd}",
    ] {
        let text = SQUARE.replacen("1 1.5 0 0", &format!("1 {word} 0 0"), 1);
        let error = read(text.as_bytes()).unwrap_err();
        assert!(error.cause.contains("which is not a number"), "{error}");
        assert_eq!(error.line, Some(16), "{error}");
    }
}

/// Programs write such normals for points that have none.
#[test]
fn normals_that_are_not_numbers_are_none() {
    let properties = "property float nx\nproperty float ny\nproperty float nz\n";
    for nan in ["nan", "-nan", "NaN", "inf"] {
        let vertices = ["0 0 0", "1 0 0", "0 1 0"].map(|at| format!("{at} {nan} {nan} {nan}\n"));
        let text = with_properties(properties, "") + &vertices.concat() + "3 0 1 2\n";
        let scene = read(text.as_bytes()).unwrap().scene;
        assert!(scene.objects[0].normals.is_flat(), "{nan}");
    }
}

#[track_caller]
fn rejects(text: &str, expected: &str) {
    let error = read(text.as_bytes()).unwrap_err();
    assert_eq!(error.to_string(), expected);
    assert!(!error.remedy.is_empty());
    // Words of the crate that reads headers.
    for word in ["Couldn't", "Error", "String:", "Unexpected"] {
        assert!(!expected.contains(word));
    }
}

#[test]
#[rustfmt::skip]
fn lines_that_cannot_be_read_are_named_with_their_cause() {
    let text = |from: &str, to: &str| SQUARE.replacen(from, to, 1);
    for (text, expected) in [
        (text("1 1.5 0 0", "1 1.5"), "thing.ply:16: the line ends before \"z\" of vertex 2 (from 0)"),
        (text("1 1.5 0 0\n", "\n"), "thing.ply:16: the line ends before \"x\" of vertex 2 (from 0)"),
        (text("1 1.5 0 0", "1 1.5 0.5 0"), "thing.ply:16: \"z\" of vertex 2 (from 0) is `0.5`; the header announces a whole number from -32768 to 32767"),
        (text("1 1.5 0 0", "1 1.5 0 256"), "thing.ply:16: \"red\" of vertex 2 (from 0) is `256`; the header announces a whole number from 0 to 255"),
        (text("1 1.5 0 0", "1e39 1.5 0 0"), "thing.ply:16: \"x\" of vertex 2 (from 0) is `1e39`, which is not a finite number of the announced type"),
        (text("1 1.5 0 0", "1 1.5 0 0 # 3"), "thing.ply:16: `#` stands behind the last property"),
        (text("4 0 1 2 3", "5 0 1 2 3"), "thing.ply:18: the line ends before entry 4 (from 0) of \"vertex_indices\" of face 0 (from 0)"),
        (text("4 0 1 2 3", "18446744073709551615 0"), "thing.ply:18: the line ends before entry 1 (from 0) of \"vertex_indices\" of face 0 (from 0)"),
        (text("4 0 1 2 3", "-4 0 1 2 3"), "thing.ply:18: the length of \"vertex_indices\" of face 0 (from 0) is `-4`, which is not a whole number at or above 0"),
        (text("12\n", ""), "thing.ply: the file ends behind 0 of 1 elements \"wheel\""),
    ] {
        rejects(&text, expected);
    }
}

#[test]
#[rustfmt::skip]
fn headers_that_cannot_be_read_are_named_with_their_cause() {
    let text = |from: &str, to: &str| SQUARE.replacen(from, to, 1);
    for (text, expected) in [
        (String::new(), "thing.ply: the file is empty"),
        (SQUARE.replace('\n', "\r"), "thing.ply:1: lines of the header end with a carriage return alone"),
        (String::from("ply\nformat ascii 1.0\n"), "thing.ply: the file ends before the end of its header"),
        (text("format ascii 1.0\n", ""), "thing.ply: the header has no format"),
        (text("ascii 1.0", "ascii 99999.0"), "thing.ply: `format ascii 99999.0` has an unknown version"),
        (text("ascii 1.0", "ascii 7.3"), "thing.ply:2: `format ascii 7.3` has an unknown version"),
        (text("ascii", "asci"), "thing.ply:2: `format asci 1.0` is not a line of a PLY header"),
        (text("comment a square", "format binary_little_endian 1.0"), "thing.ply:3: `format binary_little_endian 1.0` differs from the format of a line above"),
        (text("comment a square", "ply"), "thing.ply:3: `ply` stands in the middle of the header"),
        (text("comment a square", "property int x"), "thing.ply:3: `property int x` stands above the first element"),
        (text("vertex 4", "vertex 4.5"), "thing.ply:4: `element vertex 4.5` is not a line of a PLY header"),
        (text("vertex 4", "vertex 99999999999999999999"), "thing.ply:4: `element vertex 99999999999999999999` announces more elements than a file can hold"),
        (text("float x", "list uchar float x"), "thing.ply: the header announces a property \"x\" of \"vertex\" that is not a number"),
        (text("uchar uint", "uchar float"), "thing.ply: the header announces a property \"vertex_indices\" of \"face\" that is not a list of whole numbers"),
    ] {
        rejects(&text, expected);
    }
    let latin = SQUARE.as_bytes().iter().map(|&byte| if byte == b'q' { 0xe9 } else { byte });
    let error = read(&latin.collect::<Vec<_>>()).unwrap_err();
    assert_eq!(error.to_string(), "thing.ply:3: the header is not UTF-8 text");
}

#[test]
fn binary_elements_that_are_cut_or_broken_are_named() {
    let header = "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty uchar x\n\
                  property uchar y\nproperty uchar z\nelement face 1\n\
                  property list char uchar vertex_indices\nend_header\n";
    let whole = [header.as_bytes(), &[0, 0, 0, 1, 0, 0, 0, 1, 0, 3, 0, 1, 2]].concat();
    assert!(read(&whole).is_ok());
    let fault = |bytes: &[u8]| read(bytes).unwrap_err().to_string();
    assert_eq!(
        fault(&whole[..whole.len() - 1]),
        "thing.ply: the file ends behind 0 of 1 elements \"face\""
    );
    assert_eq!(
        fault(&whole[..whole.len() - 5]),
        "thing.ply: the file ends behind 2 of 3 elements \"vertex\""
    );
    let mut broken = whole.clone();
    broken[whole.len() - 4] = 0xff;
    assert_eq!(
        fault(&broken),
        "thing.ply: a list of face 0 (from 0) has a length that is not a whole number at or above 0"
    );
}

#[test]
fn numbers_behind_the_last_property_are_warned_of() {
    let text = SQUARE.replace("0 0 0 255", "0 0 0 255 7 8");
    let text = text.replace("1 1.5 0 0", "1 1.5 0 0 .5");
    let warnings = read(text.as_bytes()).unwrap().warnings;
    let sentence =
        "thing.ply:14: numbers behind the last property of a line are ignored (and once more)";
    assert!(warnings.iter().any(|it| it == sentence), "{warnings:?}");
}

#[test]
fn ply_files_of_other_programs_are_read() {
    for name in [
        "meshes/fuze.ply",
        "meshes/fuze_ascii.ply",
        "meshes/octagonal_pocket.ply",
    ] {
        let Some(path) = samples::find(name) else {
            continue;
        };
        let imported = load(&path).unwrap();
        let (vertices, triangles) = mesh(&imported.scene.objects[0]);
        assert!(vertices.len() > 100 && triangles.len() > 100, "{name}");
    }
}

/// A header with these properties of vertices and faces, above three vertices and a face.
fn with_properties(vertex: &str, face: &str) -> String {
    format!(
        "ply\nformat ascii 1.0\ncomment TextureFile a.png\nelement vertex 3\nproperty float x\n\
         property float y\nproperty float z\n{vertex}element face 1\n\
         property list uchar int vertex_indices\n{face}end_header\n"
    )
}

#[test]
fn colors_of_faces_and_textures_are_warned_of() {
    let text = with_properties(
        "property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\n",
        "property uchar red\n",
    ) + "0 0 0 0 0 1 9\n1 0 0 0 0 1 9\n0 1 0 0 0 1 9\n3 0 1 2 7\n";
    let warnings = read(text.as_bytes()).unwrap().warnings;
    let ends: Vec<_> = warnings
        .iter()
        .map(|warning| warning.split_once("thing.ply:").unwrap().1)
        .collect();
    assert_eq!(
        ends,
        [
            "3: the texture is not drawn; export the mesh as glTF or OBJ to show it",
            "14: the color of a face is ignored; the surface has one color",
            " colors of vertices without red, green or blue are ignored",
        ]
    );
}

#[test]
fn triangle_strips_are_read() {
    let text = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n\
                property float z\nelement tristrips 1\nproperty list int int vertex_indices\n\
                end_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n10 0 1 2 3 3 4 -1 2 3 4\n";
    let imported = read(text.as_bytes()).unwrap();
    assert_eq!(imported.warnings, [] as [&str; 0]);
    let (_, triangles) = mesh(&imported.scene.objects[0]);
    assert_eq!(triangles, [[0, 1, 2], [2, 1, 3], [2, 3, 4]]);
    // Without a sign, -1 is the largest number.
    let unsigned = text.replace("list int int", "list int uint");
    let unsigned = unsigned.replace("-1", "4294967295");
    let imported = read(unsigned.as_bytes()).unwrap();
    let (_, without_sign) = mesh(&imported.scene.objects[0]);
    assert_eq!(without_sign, triangles);
    for wrong in ["-1 2 3 5", "-1 2 3 -2"] {
        let error = read(text.replace("-1 2 3 4", wrong).as_bytes()).unwrap_err();
        assert!(
            error
                .cause
                .contains("triangle strips 0 (from 0) use vertex"),
            "{error}"
        );
    }
}

#[test]
fn surfaces_that_are_not_read_are_named() {
    let fans = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
                property float z\nelement trifans 1\nproperty list int int vertex_indices\n\
                end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    let error = read(fans.as_bytes()).unwrap_err();
    assert!(
        error
            .cause
            .contains("its elements \"trifans\" are not read"),
        "{error}"
    );
    let corners = fans
        .replace("trifans", "face")
        .replace("vertex_indices", "corners");
    let error = read(corners.as_bytes()).unwrap_err();
    let parts = ["\"face\" have no list \"vertex_indices\"", "\"corners\""];
    assert!(parts.iter().all(|it| error.cause.contains(it)), "{error}");
}

#[test]
fn data_behind_what_is_announced_is_reported() {
    let surplus = [SQUARE.as_bytes(), b"3 0 1 2\n"].concat();
    let imported = read(&surplus).unwrap();
    let found = imported.warnings.iter();
    let found = found.filter(|it| it.contains("behind what the header announces"));
    assert_eq!(found.count(), 1, "{:?}", imported.warnings);
    let blank = read(&[SQUARE.as_bytes(), b"\n \n"].concat()).unwrap();
    assert_eq!(blank.warnings.len(), 3, "{:?}", blank.warnings);
}

#[test]
fn vertices_bring_their_normals() {
    let properties = "property float nx\nproperty float ny\nproperty float nz\n";
    let text =
        with_properties(properties, "") + "0 0 0 0 0 2\n1 0 0 0.5 0 1\n0 1 0 0 0.5 1\n3 0 1 2\n";
    let scene = read(text.as_bytes()).unwrap().scene;
    let normals = &scene.objects[0].normals;
    assert_eq!(normals.triangles, [[0, 1, 2]]);
    assert_eq!(normals.vectors[0], DVec3::Z);
    assert!(
        read(SQUARE.as_bytes()).unwrap().scene.objects[0]
            .normals
            .is_flat()
    );
}

#[test]
fn colors_of_vertices_are_taken_from_srgb() {
    for (kind, most) in [
        ("uchar", "255"),
        ("ushort", "65535"),
        ("int", "255"),
        ("uint", "255"),
        ("float", "1"),
        ("double", "1"),
    ] {
        let channels = ["red", "green", "blue", "alpha"];
        let properties = channels
            .map(|name| format!("property {kind} {name}\n"))
            .concat();
        let text = with_properties(&properties, "").replace("comment TextureFile a.png\n", "");
        let rows = format!(
            "0 0 0 {most} 0 0 {most}\n1 0 0 0 {most} 0 {most}\n0 1 0 0 0 {most} {most}\n3 0 1 2\n"
        );
        let imported = read((text + &rows).as_bytes()).unwrap();
        let colors = &imported.scene.objects[0].attributes.colors;
        let expected = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert_eq!(*colors, expected, "{kind}");
        assert_eq!(imported.warnings, [] as [&str; 0]);
    }
    // By their short names; out of range, or with an alpha.
    let properties = |kind: &str| {
        let names = ["r", "g", "b", "a"].map(|name| format!("property {kind} {name}\n"));
        with_properties(&names.concat(), "").replace("comment TextureFile a.png\n", "")
    };
    let rows = "0 0 0 128 0 0 1\n1 0 0 0 1 0 1\n0 1 0 0 0 -1 0.5\n3 0 1 2\n";
    let imported = read((properties("float") + rows).as_bytes()).unwrap();
    let colors = &imported.scene.objects[0].attributes.colors;
    assert_eq!(*colors, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0; 3]]);
    let [range, alpha] = &imported.warnings[..] else {
        panic!("{:?}", imported.warnings)
    };
    assert!(
        range.contains("colors of vertices are limited") && range.contains("2"),
        "{range}"
    );
    assert!(
        alpha.contains("the alpha of colors of vertices is ignored"),
        "{alpha}"
    );
    // Those between black and white, too.
    let text = with_properties(
        "property uchar red\nproperty uchar green\nproperty uchar blue\n",
        "",
    );
    let rows = "0 0 0 20 40 60\n1 0 0 20 40 60\n0 1 0 20 40 60\n3 0 1 2\n";
    let imported = read((text + rows).as_bytes()).unwrap();
    let expected = [20.0, 40.0, 60.0].map(|it| linear_of_srgb(it / 255.0));
    let colors = &imported.scene.objects[0].attributes.colors;
    assert_eq!(*colors, [expected; 3]);
    let list = with_properties("property list uchar uchar red\n", "");
    let error = read((list + "0 0 0 1 2\n1 0 0 1 2\n0 1 0 1 2\n3 0 1 2\n").as_bytes());
    assert!(error.is_err());
}

#[test]
fn incomplete_normals_are_warned_of_and_a_mark_before_text_is_passed_over() {
    let text = with_properties("property float nx\nproperty float ny\n", "")
        + "0 0 0 0 1\n1 0 0 0 1\n0 1 0 0 1\n3 0 1 2\n";
    let warnings = read(format!("\u{feff}{text}").as_bytes()).unwrap().warnings;
    let found = warnings
        .iter()
        .filter(|it| it.contains("without nx, ny or nz"));
    assert_eq!(found.count(), 1, "{warnings:?}");
}

#[test]
fn more_elements_than_a_scene_holds_are_rejected_before_they_are_read() {
    let header = |vertices: usize, faces: usize| {
        format!(
            "ply\nformat binary_little_endian 1.0\nelement vertex {vertices}\nproperty uchar x\n\
             element face {faces}\nproperty list uchar uchar vertex_indices\nend_header\n"
        )
    };
    for (vertices, faces, named) in [
        (29_687_501, 1, "29,687,501 elements \"vertex\""),
        (3, (1 << 24) + 1, "16,777,217 elements \"face\""),
    ] {
        let mut bytes = header(vertices, faces).into_bytes();
        bytes.resize(bytes.len() + vertices.max(faces), 0);
        let error = read(&bytes).unwrap_err();
        assert!(error.cause.contains(named), "{error}");
    }
}
