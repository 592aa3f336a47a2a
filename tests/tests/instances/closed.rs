//! A closed part is closed under every map, and rays leave it.

use super::{blob, instance, part, placement, random_ray, ray};
use glam::DVec3;
use gridel_core::{Fixed, Number, Scene as Loaded, Structure};
use gridel_host::scene::Shape;
use gridel_tests::effort::part_of;
use gridel_tests::every_format;
use gridel_tests::query::{held, through};
use gridel_tests::random::Random;
use gridel_tests::scenes;

/// Returns how many rays to and from points inside a closed part miss it or hit the wrong side.
fn leaks<N: Number>(scene: &Loaded<'_>, random: &mut Random, count: usize) -> usize {
    let [low, high] = [0, 1].map(|side| scene.bounds().0.map(|axis| f64::from(axis[side])));
    let [low, high] = [low, high].map(DVec3::from_array);
    let (middle, half) = (low.midpoint(high), (high - low).min_element() / 2.0);
    let mut leaks = 0;
    for _ in 0..count {
        let inside = middle + 0.3 * half * DVec3::from_array(random.direction());
        let way = DVec3::from_array(random.direction());
        let outside = inside - 4.0 * half * way;
        let leaves = ray::<N>(scene, inside, way);
        let enters = ray::<N>(scene, outside, way);
        for (ray, front) in [(leaves, false), (enters, true)] {
            for structure in held(scene) {
                let (hit, any) = through(structure, scene, &ray);
                leaks += usize::from(!(any && hit.is_some_and(|hit| hit.front == front)));
            }
        }
    }
    leaks
}

#[test]
fn closed_part_is_closed_under_every_map() {
    let structures = [
        Structure::Bvh,
        Structure::Flagged,
        Structure::DualSplit,
        Structure::Wide,
    ];
    let random = &mut Random(3);
    let (vertices, triangles) = scenes::icosphere(3);
    let mesh = Shape::Mesh {
        vertices,
        triangles,
    };
    for _ in 0..part_of(40, 1000) {
        let mut scene = scenes::of([]);
        scene.parts = vec![part("ball", [mesh.clone()])];
        scene.instances = vec![instance(0, placement(random, 50.0, [1e-3, 1e3]))];
        let blob = blob(&scene, &structures);
        let loaded = blob.scene().expect("a scene");
        let count = part_of(20, 840);
        let all = [
            leaks::<Fixed>(&loaded, random, count),
            leaks::<f32>(&loaded, random, count),
            leaks::<f64>(&loaded, random, count),
        ];
        assert_eq!(all, [0; 3], "{:?}", loaded.instances());
    }
}

fn rays_do_not_meet_what_they_leave_in<N: Number>(scene: &Loaded<'_>, random: &mut Random) {
    let mut hits = 0;
    for _ in 0..600 {
        let (from, way) = random_ray(random, scene);
        let Some(hit) = through(Structure::List, scene, &ray::<N>(scene, from, way)).0 else {
            continue;
        };
        hits += 1;
        let normal = DVec3::from_array(hit.normal.map(N::ratio_to_f64));
        let mut away = DVec3::from_array(random.direction());
        if away.dot(normal) < 0.0 {
            away = -away;
        }
        // All parts are convex, so a ray that leaves one does not meet it again.
        let outside = DVec3::from_array(hit.outside().map(N::length_to_f64));
        let again = through(Structure::List, scene, &ray::<N>(scene, outside, away)).0;
        let again = again.filter(|again| again.instance() == hit.instance());
        assert_eq!(again, None, "{:?} after {hit:?}", N::FORMAT);
        // And one that goes in meets it from inside.
        let inside = DVec3::from_array(hit.inside(scene).map(N::length_to_f64));
        let opposite = through(Structure::List, scene, &ray::<N>(scene, inside, -normal)).0;
        assert!(
            opposite.is_some_and(|it| it.instance() == hit.instance() && !it.front),
            "{:?}: {opposite:?} after {hit:?}",
            N::FORMAT
        );
    }
    assert!(hits > 20, "{hits}");
}

#[test]
fn rays_do_not_meet_the_instance_that_they_leave() {
    let random = &mut Random(4);
    for _ in 0..part_of(8, 100) {
        let (vertices, triangles) = scenes::icosphere(1);
        let mesh = Shape::Mesh {
            vertices,
            triangles,
        };
        let mut scene = scenes::of([]);
        let solid =
            |kind: usize, random: &mut Random| scenes::shape(random, kind, DVec3::ZERO, 1.0);
        scene.parts = vec![part("ball", [mesh])];
        for kind in 0..5 {
            let shape = solid(kind, random);
            let kinds = Solids::of(&shape);
            if kinds == Solids::Closed {
                scene.parts.push(part("solid", [shape]));
            }
        }
        scene.instances = (0..scene.parts.len())
            .map(|part| {
                let mut placement = placement(random, 0.0, [0.5, 2.0]);
                placement.translation = DVec3::X * 12.0 * part as f64;
                instance(part, placement)
            })
            .collect();
        let blob = blob(&scene, &[Structure::List]);
        let loaded = blob.scene().expect("a scene");
        every_format!(rays_do_not_meet_what_they_leave_in(&loaded, random));
    }
}

/// Convex solids with an inside, and other shapes.
#[derive(PartialEq)]
enum Solids {
    Closed,
    Other,
}

impl Solids {
    fn of(shape: &Shape) -> Self {
        match shape {
            Shape::Sphere(_) | Shape::Box(_) | Shape::Cone(_) => Self::Closed,
            _ => Self::Other,
        }
    }
}
