use super::*;
use crate::scene::test_scenes::{self, load, mesh};

/// A square and a line, with colors and an element that nobody knows.
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
    test_scenes::read("thing.ply", bytes)
}

#[test]
fn faces_become_triangles() {
    let imported = read(SQUARE.as_bytes()).unwrap();
    let (vertices, triangles) = mesh(&imported.scene.objects[0]);
    assert_eq!(vertices[2], DVec3::new(1.0, 1.5, 0.0));
    assert_eq!(triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(imported.scene.objects[0].name, "thing");
    assert_eq!(imported.warnings.len(), 3, "{:?}", imported.warnings);
    assert!(imported.warnings[0].contains("thing.ply:8: the color of a vertex is ignored; the surface has one color (and 3 times more)"));
    assert!(imported.warnings[1].contains("elements \"wheel\" are ignored"));
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
        (text("4 0 1 2 3", "4 0 1 2 -1"), Some(18), "-1"),
        (text("1 0 0 0", "1 nan 0 0"), Some(15), "1 nan 0 0"),
        (text("1 0 0 0", "1 word 0 0"), Some(15), "word"),
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
        (text("ply\n", "plx\n"), Some(1), "ply"),
    ] {
        let error = read(text.as_bytes()).unwrap_err();
        assert!(error.cause.contains(cause), "{cause}: {error}");
        assert_eq!(error.line, line, "{error}");
    }
}

#[test]
fn real_files() {
    for name in [
        "meshes/fuze.ply",
        "meshes/fuze_ascii.ply",
        "meshes/octagonal_pocket.ply",
    ] {
        let Some(path) = test_scenes::find(name) else {
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
fn colors_and_textures_are_warned_of() {
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
            "3: textures are not drawn; the plain colors are used",
            "11: the color of a vertex is ignored; the surface has one color (and 2 times more)",
            "14: the color of a face is ignored; the surface has one color",
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
