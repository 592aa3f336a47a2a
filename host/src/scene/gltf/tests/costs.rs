//! Files whose counts multiply: they are rejected, or take time in proportion to their length.

use super::animation::{animated, channel, sampler, set_times};
use super::*;

/// An accessor without a view holds zeros, which take no bytes in the file.
#[test]
fn keys_of_all_channels_are_limited_before_they_are_read() {
    let million = |kind: &str, count: usize| json!({"componentType": 5126, "count": count, "type": kind, "min": [0], "max": [0]});
    let mut document = document();
    for _ in 0..4 {
        push(&mut document, "nodes", json!({}));
    }
    push(&mut document, "accessors", million("SCALAR", 1_000_000));
    let mut output = million("VEC3", 1_000_000);
    output
        .as_object_mut()
        .unwrap()
        .retain(|key, _| !key.starts_with('m'));
    push(&mut document, "accessors", output);
    let channels: Vec<_> = (0..5).map(|node| channel(0, node, "translation")).collect();
    document["animations"] =
        json!([{"channels": channels, "samplers": [{"input": 2, "output": 3}]}]);
    let expected = "up to channel 4, animation 0 has 5,000,000 keys; the limit is 4,194,304";
    assert_eq!(cause(&document), expected);

    // Each morph target has keys of its own.
    document["meshes"][0]["primitives"][0]["targets"] = json!(vec![json!({}); 5]);
    push(&mut document, "accessors", million("SCALAR", 5_000_000));
    document["animations"] = json!([{
        "channels": [channel(0, 0, "weights")],
        "samplers": [{"input": 2, "output": 4}],
    }]);
    let expected = "up to channel 0, animation 0 has 5,000,000 keys; the limit is 4,194,304";
    assert_eq!(cause(&document), expected);

    // Values without times are read, too.
    document["accessors"][2]["count"] = json!(1);
    assert_eq!(cause(&document), expected);
}

/// The camera and the light of node 1 below `depth` nodes, of which the uppermost moves for `seconds`.
fn carried(depth: usize, seconds: f32) -> Value {
    let mut document = animated(json!([{"channels": [channel(0, 2, "translation")],
        "samplers": [sampler(3, "LINEAR")]}]));
    set_times(&mut document, [0.0, 1.0, seconds]);
    for number in 0..depth {
        let below = if number + 1 < depth { number + 3 } else { 1 };
        push(&mut document, "nodes", json!({"children": [below]}));
    }
    document["scenes"] = json!([{"nodes": [0, 2]}]);
    document
}

#[test]
fn samples_below_many_nodes_are_limited() {
    assert_eq!(scene(&carried(600, 2.0)).tracks.len(), 3);
    assert_eq!(scene(&carried(2, 2000.0)).tracks[0].keys.len(), 65_538);
    let found = cause(&carried(600, 2000.0));
    assert!(found.contains("take more than 33554432 steps"), "{found}");
}

/// Times the joints of their skin times the depth of these, the work would be hours.
#[test]
fn meshes_that_share_a_skin_take_time_in_proportion() {
    let count = 20_000;
    let mut document = animated(json!([{"channels": [channel(0, 0, "translation")],
        "samplers": [sampler(3, "LINEAR")]}]));
    let first = document["nodes"].as_array().unwrap().len();
    for number in 0..count {
        let children = match number + 1 < count {
            true => json!({"children": [first + number + 1]}),
            false => json!({}),
        };
        push(&mut document, "nodes", children);
    }
    let last = first + count;
    for _ in 0..count {
        push(&mut document, "nodes", json!({"mesh": 0, "skin": 0}));
    }
    let joints: Vec<_> = (first..last).collect();
    document["skins"] = json!([{"joints": joints}]);
    // The bent meshes stand outside of the scene, and are counted.
    assert!(!warnings(&document).iter().any(|it| it.contains("bends")));
    document["animations"][0]["channels"][0]["target"]["node"] = json!(first);
    let sentence = format!(
        "a mesh that the animation bends keeps its shape at rest; skins do not move (and {} times more)",
        count - 1
    );
    let found = warnings(&document);
    assert!(found.contains(&sentence), "{found:?}");
}

#[test]
fn nodes_that_share_a_mesh_of_many_primitives_take_time_in_proportion() {
    let (nodes, parts) = (100_000, 20_000);
    let mut document = document();
    let part = document["meshes"][0]["primitives"][0].clone();
    document["meshes"][0]["primitives"] = json!(vec![part; parts]);
    document["nodes"] = json!(vec![json!({"mesh": 0}); nodes]);
    document["scenes"] = json!([{"nodes": (0..nodes).collect::<Vec<_>>()}]);
    let start = std::time::Instant::now();
    let made = scene(&document);
    assert_eq!((made.parts.len(), made.instances.len()), (1, nodes));
    assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
}

#[test]
fn nodes_that_share_a_mesh_of_many_points_are_rejected() {
    let (nodes, parts) = (10_000, 10_000);
    let mut document = document();
    let points = json!({"attributes": {"POSITION": 0}, "mode": 0});
    document["meshes"][0]["primitives"] = json!(vec![points; parts]);
    document["nodes"] = json!(vec![json!({"mesh": 0}); nodes]);
    document["scenes"] = json!([{"nodes": (0..nodes).collect::<Vec<_>>()}]);
    assert!(cause(&document).contains("the limit is 3.8 GB"));
}

/// Targets with weights of 0 move nothing, and are passed at each node.
#[test]
fn nodes_that_share_a_mesh_of_many_morph_targets_are_rejected() {
    let (nodes, targets) = (20_000, 20_000);
    let mut document = document();
    document["meshes"][0]["primitives"][0]["targets"] = json!(vec![json!({}); targets]);
    document["meshes"][0]["weights"] = json!(vec![0.0; targets]);
    document["nodes"] = json!(vec![json!({"mesh": 0, "scale": [1, 2, 1]}); nodes]);
    document["scenes"] = json!([{"nodes": (0..nodes).collect::<Vec<_>>()}]);
    let found = cause(&document);
    assert!(
        found.contains("nodes have more than 268435456 morph targets"),
        "{found}"
    );
}
