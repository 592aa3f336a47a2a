use super::*;
use crate::scene::{Diffuse, test_scenes};
use base64::Engine;

/// A triangle below a node that moves it, a camera and a light; the data is three points.
pub(in crate::scene) const TRIANGLE: &str = r#"{
"asset": {"version": "2.0"}, "scene": 0,
"scenes": [{"nodes": [0]}],
"nodes": [
 {"name": "root", "translation": [0, 0, 1], "children": [1, 2, 3]},
 {"name": "leaf", "scale": [2, 1, -1], "mesh": 0},
 {"camera": 0, "translation": [0, 0, 5]},
 {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [3, 4, 5]}],
"cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}],
"extensionsUsed": ["KHR_lights_punctual"],
"extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "color": [1, 0.5, 0], "intensity": 40}]}},
"materials": [{"name": "tin", "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.6, 0.4, 1], "metallicFactor": 1, "roughnessFactor": 0.25}}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
"bufferViews": [{"buffer": 0, "byteLength": 36}],
"buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]
}"#;

fn read(text: &str) -> Result<Imported, SceneError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("thing.gltf");
    std::fs::write(&path, text).unwrap();
    load(&path)
}

#[test]
fn nodes_place_meshes_cameras_and_lights() {
    let points: Vec<u8> = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]
        .iter()
        .flat_map(|float| float.to_le_bytes())
        .collect();
    let encoded = base64::engine::general_purpose::STANDARD.encode(points);
    assert!(TRIANGLE.contains(&encoded), "{encoded}");
    let Imported { scene, warnings } = read(TRIANGLE).unwrap();
    assert_eq!(warnings, [""; 0]);
    let object = &scene.objects[0];
    assert_eq!(object.name, "leaf");
    // The mirror turns the corners round, so that the front stays one.
    let expected = Shape::Mesh {
        vertices: vec![
            DVec3::new(0.0, 0.0, 1.0),
            DVec3::new(2.0, 0.0, 1.0),
            DVec3::new(0.0, 1.0, 1.0),
        ],
        triangles: vec![[0, 2, 1]],
    };
    assert_eq!(object.shape, expected);
    let camera = scene.camera.unwrap();
    assert_eq!(
        (camera.eye, camera.target),
        (DVec3::Z * 6.0, DVec3::Z * 5.0)
    );
    assert!((camera.fov_degrees - 28.648).abs() < 1e-3);
    let position = DVec3::new(3.0, 4.0, 6.0);
    let color = [1.0, 0.5, 0.0];
    assert_eq!(scene.lights, [Light::Point { position, color }]);
    let tin = &scene.materials[object.material];
    assert_eq!(tin.name, "tin");
    let near = |found: [f64; 3], expected: [f64; 3]| {
        assert!(
            found
                .iter()
                .zip(expected)
                .all(|(a, b)| (a - b).abs() < 1e-6),
            "{found:?}"
        );
    };
    near(tin.mirror, [0.6, 0.45, 0.3]);
    match tin.diffuse {
        Diffuse::Plain(diffuse) => near(diffuse, [0.2, 0.15, 0.1]),
        _ => panic!("{tin:?}"),
    }
    assert_eq!(tin.transmit, [0.0; 3]);
}

#[test]
fn faults_name_what_they_are_in() {
    let text = |from: &str, to: &str| {
        assert!(TRIANGLE.contains(from), "{from}");
        TRIANGLE.replacen(from, to, 1)
    };
    for (text, cause) in [
        (String::from("{"), "no valid glTF"),
        (
            text("\"count\": 3", "\"count\": 4"),
            "accessor 0 reaches beyond its buffer",
        ),
        (
            text("\"count\": 3", "\"count\": 18446744073709551615"),
            "accessor 0 reaches beyond",
        ),
        (
            text("\"byteLength\": 36}]", "\"byteLength\": 360}]"),
            "accessor 0 reaches beyond",
        ),
        (text("\"VEC3\"", "\"VEC2\""), "accessor 0 holds no points"),
        (
            text("\"byteLength\": 36, \"uri\"", "\"byteLength\": 37, \"uri\""),
            "buffer 0 has 36 bytes of 37",
        ),
        (text("base64,AAAA", "base64,A!AA"), "buffer 0 is broken"),
        (
            text(
                "data:application/octet-stream;base64,",
                "missing%20file.bin?",
            ),
            "buffer 0 is \"missing file.bin",
        ),
        (
            text(", \"uri\": \"data", ", \"name\": \"data"),
            "buffer 0 has no data",
        ),
        (text("[1, 2, 3]", "[1, 2, 3, 0]"), "node 0 is met twice"),
        (text("\"mesh\": 0", "\"mesh\": 1"), "no valid glTF"),
        (text("\"mesh\": 0}", "\"name\": \"\"}"), "no valid glTF"),
        (
            text(
                "\"attributes\": {\"POSITION\": 0}",
                "\"attributes\": {\"POSITION\": 0}, \"mode\": 0",
            ),
            "has no triangles",
        ),
        (text("[2, 1, -1]", "[2e38, 1e38, -1]"), "not finite"),
    ] {
        let Err(error) = read(&text) else {
            panic!("{cause}: {text}")
        };
        let shown = error.to_string();
        assert!(shown.contains(cause), "{cause}: {shown}");
        assert!(!error.remedy.is_empty());
    }
}

#[test]
fn strips_fans_and_small_indices() {
    let indexed = TRIANGLE
        .replace("{\"POSITION\": 0}", "{\"POSITION\": 0}, \"indices\": 1, \"mode\": MODE")
        .replace("}],\n\"bufferViews\": [", "}, {\"bufferView\": 1, \"componentType\": 5121, \"count\": 4, \"type\": \"SCALAR\"}],\n\"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36}, {\"buffer\": 1, \"byteLength\": 4}], \"unused\": [")
        .replace("AAAAgD8AAAAA\"}]", "AAAAgD8AAAAA\"}, {\"byteLength\": 4, \"uri\": \"data:;base64,AAECAA==\"}]");
    for (mode, expected) in [
        ("5", &[[0, 2, 1], [2, 0, 1]][..]),
        ("6", &[[0, 2, 1], [0, 0, 2]][..]),
        ("4", &[[0, 2, 1]][..]),
    ] {
        let imported = read(&indexed.replace("MODE", mode)).unwrap();
        let Shape::Mesh { triangles, .. } = &imported.scene.objects[0].shape else {
            panic!()
        };
        assert_eq!(triangles, expected, "mode {mode}");
    }
}

#[test]
fn real_files() {
    for name in [
        "meshes/monkey.glb",
        "meshes/boolean.glb",
        "meshes/nested.glb",
        "meshes/no_indices_3storybuilding.glb",
        "meshes/BoxTextured.glb",
    ] {
        let Some(path) = test_scenes::find(name) else {
            continue;
        };
        let imported = load(&path).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(!imported.scene.objects.is_empty(), "{name}");
    }
}
