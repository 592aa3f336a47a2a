//! Tests of the choice of a camera.

use super::*;

/// Two cameras whose names are those of each other's nodes; the first has this field of view.
fn crossed(yfov: f64) -> Value {
    let camera = |name: &str, yfov: f64, aspect: f64| {
        let perspective = json!({"yfov": yfov, "znear": 1, "aspectRatio": aspect});
        json!({"name": name, "type": "perspective", "perspective": perspective})
    };
    let mut document = document();
    document["cameras"] = json!([camera("b", yfov, 2.0), camera("a", 1.0, 1.0)]);
    document["nodes"] = json!([
        {"mesh": 0},
        {"camera": 0, "name": "a", "translation": [0, 0, 5]},
        {"camera": 1, "name": "b", "translation": [0, 0, 7]},
    ]);
    document["scenes"][0]["nodes"] = json!([0, 2, 1]);
    document
}

#[test]
fn a_camera_is_known_by_its_node_first() {
    for (name, place, width) in [("a", 5.0, 480), ("b", 7.0, 240)] {
        let options = GltfOptions {
            camera: Some(name.to_owned()),
            ..GltfOptions::default()
        };
        let found = chosen(&crossed(1.0), options).unwrap();
        assert_eq!(found.scene.camera.unwrap().eye.z, place, "{name}");
        assert_eq!(found.scene.render.width, width, "{name}");
    }
}

#[test]
fn several_cameras_are_said_where_one_can_be_chosen() {
    let said = |document: &Value| {
        let mut all = warnings(document);
        all.retain(|it| it.contains("several cameras"));
        all.join("")
    };
    let mut document = crossed(1.0);
    assert!(said(&document).ends_with("is used; choose one with `--camera`"));
    for number in 0..2 {
        for list in ["cameras", "nodes"] {
            let number = number + usize::from(list == "nodes");
            document[list][number]
                .as_object_mut()
                .unwrap()
                .remove("name");
        }
    }
    assert!(said(&document).ends_with("name their nodes to choose one with `--camera`"));
    document["cameras"][0] = json!({
        "type": "orthographic",
        "orthographic": {"xmag": 2, "ymag": 2, "znear": 0.1, "zfar": 100},
    });
    assert_eq!(said(&document), "");
}

#[test]
fn aspect_ratios_that_are_not_above_0_are_ignored_with_a_warning() {
    let mut document = document();
    for (ratio, width, expected) in [(2.0, 480, 0), (0.0, 320, 1), (-2.0, 320, 1)] {
        document["cameras"][0]["perspective"]["aspectRatio"] = json!(ratio);
        assert_eq!(scene(&document).render.width, width, "{ratio}");
        let warnings = warnings(&document);
        assert_eq!(warnings.len(), expected, "{ratio}: {warnings:?}");
        assert!(warnings.iter().all(|it| it.contains("the aspect ratio")));
    }
}

#[test]
fn a_camera_that_sees_nothing_is_named() {
    for yfov in [0.0, -1.0, 3.2] {
        let options = GltfOptions {
            camera: Some("a".to_owned()),
            ..GltfOptions::default()
        };
        // By the name of the other node's camera.
        let found = chosen(&crossed(yfov), options).unwrap();
        assert_eq!(found.scene.camera.unwrap().eye.z, 7.0);
        let warned = |it: &String| it.contains("yfov");
        assert!(found.warnings.iter().any(warned), "{:?}", found.warnings);
        let mut document = crossed(yfov);
        document["scenes"][0]["nodes"] = json!([0, 1]);
        let options = GltfOptions {
            camera: Some("a".to_owned()),
            ..GltfOptions::default()
        };
        let error = chosen(&document, options).unwrap_err();
        assert!(error.cause.contains("yfov"), "{error}");
        let found = chosen(&document, GltfOptions::default()).unwrap();
        assert!(found.scene.camera.is_none() && found.warnings.iter().any(warned));
    }
}
