use super::*;
use crate::scene::test_scenes::{self, mesh};

/// A square and a line, with colours and an element that nobody knows.
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
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("thing.ply");
    std::fs::write(&path, bytes).unwrap();
    load(&path)
}

#[test]
fn faces_become_triangles() {
    let imported = read(SQUARE.as_bytes()).unwrap();
    let (vertices, triangles) = mesh(&imported.scene.objects[0]);
    assert_eq!(vertices[2], DVec3::new(1.0, 1.5, 0.0));
    assert_eq!(triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(imported.scene.objects[0].name, "thing");
    assert_eq!(imported.warnings.len(), 2, "{:?}", imported.warnings);
    assert!(imported.warnings[0].contains("elements \"wheel\" are passed over"));
    assert!(imported.warnings[1].contains("1 faces have fewer than three vertices"));
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
            "no face of the file has three vertices",
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
