//! Faces of different shapes in one plane at right angles to an axis: every ray meets the one that comes first in the
//! scene file, in every format and structure.

use glam::{DVec3, Vec3Swizzles};
use gridel_core::{Format, Scene, Structure};
use gridel_host::scene::Shape;
use gridel_host::shape::{Cone, Cuboid, Disc, Plane};
use gridel_host::trace::{Query, SceneHit, SceneRay, trace};
use gridel_tests::effort::part_of;
use gridel_tests::query::held;
use gridel_tests::random::Random;
use gridel_tests::scenes;

/// The reach of the shapes from the middle of the face, and the height of solid ones.
const REACH: f64 = 0.9;
const HEIGHT: f64 = 1.3;

/// Every shape with such a face, around a point of it; those that are solid lie where `up` points.
fn with_faces(middle: DVec3, up: DVec3) -> Vec<(&'static str, Shape)> {
    let across = DVec3::ONE - up.abs();
    let cone = |base_radius, apex_radius| Cone {
        base: middle,
        base_radius,
        apex: middle + HEIGHT * up,
        apex_radius,
    };
    let turned = Cone {
        base: middle + HEIGHT * up,
        base_radius: 1.1,
        apex: middle,
        apex_radius: 1.4,
    };
    let corners = [middle - 1.5 * across, middle + 1.5 * across + HEIGHT * up];
    vec![
        (
            "plane",
            Shape::Plane(Plane {
                point: middle + 7.0 * up.yzx(),
                normal: -up,
            }),
        ),
        (
            "disc",
            Shape::Disc(Disc {
                center: middle,
                normal: up,
                radius: 1.4,
            }),
        ),
        (
            "box",
            Shape::Box(Cuboid {
                min: corners[0].min(corners[1]),
                max: corners[0].max(corners[1]),
            }),
        ),
        ("cylinder", Shape::Cone(cone(1.5, 1.5))),
        ("cone", Shape::Cone(cone(1.6, 1.0))),
        ("frustum on its head", Shape::Cone(turned)),
    ]
}

/// Rays from within the solids, from without and from far away, which meet the face first.
fn rays(middle: DVec3, up: DVec3, random: &mut Random) -> [SceneRay; 3] {
    let mut beside = |reach: f64| {
        let [a, b] = [random.signed(), random.signed()].map(|it| 0.7 * reach * it);
        middle + a * up.yzx() + b * up.zxy()
    };
    let (target, near, far) = (beside(REACH), beside(REACH), beside(8.0));
    let from = |origin: DVec3| SceneRay {
        origin,
        tmin: 0.0,
        direction: target - origin,
        tmax: f64::INFINITY,
    };
    [
        from(near + 0.9 * HEIGHT * up),
        from(far - 3.1 * up),
        from(target + 2e3 * (far - middle) - 7e3 * up),
    ]
}

#[test]
fn the_first_of_faces_in_one_plane_is_met() {
    fn meet_first(name: &str, scene: &Scene<'_>, rays: &[SceneRay]) {
        let mut hits = vec![SceneHit::MISS; rays.len()];
        for structure in held(scene).chain([Structure::List]) {
            for format in Format::ALL {
                let query = Query {
                    format,
                    structure,
                    any: false,
                };
                trace(scene, rays, query, &mut hits).expect("a structure");
                for (ray, hit) in rays.iter().zip(&hits) {
                    let way = (format, structure);
                    assert_eq!(hit.object, 0, "{name}, {way:?}, {ray:?}: {hit:?}");
                }
            }
        }
    }
    let mut random = Random(33);
    for up in [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::Y] {
        let middle = DVec3::new(0.37, -0.21, 0.63);
        let shapes = with_faces(middle, up);
        for first in 0..shapes.len() {
            for second in (0..shapes.len()).filter(|&it| it != first) {
                let pair = [&shapes[first], &shapes[second]];
                let name = format!("{} before {}, {up}", pair[0].0, pair[1].0);
                let blob = scenes::blob(&scenes::of(pair.map(|it| it.1.clone())), 24);
                let scene = blob.scene().expect("a scene");
                let rays = (0..part_of(8, 400)).flat_map(|_| rays(middle, up, &mut random));
                meet_first(&name, &scene, &rays.collect::<Vec<_>>());
            }
        }
    }
}
