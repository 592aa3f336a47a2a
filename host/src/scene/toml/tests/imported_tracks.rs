//! Tracks of imports that come along, and those that do not.

use super::load_in;
use crate::scene::{Scene, TrackTarget};
use tempfile::TempDir;

/// A sphere whose material `m` goes from one color to another in a second, if it does.
fn ball(material: &str, end: Option<&str>) -> String {
    let track = end.map(|end| {
        format!("[[track]]\ntarget = 'material.{material}.diffuse'\ntimes = [0, 1]\nvalues = [0.8, {end}]\n")
    });
    format!(
        "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = '{material}'\n\
         [material.{material}]\ndiffuse = 0.8\n{}",
        track.unwrap_or_default()
    )
}

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let green = "[0, 1, 0]";
    for (name, text) in [
        ("green", ball("m", Some(green))),
        ("also_green", ball("m", Some(green))),
        ("blue", ball("m", Some("[0, 0, 1]"))),
        ("still", ball("m", None)),
        ("fallback", ball("default", Some(green))),
        (
            "turntable",
            "[[track]]\ntarget = 'camera.orbit'\ntimes = [0, 4]\nvalues = [0, 360]\n\
             [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n"
                .into(),
        ),
    ] {
        std::fs::write(folder.path().join(name).with_extension("toml"), text).unwrap();
    }
    folder
}

fn import(file: &str) -> String {
    format!("[[object]]\nkind = 'import'\nfile = '{file}.toml'\n")
}

/// The last color of the track of an object's material.
fn end_of(scene: &Scene, object: usize) -> Option<[f64; 4]> {
    let material = scene.objects[object].material;
    let mut tracks = scene.tracks.iter();
    let track = tracks.find(|it| it.target.is_of_material() && it.index == material);
    track.map(|it| it.keys[1].value)
}

#[test]
fn materials_that_are_equal_at_rest_keep_their_own_tracks() {
    let folder = folder();
    let [green, blue] = [[0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]].map(Some);
    for (files, ends, materials) in [
        (["green", "blue"], [green, blue], 2),
        (["blue", "green"], [blue, green], 2),
        (["green", "still"], [green, None], 2),
        (["still", "green"], [None, green], 2),
        // These move alike.
        (["green", "also_green"], [green, green], 1),
        (["green", "green"], [green, green], 1),
        (["still", "still"], [None, None], 1),
    ] {
        let text = files.map(import).concat();
        let scene = load_in(folder.path(), &text).unwrap().scene;
        assert_eq!([0, 1].map(|it| end_of(&scene, it)), ends, "{files:?}");
        assert_eq!(scene.materials.len(), materials, "{files:?}");
    }
}

#[test]
fn objects_without_a_material_do_not_move_with_an_imported_one() {
    let folder = folder();
    let own = "[[object]]\nkind = 'sphere'\ncenter = [3, 0, 0]\nradius = 1\n";
    for (text, ours) in [
        (format!("{own}{}", import("fallback")), 0),
        (format!("{}{own}", import("fallback")), 1),
    ] {
        let scene = load_in(folder.path(), &text).unwrap().scene;
        assert_eq!(end_of(&scene, ours), None, "{text}");
        assert!(end_of(&scene, 1 - ours).is_some(), "{text}");
    }
}

#[test]
fn a_track_of_the_importing_scene_comes_first() {
    let folder = folder();
    let own = "[[track]]\ntarget = 'material.m.diffuse'\ntimes = [0, 1]\nvalues = [1, [1, 0, 0]]\n";
    let text = format!("{}{own}", import("green"));
    let scene = load_in(folder.path(), &text).unwrap().scene;
    assert_eq!(end_of(&scene, 0), Some([1.0, 0.0, 0.0, 0.0]));
    assert_eq!(scene.tracks.len(), 1);
}

#[test]
fn tracks_that_do_not_come_along_are_warned_of() {
    let folder = folder();
    let painted = format!(
        "{}material = 'x'\n[material.x]\ndiffuse = 0.1\n",
        import("green")
    );
    for (text, lost) in [
        (
            painted,
            "the tracks of this import's materials move nothing",
        ),
        (
            import("turntable"),
            "the tracks of this import's camera do not come along",
        ),
    ] {
        let imported = load_in(folder.path(), &text).unwrap();
        let [warning] = &imported.warnings[..] else {
            panic!("{:?}", imported.warnings)
        };
        assert!(
            warning.contains("scene.toml:1: ") && warning.contains(lost),
            "{warning}"
        );
        let tracks = imported.scene.tracks;
        let lost = |it: TrackTarget| it.is_of_camera() || it.is_of_material();
        assert!(!tracks.iter().any(|it| lost(it.target)));
    }
    // In a file of its own it is a turntable.
    let text = std::fs::read_to_string(folder.path().join("turntable.toml")).unwrap();
    let imported = load_in(folder.path(), &text).unwrap();
    assert_eq!(
        (imported.scene.tracks.len(), imported.warnings.len()),
        (1, 0)
    );
}
