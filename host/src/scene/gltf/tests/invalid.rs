//! Documents that are rejected.

use super::*;

#[test]
fn broken_documents_are_rejected_with_their_cause() {
    let with = |change: fn(&mut Value)| {
        let mut document = document();
        change(&mut document);
        cause(&document)
    };
    for (change, expected) in [
        (
            (|d| d["nodes"][0]["children"] = json!([0])) as fn(&mut Value),
            "node 0 is inside of itself",
        ),
        (
            |d| d["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]),
            "KHR_draco_mesh_compression",
        ),
        (
            |d| d["accessors"][0]["type"] = json!("VEC2"),
            "holds Vec2 of F32",
        ),
        (
            |d| d["accessors"][1]["componentType"] = json!(5126),
            "holds Scalar of F32",
        ),
        (
            |d| d["accessors"][0]["count"] = json!(5),
            "reads 5 elements",
        ),
        (|d| d["accessors"][0]["count"] = json!(3), "uses vertex 3"),
        (
            |d| d["accessors"][0]["count"] = json!(4_000_000_000_u32),
            "are the most",
        ),
        (
            |d| d["bufferViews"][0]["byteOffset"] = json!(u64::MAX),
            "has 0 bytes",
        ),
        (
            |d| d["bufferViews"][0]["byteStride"] = json!(4),
            "4 bytes apart",
        ),
        (
            |d| d["buffers"][0]["byteLength"] = json!(61),
            "61 are announced",
        ),
        (|d| d["buffers"][0]["uri"] = json!("https://a/b"), "network"),
        (
            |d| d["buffers"][0]["uri"] = json!("data:text/plain,abc"),
            "not in base 64",
        ),
        (
            |d| d["nodes"][0]["scale"] = json!([1e38, 1e39, 1]),
            "out of range",
        ),
        (|d| d["nodes"][0]["mesh"] = json!(7), "nodes[0].mesh"),
        (
            |d| d["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(7),
            "mesh 0 uses accessor 7",
        ),
        (
            |d| d["meshes"][0]["primitives"][0]["attributes"]["WHATEVER"] = json!(0),
            "meshes[0].primitives[0].attributes: the name of an attribute is unknown",
        ),
        (
            |d| d["cameras"][0]["type"] = json!("orthographic"),
            "camera 0 lacks",
        ),
    ] {
        let cause = with(change);
        assert!(cause.contains(expected), "{expected}: {cause}");
    }
    let error = read(b"{\n \"asset\": {\"version\": 2.0}\n}").unwrap_err();
    assert_eq!(error.line, Some(2));
    assert!(error.cause.ends_with("(column 25)"), "{error}");
}

#[test]
fn required_extensions_must_be_read() {
    let mut document = document();
    document["extensionsRequired"] = document["extensionsUsed"].clone();
    assert_eq!(warnings(&document), [] as [&str; 0]);
    for name in [
        "KHR_texture_basisu",
        "EXT_texture_webp",
        "MSFT_texture_dds",
        "KHR_mesh_quantization",
    ] {
        document["extensionsUsed"] = json!([name]);
        assert!(warnings(&document).concat().contains(name));
        document["extensionsRequired"] = json!(["KHR_materials_ior", name]);
        let expected = format!("`extensionsRequired` names an extension that is not read: {name}");
        assert_eq!(cause(&document), expected);
        document["extensionsRequired"] = json!([]);
    }
    document["extensionsUsed"] = json!(["KHR_materials_unlit"]);
    document["extensionsRequired"] = document["extensionsUsed"].clone();
    assert!(warnings(&document).concat().contains("KHR_materials_unlit"));
}

/// Instances count against the limit of a blob before they are made.
#[test]
fn a_million_instances_are_rejected() {
    let mut document = document();
    let count = 100_000;
    // Posed, because their scale is uneven.
    document["nodes"] = json!(vec![json!({"mesh": 0, "scale": [1, 2, 1]}); count]);
    document["scenes"][0]["nodes"] = json!((0..count).collect::<Vec<_>>());
    document["meshes"][0]["primitives"] =
        json!(vec![document["meshes"][0]["primitives"][0].clone(); 50]);
    assert!(cause(&document).contains("instances counted"));
    // As instances they fit, until they are flattened.
    document["nodes"] = json!(vec![json!({"mesh": 0}); count]);
    let scene = scene(&document);
    assert_eq!((scene.parts.len(), scene.instances.len()), (1, count));
    let error = scene.flattened().unwrap_err();
    assert!(error.remedy.contains("--instances keep"), "{error}");
}

/// The member `nodes` of a scene is optional.
#[test]
fn scenes_without_nodes_are_read() {
    let mut document = document();
    push(&mut document, "scenes", json!({}));
    document["animations"] = json!([{
        "channels": [{"sampler": 0, "target": {"path": "pointer"}}],
        "samplers": [{"input": 0, "output": 0}],
    }]);
    assert_eq!(scene(&document).objects.len(), 1);
    let empty = json!({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{}]});
    assert_eq!(
        warnings(&empty),
        ["the scene of the file has no triangles; nothing is drawn"]
    );
    let broken = json!({"asset": {"version": "2.0"}, "scenes": [{"nodes": 1}]});
    assert!(cause(&broken).contains("the JSON is broken"));
}

/// glTF allows any JSON there.
#[test]
fn extras_of_any_kind_are_passed_over() {
    for extras in [
        json!("text"),
        json!(7),
        json!(null),
        json!([1]),
        json!({"a": {}}),
    ] {
        let mut document = document();
        document["extras"] = extras.clone();
        for list in ["nodes", "meshes", "cameras"] {
            document[list][0]["extras"] = extras.clone();
        }
        assert_eq!(warnings(&document), [] as [&str; 0], "{extras}");
    }
}

#[test]
fn other_versions_are_rejected() {
    let mut document = document();
    for (version, message) in [
        (json!("3.0"), "glTF of version 3.0; version 2 is required"),
        (json!("1.0"), "glTF of version 1.0"),
        (json!("20"), "glTF of version 20"),
    ] {
        document["asset"]["version"] = version;
        assert!(cause(&document).contains(message), "{}", cause(&document));
    }
    document["asset"] = json!({"version": "2.1", "minVersion": "2.1"});
    assert!(cause(&document).contains("at least glTF of version 2.1"));
    document["asset"] = json!({"version": "2.0", "minVersion": "3.0"});
    assert!(cause(&document).contains("version 3.0"));
    document["asset"] = json!({"version": "2.9", "minVersion": "2.0"});
    assert_eq!(warnings(&document), [] as [&str; 0]);
    // Objects where version 2 has arrays.
    let old = br#"{"asset": {"version": "1.0"}, "nodes": {"a": {}}}"#;
    assert!(read(old).unwrap_err().cause.contains("version 1.0"));
}

#[test]
fn a_projective_matrix_is_rejected() {
    let mut document = document();
    let mut matrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1].map(f64::from);
    document["nodes"][0]["matrix"] = json!(matrix);
    assert_eq!(warnings(&document), [] as [&str; 0]);
    for (place, value, row) in [
        (11, 0.125, "0 0 0.125 1"),
        (3, -1.0, "-1 0 0 1"),
        (15, 2.0, "0 0 0 2"),
        (15, 0.0, "0 0 0 0"),
    ] {
        let kept = std::mem::replace(&mut matrix[place], value);
        document["nodes"][0]["matrix"] = json!(matrix);
        let cause = cause(&document);
        let expected = format!("node 0 \"tile\": the matrix is projective (its last row is {row}");
        assert!(cause.contains(&expected), "{cause}");
        matrix[place] = kept;
    }
}

#[test]
fn nodes_with_two_transforms_are_warned_of() {
    let mut document = document();
    document["nodes"][0]["matrix"] = json!([2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1]);
    document["nodes"][0]["translation"] = json!([7, 7, 7]);
    let warnings = warnings(&document);
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert!(warnings[0].starts_with("node 0 has a matrix, and a translation"));
    let scene = scene(&document);
    let (vertices, _) = mesh(&scene.objects[0]);
    assert_eq!(vertices[2], DVec3::new(2.0, 2.0, 0.0));
}

#[test]
fn scenes_that_list_an_inner_node_are_rejected() {
    let mut document = document();
    document["nodes"][0]["children"] = json!([2]);
    push(&mut document, "nodes", json!({"mesh": 0}));
    assert_eq!(scene(&document).objects.len(), 2);
    push(&mut document, "scenes", json!({"nodes": [1, 2]}));
    assert!(cause(&document).contains("scene 1 lists node 2, which is inside of node 0"));
}

/// Nodes and meshes that no scene shows must be valid all the same.
#[test]
fn meshes_that_are_not_shown_are_checked() {
    let mut document = document();
    document["scenes"] = json!([{"nodes": []}]);
    document["nodes"] = json!([{"children": [1]}, {"children": [2]}, {"children": [0]}]);
    assert!(cause(&document).contains("node 0 is inside of itself"));
    document["nodes"] = json!([{"children": [2]}, {"children": [2]}, {}]);
    assert!(cause(&document).contains("node 2 is inside of two nodes"));
    document["nodes"] = json!([]);
    document["accessors"][0]["count"] = json!(3);
    assert!(cause(&document).contains("mesh 0, primitive 0 uses vertex 3"));
}

/// A mesh of many small parts that many nodes share.
#[test]
fn nodes_that_multiply_beyond_all_memory_are_rejected_with_the_figure() {
    let mut document = document();
    let part = document["meshes"][0]["primitives"][0].clone();
    document["meshes"][0]["primitives"] = json!(vec![part; 4000]);
    let name = "n".repeat(1000);
    let count = 3000;
    document["nodes"] = json!(vec![
        json!({"mesh": 0, "name": name, "scale": [1, 2, 1]});
        count
    ]);
    document["scenes"][0]["nodes"] = json!((0..count).collect::<Vec<_>>());
    let cause = cause(&document);
    assert!(cause.contains("GB of memory, for"), "{cause}");
    assert!(cause.contains("the limit is 3.8 GB"), "{cause}");
}

/// Many accessors of the same bytes, which nothing uses.
#[test]
fn accessors_that_multiply_are_rejected() {
    let mut document = document();
    let accessors = document["accessors"].as_array_mut().unwrap();
    let many =
        json!({"bufferView": 0, "componentType": 5126, "count": 16_000_000, "type": "SCALAR"});
    accessors.extend(vec![many; 20]);
    assert!(
        cause(&document).contains("the accessors of the file have more than 268435456 elements")
    );
}
