//! Nodes that move meshes, against transforms of the nodes as glTF defines them.

use super::*;
use crate::scene::TrackTarget;
use glam::{DMat4, DQuat, DVec3, DVec4};

/// Random numbers, the same in each run.
struct Random(u64);

impl Random {
    /// Returns a number from -1 to 1, exact in single precision.
    fn number(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        f64::from((self.0 >> 40) as f32 / (1_u32 << 23) as f32 - 1.0)
    }

    fn numbers(&mut self, count: usize) -> Vec<f64> {
        (0..count).map(|_| self.number()).collect()
    }

    fn below(&mut self, count: usize) -> usize {
        ((self.number() * 0.5 + 0.5) * count as f64) as usize % count
    }
}

/// A channel of an animation: which node and path, how, when, and the values of each key.
struct Channel {
    node: usize,
    path: &'static str,
    interpolation: &'static str,
    times: Vec<f64>,
    values: Vec<Vec<f64>>,
}

impl Channel {
    /// The value at a time, as the specification says.
    fn at(&self, seconds: f64) -> DVec4 {
        let vector = |values: &[f64]| {
            let mut all = [0.0; 4];
            all[..values.len()].copy_from_slice(values);
            DVec4::from_array(all)
        };
        let spline = self.interpolation == "CUBICSPLINE";
        let value = |key: usize| vector(&self.values[if spline { 3 * key + 1 } else { key }]);
        let last = self.times.len() - 1;
        if seconds <= self.times[0] {
            return value(0);
        }
        if seconds >= self.times[last] {
            return value(last);
        }
        let key = self.times.iter().rposition(|&it| it <= seconds).unwrap();
        let duration = self.times[key + 1] - self.times[key];
        let t = (seconds - self.times[key]) / duration;
        let (one, other) = (value(key), value(key + 1));
        match self.interpolation {
            "STEP" => one,
            "LINEAR" if self.path == "rotation" => {
                let [one, other] = [one, other].map(|it| DQuat::from_vec4(it).normalize());
                one.slerp(other, t).into()
            }
            "LINEAR" => one.lerp(other, t),
            _ => {
                let leaving = vector(&self.values[3 * key + 2]) * duration;
                let entering = vector(&self.values[3 * key + 3]) * duration;
                let (t2, t3) = (t * t, t * t * t);
                one * (2.0 * t3 - 3.0 * t2 + 1.0)
                    + leaving * (t3 - 2.0 * t2 + t)
                    + other * (-2.0 * t3 + 3.0 * t2)
                    + entering * (t3 - t2)
            }
        }
    }
}

/// Adds an animation to a document.
fn animate(document: &mut Value, channels: &[Channel]) {
    let mut bytes = Vec::new();
    let buffer = document["buffers"].as_array().unwrap().len();
    let (mut samplers, mut listed) = (Vec::new(), Vec::new());
    for channel in channels {
        let components = channel.values[0].len();
        for (count, kind, numbers) in [
            (channel.times.len(), "SCALAR", channel.times.clone()),
            (
                channel.values.len(),
                ["", "SCALAR", "", "VEC3", "VEC4"][components],
                channel.values.concat(),
            ),
        ] {
            let view = document["bufferViews"].as_array().unwrap().len();
            document["bufferViews"]
                .as_array_mut()
                .unwrap()
                .push(json!({"buffer": buffer,
                "byteOffset": bytes.len(), "byteLength": 4 * numbers.len()}));
            let mut accessor =
                json!({"bufferView": view, "componentType": 5126, "count": count, "type": kind});
            if kind == "SCALAR" {
                accessor["min"] = json!([numbers[0]]);
                accessor["max"] = json!([numbers[numbers.len() - 1]]);
            }
            document["accessors"].as_array_mut().unwrap().push(accessor);
            bytes.extend(numbers.iter().flat_map(|it| (*it as f32).to_le_bytes()));
        }
        let accessors = document["accessors"].as_array().unwrap().len();
        listed.push(json!({"sampler": samplers.len(), "target": {"node": channel.node, "path": channel.path}}));
        samplers.push(json!({"input": accessors - 2, "output": accessors - 1,
            "interpolation": channel.interpolation}));
    }
    let data = STANDARD.encode(&bytes);
    document["buffers"]
        .as_array_mut()
        .unwrap()
        .push(json!({"byteLength": bytes.len(),
        "uri": format!("data:application/octet-stream;base64,{data}")}));
    document["animations"] = json!([{"channels": listed, "samplers": samplers}]);
}

/// A channel of random keys.
fn channel(random: &mut Random, node: usize, path: &'static str, scale: &[f64]) -> Channel {
    let interpolation = ["STEP", "LINEAR", "CUBICSPLINE"][random.below(3)];
    let keys = 1 + random.below(4);
    let spline = interpolation == "CUBICSPLINE";
    let mut value = |tangent: bool| match path {
        "rotation" => {
            let mut value = random.numbers(4);
            if !tangent {
                // Away from 0, also between.
                value[3] = value[3].abs() + 1.0;
            }
            value
        }
        "scale" => {
            let factor = 2.0_f64.powf(random.number().round()) * if tangent { 0.125 } else { 1.0 };
            scale.iter().map(|it| it * factor).collect()
        }
        _ => random.numbers(3),
    };
    let values = (0..keys).flat_map(|_| match spline {
        true => vec![value(true), value(false), value(true)],
        false => vec![value(false)],
    });
    Channel {
        node,
        path,
        interpolation,
        values: values.collect(),
        times: (0..keys).map(|key| 0.5 * key as f64 + 0.25).collect(),
    }
}

/// Translation, rotation and scale of a node.
type Rest = [Vec<f64>; 3];

/// Returns a chain of nodes, each inside of the one before, and a square in the last one. Some nodes move.
fn chain(random: &mut Random, uneven: bool) -> (Value, Vec<Rest>, Vec<Channel>) {
    let mut document = document();
    let count = 1 + random.below(5);
    let (mut rests, mut channels, mut nodes) = (Vec::new(), Vec::new(), Vec::new());
    for node in 0..count {
        let scale = 2.0_f64.powf(random.number().round());
        let mut scale = vec![scale; 3];
        // Below it nothing turns.
        let is_last = node == count - 1;
        if uneven && is_last {
            scale = vec![0.5, 2.0, -1.0];
        }
        let rest = [random.numbers(3), random.numbers(4), scale.clone()];
        for path in ["translation", "rotation", "scale"] {
            if random.number() > 0.0 {
                channels.push(channel(random, node, path, &scale));
            }
        }
        let mut json =
            json!({"translation": rest[0], "rotation": rest[1], "scale": rest[2], "name": "link"});
        match is_last {
            true => json["mesh"] = json!(0),
            false => json["children"] = json!([node + 1]),
        }
        nodes.push(json);
        rests.push(rest);
    }
    document["nodes"] = json!(nodes);
    document["scenes"] = json!([{"nodes": [0]}]);
    if !channels.is_empty() {
        animate(&mut document, &channels);
    }
    (document, rests, channels)
}

/// Returns the transform of the last node of a chain at a time, or at rest.
fn world(rests: &[Rest], channels: &[Channel], seconds: Option<f64>) -> DMat4 {
    let locals = rests.iter().enumerate().map(|(node, rest)| {
        let value = |index: usize, path: &str| {
            let mut of_node = channels
                .iter()
                .filter(|it| it.node == node && it.path == path);
            let moved = seconds.and_then(|seconds| Some(of_node.next()?.at(seconds)));
            moved.unwrap_or_else(|| {
                let mut all = [0.0; 4];
                all[..rest[index].len()].copy_from_slice(&rest[index]);
                DVec4::from_array(all)
            })
        };
        DMat4::from_scale_rotation_translation(
            value(2, "scale").truncate(),
            DQuat::from_vec4(value(1, "rotation")).normalize(),
            value(0, "translation").truncate(),
        )
    });
    locals.fold(DMat4::IDENTITY, |world, local| world * local)
}

#[test]
fn random_chains_move_as_their_nodes_do() {
    let mut random = Random(3);
    let mut moving = 0;
    for number in 0..300 {
        let (document, rests, channels) = chain(&mut random, number % 3 == 0);
        let imported = read(document.to_string().as_bytes()).unwrap();
        assert_eq!(imported.warnings, Vec::<String>::new());
        let scene = imported.scene;
        if scene.joints.is_empty() {
            // All keys are at rest.
            for step in 0..=50 {
                let moved = world(&rests, &channels, Some(f64::from(step) * 0.04));
                assert!(moved.abs_diff_eq(world(&rests, &channels, None), 1e-6));
            }
            continue;
        }
        let [instance] = &scene.instances[..] else {
            panic!("{} instances of {document}", scene.instances.len())
        };
        moving += 1;
        let Shape::Mesh { vertices, .. } = &scene.parts[0].objects[0].shape else {
            panic!("no mesh")
        };
        let corners = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        for step in -1..=50 {
            let seconds = (step >= 0).then(|| f64::from(step) * 0.04);
            let world = world(&rests, &channels, seconds);
            let placement = match seconds {
                Some(seconds) => scene.instances_at(seconds)[0].placement,
                None => instance.placement,
            };
            for (vertex, corner) in vertices.iter().zip(corners) {
                let (found, expected) = (placement.point(*vertex), world.transform_point3(corner));
                let error = found.distance(expected);
                assert!(
                    error < 1e-6 * (1.0 + expected.length()),
                    "{number}, {seconds:?}: {error:e}\n{document}"
                );
            }
        }
    }
    assert!(moving > 200, "{moving}");
}

/// A square in a node that moves in another one.
fn below(outer: Value, channels: &[Channel]) -> Imported {
    let mut document = document();
    let mut outer = outer;
    outer["children"] = json!([1]);
    document["nodes"] = json!([outer, {"name": "tile", "mesh": 0}, {"mesh": 0, "name": "still"}]);
    document["scenes"] = json!([{"nodes": [0, 2]}]);
    animate(&mut document, channels);
    read(document.to_string().as_bytes()).unwrap()
}

fn two_keys(node: usize, path: &'static str, values: [&[f64]; 2]) -> Channel {
    Channel {
        node,
        path,
        interpolation: "LINEAR",
        times: vec![0.0, 1.0],
        values: values.map(<[f64]>::to_vec).to_vec(),
    }
}

const QUARTER: [&[f64]; 2] = [
    &[0.0, 0.0, 0.0, 1.0],
    &[
        0.0,
        0.0,
        std::f64::consts::FRAC_1_SQRT_2,
        std::f64::consts::FRAC_1_SQRT_2,
    ],
];

#[test]
fn a_node_that_is_sheared_itself_does_not_turn_and_is_named() {
    let matrix = json!({"matrix": [1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]});
    let imported = below(matrix, &[two_keys(0, "rotation", QUARTER)]);
    let [warning] = &imported.warnings[..] else {
        panic!("{:?}", imported.warnings)
    };
    assert!(
        warning.contains("node 0") && warning.ends_with("has a sheared matrix; it does not turn"),
        "{warning}"
    );
}

#[test]
fn what_would_bend_or_shear_stays_and_is_named() {
    for (outer, channel, words) in [
        (
            json!({"scale": [1, 2, 1]}),
            two_keys(1, "rotation", QUARTER),
            "node 1 \"tile\" turns below a node",
        ),
        (
            json!({}),
            two_keys(1, "scale", [&[1.0, 1.0, 1.0], &[1.0, 2.0, 1.0]]),
            "grows unevenly",
        ),
        (
            json!({}),
            two_keys(1, "scale", [&[1.0, 1.0, 1.0], &[100.0, 100.0, 100.0]]),
            "64 times",
        ),
        (
            json!({}),
            two_keys(1, "scale", [&[1.0, 1.0, 1.0], &[-1.0, -1.0, -1.0]]),
            "grows unevenly",
        ),
        // Above 0 at both keys, and below it between them.
        (
            json!({}),
            Channel {
                node: 1,
                path: "scale",
                interpolation: "CUBICSPLINE",
                times: vec![0.0, 1.0],
                values: [0.0, 1.0, -15.0, 0.0, 2.0, 0.0]
                    .map(|x| vec![x; 3])
                    .to_vec(),
            },
            "grows unevenly",
        ),
    ] {
        let imported = below(outer, &[channel]);
        let [warning] = &imported.warnings[..] else {
            panic!("{:?}", imported.warnings)
        };
        assert!(warning.contains(words), "{warning}");
        assert!(imported.scene.joints.is_empty() && imported.scene.tracks.is_empty());
        assert_eq!(
            (imported.scene.objects.len(), imported.scene.instances.len()),
            (2, 0)
        );
    }
    // A scale that is uneven at rest alone bends nothing, and neither does a shift below it.
    let turned = below(json!({}), &[two_keys(0, "rotation", QUARTER)]);
    let shifted = two_keys(1, "translation", [&[0.0; 3], &[0.0, 1.0, 0.0]]);
    let shifted = below(json!({"scale": [1, 2, 1]}), &[shifted]);
    for imported in [&turned, &shifted] {
        assert_eq!(imported.warnings, Vec::<String>::new());
        assert_eq!(
            (imported.scene.objects.len(), imported.scene.instances.len()),
            (1, 1)
        );
    }
    let key = shifted.scene.tracks[0].keys[1];
    assert_eq!(key.vector(), DVec3::new(0.0, 2.0, 0.0));
}

#[test]
fn what_shrinks_to_nothing_keeps_a_little() {
    let imported = below(json!({}), &[two_keys(0, "scale", [&[1.0; 3], &[0.0; 3]])]);
    assert!(
        imported.warnings[0].contains("1/256"),
        "{:?}",
        imported.warnings
    );
    assert_eq!(imported.scene.tracks[0].keys[1].value[0], 1.0 / 256.0);
}

#[test]
fn nodes_that_grow_too_much_together_keep_their_size() {
    let grow: [&[f64]; 2] = [&[1.0; 3], &[10.0; 3]];
    let imported = below(json!({}), &[0, 1].map(|node| two_keys(node, "scale", grow)));
    let tracks = &imported.scene.tracks;
    assert_eq!(tracks.len(), 1, "{tracks:?}");
    assert!(
        imported.warnings[0].contains("with the nodes above it"),
        "{:?}",
        imported.warnings
    );
}

#[test]
fn nodes_that_stay_at_rest_make_no_joint() {
    let still = two_keys(1, "translation", [&[0.0; 3], &[0.0; 3]]);
    let back = two_keys(
        0,
        "rotation",
        [&[0.0, 0.0, 0.0, 1.0], &[0.0, 0.0, 0.0, -1.0]],
    );
    let imported = below(json!({}), &[still, back]);
    assert_eq!(imported.warnings, Vec::<String>::new());
    assert_eq!(
        (imported.scene.objects.len(), imported.scene.joints.len()),
        (2, 0)
    );
}

/// Quaternions have any length, and scenes any size.
#[test]
fn short_quaternions_and_small_shifts_move() {
    let turn = two_keys(
        0,
        "rotation",
        [&[1e-9, 0.0, 0.0, 1e-9], &[0.0, 0.0, 0.0, 1e-9]],
    );
    let shift = two_keys(1, "translation", [&[0.0; 3], &[1e-12, 0.0, 0.0]]);
    let imported = below(json!({}), &[turn, shift]);
    let targets: Vec<_> = imported.scene.tracks.iter().map(|it| it.target).collect();
    for target in [TrackTarget::JointRotation, TrackTarget::JointShift] {
        assert!(targets.contains(&target), "{targets:?}");
    }
}

#[test]
fn a_mesh_of_several_moving_nodes_is_one_part() {
    let mut document = document();
    document["nodes"] = json!([{"children": [1, 2], "name": "arm"}, {"mesh": 0}, {"mesh": 0, "translation": [2, 0, 0]},
        {"name": "nothing below"}]);
    document["scenes"] = json!([{"nodes": [0, 3]}]);
    let lift: [&[f64]; 2] = [&[0.0; 3], &[0.0, 1.0, 0.0]];
    let channels = [0, 2, 3].map(|node| two_keys(node, "translation", lift));
    animate(&mut document, &channels);
    let scene = read(document.to_string().as_bytes()).unwrap().scene;
    assert_eq!((scene.parts.len(), scene.instances.len()), (1, 2));
    let joints: Vec<_> = scene
        .joints
        .iter()
        .map(|it| (it.name.as_str(), it.parent))
        .collect();
    assert_eq!(joints, [("arm", None), ("node 2", Some(0))]);
    assert_eq!(
        [0, 1].map(|it| scene.instances[it].joint),
        [Some(0), Some(1)]
    );
    assert!(
        scene
            .tracks
            .iter()
            .all(|track| track.target == TrackTarget::JointShift)
    );
}

/// A square in a node with two keys of a spline, each with the changes before and behind it.
fn below_spline<const N: usize>(path: &'static str, keys: [[f64; N]; 6]) -> Imported {
    let channel = Channel {
        node: 0,
        path,
        interpolation: "CUBICSPLINE",
        times: vec![0.0, 1.0],
        values: keys.map(Vec::from).to_vec(),
    };
    below(json!({}), &[channel])
}

#[test]
fn splines_that_shrink_to_nothing_between_keys_keep_a_little() {
    // The least scale is 0, at 0.5 s.
    let keys = [[-4.0; 3], [1.0; 3], [-4.0; 3], [4.0; 3], [1.0; 3], [4.0; 3]];
    let imported = below_spline("scale", keys);
    let warnings = &imported.warnings;
    assert!(warnings[0].contains("1/256"), "{warnings:?}");
    let scale = |seconds: f64| imported.scene.tracks[0].at(seconds)[0];
    let least = (0..=100).map(|it| scale(f64::from(it) * 0.01));
    let least = least.fold(f64::INFINITY, f64::min);
    assert!((0.0038..0.004).contains(&least), "{least}");
    // It is hardly another one elsewhere.
    assert!((scale(0.25) - 0.25).abs() < 0.005, "{}", scale(0.25));
}

/// A spline from a rotation to its opposite quaternion passes through 0.
#[test]
fn splines_through_a_quaternion_without_a_length_keep_the_earlier_rotation() {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let turned = [0.0, 0.0, half, half];
    let (still, back) = ([0.0; 4], turned.map(|it| -it));
    let keys = [still, turned, still, still, back, still];
    let imported = below_spline("rotation", keys);
    for seconds in [0.0, 0.5] {
        let motion = imported.scene.motions(seconds)[0];
        let moved = motion.rotation * DVec3::X;
        assert!(moved.distance(DVec3::Y) < 1e-6, "{moved} at {seconds} s");
    }
}
