//! Comparisons of scenes with instances.

use super::{Options, compare};
use crate::compile::{self, compile};
use crate::scene::{ImportOptions, Instances, Scene, read};
use gridel_core::Structure;
use gridel_core::format::record::UnitBox;
use std::fmt::Write;

fn scene(text: &str) -> Scene {
    let options = ImportOptions::default();
    read("a.toml".as_ref(), text.into(), &options)
        .expect("a scene")
        .scene
}

/// Two balls, and three instances of three more.
fn balls() -> Scene {
    scene(
        "[camera]\neye = [1, 2, 12]\ntarget = [1, 0, 0]\n\
         [[light]]\nkind = 'point'\nposition = [2, 9, 6]\n\
         [[object]]\nkind = 'sphere'\ncenter = [0, -2, 0]\nradius = 0.8\n\
         [[object]]\nkind = 'sphere'\ncenter = [2, -2, 0]\nradius = 0.9\n\
         [[part]]\nname = 'some'\nobject = [\
           { kind = 'sphere', center = [0, 0, 0], radius = 0.5 },\
           { kind = 'sphere', center = [0.7, 0, 0], radius = 0.4 },\
           { kind = 'sphere', center = [0, 0.9, 0.2], radius = 0.5 }]\n\
         [[instance]]\npart = 'some'\n\
         [[instance]]\npart = 'some'\ntranslate = [2, 0, 0]\nscale = 0.7\n\
         [[instance]]\npart = 'some'\ntranslate = [1, 1, 1]\nrotate = [20, 40, 60]\n",
    )
}

fn counted(structures: &[Structure]) -> Options<'static> {
    Options {
        structures: structures.to_vec(),
        size: [32, 24],
        repeats: 0,
        compiling: compile::Options {
            gridels: Some(1),
            ..compile::Options::default()
        },
        ..Options::default()
    }
}

#[test]
fn brute_force_tests_all_of_every_part_that_is_entered() {
    let options = counted(&[Structure::List, Structure::DualSplit]);
    let comparison = compare(&balls(), &options, &|_| ()).expect("a comparison");
    let instances = comparison.instances.expect("instances");
    assert_eq!((instances.instances, instances.parts), (3, Some(1)));
    assert_eq!(instances.choice, Instances::Keep);
    assert_eq!(
        (instances.stored_primitives, instances.placed_primitives),
        (5, 11)
    );
    let [list, dual_split] = &comparison.rows[..] else {
        panic!("two rows")
    };
    let work = list.work.expect("right").primary;
    let entered = work.instances.expect("instances");
    assert!(entered > 0.1, "{entered}");
    // Those of the scene itself, and three for each instance.
    assert!((work.primitives - (2.0 + 3.0 * entered)).abs() < 1e-9);
    // Two boxes and twelve planes for each pair of the hierarchy above instances.
    assert!((work.planes - 6.0 * work.boxes).abs() < 1e-9 && work.boxes >= 2.0);
    let other = dual_split.work.expect("right").primary;
    assert!(other.boxes > work.boxes && other.primitives < work.primitives);
    assert_eq!((list.sah_cost, dual_split.sah_cost), (None, None));
}

#[test]
fn structures_agree_with_brute_force_in_instances() {
    let options = counted(&Structure::ALL);
    let comparison = compare(&balls(), &options, &|_| ()).expect("a comparison");
    assert_eq!(comparison.rows.len(), Structure::ALL.len());
    for row in &comparison.rows {
        assert_eq!(row.wrong, None, "{}", row.name);
    }
}

/// The boxes that a scene has, itself or in its first part, through a structure.
fn bounds(scene: &Scene, structure: Structure) -> UnitBox {
    let options = compile::Options {
        structures: vec![structure],
        ..compile::Options::default()
    };
    let blob = compile(scene, &options).expect("a blob").blob;
    let scene = blob.scene().expect("a scene");
    *scene.parts().first().unwrap_or(&scene).bounds()
}

/// An octree may divide more than the box of a thin scene, and rays in a part start at its box.
#[test]
fn thin_parts_have_one_box_through_all_structures() {
    let mut tiles = String::new();
    for number in 0..100 {
        let (x, y) = (number % 10, number / 10);
        let (right, top) = (f64::from(x) + 0.9, f64::from(y) + 0.9);
        let _ = write!(
            tiles,
            "{{ kind = 'box', min = [{x}, {y}, 0], max = [{right}, {top}, 0.001] }},"
        );
    }
    let own = scene(&format!("object = [{tiles}]\n"));
    let boxes = [Structure::List, Structure::Octree].map(|it| bounds(&own, it));
    assert_ne!(boxes[0], boxes[1]);
    let placed = scene(&format!(
        "[[part]]\nname = 'floor'\nobject = [{tiles}]\n\
         [[instance]]\npart = 'floor'\nrotate = [10, 20, 30]\n\
         [[instance]]\npart = 'floor'\ntranslate = [0, 0, 3]\n"
    ));
    let boxes = [Structure::List, Structure::Octree].map(|it| bounds(&placed, it));
    assert_eq!(boxes[0], boxes[1]);
    let options = counted(&[Structure::Flagged, Structure::Octree]);
    let comparison = compare(&placed, &options, &|_| ()).expect("a comparison");
    for row in &comparison.rows {
        assert_eq!(row.wrong, None, "{}", row.name);
    }
}
