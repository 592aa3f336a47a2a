//! The shapes that morph targets give to meshes.

use super::*;

/// The document with two morph targets of the square, whose vertices have normals along z. The first moves the second
/// vertex by (2, 0, 0), the others not; the second moves all by (0, 0, 1) and leans their normals by (1, 0, 0).
fn morphed() -> Value {
    let mut document = document();
    let first = [[0.0_f32; 3], [2.0, 0.0, 0.0], [0.0; 3], [0.0; 3]];
    let vectors = [first, [[0.0, 0.0, 1.0]; 4], [[1.0, 0.0, 0.0]; 4]];
    let bytes: Vec<u8> = vectors
        .iter()
        .flatten()
        .flatten()
        .flat_map(|it| it.to_le_bytes())
        .collect();
    let data = STANDARD.encode(&bytes);
    let uri = format!("data:application/octet-stream;base64,{data}");
    push(
        &mut document,
        "buffers",
        json!({"byteLength": bytes.len(), "uri": uri}),
    );
    for number in 0..3 {
        let view = json!({"buffer": 1, "byteOffset": 48 * number, "byteLength": 48});
        push(&mut document, "bufferViews", view);
        let accessor = json!({"bufferView": 2 + number, "componentType": 5126, "count": 4,
            "type": "VEC3", "min": [0, 0, 0], "max": [2, 1, 1]});
        push(&mut document, "accessors", accessor);
    }
    let part = &mut document["meshes"][0]["primitives"][0];
    part["attributes"]["NORMAL"] = json!(3);
    part["targets"] = json!([{"POSITION": 2}, {"POSITION": 3, "NORMAL": 4}]);
    document
}

fn vertices(document: &Value, object: usize) -> Vec<DVec3> {
    let imported = read(document.to_string().as_bytes()).unwrap();
    assert_eq!(imported.warnings, [] as [&str; 0]);
    mesh(&imported.scene.objects[object]).0.to_vec()
}

#[test]
fn weights_of_the_node_or_else_of_the_mesh_move_vertices() {
    let mut document = morphed();
    let rest = vertices(&document, 0);
    document["meshes"][0]["weights"] = json!([0.5, 0.25]);
    let lifted = rest.iter().map(|it| *it + DVec3::Z * 0.25);
    let mut expected: Vec<DVec3> = lifted.collect();
    expected[1].x += 1.0;
    assert_eq!(vertices(&document, 0), expected);
    document["nodes"][0]["weights"] = json!([-1.0, 0.0]);
    let mut expected = rest.clone();
    expected[1].x -= 2.0;
    assert_eq!(vertices(&document, 0), expected);
    document["nodes"][0]["weights"] = json!([0.0, 0.0]);
    assert_eq!(vertices(&document, 0), rest);
}

#[test]
fn normals_lean_with_the_shape() {
    let mut document = morphed();
    document["meshes"][0]["weights"] = json!([0.0, 1.0]);
    let imported = read(document.to_string().as_bytes()).unwrap();
    let normals = &imported.scene.objects[0].normals;
    let text = format!("{normals:?}");
    let leaning = DVec3::new(1.0, 0.0, 1.0);
    let found = normals.vectors.iter().map(|it| it.normalize());
    assert!(normals.vectors.len() == 4, "{text}");
    for normal in found {
        assert!(normal.distance(leaning.normalize()) < 1e-12, "{text}");
    }
}

/// A mesh that several nodes place is not shared with one that has weights of its own.
#[test]
fn nodes_with_weights_have_parts_of_their_own() {
    let mut document = morphed();
    let corners: Vec<u8> = [0_u16, 1, 2]
        .repeat(2000)
        .iter()
        .flat_map(|it| it.to_le_bytes())
        .collect();
    let uri = format!(
        "data:application/octet-stream;base64,{}",
        STANDARD.encode(&corners)
    );
    push(
        &mut document,
        "buffers",
        json!({"byteLength": corners.len(), "uri": uri}),
    );
    push(
        &mut document,
        "bufferViews",
        json!({"buffer": 2, "byteLength": corners.len()}),
    );
    let accessor = json!({"bufferView": 5, "componentType": 5123, "count": 6000, "type": "SCALAR"});
    push(&mut document, "accessors", accessor);
    document["meshes"][0]["primitives"][0]["indices"] = json!(5);
    for place in 1..4 {
        push(
            &mut document,
            "nodes",
            json!({"mesh": 0, "translation": [0, 0, place]}),
        );
    }
    document["nodes"][3]["weights"] = json!([1.0, 0.0]);
    document["scenes"][0]["nodes"] = json!([0, 2, 3, 4]);
    let scene = read(document.to_string().as_bytes()).unwrap().scene;
    assert_eq!((scene.instances.len(), scene.parts.len()), (4, 2));
    let parts = scene.instances.iter().map(|it| it.part);
    assert_eq!(parts.collect::<Vec<_>>(), [0, 0, 1, 0]);
    let widest = |part: usize| {
        let (vertices, _) = mesh(&scene.parts[part].objects[0]);
        vertices.iter().map(|it| it.x).fold(0.0, f64::max)
    };
    assert_eq!([widest(0), widest(1)], [1.0, 3.0]);
}

#[test]
fn targets_of_another_length_are_rejected() {
    let mut document = morphed();
    document["accessors"][2]["count"] = json!(3);
    document["meshes"][0]["weights"] = json!([1.0]);
    let error = read(document.to_string().as_bytes()).unwrap_err();
    assert!(
        error.cause.contains("4 vertices, and its morph target 0 3"),
        "{error}"
    );
}
