//! Nodes that move, and whose scales mirror or are 0.

use super::animation::{animated, channel, sampler};
use super::*;
use crate::scene::TrackTarget;
use glam::DQuat;

#[test]
fn nodes_of_any_scale_lead_where_they_do_at_rest() {
    let scales = [
        [1, 1, 1],
        [-1, -1, 1],
        [1, -1, 1],
        [-1, 1, -1],
        [1, 1, -1],
        [2, 0, 1],
        [0, 0, 0],
    ];
    for (scale, path) in scales
        .into_iter()
        .flat_map(|it| [(it, "rotation"), (it, "translation")])
    {
        let output = if path == "rotation" { 4 } else { 3 };
        let mut document = animated(json!([{"channels": [channel(0, 2, path)],
            "samplers": [sampler(output, "LINEAR")]}]));
        // The place of the first key, at which the rotation is none.
        document["nodes"]
            .as_array_mut()
            .unwrap()
            .push(json!({"children": [1], "scale": scale, "translation": [0.5, 0.5, 4]}));
        document["scenes"] = json!([{"nodes": [0, 2]}]);
        let imported = read(document.to_string().as_bytes()).unwrap().scene;
        let track = |target| {
            imported
                .tracks
                .iter()
                .find(|it| it.target == target)
                .unwrap()
        };
        let Light::Point { position, .. } = imported.lights[0] else {
            panic!("a point light")
        };
        let moved = track(TrackTarget::LightPosition).keys[0].vector();
        assert!(
            moved.distance(position) < 1e-6,
            "{scale:?} {path}: {moved} {position}"
        );
        let Some(camera) = imported.camera else {
            assert!(scale.contains(&0));
            continue;
        };
        let rotation = DQuat::from_array(track(TrackTarget::CameraRotation).keys[0].value);
        let ahead = (camera.target - camera.eye).normalize();
        assert!(
            (rotation * DVec3::NEG_Z).distance(ahead) < 1e-6,
            "{scale:?} {path}"
        );
        assert!(
            (rotation * DVec3::Y).distance(camera.up.normalize()) < 1e-6,
            "{scale:?} {path}"
        );
    }
}

#[test]
fn the_scale_of_a_cameras_own_node_does_not_turn_it() {
    for scale in [[1, 1, -1], [1, -1, 1], [-1, -1, -1], [3, 2, 1]] {
        for path in [None, Some(("rotation", 4)), Some(("translation", 3))] {
            let mut document = animated(match path {
                Some((path, output)) => json!([{"channels": [channel(0, 1, path)],
                    "samplers": [sampler(output, "LINEAR")]}]),
                None => json!([]),
            });
            document["nodes"][1]["scale"] = json!(scale);
            let imported = read(document.to_string().as_bytes()).unwrap().scene;
            let camera = imported.camera.unwrap();
            let ahead = (camera.target - camera.eye).normalize();
            assert!(
                ahead.distance(DVec3::NEG_Z) < 1e-6 && camera.up.y > 0.0,
                "{scale:?}"
            );
            let turns = imported
                .tracks
                .iter()
                .find(|it| it.target == TrackTarget::CameraRotation);
            assert_eq!(turns.is_some(), path.is_some());
            if let Some(track) = turns {
                let rotation = DQuat::from_array(track.keys[0].value);
                assert!(
                    rotation.dot(DQuat::IDENTITY).abs() > 1.0 - 1e-9,
                    "{scale:?} {path:?}"
                );
            }
        }
    }
}

#[test]
fn a_mirrored_light_shines_alike_at_rest_and_in_steps() {
    for scale in [[1, 1, -1], [1, 1, 1], [-1, 1, -2]] {
        let mut document = animated(json!([{"channels": [channel(0, 1, "rotation")],
            "samplers": [sampler(4, "STEP")]}]));
        document["extensions"]["KHR_lights_punctual"]["lights"] = json!([{"type": "directional"}]);
        document["nodes"][1]["scale"] = json!(scale);
        let imported = read(document.to_string().as_bytes()).unwrap().scene;
        let Light::Directional { direction, .. } = imported.lights[0] else {
            panic!("a directional light")
        };
        let track = imported
            .tracks
            .iter()
            .find(|it| it.target == TrackTarget::LightDirection);
        let first = track.unwrap().keys[0].vector();
        assert!(
            first.normalize().distance(direction.normalize()) < 1e-6,
            "{scale:?}"
        );
    }
}
