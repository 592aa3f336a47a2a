//! Forgeries of blobs with one structure each, and with all of them: what loads answers as brute force
//! does.
//!
//! By default some thousand forgeries of each, and twenty times as many with `GRIDEL_FULL=1`. The 10^7
//! that the project promises take minutes for each structure:
//!
//! ```text
//! GRIDEL_FORGERIES=10000000 cargo test -p gridel-tests --test suite mutants -- --nocapture
//! ```

use glam::DVec3;
use gridel_core::Structure;
use gridel_core::format::SectionKind;
use gridel_host::compile::{Options, compile};
use gridel_host::scene::{Diffuse, Light, Scene, Shape};
use gridel_host::shape::Sphere;
use gridel_tests::effort::part_of;
use gridel_tests::fuzz::{Base, Forger, agree, moves, some_rays};
use gridel_tests::random::Random;
use gridel_tests::scenes;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

/// One in this many must load, so that the test covers loaded blobs.
const LOADED: u64 = 100;

fn forgeries() -> u64 {
    let asked = std::env::var("GRIDEL_FORGERIES").ok();
    let few = part_of(5_000, 100_000) as u64;
    asked.map_or(few, |text| text.parse().expect("a number of forgeries"))
}

/// Every kind of primitive, in two leaves and more.
fn mixed() -> Scene {
    scenes::soup(21, 16, 0.4)
}

/// More spheres than a pack holds, of radii up to a fifth of the scene.
fn spheres() -> Scene {
    let mut random = Random(4);
    let sphere = |number: u32| {
        Shape::Sphere(Sphere {
            center: DVec3::new((number % 3).into(), (number / 3).into(), random.unit()),
            radius: random.magnitude(0.1, 0.9),
        })
    };
    scenes::of((0..11).map(sphere))
}

/// Blobs of some structures, as they were compiled and loosened.
fn bases(structures: &[Structure]) -> Vec<Base> {
    let mut bases = Vec::new();
    for (scene, lattice_bits) in [
        (mixed(), 24),
        (mixed(), 16),
        (spheres(), 24),
        (spheres(), 16),
        (scenes::of([scenes::sheet(3)]), 20),
    ] {
        let options = Options {
            structures: structures.to_vec(),
            lattice_bits,
            gridels: Some(1),
            budget: Some(4096),
            slab_directions: 3,
            ..Options::default()
        };
        let blob = compile(&scene, &options).expect("compiles").blob;
        bases.push(Base::of(blob.bytes()));
        bases.extend(Base::loose(blob.bytes()));
    }
    bases
}

/// Forges, and holds what loads to brute force.
fn holds(structures: &[Structure]) {
    let forgeries = forgeries();
    let mut forger = Forger::new(bases(structures), 11);
    while forger.made < forgeries {
        let number = forger.made;
        forger.forge(|scene, blob| {
            let rays = some_rays(scene, number);
            let agrees = AssertUnwindSafe(|| {
                agree(scene, &rays);
                moves(scene, blob);
            });
            if let Err(panic) = catch_unwind(agrees) {
                let folder = std::env::temp_dir();
                let path = folder.join(format!("forged-{number}.gridel"));
                std::fs::write(&path, blob.bytes()).expect("the forgery is kept");
                eprintln!("forgery {number}: {}", path.display());
                resume_unwind(panic);
            }
        });
    }
    let names: Vec<_> = structures.iter().map(|it| it.name()).collect();
    let (made, loaded) = (forger.made, forger.loaded);
    eprintln!("{}: {made} forgeries, {loaded} loaded", names.join(" "));
    assert!(LOADED * loaded >= made, "too few loaded");
}

macro_rules! alone {
    ($($test:ident: $structure:ident;)*) => {
        $(
            #[test]
            fn $test() {
                holds(&[Structure::$structure]);
            }
        )*
    };
}

alone! {
    forged_list_answers_as_brute_force: List;
    forged_bvh_answers_as_brute_force: Bvh;
    forged_flagged_answers_as_brute_force: Flagged;
    forged_dual_split_answers_as_brute_force: DualSplit;
    forged_wide_answers_as_brute_force: Wide;
    forged_slabs_answer_as_brute_force: Slabs;
    forged_flagged_slabs_answer_as_brute_force: FlaggedSlabs;
    forged_spheres_answer_as_brute_force: Spheres;
    forged_grid_answers_as_brute_force: Grid;
    forged_octree_answers_as_brute_force: Octree;
    forged_cylinder_cube_finds_no_more_than_brute_force: CylinderCube;
    forged_tight_cylinder_cube_finds_no_more_than_brute_force: CylinderCubeTight;
    forged_entry_cylinder_cube_finds_no_more_than_brute_force: CylinderCubeEntry;
    forged_apex_finds_no_more_than_brute_force: Apex;
    forged_ray_classes_find_no_more_than_brute_force: RayClasses;
}

#[test]
fn forged_blobs_of_all_structures_answer_as_brute_force() {
    holds(&Structure::ALL);
}

/// Tracks of everything that moves: what loads has a state at any time.
#[test]
fn forged_tracks_are_rejected_or_harmless() {
    let mut scene = mixed();
    let color = [0.8; 3];
    scene.lights = vec![
        Light::Point {
            position: DVec3::new(3.0, 4.0, 5.0),
            color,
        },
        Light::Directional {
            direction: DVec3::NEG_Y,
            color,
        },
    ];
    scene.materials[0].diffuse = Diffuse::Checker {
        even: [0.9; 3],
        odd: [0.1; 3],
        size: 0.2,
        origin: DVec3::ZERO,
    };
    scene.materials[0].mirror = [0.5; 3];
    let bases = [false, true].map(|by_rotation| {
        let mut scene = scene.clone();
        scene.tracks = scenes::moving(&scene, by_rotation);
        let options = Options {
            structures: vec![Structure::List],
            ..Options::default()
        };
        let blob = compile(&scene, &options).expect("compiles").blob;
        assert!(moves(&blob.scene().expect("a scene"), &blob));
        let mut base = Base::of(blob.bytes());
        // Without names, most forgeries are of tracks.
        base.remove(&[SectionKind::NameStarts, SectionKind::NameText]);
        base
    });
    let mut forger = Forger::new(bases.to_vec(), 12);
    let (mut accepted, forgeries) = (0, 4 * forgeries());
    while forger.made < forgeries {
        forger.forge(|scene, blob| accepted += u64::from(moves(scene, blob)));
    }
    let (made, loaded) = (forger.made, forger.loaded);
    eprintln!("tracks: {made} forgeries, {loaded} loaded, {accepted} with tracks");
    assert!(LOADED * accepted >= made, "too few loaded");
    assert!(20 * (loaded - accepted) >= made, "too few rejected");
}
