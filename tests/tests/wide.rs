//! The eight-wide hierarchy alone in a blob, where triangles and spheres lie in its clusters only.

use glam::DVec3;
use gridel_core::{Kind, List, NoCount, Number, SimdLevel, Structure, Wide};
use gridel_host::blob::Blob;
use gridel_host::compile::{Options, Quality, compile};
use gridel_host::scene::{Scene, Shape};
use gridel_host::shape::Sphere;
use gridel_host::trace::{Frame, Query, SceneHit, trace};
use gridel_tests::effort::part_of;
use gridel_tests::query::{HitBits, any, closest};
use gridel_tests::random::Random;
use gridel_tests::{every_format, rays, scenes};

fn alone(scene: &Scene, lattice_bits: u8, quality: Quality) -> Blob {
    let options = Options {
        structures: vec![Structure::Wide],
        lattice_bits,
        quality,
        ..Options::default()
    };
    compile(scene, &options).expect("compiles").blob
}

/// Meshes whose strips are full, soups whose strips are joined, and every other shape.
fn some_scenes() -> Vec<(String, Scene)> {
    let mut all = vec![
        (String::from("soup of 60"), scenes::soup(11, 60, 0.4)),
        (String::from("soup of 900"), scenes::soup(12, 900, 0.1)),
        // More than one search of its compiler looks at.
        (
            String::from("soup of 3000 that overlap"),
            scenes::soup(15, 3000, 1.0),
        ),
    ];
    all.extend(scenes::fixtures());
    let real = ["meshes/cow.obj", "meshes/soup.stl", "spd/balls_s2.nff"];
    all.extend(real.iter().filter_map(|name| {
        let path = scenes::real(name)?;
        Some(((*name).to_owned(), scenes::read(&path)))
    }));
    all
}

/// Compares hits of three: brute force of an ordinary blob, and brute force and the hierarchy of one with clusters
/// only.
fn agrees<N: Number>(name: &str, ordinary: &gridel_core::Scene<'_>, own: &gridel_core::Scene<'_>) {
    let total: usize = Kind::ALL.iter().map(|&kind| own.count(kind)).sum();
    let rays = part_of(600_000, 3_000_000) / (total + 200);
    let mut hits = 0;
    for ray in rays::rays(ordinary, 23).take(rays) {
        let Some(ready) = ray.ready::<N>(ordinary) else {
            continue;
        };
        let bits = |hit: Option<gridel_core::Hit<N>>| hit.as_ref().map(HitBits::of);
        let expected = bits(closest::<N, List>(ordinary, &ready, &mut NoCount));
        let listed = bits(closest::<N, List>(own, &ready, &mut NoCount));
        let found = bits(closest::<N, Wide>(own, &ready, &mut NoCount));
        let about = || format!("{name}, {}: {ray:?}", N::FORMAT.name());
        assert_eq!(expected, listed, "list: {}", about());
        assert_eq!(expected, found, "wide: {}", about());
        assert_eq!(
            expected.is_some(),
            any::<N, Wide>(own, &ready),
            "{}",
            about()
        );
        hits += usize::from(expected.is_some());
    }
    eprintln!("{name:24} {:5}: {rays} rays, {hits} hits", N::FORMAT.name());
}

#[test]
fn clusters_alone_give_the_answers_of_the_list() {
    for (name, scene) in some_scenes() {
        for (bits, quality) in [
            (24, Quality::Good),
            (16, Quality::Best),
            (12, Quality::Fast),
        ] {
            let (ordinary, own) = (scenes::blob(&scene, bits), alone(&scene, bits, quality));
            let (ordinary, own) = (
                ordinary.scene().expect("sound"),
                own.scene().expect("sound"),
            );
            for kind in Kind::ALL {
                assert_eq!(ordinary.count(kind), own.count(kind), "{name}");
            }
            every_format!(agrees(&name, &ordinary, &own));
        }
    }
}

/// Hits through one scene with every level of instructions, and through the facade that users call.
fn levels_agree<N: Number>(name: &str, scene: &gridel_core::Scene<'_>) {
    let portable = scene.with_simd(SimdLevel::Portable);
    for level in SimdLevel::available().filter(|level| *level != SimdLevel::Portable) {
        let fast = scene.with_simd(level);
        let (mut hits, mut queries) = (0, Vec::new());
        for ray in rays::rays(scene, 29).take(4_000) {
            let Some(ready) = ray.ready::<N>(scene) else {
                continue;
            };
            let bits = |scene: &gridel_core::Scene<'_>| {
                let hit: Option<gridel_core::Hit<N>> =
                    closest::<N, Wide>(scene, &ready, &mut NoCount);
                (hit.as_ref().map(HitBits::of), any::<N, Wide>(scene, &ready))
            };
            let (expected, found) = (bits(&portable), bits(&fast));
            assert_eq!(expected, found, "{name}, {}: {ray:?}", N::FORMAT.name());
            hits += usize::from(found.1);
            queries.push(Frame::of(scene).scene_ray(&ray));
        }
        assert!(hits > 0, "{name}: no ray hits");
        for any in [false, true] {
            let query = Query {
                format: N::FORMAT,
                structure: Structure::Wide,
                any,
            };
            let traced = [&portable, &fast].map(|scene| {
                let mut hits = vec![SceneHit::MISS; queries.len()];
                trace(scene, &queries, query, &mut hits).expect("a structure");
                hits
            });
            assert!(traced[0] == traced[1], "{name}, {}", N::FORMAT.name());
        }
    }
}

#[test]
fn every_level_of_instructions_gives_the_same_bits() {
    for (name, scene) in some_scenes() {
        for bits in [24, 16] {
            let blob = alone(&scene, bits, Quality::Good);
            let scene = blob.scene().expect("sound");
            every_format!(levels_agree(&name, &scene));
        }
    }
}

/// The slots of primitives that lie in clusters lead to all of them.
#[test]
fn slots_of_clusters_are_all_primitives() {
    let scene = scenes::soup(13, 500, 0.2);
    let (ordinary, own) = (scenes::blob(&scene, 24), alone(&scene, 24, Quality::Good));
    let (ordinary, own) = (
        ordinary.scene().expect("sound"),
        own.scene().expect("sound"),
    );
    for kind in Kind::ALL {
        let all = |scene: &gridel_core::Scene<'_>| {
            let slots = 0..scene.count(kind);
            let mut all: Vec<_> = slots
                .map(|slot| {
                    let bounds = scene.primitive_bounds(kind, slot).expect("a primitive");
                    (
                        scene.primitive(kind, slot as u32),
                        bounds.0,
                        scene.triangle(slot),
                    )
                })
                .collect();
            all.iter_mut().for_each(|it| {
                if kind != Kind::Triangle {
                    it.2 = None;
                }
            });
            all.sort();
            all
        };
        assert_eq!(all(&ordinary), all(&own), "{}", kind.name());
    }
}

/// Spheres of so many different radii: packs share a window of radii or have windows of their own, and
/// the last may not be full.
#[test]
fn packs_hold_any_radii() {
    for (count, different) in [
        (1, 1),
        (8, 8),
        (40, 16),
        (41, 15),
        (41, 16),
        (40, 17),
        (203, 203),
    ] {
        let mut random = Random(15 + count);
        let scene = scenes::of((0..count).map(|number| {
            Shape::Sphere(Sphere {
                center: DVec3::from_array([0; 3].map(|_| random.signed())),
                radius: 0.05 + 0.2 * ((number % different) as f64 / different as f64),
            })
        }));
        for bits in [24, 16] {
            let (ordinary, own) = (
                scenes::blob(&scene, bits),
                alone(&scene, bits, Quality::Good),
            );
            let (ordinary, own) = (
                ordinary.scene().expect("sound"),
                own.scene().expect("sound"),
            );
            assert_eq!(own.count(Kind::Sphere), count as usize);
            let name = format!("{count} spheres of {different} radii");
            every_format!(agrees(&name, &ordinary, &own));
        }
    }
}

#[test]
fn the_number_of_threads_changes_no_byte() {
    let scene = scenes::soup(14, 6000, 0.03);
    let build = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let blob = pool
            .expect("threads")
            .install(|| alone(&scene, 20, Quality::Good));
        blob.bytes().to_vec()
    };
    let one = build(1);
    assert!(one == build(2) && one == build(5));
}
