//! Nodes, meshes and accessors.

use super::*;

/// The sum of the triangles' normals, each as long as twice its area.
fn facing(object: &Object) -> DVec3 {
    let (vertices, triangles) = mesh(object);
    let corners = |t: &[u32; 3]| t.map(|corner| vertices[corner as usize]);
    let normal = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a);
    triangles.iter().map(|t| normal(corners(t))).sum()
}

#[test]
fn a_square_is_read_as_text_and_as_binary() {
    let scene = scene(&document());
    let (vertices, triangles) = mesh(&scene.objects[0]);
    assert_eq!(vertices[2], DVec3::new(1.0, 1.0, 0.0));
    assert_eq!(triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(scene.objects[0].name, "tile");
    assert_eq!(scene.materials[0].diffuse, Diffuse::Plain([1.0; 3]));
    assert_eq!(
        read(&binary()).unwrap().scene.objects[0].shape,
        scene.objects[0].shape
    );
    let with_mark = [b"\xef\xbb\xbf", document().to_string().as_bytes()].concat();
    assert!(read(&with_mark).is_ok());
}

#[test]
fn a_buffer_is_read_from_a_file_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("thing.gltf");
    let mut document = document();
    document["buffers"][0]["uri"] = json!("the%20square.bin");
    std::fs::write(&path, document.to_string()).unwrap();
    let missing = load(&path).unwrap_err();
    assert!(missing.cause.contains("the square.bin"), "{missing}");
    std::fs::write(folder.path().join("the square.bin"), square()).unwrap();
    assert_eq!(load(&path).unwrap().scene.objects.len(), 1);
}

/// Children lie in their parents, and mirrored meshes still face outward.
#[test]
fn nodes_place_their_meshes() {
    let mut document = document();
    document["nodes"] = json!([
        {"translation": [10, 0, 0], "children": [1, 2], "rotation": [0, 0, 1, 1]},
        {"mesh": 0, "scale": [2, 2, 2]},
        {"mesh": 0, "scale": [-1, 1, 1], "name": "mirrored"},
    ]);
    document["scenes"][0]["nodes"] = json!([0]);
    let scene = scene(&document);
    let (vertices, _) = mesh(&scene.objects[0]);
    assert!(vertices[1].distance(DVec3::new(10.0, 2.0, 0.0)) < 1e-6);
    assert!(facing(&scene.objects[0]).distance(DVec3::Z * 8.0) < 1e-6);
    assert_eq!(scene.objects[1].name, "mirrored");
    assert!(facing(&scene.objects[1]).distance(DVec3::Z * 2.0) < 1e-6);
}

#[test]
fn strips_fans_and_meshes_without_indices_become_triangles() {
    let mut document = document();
    document["meshes"][0]["primitives"] = json!([
        {"attributes": {"POSITION": 0}, "mode": 6},
        {"attributes": {"POSITION": 0}, "mode": 5},
        {"attributes": {"POSITION": 0}},
        {"attributes": {"POSITION": 0}, "mode": 1},
    ]);
    let scene = scene(&document);
    let triangles: Vec<_> = scene.objects.iter().map(|object| mesh(object).1).collect();
    assert_eq!(triangles[0], [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(triangles[1], [[0, 1, 2], [1, 3, 2]]);
    assert_eq!(triangles[2], [[0, 1, 2]]);
    assert_eq!(scene.objects.len(), 3);
    assert_eq!(scene.objects[1].name, "tile 1");
}

#[test]
fn corners_that_make_no_whole_triangle_are_warned_of() {
    let mut document = document();
    let mut with = |mode: usize, corners: usize| {
        document["meshes"][0]["primitives"][0]["mode"] = json!(mode);
        document["accessors"][1]["count"] = json!(corners);
        warnings(&document)
    };
    let sentence =
        "mesh 0, primitive 0 has 5 corners, of which 2 make no whole triangle and are left out";
    assert_eq!(with(4, 5), [sentence]);
    for mode in [5, 6] {
        assert_eq!(with(mode, 5), [] as [&str; 0]);
        let found = with(mode, 2);
        assert_eq!(found[0], sentence.replace('5', "2"));
        assert!(found[1].contains("nothing is drawn"), "{found:?}");
    }
    assert_eq!(with(4, 6), [] as [&str; 0]);
    // Other sentences are about points and lines.
    assert_eq!(with(1, 5)[0], "points and lines are not drawn");
    // Corners without indices are the vertices. They are counted where nothing is drawn, too.
    let part = json!({"attributes": {"POSITION": 0}});
    document["meshes"] = json!([{"primitives": [part]}, {"primitives": [part, part]}]);
    let found = warnings(&document);
    let sentence =
        "mesh 0, primitive 0 has 4 corners, of which 1 make no whole triangle and are left out";
    assert_eq!(found, [format!("{sentence} (and 2 times more)")]);
}

#[test]
fn numbers_that_are_not_finite_are_reported_with_what_follows() {
    let mut document = document();
    let mut numbers = [0.0_f32, 0.0, 1.0].repeat(4);
    numbers[3] = f32::NAN;
    let bytes: Vec<u8> = numbers.iter().flat_map(|it| it.to_le_bytes()).collect();
    let uri = format!(
        "data:application/octet-stream;base64,{}",
        STANDARD.encode(&bytes)
    );
    let push = |list: &mut Value, item: Value| list.as_array_mut().unwrap().push(item);
    push(
        &mut document["buffers"],
        json!({"byteLength": 48, "uri": uri}),
    );
    push(
        &mut document["bufferViews"],
        json!({"buffer": 1, "byteLength": 48}),
    );
    push(
        &mut document["accessors"],
        json!({"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC3"}),
    );
    for (attribute, follows) in [
        ("NORMAL", "triangles with such a normal are shaded flat"),
        ("COLOR_0", "such a channel of a color is 0"),
        ("_OTHER", "nothing that is drawn uses it"),
    ] {
        let mut document = document.clone();
        document["meshes"][0]["primitives"][0]["attributes"][attribute] = json!(2);
        let found = warnings(&document);
        let warning = format!("element 1 of accessor 2 is not a finite number; {follows}");
        assert!(found.contains(&warning), "{found:?}");
        let attributes = &scene(&document).objects[0].attributes;
        if attribute == "COLOR_0" {
            assert_eq!(attributes.colors[1], [0.0, 0.0, 1.0]);
        }
    }
}

/// An accessor may replace elements of its view, or of nothing.
#[test]
fn sparse_positions_replace_those_of_their_view() {
    let mut bytes = square();
    bytes.extend([2, 0, 0, 0]);
    bytes.extend([9.0_f32, 8.0, 7.0].iter().flat_map(|x| x.to_le_bytes()));
    let mut document = document();
    document["buffers"][0] = json!({
        "byteLength": bytes.len(),
        "uri": format!("data:;base64,{}", STANDARD.encode(&bytes)),
    });
    let views = document["bufferViews"].as_array_mut().unwrap();
    views.push(json!({"buffer": 0, "byteOffset": 60, "byteLength": 4}));
    views.push(json!({"buffer": 0, "byteOffset": 64, "byteLength": 12}));
    document["accessors"][0]["sparse"] = json!({
        "count": 1,
        "indices": {"bufferView": 2, "componentType": 5121},
        "values": {"bufferView": 3},
    });
    let placed = scene(&document);
    let (vertices, _) = mesh(&placed.objects[0]);
    assert_eq!(vertices[1..3], [DVec3::X, DVec3::new(9.0, 8.0, 7.0)]);
    let accessor = document["accessors"][0].as_object_mut().unwrap();
    accessor.remove("bufferView");
    let placed = scene(&document);
    let (vertices, _) = mesh(&placed.objects[0]);
    assert_eq!(vertices[1..3], [DVec3::ZERO, DVec3::new(9.0, 8.0, 7.0)]);
    document["accessors"][0]["count"] = json!(2);
    let part = document["meshes"][0]["primitives"][0].as_object_mut();
    part.unwrap().remove("indices");
    assert!(cause(&document).contains("replaces element 2"));
}

/// Triangles, instances counted, as other programs count them.
#[test]
fn gltf_files_of_other_programs_keep_their_triangles() {
    for (name, objects, triangles) in [
        ("monkey.glb", 1, 968),
        ("BoxTextured.glb", 1, 12),
        ("boolean.glb", 28, 3936),
        ("nested.glb", 3, 36),
        ("no_indices_3storybuilding.glb", 3, 72),
        ("TestScene.gltf", 9, 1096),
    ] {
        let Some(path) = samples::find(&format!("meshes/{name}")) else {
            return;
        };
        let scene = load(&path).unwrap_or_else(|error| panic!("{error}")).scene;
        let count: usize = scene
            .objects
            .iter()
            .map(|object| mesh(object).1.len())
            .sum();
        assert_eq!((scene.objects.len(), count), (objects, triangles), "{name}");
    }
}

#[test]
fn normals_stay_at_right_angles_to_the_surface() {
    let normals = [
        [0.6_f32, 0.0, 0.8],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, 2.0],
        [0.0, 0.0, 1.0],
    ];
    let mut bytes = square();
    bytes.extend(normals.iter().flatten().flat_map(|x| x.to_le_bytes()));
    let mut document = document();
    document["buffers"][0] = json!({
        "byteLength": bytes.len(),
        "uri": format!("data:;base64,{}", STANDARD.encode(&bytes)),
    });
    let views = document["bufferViews"].as_array_mut().unwrap();
    views.push(json!({"buffer": 0, "byteOffset": 60, "byteLength": 48}));
    let accessors = document["accessors"].as_array_mut().unwrap();
    accessors.push(json!({"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC3"}));
    let attributes = &mut document["meshes"][0]["primitives"][0]["attributes"];
    attributes["NORMAL"] = json!(2);
    document["nodes"][0]["scale"] = json!([-1, 1, 2]);
    let normals = scene(&document).objects[0].normals.clone();
    assert_eq!(normals.triangles, [[0, 2, 1], [0, 3, 2]]);
    let expected = DVec3::new(-0.6, 0.0, 0.4).normalize();
    assert!(
        (normals.vectors[0] - expected).length() < 1e-6,
        "{normals:?}"
    );
    // As many normals as vertices.
    document["accessors"][2]["count"] = json!(3);
    let error = read(document.to_string().as_bytes()).unwrap_err();
    assert!(
        error.cause.contains("has 4 vertices and 3 normals"),
        "{error}"
    );
}
