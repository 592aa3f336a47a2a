//! `gridel explain`: its sentences, and options that do not go together.

use crate::program::Folder;

const BALL: &str = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n";
const CAMERA: &str = "[camera]\neye = [0, 0, 4]\ntarget = [0, 0, 0]\n";

/// The edge of an area's shadow sees some of it.
#[test]
fn unlit_samples_are_counted() {
    let folder = Folder::new();
    let scene = "[camera]\neye = [0, 9, 0.01]\ntarget = [0, 0, 0]\nfov = 20\n\
        [[light]]\nkind = 'sphere'\ncenter = [0, 6, 0]\nradius = 0.5\nradiance = 9\n\
        [[object]]\nkind = 'plane'\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\n\
        [[object]]\nkind = 'box'\nmin = [-9, 2, -9]\nmax = [0, 2.1, 9]\n";
    folder.write("a.toml", scene.as_bytes());
    let sentence = |x: u16| {
        let pixel = format!("{x},20");
        let text = folder.done(&[
            "explain",
            "a.toml",
            "--size",
            "60x40",
            "--samples",
            "16",
            "--pixel",
            &pixel,
        ]);
        let lines = text.lines().skip(1);
        let found: Vec<_> = lines
            .filter(|it| it.contains("o light reaches the first hit"))
            .collect();
        found.first().map(|it| String::from(*it))
    };
    let all: Vec<_> = (30..60).map(sentence).collect();
    let some = all
        .iter()
        .flatten()
        .filter(|it| it.starts_with("In "))
        .count();
    assert!(some > 0, "{all:?}");
    assert!(all.contains(&None), "{all:?}");
    let whole = all.iter().flatten().filter(|it| it.starts_with("No light"));
    for sentence in whole {
        assert!(!sentence.contains("samples"), "{sentence}");
    }
}

#[test]
fn scenes_with_glowing_surfaces_have_more_than_ambient_light() {
    let folder = Folder::new();
    let sentence = "The scene has only ambient light.";
    let lamp = "[material.lamp]\nemission = 2\nlights = false\n\
        [[object]]\nkind = 'sphere'\ncenter = [3, 0, 0]\nradius = 1\nmaterial = 'lamp'\n";
    for (scene, expected) in [
        (format!("ambient = 0.5\n{CAMERA}{BALL}"), true),
        (
            format!("ambient = 0\nrender.bounces = 2\n{CAMERA}{lamp}{BALL}"),
            false,
        ),
        (
            format!("ambient = 0.5\nrender.bounces = 2\n{CAMERA}{lamp}{BALL}"),
            false,
        ),
    ] {
        folder.write("a.toml", scene.as_bytes());
        let text = folder.done(&["explain", "a.toml", "--pixel", "160,120"]);
        assert_eq!(text.contains(sentence), expected, "{scene}{text}");
    }
}

#[test]
fn steps_that_are_not_listed_are_counted() {
    let folder = Folder::new();
    let count = 20_100;
    let mut scene = String::from("ambient = 1\nobject = [\n");
    for number in 0..count {
        let x = 3 + number % 150;
        let y = number / 150;
        scene.push_str(&format!(
            "{{ kind = 'sphere', center = [{x}, {y}, 0], radius = 0.4 }},\n"
        ));
    }
    scene.push_str("]\n");
    folder.write("a.toml", scene.as_bytes());
    let explain = [
        "explain",
        "a.toml",
        "--accel",
        "list",
        "--ray",
        "0,0,5,0,0,-1",
    ];
    let text = folder.done(&explain);
    assert!(text.contains("20,100 primitives tested"), "{text:.400}");
    assert!(
        text.contains("100 further steps were not listed"),
        "no sentence"
    );
    let walk = &folder.json(&explain)["samples"][0]["rays"][0]["walk"];
    assert_eq!(
        (&walk["candidates"], &walk["unlisted"]),
        (&20_100.into(), &100.into())
    );
    assert_eq!(walk["steps"].as_array().unwrap().len(), 20_000);
}

/// A ray that hits nothing, and one that hits an object without a name.
#[test]
fn objects_of_json_are_a_table_in_every_pixel() {
    let folder = Folder::new();
    folder.write("a.toml", format!("{CAMERA}{BALL}").as_bytes());
    for pixel in ["0,0", "160,120"] {
        let report = folder.json(&["explain", "a.toml", "--pixel", pixel]);
        assert!(report["objects"].is_object(), "{report}");
    }
}

#[test]
fn intervals_reject_what_does_not_change_them() {
    let folder = Folder::new();
    folder.write("a.toml", format!("ambient = 1\n{BALL}").as_bytes());
    let intervals = ["explain", "a.toml", "--pixel", "3,3", "--interval"];
    for option in [["--format", "fixed"], ["--accel", "grid"]] {
        folder.fails(
            2,
            &[&intervals[..], &option[..]].concat(),
            &[option[0], "--interval"],
        );
    }
    let report = folder.json(&intervals);
    assert!(report["warnings"].is_array(), "{report}");
}
