//! The shapes that morph targets give to meshes, at rest and with time.

use super::*;
use crate::scene::TrackTarget;

fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|it| it.to_le_bytes()).collect()
}

/// Adds an accessor with bytes of its own, and returns its number.
fn stored(document: &mut Value, bytes: &[u8], mut accessor: Value) -> usize {
    let data = STANDARD.encode(bytes);
    let uri = format!("data:application/octet-stream;base64,{data}");
    let number = |document: &Value, list: &str| document[list].as_array().unwrap().len();
    let view = json!({"buffer": number(document, "buffers"), "byteLength": bytes.len()});
    push(
        document,
        "buffers",
        json!({"byteLength": bytes.len(), "uri": uri}),
    );
    accessor["bufferView"] = json!(number(document, "bufferViews"));
    push(document, "bufferViews", view);
    push(document, "accessors", accessor);
    number(document, "accessors") - 1
}

/// The document with two morph targets of the square, whose vertices have normals along z. The first moves the second
/// vertex by (2, 0, 0), the others not; the second moves all by (0, 0, 1) and leans their normals by (1, 0, 0).
fn morphed() -> Value {
    let mut document = document();
    let first = [[0.0_f32; 3], [2.0, 0.0, 0.0], [0.0; 3], [0.0; 3]];
    for vectors in [first, [[0.0, 0.0, 1.0]; 4], [[1.0, 0.0, 0.0]; 4]] {
        let accessor = json!({"componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [2, 1, 1]});
        stored(&mut document, &floats(&vectors.concat()), accessor);
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
    let accessor = json!({"componentType": 5123, "count": 6000, "type": "SCALAR"});
    let indices = stored(&mut document, &corners, accessor);
    document["meshes"][0]["primitives"][0]["indices"] = json!(indices);
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

/// A few bytes announce any number of vertices, and any number of targets of as many.
#[test]
fn more_differences_than_a_file_may_have_are_rejected_before_they_are_read() {
    let mut document = document();
    push(
        &mut document,
        "accessors",
        json!({"componentType": 5126, "count": 1 << 24, "type": "VEC3", "min": [0, 0, 0], "max": [0, 0, 0]}),
    );
    let accessor = document["accessors"].as_array().unwrap().len() - 1;
    let part = &mut document["meshes"][0]["primitives"][0];
    part["attributes"] = json!({"POSITION": accessor});
    part["targets"] = vec![json!({"POSITION": accessor}); 17].into();
    document["meshes"][0]["weights"] = vec![1.0; 17].into();
    let error = read(document.to_string().as_bytes()).unwrap_err();
    let cause = "morph targets move more than 268435456 vertices";
    assert!(error.cause.contains(cause), "{error}");
}

/// The document, whose animation moves the weights of its two morph targets by these numbers at 0 s and 1 s.
fn animated(values: &[f32], interpolation: &str) -> Value {
    let mut document = morphed();
    for numbers in [&[0.0, 1.0], values] {
        let accessor = json!({"componentType": 5126, "count": numbers.len(), "type": "SCALAR",
            "min": [0], "max": [1]});
        stored(&mut document, &floats(numbers), accessor);
    }
    document["animations"] = json!([{
        "name": "wave",
        "samplers": [{"input": 5, "output": 6, "interpolation": interpolation}],
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}],
    }]);
    document
}

#[test]
fn animated_weights_become_tracks_of_morph_targets() {
    let mut document = animated(&[0.0, 0.25, 1.0, -0.5], "LINEAR");
    document["nodes"][0]["weights"] = json!([0.5, 0.0]);
    document["nodes"][0]["scale"] = json!([1, 1, 3]);
    let options = GltfOptions {
        animation: Some(String::from("wave")),
        ..GltfOptions::default()
    };
    let imported = chosen(&document, options).unwrap();
    assert_eq!(imported.warnings, [] as [&str; 0]);
    let scene = imported.scene;
    let weights = scene.morph_targets.iter().map(|it| it.weight);
    assert_eq!(weights.collect::<Vec<_>>(), [0.5, 0.0]);
    let tracks: Vec<_> = scene
        .tracks
        .iter()
        .map(|track| {
            let values = track.keys.iter().map(|key| (key.seconds, key.value[0]));
            (track.target, track.index, values.collect::<Vec<_>>())
        })
        .collect();
    let target = TrackTarget::MorphWeight;
    assert_eq!(
        tracks,
        [
            (target, 0, vec![(0.0, 0.0), (1.0, 1.0)]),
            (target, 1, vec![(0.0, 0.25), (1.0, -0.5)])
        ]
    );
    let object = &scene.objects[0];
    let [first, second] = &object.attributes.displacements[..] else {
        panic!("{:?}", object.attributes)
    };
    assert_eq!((first.target, second.target), (0, 1));
    // As the node scales them; vertices are those at rest.
    assert_eq!(first.vectors[1], DVec3::X * 2.0);
    assert_eq!(second.vectors, [DVec3::Z * 3.0; 4]);
    assert_eq!(mesh(object).0[1].x, 2.0);
    // The file's own change of normals, and that of the faces, which stay in their plane.
    let changes = &object.normals.changes;
    assert_eq!(changes.len(), 2, "{changes:?}");
    for change in changes {
        let expected = [DVec3::ZERO, DVec3::X * 3.0][change.target];
        assert!(
            change
                .vectors
                .iter()
                .all(|it| it.distance(expected) < 1e-12),
            "{changes:?}"
        );
    }
}

#[test]
fn splines_of_weights_have_changes_for_each_target() {
    let values = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0].map(|it| it / 8.0);
    let both = [values, values.map(|it| -it)].concat();
    let scene = scene(&animated(&both, "CUBICSPLINE"));
    let [first, second] = &scene.tracks[..] else {
        panic!("{:?}", scene.tracks)
    };
    let key = |track: &crate::scene::Track| {
        let key = track.keys[0];
        [key.entering, key.value, key.leaving].map(|it| it[0] * 8.0)
    };
    assert_eq!(key(first), [1.0, 3.0, 5.0]);
    assert_eq!(key(second), [2.0, 4.0, 6.0]);
}

#[test]
fn weights_of_another_count_are_rejected() {
    let cause = cause(&animated(&[0.0, 0.25, 1.0], "LINEAR"));
    assert!(
        cause.contains("channel 0 of node 0: it has no keys, or not a value for each"),
        "{cause}"
    );
}

/// Two nodes with one mesh, of which one is animated and moves: they share nothing.
#[test]
fn animated_nodes_have_parts_of_their_own() {
    let mut document = animated(&[0.0, 0.25, 1.0, -0.5], "STEP");
    push(
        &mut document,
        "nodes",
        json!({"mesh": 0, "translation": [0, 0, 2]}),
    );
    document["scenes"][0]["nodes"] = json!([0, 1, 2]);
    let still = scene(&document);
    assert_eq!((still.objects.len(), still.parts.len()), (2, 0));
    let moves = |object: &Object| !object.attributes.displacements.is_empty();
    assert_eq!(
        [0, 1].map(|it: usize| moves(&still.objects[it])),
        [true, false]
    );
    // A node that moves as well is an instance of a part that morphs.
    let vectors = floats(&[0.0, 0.0, 0.0, 0.0, 4.0, 0.0]);
    let accessor = json!({"componentType": 5126, "count": 2, "type": "VEC3"});
    let output = stored(&mut document, &vectors, accessor);
    let animation = &mut document["animations"][0];
    push(animation, "samplers", json!({"input": 5, "output": output}));
    push(
        animation,
        "channels",
        json!({"sampler": 1, "target": {"node": 0, "path": "translation"}}),
    );
    let moving = scene(&document);
    assert_eq!((moving.objects.len(), moving.parts.len()), (1, 1));
    assert!(moves(&moving.parts[0].objects[0]) && !moves(&moving.objects[0]));
    assert!(moving.instances[0].joint.is_some());
    assert_eq!((moving.morph_targets.len(), moving.tracks.len()), (2, 3));
}

/// A target of normals alone turns them, and moves no vertex.
#[test]
fn targets_of_normals_alone_change_normals() {
    let mut document = animated(&[0.0, 0.0, 0.0, 1.0], "LINEAR");
    document["meshes"][0]["primitives"][0]["targets"] = json!([{}, {"NORMAL": 4}]);
    let scene = scene(&document);
    let object = &scene.objects[0];
    assert!(object.attributes.displacements.is_empty());
    let [change] = &object.normals.changes[..] else {
        panic!("{:?}", object.normals)
    };
    assert_eq!((change.target, change.vectors[0]), (1, DVec3::X));
}

#[test]
fn weights_can_be_integers() {
    let mut document = animated(&[0.0, 0.0, 0.0, 0.0], "LINEAR");
    let accessor = json!({"componentType": 5121, "normalized": true, "count": 4, "type": "SCALAR"});
    let output = stored(&mut document, &[0, 255, 51, 102], accessor);
    document["animations"][0]["samplers"][0]["output"] = json!(output);
    let scene = scene(&document);
    let values = |track: usize| [0, 1].map(|key: usize| scene.tracks[track].keys[key].value[0]);
    assert_eq!([values(0), values(1)], [[0.0, 0.2], [1.0, 0.4]]);
    // Times are floats.
    document["animations"][0]["samplers"][0]["input"] = json!(output);
    assert!(cause(&document).contains("is to hold times"));
}

#[test]
fn counts_that_differ_and_what_is_left_out_are_warned_of() {
    let mut document = animated(&[0.0, 0.25, 1.0, -0.5], "LINEAR");
    document["meshes"][0]["weights"] = json!([0.0, 0.0, 1.0]);
    document["nodes"][0]["weights"] = json!([0.5]);
    let part = document["meshes"][0]["primitives"][0].clone();
    push(&mut document["meshes"][0], "primitives", part);
    let targets = &mut document["meshes"][0]["primitives"][1]["targets"];
    *targets = json!([{"POSITION": 2, "COLOR_0": 2}]);
    let channel = document["animations"][0]["channels"][0].clone();
    push(&mut document["animations"][0], "channels", channel);
    let said = warnings(&document).join("\n");
    for words in [
        "the primitives of mesh 0 have 1 to 2 morph targets",
        "mesh 0 has 2 morph targets, and it has 3 weights",
        "mesh 0 has 2 morph targets, and node 0 has 1 weights",
        "two channels for one property of node 0",
        "colors and texture coordinates of morph targets are ignored",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
    document["meshes"][0]["primitives"] = json!([{"attributes": {"POSITION": 0}, "indices": 1}]);
    let said = warnings(&document).join("\n");
    assert!(
        said.contains("moves weights of node 0, whose mesh has no morph targets"),
        "{said}"
    );
}
