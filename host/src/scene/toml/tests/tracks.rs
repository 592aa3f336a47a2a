//! Tracks: targets, values and tangents.

use super::{load, scene};
use crate::scene::{Interpolation, Key, Track, TrackTarget};
use glam::DVec3;

const SCENE: &str = "\
    [material.red]\n\
    [material.board]\nchecker = { even = 0, odd = 1 }\n\
    [[light]]\nkind = 'point'\nposition = [0, 5, 0]\nname = 'lamp'\n\
    [[light]]\nkind = 'directional'\ndirection = [0, -1, 0]\nname = 'a.b'\n\
    [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'red'\n\
    [[object]]\nkind = 'sphere'\ncenter = [2, 0, 0]\nradius = 1\nmaterial = 'board'\n";

fn track(rest: &str) -> Track {
    let mut tracks = scene(&format!("{SCENE}[[track]]\n{rest}")).tracks;
    assert_eq!(tracks.len(), 1);
    tracks.remove(0)
}

#[test]
fn targets_are_found_by_name_and_number() {
    for (target, value, expected, index) in [
        ("camera.eye", "[1, 2, 3]", TrackTarget::CameraEye, 0),
        ("camera.target", "[1, 2, 3]", TrackTarget::CameraTarget, 0),
        ("camera.up", "[0, 1, 0]", TrackTarget::CameraUp, 0),
        ("camera.fov", "30", TrackTarget::CameraFieldOfView, 0),
        ("camera.orbit", "-720", TrackTarget::CameraOrbit, 0),
        (
            "light.0.position",
            "[1, 2, 3]",
            TrackTarget::LightPosition,
            0,
        ),
        ("light.lamp.color", "0.5", TrackTarget::LightColor, 0),
        (
            "light.a.b.direction",
            "[1, 0, 0]",
            TrackTarget::LightDirection,
            1,
        ),
        ("light.1.color", "'#ffffff'", TrackTarget::LightColor, 1),
        (
            "material.red.diffuse",
            "[0.1, 0.2, 0.3]",
            TrackTarget::MaterialDiffuse,
            1,
        ),
        (
            "material.board.checker.even",
            "0.5",
            TrackTarget::MaterialDiffuse,
            0,
        ),
        (
            "material.board.checker.odd",
            "0.5",
            TrackTarget::MaterialOdd,
            0,
        ),
        (
            "material.red.highlight",
            "0.5",
            TrackTarget::MaterialHighlight,
            1,
        ),
        ("material.red.mirror", "0.5", TrackTarget::MaterialMirror, 1),
        (
            "material.red.transmit",
            "0.5",
            TrackTarget::MaterialTransmit,
            1,
        ),
    ] {
        let track = track(&format!(
            "target = '{target}'\ntimes = [0]\nvalues = [{value}]"
        ));
        assert_eq!(track.target, expected, "{target}");
        if expected.is_of_material() {
            // Tables of materials are in the order of the parser.
            let scene = scene(SCENE);
            let name = target.split('.').nth(1).unwrap();
            assert_eq!(scene.materials[track.index].name, name);
        } else {
            assert_eq!(track.index, index, "{target}");
        }
        assert_eq!(track.interpolation, Interpolation::Linear);
    }
}

#[test]
fn splines_have_given_or_smooth_tangents() {
    let text = "target = 'camera.eye'\ninterpolation = 'cubic'\ntimes = [0, 1, 3, 4]\n\
        values = [[0, 0, 0], [1, 2, 3], [6, 3, 0], [0, 0, 0]]";
    let tangents = |track: &Track| -> Vec<[f64; 4]> {
        assert!(track.keys.iter().all(|key| key.entering == key.leaving));
        track.keys.iter().map(|key: &Key| key.leaving).collect()
    };
    let still = [0.0; 4];
    let slopes = [[2.0, 1.0, 0.0, 0.0], [-1.0 / 3.0, -2.0 / 3.0, -1.0, 0.0]];
    assert_eq!(tangents(&track(text)), [still, slopes[0], slopes[1], still]);
    let given = format!("{text}\ntangents = [[1, 0, 0], [0, 2, 0], [0, 0, 3], [0, 0, 0]]");
    let given = track(&given);
    assert_eq!(tangents(&given)[1], [0.0, 2.0, 0.0, 0.0]);
    assert_eq!(given.keys[2].vector(), DVec3::new(6.0, 3.0, 0.0));
}

#[test]
fn a_material_of_no_object_moves_nothing_and_is_named() {
    let text = format!(
        "{SCENE}[material.lost]\n[[track]]\ntarget = 'material.lost.diffuse'\ntimes = [0]\nvalues = [0]"
    );
    let imported = load(&text).unwrap();
    let [warning] = &imported.warnings[..] else {
        panic!("{:?}", imported.warnings)
    };
    assert!(
        warning.contains("lost") && warning.contains("moves nothing"),
        "{warning}"
    );
}

#[test]
fn tracks_of_the_directions_of_spots_are_rejected_as_such() {
    let text = "[[light]]\nkind = 'spot'\nposition = [0, 5, 0]\ndirection = [0, -1, 0]\nname = 'lamp'\n\
        [[track]]\ntarget = 'light.lamp.direction'\ntimes = [0]\nvalues = [[0, -1, 0]]\n";
    let error = load(text).unwrap_err().to_string();
    assert!(
        error.contains("is a spot, whose `direction` cannot move yet"),
        "{error}"
    );
}

#[test]
fn names_of_lights_that_are_numbers_come_before_numbers() {
    let light =
        |name: &str| format!("[[light]]\nname = '{name}'\nkind = 'point'\nposition = [0, 5, 0]\n");
    let lights = light("1") + &light("0") + &light("x");
    for (name, index) in [("1", 0), ("0", 1), ("2", 2), ("x", 2)] {
        let track =
            format!("[[track]]\ntarget = 'light.{name}.color'\ntimes = [0]\nvalues = [0]\n");
        let scene = scene(&format!("{lights}{track}"));
        assert_eq!(scene.tracks[0].index, index, "{name}");
    }
    let track = "[[track]]\ntarget = 'light.3.color'\ntimes = [0]\nvalues = [0]\n";
    let error = load(&format!("{lights}{track}")).unwrap_err();
    assert!(error.cause.contains("the scene has 3 lights"), "{error}");
}

#[test]
fn tangents_of_values_that_are_one_number_are_no_arrays() {
    for (target, values) in [("camera.fov", "[40, 50]"), ("camera.orbit", "[0, 90]")] {
        let text = |tangents: &str| {
            format!(
                "{SCENE}[[track]]\ntarget = '{target}'\ninterpolation = 'cubic'\ntimes = [0, 1]\n\
                 values = {values}\ntangents = {tangents}\n"
            )
        };
        load(&text("[1, 2]")).unwrap();
        assert!(load(&text("[[1, 5, 7], [2, 5, 7]]")).is_err(), "{target}");
    }
}
