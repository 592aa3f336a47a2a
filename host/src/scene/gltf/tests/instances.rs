//! Meshes that several nodes place.

use super::*;
use crate::scene::{ImportOptions, Instances, Placement, Shape};
use glam::{DQuat, DVec3};

/// A mesh of so many triangles, and nodes that place it.
fn shared(triangles: usize, nodes: Value) -> Value {
    let mut document = document();
    let mut bytes = square();
    bytes.truncate(48);
    let corners = [0_u16, 1, 2].repeat(triangles);
    bytes.extend(corners.iter().flat_map(|x| x.to_le_bytes()));
    let data = STANDARD.encode(&bytes);
    document["buffers"] = json!([{
        "byteLength": bytes.len(),
        "uri": format!("data:application/octet-stream;base64,{data}"),
    }]);
    document["bufferViews"][1]["byteLength"] = json!(6 * triangles);
    document["accessors"][1]["count"] = json!(3 * triangles);
    let numbers: Vec<usize> = (0..nodes.as_array().unwrap().len()).collect();
    document["nodes"] = nodes;
    document["scenes"] = json!([{"nodes": numbers}]);
    document["meshes"][0]["name"] = json!("tree");
    document
}

fn turned(degrees: f64) -> Value {
    let half = degrees.to_radians() / 2.0;
    json!([0, half.sin(), 0, half.cos()])
}

#[test]
fn shared_mesh_that_saves_enough_is_a_part() {
    let scene = scene(&shared(
        512,
        json!([
            {"name": "left", "mesh": 0, "translation": [-1, 0, 0]},
            {"mesh": 0, "rotation": turned(30.0), "scale": [2, 2, 2]},
            {"name": "right", "mesh": 0, "translation": [3, 0, 0]},
        ]),
    ));
    assert_eq!(scene.objects.len(), 0);
    let [part] = &scene.parts[..] else {
        panic!("{:?}", scene.parts)
    };
    assert_eq!((part.name.as_str(), part.objects.len()), ("tree", 1));
    let names: Vec<_> = scene.instances.iter().map(|it| it.name.as_str()).collect();
    assert_eq!(names, ["left", "tree", "right"]);
    let placement = scene.instances[1].placement;
    let expected = DQuat::from_rotation_y(30_f64.to_radians());
    assert!(placement.rotation.dot(expected).abs() > 1.0 - 1e-12);
    assert!((placement.scale - 2.0).abs() < 1e-6);
    assert_eq!(
        scene.instances[2].placement.translation,
        DVec3::new(3.0, 0.0, 0.0)
    );
    assert_eq!(scene.flattened().unwrap().objects[2].name, "right/tree");
}

#[test]
fn mesh_that_saves_little_is_copied() {
    // 1,023 triangles are saved.
    let nodes = json!([{"mesh": 0}, {"mesh": 0, "translation": [1, 0, 0]}]);
    let copied = scene(&shared(1023, nodes.clone()));
    assert_eq!((copied.objects.len(), copied.parts.len()), (2, 0));
    let kept = scene(&shared(1024, nodes));
    assert_eq!((kept.objects.len(), kept.instances.len()), (0, 2));
}

#[test]
fn mirrored_and_uneven_nodes_are_copied() {
    let scene = scene(&shared(
        1024,
        json!([
            {"name": "a", "mesh": 0},
            {"name": "uneven", "mesh": 0, "scale": [1, 2, 1]},
            {"name": "mirrored", "mesh": 0, "scale": [-1, 1, 1]},
            {"name": "b", "mesh": 0, "scale": [0.5, 0.5, 0.5]},
        ]),
    ));
    let names: Vec<_> = scene.objects.iter().map(|it| it.name.as_str()).collect();
    assert_eq!(names, ["uneven", "mirrored"]);
    let names: Vec<_> = scene.instances.iter().map(|it| it.name.as_str()).collect();
    assert_eq!(names, ["a", "b"]);
}

#[test]
fn nodes_inside_of_nodes_stand_where_all_of_them_put_them() {
    let mut document = shared(
        1024,
        json!([
            {"translation": [0, 0, 5], "scale": [3, 3, 3], "children": [1, 2]},
            {"name": "a", "mesh": 0, "translation": [1, 0, 0]},
            {"name": "b", "mesh": 0},
        ]),
    );
    document["scenes"] = json!([{"nodes": [0]}]);
    let scene = scene(&document);
    let placement = |at: usize| scene.instances[at].placement;
    let expected = Placement {
        translation: DVec3::new(3.0, 0.0, 5.0),
        scale: 3.0,
        ..Placement::IDENTITY
    };
    assert_eq!(placement(0), expected);
    assert_eq!(placement(1).translation, DVec3::new(0.0, 0.0, 5.0));
}

#[test]
fn flattened_instances_stand_where_copies_do() {
    let node = |at: f64| json!({"mesh": 0, "rotation": turned(at), "translation": [at, 1, 2]});
    let few = shared(2, json!([node(10.0), node(70.0)]));
    let many = shared(1024, json!([node(10.0), node(70.0)]));
    let options = ImportOptions {
        instances: Instances::Flatten,
        ..ImportOptions::default()
    };
    let flat = crate::scene::read("a.gltf".as_ref(), many.to_string().into(), &options);
    let flat = flat.unwrap().scene;
    assert!(flat.parts.is_empty() && flat.instances.is_empty());
    let copied = scene(&few);
    assert_eq!(flat.objects.len(), copied.objects.len());
    for (flat, copied) in flat.objects.iter().zip(&copied.objects) {
        let (Shape::Mesh { vertices: a, .. }, Shape::Mesh { vertices: b, .. }) =
            (&flat.shape, &copied.shape)
        else {
            panic!("no meshes")
        };
        for (a, b) in a.iter().zip(b) {
            assert!((*a - *b).length() < 1e-12, "{a} {b}");
        }
    }
}

#[test]
fn node_that_moves_is_an_instance_whatever_it_saves() {
    let mut document = shared(
        4,
        json!([{"mesh": 0}, {"mesh": 0, "translation": [1, 0, 0]}]),
    );
    let views = document["bufferViews"].as_array_mut().unwrap();
    views.push(json!({"buffer": 0, "byteLength": 4}));
    views.push(json!({"buffer": 0, "byteLength": 12}));
    let accessors = document["accessors"].as_array_mut().unwrap();
    accessors.push(
        json!({"bufferView": 2, "componentType": 5126, "count": 1, "type": "SCALAR",
        "min": [0], "max": [0]}),
    );
    accessors.push(json!({"bufferView": 3, "componentType": 5126, "count": 1, "type": "VEC3"}));
    document["animations"] = json!([{
        "samplers": [{"input": 2, "output": 3}],
        "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}],
    }]);
    let scene = scene(&document);
    assert_eq!((scene.objects.len(), scene.instances.len()), (1, 1));
}
