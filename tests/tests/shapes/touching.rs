//! Hits where a kernel's rounding decides: spheres that touch the scene's box, and surfaces at a ray's origin.

use glam::DVec3;
use gridel_core::{Format, Scene, Structure};
use gridel_host::scene::Shape;
use gridel_host::shape::{Cuboid, Sphere};
use gridel_host::trace::{Query, SceneHit, SceneRay, trace};
use gridel_tests::effort::part_of;
use gridel_tests::query::held;
use gridel_tests::random::Random;
use gridel_tests::scenes;

/// The hits of rays through a structure.
fn hits(
    scene: &Scene<'_>,
    rays: &[SceneRay],
    format: Format,
    structure: Structure,
) -> Vec<SceneHit> {
    let mut hits = vec![SceneHit::MISS; rays.len()];
    let query = Query {
        format,
        structure,
        any: false,
    };
    trace(scene, rays, query, &mut hits).expect("a structure");
    hits
}

/// A ray to a point of a surface with this normal: from without, or from within or beyond to behind its origin.
fn ray_to(point: DVec3, normal: DVec3, random: &mut Random) -> SceneRay {
    let direction = loop {
        let direction = DVec3::from_array(random.direction());
        if direction.dot(normal) < -0.2 {
            break direction * random.magnitude(0.1, 10.0);
        }
    };
    let back = random.magnitude(0.01, 100.0) * [1.0, 1.0, -0.01, -1.0][random.below(4)];
    SceneRay {
        origin: point - back * direction,
        tmin: if back > 0.0 { 0.0 } else { -1e6 },
        direction,
        tmax: f64::INFINITY,
    }
}

#[test]
fn spheres_that_touch_the_box_of_a_scene_are_entered() {
    let mut random = Random(41);
    for (radius, bits) in [(1.0, 24), (1.0, 16), (0.7, 12), (0.3, 10)] {
        let ball = Shape::Sphere(Sphere {
            center: DVec3::ZERO,
            radius,
        });
        let blob = scenes::blob(&scenes::of([ball]), bits);
        let scene = blob.scene().expect("a scene");
        // The lattice moves the surface by up to a step.
        let tolerance = 4.0 * radius * f64::powi(0.5, bits.into()) + 1e-5;
        for normal in [DVec3::X, DVec3::Y, DVec3::Z]
            .into_iter()
            .flat_map(|axis| [axis, -axis])
        {
            let rays: Vec<_> = (0..part_of(300, 20_000))
                .map(|_| ray_to(radius * normal, normal, &mut random))
                .collect();
            for format in Format::ALL {
                for structure in held(&scene).chain([Structure::List]) {
                    for (ray, hit) in rays.iter().zip(hits(&scene, &rays, format, structure)) {
                        let point = ray.origin + hit.t * ray.direction;
                        let apart = point.distance(radius * normal);
                        assert!(
                            apart < 10.0 * tolerance,
                            "{format:?}, {structure:?}, {bits} bits, {ray:?}: {apart} apart, {hit:?}"
                        );
                    }
                }
            }
        }
    }
}

/// Shapes with whole coordinates, some of which touch each other.
fn whole_numbers(random: &mut Random) -> Vec<Shape> {
    let point = |random: &mut Random, most: i32| {
        DVec3::from_array([0; 3].map(|_| random.within(-most, most).into()))
    };
    (0..4)
        .map(|k| {
            let min = point(random, 2);
            if k % 2 == 0 {
                let size = [0; 3].map(|_| random.within(1, 2).into());
                let max = min + DVec3::from_array(size);
                Shape::Box(Cuboid { min, max })
            } else {
                Shape::Sphere(Sphere {
                    center: min,
                    radius: random.within(1, 2).into(),
                })
            }
        })
        .collect()
}

#[test]
fn what_is_met_at_the_origin_is_the_same_through_every_structure() {
    let mut random = Random(43);
    for _ in 0..part_of(60, 2000) {
        let shapes = whole_numbers(&mut random);
        let blob = scenes::blob(&scenes::of(shapes.clone()), 24);
        let scene = blob.scene().expect("a scene");
        let whole = |random: &mut Random, most: i32| {
            DVec3::from_array([0; 3].map(|_| random.within(-most, most).into()))
        };
        let rays: Vec<_> = (0..60)
            .map(|_| SceneRay {
                origin: whole(&mut random, 4),
                tmin: f64::from(-random.within(0, 1)),
                direction: whole(&mut random, 1),
                tmax: f64::INFINITY,
            })
            .filter(|ray| ray.direction != DVec3::ZERO)
            .collect();
        for format in Format::ALL {
            let expected = hits(&scene, &rays, format, Structure::List);
            for structure in held(&scene) {
                let found = hits(&scene, &rays, format, structure);
                for ((ray, expected), found) in rays.iter().zip(&expected).zip(&found) {
                    let about = || format!("{format:?}, {structure:?}, {ray:?} in {shapes:?}");
                    assert_eq!(found.object, expected.object, "{}", about());
                    assert_eq!(found.t.to_bits(), expected.t.to_bits(), "{}", about());
                }
            }
        }
    }
}
