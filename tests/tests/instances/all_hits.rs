//! All hits through instances: each structure lists the same, and placed closed meshes are crossed an even number of
//! times.

use super::{blob, instance, part, placement, random_ray, random_scene};
use crate::all_hits::all_agree;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::{Number, Scene, Solid, Stack, Structure};
use gridel_host::scene::{Scene as Model, Shape};
use gridel_tests::effort::{part_of, sixth_of};
use gridel_tests::every_format;
use gridel_tests::query::UnitRay;
use gridel_tests::random::Random;
use gridel_tests::scenes;

#[test]
fn instances_are_listed_alike_through_every_structure() {
    fn compare<N: Number>(scene: &Scene<'_>, count: usize) {
        let mut random = Random(0x4a11);
        let mut stack = Stack::<MAX_STACK_DEPTH>::new();
        let (mut met, mut differ) = (0, 0);
        for _ in 0..count {
            let (from, way) = random_ray(&mut random, scene);
            let ray = UnitRay::new(from.into(), way.into());
            let hits = all_agree::<N>("instances", scene, &ray);
            // Rays are not aimed at edges, where the rules differ.
            let ready = ray.ready::<N>(scene).expect("a ray");
            let closest = scene.closest_hit(&ready, stack.as_view());
            met += usize::from(closest.is_some());
            differ += usize::from(closest.is_some() != (hits > 0));
        }
        eprintln!(
            "{}: {met} of {count} rays hit, {differ} differ",
            N::FORMAT.name()
        );
        assert!(met > 0 && differ == 0, "{met} rays hit, {differ} differ");
    }
    let mut random = Random(0x1a57);
    for (own, instances) in [(0, 1), (3, 1), (0, 9), (5, 20)] {
        let model = random_scene(&mut random, own, instances);
        let blob = blob(&model, &Structure::ALL);
        let scene = blob.scene().expect("a scene");
        let count = part_of(sixth_of(300), 20_000);
        every_format!(compare(&scene, count));
    }
}

#[test]
fn placed_closed_meshes_are_crossed_an_even_number_of_times() {
    fn parity<N: Number>(scene: &Scene<'_>, count: usize) {
        let mut random = Random(0x9a);
        let mut stack = Stack::<MAX_STACK_DEPTH>::new();
        let (mut crossed, mut contained) = (0, 0);
        for _ in 0..count {
            let through = [(); 3].map(|()| 30_000.0 * random.signed());
            let direction = if random.one_in(2) {
                random.direction()
            } else {
                [0.0, 0.0, 1.0]
            };
            let origin = [0, 1, 2].map(|k| through[k] - 1e6 * direction[k]);
            let ray = UnitRay::new(origin, direction);
            let ready = ray.ready::<N>(scene).expect("a ray");
            let hits = scene.count_hits(&ready, stack.as_view());
            assert!(
                hits.is_multiple_of(2),
                "{}: {hits} hits of {ray:?}",
                N::FORMAT.name()
            );
            crossed += u32::from(hits > 0);
            let solids = (0..scene.instances().len() as u32).map(|index| Solid {
                object: 0,
                instance: Some(index),
            });
            let point = through.map(N::far_from_f64);
            let inside = solids
                .filter(|&solid| scene.contains::<N>(solid, point, stack.as_view()) == Ok(true));
            contained += inside.count();
        }
        assert!(crossed > 0 && contained > 0, "{crossed} {contained}");
    }
    let mut random = Random(0xba11);
    let (vertices, triangles) = scenes::icosphere(2);
    let ball = Shape::Mesh {
        vertices,
        triangles,
    };
    let model = Model {
        parts: vec![part("ball", [ball])],
        instances: (0..12)
            .map(|_| instance(0, placement(&mut random, 4.0, [0.5, 2.0])))
            .collect(),
        ..scenes::of([])
    };
    let blob = blob(&model, &[Structure::DualSplit, Structure::Wide]);
    let scene = blob.scene().expect("a scene");
    every_format!(parity(&scene, part_of(sixth_of(6000), 1_000_000)));
}
