//! The scene files of the project hold what their comments promise.

use crate::scene::{Diffuse, Light, MoleculeOptions, Object, Scene};
use std::collections::BTreeSet;
use std::path::Path;

fn fixture(name: &str) -> Scene {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures");
    let imported = crate::scene::load(&folder.join(name), &MoleculeOptions::default());
    let imported = imported.unwrap_or_else(|error| panic!("{error}; {}", error.remedy));
    assert_eq!(imported.warnings, Vec::<String>::new());
    assert!(imported.scene.camera.is_some() && !imported.scene.lights.is_empty());
    imported.scene
}

fn kinds(scene: &Scene) -> BTreeSet<&'static str> {
    scene
        .objects
        .iter()
        .map(|object| object.shape.kind())
        .collect()
}

#[test]
fn the_chessboard_has_its_squares_and_figures() {
    let scene = fixture("glass-chess.toml");
    assert_eq!(scene.objects.len(), 156);
    let below = |prefix: &str| {
        scene
            .objects
            .iter()
            .filter(|object| object.name.starts_with(prefix))
            .count()
    };
    assert_eq!(
        (below("board/"), below("white/"), below("black/")),
        (64, 43, 43)
    );
    let figure = |object: &Object| {
        let mut path = object.name.split('/');
        let army = path
            .next()
            .filter(|army| ["white", "black"].contains(army))?;
        Some(format!("{army}/{}", path.next()?))
    };
    let figures: BTreeSet<_> = scene.objects.iter().filter_map(figure).collect();
    assert_eq!(figures.len(), 32);
    assert_eq!(scene.lights.len(), 2);
    assert!(
        !kinds(&scene).contains("mesh"),
        "a mirrored box must stay a box"
    );
}

#[test]
fn the_room_has_five_walls_two_blocks_and_two_balls() {
    let scene = fixture("cornell.toml");
    let count = |wanted| {
        scene
            .objects
            .iter()
            .filter(|object| object.shape.kind() == wanted)
            .count()
    };
    assert_eq!((count("box"), count("mesh"), count("sphere")), (5, 2, 2));
}

#[test]
fn the_quick_scene_shows_every_shape_and_every_effect() {
    let scene = fixture("quick.toml");
    let all = [
        "box", "cone", "cylinder", "disc", "frustum", "mesh", "sphere", "triangle",
    ];
    assert_eq!(kinds(&scene), BTreeSet::from(all));
    let black = [0.0; 3];
    let any = |effect: fn(&crate::scene::Material) -> bool| scene.materials.iter().any(effect);
    assert!(any(|material| matches!(
        material.diffuse,
        Diffuse::Checker { .. }
    )));
    assert!(any(
        |material| material.transmit != [0.0; 3] && material.absorption != [0.0; 3]
    ));
    assert!(any(|material| material.mirror != [0.0; 3]));
    assert!(any(|material| material.highlight != [0.0; 3]));
    assert!(scene.background.is_some_and(|it| it != black) && scene.ambient != black);
    assert!(matches!(
        scene.lights[..],
        [Light::Point { .. }, Light::Directional { .. }]
    ));
}

#[test]
fn each_stress_scene_holds_one_shape_and_nothing_that_reflects() {
    for shape in [
        "sphere", "triangle", "box", "disc", "cylinder", "cone", "frustum", "torus", "plane",
    ] {
        let scene = fixture(&format!("stress-{shape}.toml"));
        assert_eq!(kinds(&scene), BTreeSet::from([shape]));
        assert!((20..=60).contains(&scene.objects.len()));
        let dull = |material: &crate::scene::Material| {
            material.mirror == [0.0; 3] && material.transmit == [0.0; 3]
        };
        assert!(scene.materials.iter().all(dull));
    }
}

#[test]
fn the_arm_has_six_instances_on_a_chain_of_joints() {
    let scene = fixture("robot-arm.toml");
    let names: Vec<_> = scene.joints.iter().map(|it| it.name.as_str()).collect();
    assert_eq!(
        names,
        ["turret", "shoulder", "elbow", "wrist", "left", "right"]
    );
    assert_eq!((scene.parts.len(), scene.instances.len()), (4, 6));
    // It comes back, and the hand is down at the ball on its way.
    let [start, there, end] = [0.0, 2.0, 4.0].map(|seconds| scene.instances_at(seconds));
    for (one, other) in start.iter().zip(&end) {
        let [one, other] = [one, other].map(|it| it.placement.point(glam::DVec3::Y));
        assert!(one.distance(other) < 1e-9, "{one} {other}");
    }
    let hand = there[3].placement.translation;
    assert!(
        hand.distance(glam::DVec3::new(1.64, 0.83, 0.0)) < 0.01,
        "{hand}"
    );
}
