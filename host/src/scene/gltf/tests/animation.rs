//! Tracks of animated cameras and lights.

use super::super::curve::Curve;
use super::*;
use crate::scene::{Interpolation, Key, TrackTarget};
use glam::DQuat;

/// The document with keys at 0, 1 and 2 seconds in a buffer of their own. Accessor 2 has the times, and 3 three
/// positions. Accessor 4 has three rotations about y by 0, 90 and 180 degrees, and 5 the positions with tangents.
pub(super) fn animated(animations: Value) -> Value {
    let mut document = document();
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let places = [[0.5_f32, 0.5, 4.0], [1.5, 0.5, 4.0], [1.5, 2.5, 4.0]];
    let mut floats: Vec<f32> = vec![0.0, 1.0, 2.0];
    floats.extend(places.as_flattened());
    floats.extend([0.0, 0.0, 0.0, 1.0, 0.0, half, 0.0, half, 0.0, 1.0, 0.0, 0.0]);
    for place in places {
        floats.extend([3.0, 0.0, 0.0]);
        floats.extend(place);
        floats.extend([0.0, 0.0, 6.0]);
    }
    let bytes: Vec<u8> = floats.iter().flat_map(|it| it.to_le_bytes()).collect();
    let data = STANDARD.encode(&bytes);
    let buffers = document["buffers"].as_array_mut().unwrap();
    buffers.push(json!({"byteLength": bytes.len(),
        "uri": format!("data:application/octet-stream;base64,{data}")}));
    let mut offset = 0;
    for (count, kind, components) in [
        (3, "SCALAR", 1),
        (3, "VEC3", 3),
        (3, "VEC4", 4),
        (9, "VEC3", 3),
    ] {
        let length = 4 * count * components;
        let view = document["bufferViews"].as_array().unwrap().len();
        document["bufferViews"]
            .as_array_mut()
            .unwrap()
            .push(json!({"buffer": 1, "byteOffset": offset, "byteLength": length}));
        document["accessors"]
            .as_array_mut()
            .unwrap()
            .push(json!({"bufferView": view,
            "componentType": 5126, "count": count, "type": kind, "min": [0], "max": [2]}));
        let accessor = document["accessors"]
            .as_array_mut()
            .unwrap()
            .last_mut()
            .unwrap();
        if kind != "SCALAR" {
            accessor
                .as_object_mut()
                .unwrap()
                .retain(|key, _| key != "min" && key != "max");
        }
        offset += length;
    }
    document["animations"] = animations;
    document
}

pub(super) fn channel(sampler: usize, node: usize, path: &str) -> Value {
    json!({"sampler": sampler, "target": {"node": node, "path": path}})
}

pub(super) fn sampler(output: usize, interpolation: &str) -> Value {
    json!({"input": 2, "output": output, "interpolation": interpolation})
}

fn tracks(document: &Value) -> (Vec<crate::scene::Track>, Vec<String>) {
    let imported = read(document.to_string().as_bytes()).unwrap();
    (imported.scene.tracks, imported.warnings)
}

#[test]
fn a_node_keeps_its_keys() {
    for (interpolation, name) in [
        (Interpolation::Step, "STEP"),
        (Interpolation::Linear, "LINEAR"),
        (Interpolation::Cubic, "CUBICSPLINE"),
    ] {
        let places = if name == "CUBICSPLINE" { 5 } else { 3 };
        let document = animated(json!([{"channels": [channel(0, 1, "translation")],
            "samplers": [sampler(places, name)]}]));
        let (tracks, warnings) = tracks(&document);
        assert_eq!(warnings, Vec::<String>::new());
        let [eye, rotation, light] = &tracks[..] else {
            panic!("{tracks:?}")
        };
        assert_eq!(
            (eye.target, eye.interpolation),
            (TrackTarget::CameraEye, interpolation)
        );
        assert_eq!((light.target, light.index), (TrackTarget::LightPosition, 0));
        assert_eq!(eye.keys, light.keys);
        assert_eq!(eye.keys[1].vector(), DVec3::new(1.5, 0.5, 4.0));
        assert_eq!(eye.keys[2].seconds, 2.0);
        if interpolation == Interpolation::Cubic {
            assert_eq!(eye.keys[0].leaving, [0.0, 0.0, 6.0, 0.0]);
            assert_eq!(eye.keys[0].entering, [3.0, 0.0, 0.0, 0.0]);
        }
        // It keeps looking along -z.
        assert_eq!(rotation.target, TrackTarget::CameraRotation);
        assert_eq!(rotation.keys.len(), 1);
        assert_eq!(rotation.keys[0].value, [0.0, 0.0, 0.0, 1.0]);
    }
}

#[test]
fn rotations_follow_what_stands_above() {
    let mut document = animated(json!([{"channels": [channel(0, 1, "rotation")],
        "samplers": [sampler(4, "LINEAR")]}]));
    // Above it a node that is turned by 90 degrees about z, scaled and moved.
    let half = std::f32::consts::FRAC_1_SQRT_2;
    document["nodes"]
        .as_array_mut()
        .unwrap()
        .push(json!({"children": [1],
        "rotation": [0, 0, half, half], "scale": [2, 2, 2], "translation": [1, 0, 0]}));
    document["scenes"] = json!([{"nodes": [0, 2]}]);
    let (tracks, warnings) = tracks(&document);
    assert_eq!(warnings, Vec::<String>::new());
    assert_eq!(tracks[0].keys.len(), 1);
    let eye = tracks[0].keys[0].vector();
    assert!(eye.distance(DVec3::new(0.0, 1.0, 8.0)) < 1e-6, "{eye}");
    let ahead = |key: usize| DQuat::from_array(tracks[1].keys[key].value) * DVec3::NEG_Z;
    assert!(ahead(0).distance(DVec3::NEG_Z) < 1e-6);
    // Turned to -x about its own y, which is -y of the scene.
    assert!(ahead(1).distance(DVec3::NEG_Y) < 1e-6, "{}", ahead(1));
    assert!(ahead(2).distance(DVec3::Z) < 1e-6);
}

#[test]
fn a_rig_is_sampled() {
    let mut document = animated(json!([{"channels": [channel(0, 2, "rotation")],
        "samplers": [sampler(4, "LINEAR")]}]));
    document["nodes"]
        .as_array_mut()
        .unwrap()
        .push(json!({"children": [1]}));
    document["scenes"] = json!([{"nodes": [0, 2]}]);
    let (tracks, warnings) = tracks(&document);
    assert!(
        warnings.len() == 1 && warnings[0].contains("60 times"),
        "{warnings:?}"
    );
    let eye = &tracks[0];
    assert_eq!(
        (eye.keys.len(), eye.interpolation),
        (121, Interpolation::Linear)
    );
    for (key, expected) in [
        (0, [0.5, 0.5, 4.0]),
        (60, [4.0, 0.5, -0.5]),
        (120, [-0.5, 0.5, -4.0]),
    ] {
        let found = eye.keys[key].vector();
        assert!(
            found.distance(DVec3::from_array(expected)) < 1e-6,
            "{found}"
        );
    }
    let ahead = DQuat::from_array(tracks[1].keys[60].value) * DVec3::NEG_Z;
    assert!(ahead.distance(DVec3::NEG_X) < 1e-6, "{ahead}");
}

#[test]
fn a_rig_that_moves_in_steps_is_sampled_at_its_keys() {
    let mut document = animated(json!([{"channels": [channel(0, 2, "translation")],
        "samplers": [sampler(3, "STEP")]}]));
    let nodes = document["nodes"].as_array_mut().unwrap();
    nodes.push(json!({"children": [1]}));
    document["scenes"] = json!([{"nodes": [0, 2]}]);
    let (tracks, _) = tracks(&document);
    let eye = &tracks[0].keys;
    let at = |seconds: f64| eye.iter().position(|key| key.seconds == seconds).unwrap();
    let [before, key] = [at(1.0) - 1, at(1.0)];
    assert_eq!(eye[before].seconds, 47_999.0 / 48_000.0);
    assert_eq!(eye[before].vector(), eye[0].vector());
    assert_eq!(eye[key].vector() - eye[0].vector(), DVec3::X);
}

#[test]
fn a_directional_light_keeps_the_keys_of_its_steps_and_is_sampled_where_it_turns_smoothly() {
    let sun = |animations: Value| {
        let mut document = animated(animations);
        document["extensions"]["KHR_lights_punctual"]["lights"] = json!([{"type": "directional"}]);
        tracks(&document)
    };
    let turn = |how: &str| {
        sun(json!([{"channels": [channel(0, 1, "rotation")], "samplers": [sampler(4, how)]}]))
    };
    let of_light = |tracks: Vec<crate::scene::Track>| {
        let mut tracks = tracks.into_iter();
        tracks.find(|it| it.target == TrackTarget::LightDirection)
    };
    let (steps, warnings) = turn("STEP");
    assert_eq!(warnings, Vec::<String>::new());
    let steps = of_light(steps).unwrap();
    assert_eq!(
        (steps.keys.len(), steps.interpolation),
        (3, Interpolation::Step)
    );
    assert!(steps.keys[1].vector().distance(DVec3::NEG_X) < 1e-6);
    let (smooth, warnings) = turn("LINEAR");
    assert!(warnings[0].contains("60 times"), "{warnings:?}");
    assert_eq!(of_light(smooth).unwrap().keys.len(), 121);
    // Where it stands does not matter.
    let (moved, warnings) = sun(
        json!([{"channels": [channel(0, 1, "translation")], "samplers": [sampler(3, "STEP")]}]),
    );
    assert_eq!((of_light(moved), warnings.len()), (None, 0));
}

#[test]
fn channels_without_a_node_are_ignored_with_a_warning() {
    let mut document = animated(json!([{"channels": [channel(0, 1, "translation")],
        "samplers": [sampler(3, "LINEAR")]}]));
    let keys = |tracks: Vec<crate::scene::Track>| -> Vec<_> {
        tracks.into_iter().map(|it| (it.target, it.keys)).collect()
    };
    let (expected, _) = tracks(&document);
    let channels = document["animations"][0]["channels"]
        .as_array_mut()
        .unwrap();
    channels.push(
        json!({"sampler": 0, "target": {"path": "pointer", "extensions":
        {"KHR_animation_pointer": {"pointer": "/nodes/0/rotation"}}}}),
    );
    let (found, warnings) = tracks(&document);
    assert_eq!(keys(found), keys(expected));
    assert!(
        warnings.iter().any(|it| it.contains("without a node")),
        "{warnings:?}"
    );
    // Not where something else is broken, or the document is something else.
    document["nodes"][0]["mesh"] = json!("no number");
    let broken = read(document.to_string().as_bytes()).unwrap_err();
    assert!(broken.to_string().contains("broken"), "{broken}");
    assert!(read(b"[1]").is_err());
}

#[test]
fn cameras_and_animations_are_chosen_by_name() {
    let mut document = animated(json!([
        {"name": "still", "channels": [channel(0, 0, "translation")], "samplers": [sampler(3, "STEP")]},
        {"name": "dolly", "channels": [channel(0, 1, "translation")], "samplers": [sampler(3, "STEP")]},
    ]));
    document["nodes"]
        .as_array_mut()
        .unwrap()
        .push(json!({"name": "top", "camera": 0, "translation": [0, 9, 0]}));
    document["scenes"] = json!([{"nodes": [0, 1, 2]}]);
    let options = |camera: Option<&str>, animation: Option<&str>| GltfOptions {
        camera: camera.map(str::to_owned),
        animation: animation.map(str::to_owned),
    };
    let first = chosen(&document, GltfOptions::default()).unwrap();
    assert_eq!((first.scene.tracks.len(), first.scene.joints.len()), (1, 1));
    let warned = |words: &str| first.warnings.iter().any(|it| it.contains(words));
    assert!(warned("several animations"));
    for name in ["dolly", "1"] {
        let dolly = chosen(&document, options(None, Some(name))).unwrap();
        assert_eq!(dolly.scene.tracks.len(), 3);
    }
    let top = chosen(&document, options(Some("top"), Some("dolly"))).unwrap();
    assert_eq!(top.scene.camera.unwrap().eye, DVec3::new(0.0, 9.0, 0.0));
    // The track of the light alone.
    assert_eq!(top.scene.tracks.len(), 1);
    let error = chosen(&document, options(Some("side"), None)).unwrap_err();
    assert!(
        error.cause.contains("side") && error.remedy.contains("top"),
        "{error}"
    );
    let error = chosen(&document, options(None, Some("2"))).unwrap_err();
    assert!(error.remedy.contains("still, dolly, or `none`"), "{error}");
    // Unless an animation is called so.
    let none = chosen(&document, options(None, Some("none"))).unwrap();
    assert_eq!((none.scene.tracks.len(), none.scene.joints.len()), (0, 0));
    let mut warnings = none.warnings.iter();
    assert!(!warnings.any(|it| it.contains("animation")));
    document["animations"][1]["name"] = json!("none");
    let dolly = chosen(&document, options(None, Some("none"))).unwrap();
    assert_eq!(dolly.scene.tracks.len(), 3);
}

#[test]
fn skins_that_are_asked_for_are_rejected() {
    let mut document = animated(
        json!([{"name": "bend", "channels": [channel(0, 2, "rotation")],
        "samplers": [sampler(4, "LINEAR")]}]),
    );
    document["nodes"]
        .as_array_mut()
        .unwrap()
        .push(json!({"name": "joint"}));
    document["scenes"] = json!([{"nodes": [0, 1, 2]}]);
    document["nodes"][0]["skin"] = json!(0);
    document["skins"] = json!([{"joints": [2]}]);
    let bend = GltfOptions {
        animation: Some(String::from("bend")),
        ..GltfOptions::default()
    };
    let error = chosen(&document, bend).unwrap_err();
    assert!(error.cause.contains("\"tile\" by a skin"), "{error}");
    let warnings = chosen(&document, GltfOptions::default()).unwrap().warnings;
    assert!(
        warnings.iter().any(|it| it.contains("bends")),
        "{warnings:?}"
    );
}

#[test]
fn broken_channels_are_rejected() {
    let animation = |channel: Value, sampler: Value| {
        let document = animated(json!([{"channels": [channel], "samplers": [sampler]}]));
        read(document.to_string().as_bytes()).unwrap_err().cause
    };
    let translated = |node| channel(0, node, "translation");
    assert!(animation(translated(7), sampler(3, "LINEAR")).contains("that there is not"));
    assert!(animation(translated(1), sampler(4, "LINEAR")).contains("accessor 4"));
    assert!(animation(translated(1), sampler(3, "CUBICSPLINE")).contains("not a value for each"));
    assert!(animation(channel(0, 1, "rotation"), sampler(3, "LINEAR")).contains("accessor 3"));
    assert!(
        animation(channel(1, 1, "translation"), sampler(3, "LINEAR")).contains("animations[0]")
    );
    let backwards = json!({"input": 2, "output": 3});
    let mut document = animated(json!([{"channels": [translated(1)], "samplers": [backwards]}]));
    document["accessors"][2]["bufferView"] = document["accessors"][3]["bufferView"].clone();
    let error = read(document.to_string().as_bytes()).unwrap_err();
    assert!(error.cause.contains("do not ascend"), "{error}");
}

#[test]
fn spots_are_warned_of_only_where_they_turn() {
    for (path, output, warns) in [("translation", 3, false), ("rotation", 4, true)] {
        let mut document = animated(
            json!([{"channels": [channel(0, 1, path)], "samplers": [sampler(output, "LINEAR")]}]),
        );
        document["extensions"]["KHR_lights_punctual"]["lights"] =
            json!([{"type": "spot", "spot": {}}]);
        let warnings = read(document.to_string().as_bytes()).unwrap().warnings;
        let spots = warnings
            .iter()
            .any(|it| it.contains("spot lights that turn"));
        assert_eq!(spots, warns, "{path}: {warnings:?}");
    }
}

/// Replaces the times of keys, which are 0, 1 and 2 seconds.
pub(super) fn set_times(document: &mut Value, times: [f32; 3]) {
    let uri = document["buffers"][1]["uri"].as_str().unwrap().to_owned();
    let (head, data) = uri.split_once(',').unwrap();
    let mut bytes = STANDARD.decode(data).unwrap();
    for (place, seconds) in times.into_iter().enumerate() {
        bytes[4 * place..][..4].copy_from_slice(&seconds.to_le_bytes());
    }
    document["buffers"][1]["uri"] = json!(format!("{head},{}", STANDARD.encode(bytes)));
}

#[test]
fn keys_within_a_tick_are_told_apart() {
    let mut document = animated(json!([{"channels": [channel(0, 1, "translation")],
        "samplers": [sampler(3, "LINEAR")]}]));
    set_times(&mut document, [0.0, 0.000_001, 0.000_002]);
    let (tracks, _) = tracks(&document);
    let times = tracks[0].keys.iter().map(|key| key.seconds);
    let times: Vec<_> = times.collect();
    // The compiler rejects the track, and shows both times.
    assert!(
        times[0] == 0.0 && times[1] > 0.0 && times[1] < 2e-6,
        "{times:?}"
    );
}

/// The seconds of a file have 24 bits, and can lie just behind the tick to which they are rounded.
#[test]
fn a_rig_takes_each_step_at_its_tick() {
    let mut document = animated(json!([{"channels": [channel(0, 2, "translation")],
        "samplers": [sampler(3, "STEP")]}]));
    set_times(&mut document, [0.0, 0.1, 0.2]);
    let nodes = document["nodes"].as_array_mut().unwrap();
    nodes.push(json!({"children": [1]}));
    document["scenes"] = json!([{"nodes": [0, 2]}]);
    let (tracks, _) = tracks(&document);
    let eye = &tracks[0].keys;
    let at = |seconds: f64| eye.iter().find(|key| key.seconds == seconds).unwrap();
    let first = eye[0].vector();
    for (seconds, moved) in [(0.1, [1.0, 0.0, 0.0]), (0.2, [1.0, 2.0, 0.0])] {
        assert_eq!(at(seconds).vector() - first, DVec3::from_array(moved));
    }
    assert_eq!(at(4_799.0 / 48_000.0).vector(), first);
}

/// Two keys within a tick are a jump: one moves to the adjacent tick.
#[test]
fn keys_of_a_jump_keep_their_order() {
    let ticks = |times: &[f64]| -> Vec<f64> {
        let key = |&seconds: &f64| Key {
            seconds: seconds / 48_000.0,
            ..Key::default()
        };
        let mut curve = Curve {
            interpolation: Interpolation::Linear,
            keys: times.iter().map(key).collect(),
        };
        curve.round_times();
        let ticks = curve.keys.iter().map(|key| key.seconds * 48_000.0);
        ticks.map(|it| (it * 1e6).round() / 1e6).collect()
    };
    assert_eq!(ticks(&[0.0, 9.6, 10.0, 20.0]), [0.0, 9.0, 10.0, 20.0]);
    assert_eq!(ticks(&[0.0, 10.0, 10.4, 20.0]), [0.0, 10.0, 11.0, 20.0]);
    assert_eq!(ticks(&[0.0, 0.4]), [0.0, 1.0]);
    // There is no tick left.
    assert_eq!(ticks(&[9.0, 9.7, 10.0]), [9.0, 9.7, 10.0]);
}
