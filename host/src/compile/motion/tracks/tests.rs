use crate::compile::{CompileError, Options, compile};
use crate::scene::{Alpha, Scene, read};

const BALL: &str = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'm'\n";

fn scene(text: &str) -> Scene {
    let imported = read(
        "t.toml".as_ref(),
        text.to_owned().into(),
        &Default::default(),
    );
    imported.unwrap_or_else(|error| panic!("{error}")).scene
}

fn compiled(scene: &Scene) -> Result<(), CompileError> {
    compile(scene, &Options::default()).map(|_| ())
}

/// A spline whose tangent is too large.
fn steep(target: &str) -> String {
    format!(
        "[[track]]\ntarget = '{target}'\ninterpolation = 'cubic'\ntimes = [0, 1, 2]\nvalues = [0, 1, 0]\n\
         tangents = [0, 1e9, 0]\n"
    )
}

#[test]
fn errors_of_tracks_name_their_targets_as_scene_files_do() {
    let light = |name: &str| format!("[[light]]\nkind = 'point'\nposition = [0, 9, 0]\n{name}\n");
    let [lamp, nameless] = [light("name = 'lamp'"), light("")];
    let plain = "[material.m]\n";
    let checker = "[material.m]\nchecker = { even = 1, odd = 0 }\n";
    for (target, text) in [
        ("light.lamp.color", format!("{nameless}{lamp}{plain}")),
        ("light.1.color", format!("{lamp}{nameless}{plain}")),
        ("light.0.color", format!("{lamp}{lamp}{plain}")),
        ("material.m.mirror", String::from(plain)),
        ("material.m.diffuse", String::from(plain)),
        ("material.m.checker.even", String::from(checker)),
        ("material.m.checker.odd", String::from(checker)),
        ("camera.orbit", String::from(plain)),
    ] {
        let scene = scene(&format!("{text}{BALL}{}", steep(target)));
        let error = compiled(&scene).unwrap_err().to_string();
        assert!(
            error.contains(&format!("track of {target}: at 1 s")),
            "{error}"
        );
    }
}

#[test]
fn tracks_that_make_glass_of_materials_with_alpha_are_rejected() {
    for (last, transmit, is_rejected) in [(1.0, 0.0, true), (0.0, 0.0, false), (1.0, 0.5, false)] {
        let mut scene = scene(&format!(
            "[material.m]\ntransmit = {transmit}\n{BALL}\
             [[track]]\ntarget = 'material.m.transmit'\ntimes = [0, 1]\nvalues = [0, {last}]\n"
        ));
        compiled(&scene).unwrap();
        // Glass of a glTF file ignores its alpha at all times.
        let mut materials = scene.materials.iter_mut();
        materials.find(|it| it.name == "m").unwrap().alpha = Some(Alpha::CutOut(0.5));
        match compiled(&scene) {
            Ok(()) => assert!(!is_rejected, "{last} {transmit}"),
            Err(error) => {
                let error = error.to_string();
                let says = error.contains("t.toml:8: track of material.m.transmit: ");
                assert!(is_rejected && says && error.contains("`alpha`"), "{error}");
            }
        }
    }
}

fn fault(track: &str) -> String {
    let file =
        format!("[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n[[track]]\n{track}");
    let imported = read("a.toml".as_ref(), file.into(), &Default::default()).unwrap();
    let error = compile(&imported.scene, &Options::default()).unwrap_err();
    error.to_string()
}

#[test]
fn numbers_that_are_too_large_are_named_with_their_limit() {
    for (track, words) in [
        (
            "target = 'camera.orbit'\ntimes = [0, 1]\nvalues = [0, 46080]",
            "at 1 s the angle is not above -46080 and below 46080 degrees, which are 128 turns",
        ),
        (
            "target = 'camera.orbit'\ntimes = [0, 1]\nvalues = [0, -46080]",
            "at 1 s the angle is not above -46080",
        ),
        (
            "target = 'camera.orbit'\ninterpolation = 'cubic'\ntimes = [0, 2]\nvalues = [0, 0]\n\
             tangents = [0, 30000]",
            "at 2 s the tangent is too large: multiplied by the time since the key before, it must be below 46080",
        ),
        (
            "target = 'camera.orbit'\ninterpolation = 'cubic'\ntimes = [0, 2]\nvalues = [0, 0]\n\
             tangents = [-30000, 0]",
            "at 0 s the tangent is too large: multiplied by the time to the next key, it must be below 46080",
        ),
    ] {
        let found = fault(track);
        assert!(found.contains(words), "{found}");
    }
}
