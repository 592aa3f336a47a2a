//! Points in solids, and points of triangles.

use super::*;

/// Points in and around solids and closed meshes, except those that lie next to a surface.
#[test]
fn points_are_contained_where_geometry_says_so() {
    fn contained<N: Number>(scene: &Scene<'_>, count: usize) {
        let structures: Vec<_> = Structure::ALL
            .into_iter()
            .filter_map(|it| scene.choose(it))
            .collect();
        let unit = f64::powi(2.0, scene.header().unit_exponent.into());
        let origin = DVec3::from_array(scene.header().origin);
        let mut stack = Stack::<MAX_STACK_DEPTH>::new();
        let mut random = Random(0xc0);
        let mut inside = [0; 5];
        for number in 0..count {
            let place = DVec3::from_array([(); 3].map(|()| 1.5 * random.signed()));
            // Where each solid has its surface: negative inside.
            let depths = [
                place.length() - 1.0,
                (place - 0.5).abs().max_element() - 0.5,
                (place.xy_length() - 1.0).hypot(place.z) - 0.25,
                // The mesh is inscribed in a ball.
                place.length() - 0.7,
                f64::INFINITY,
            ];
            let units = ((place - origin) / unit).to_array().map(N::far_from_f64);
            let scene = &structures[number % structures.len()];
            for (object, depth) in depths.into_iter().enumerate() {
                let between = if object == 3 {
                    -0.01..1e-3
                } else {
                    -1e-3..1e-3
                };
                if between.contains(&depth) {
                    continue;
                }
                let solid = Solid::own(object as u32);
                let found = scene.contains::<N>(solid, units, stack.as_view());
                assert_eq!(
                    found,
                    Ok(depth < 0.0),
                    "{object} {place} {}",
                    N::FORMAT.name()
                );
                inside[object] += usize::from(depth < 0.0);
            }
        }
        assert!(inside[..4].iter().all(|&it| it > count / 50), "{inside:?}");
    }

    trait XyLength {
        fn xy_length(&self) -> f64;
    }

    impl XyLength for DVec3 {
        fn xy_length(&self) -> f64 {
            self.x.hypot(self.y)
        }
    }
    let (vertices, triangles) = scenes::icosphere(4);
    let shapes = [
        Shape::Sphere(Sphere {
            center: DVec3::ZERO,
            radius: 1.0,
        }),
        Shape::Box(Cuboid {
            min: DVec3::ZERO,
            max: DVec3::ONE,
        }),
        Shape::Torus(Torus {
            center: DVec3::ZERO,
            axis: DVec3::Z,
            major_radius: 1.0,
            minor_radius: 0.25,
        }),
        Shape::Mesh {
            vertices: vertices.iter().map(|&v| 0.7 * v).collect(),
            triangles,
        },
        Shape::Disc(Disc {
            center: DVec3::ZERO,
            normal: DVec3::ONE,
            radius: 1.5,
        }),
    ];
    let blob = scenes::blob(&scenes::of(shapes), 24);
    let scene = blob.scene().expect("a scene");
    every_format!(contained(&scene, part_of(sixth_of(6000), 300_000)));
    let outside = containment_ray::<f64>(&scene, [1e9, 0.0, 0.0]);
    assert!(matches!(outside, Ok(None)));
    assert!(containment_ray::<f64>(&scene, [f64::NAN, 0.0, 0.0]).is_err());
}

fn assert_weights(weights: &[f64; 3]) {
    let sum: f64 = weights.iter().sum();
    let are_parts = weights.iter().all(|it| (0.0..=1.0).contains(it));
    assert!(are_parts && (sum - 1.0).abs() < 1e-6, "{weights:?}");
}

/// In a narrow triangle rounding of the point takes weights far off, but their sum stays 1.
#[test]
fn weights_of_narrow_triangles_add_up_to_one() {
    fn weights<N: Number>(scene: &Scene<'_>) {
        let mut stack = Stack::<MAX_STACK_DEPTH>::new();
        let [mut met, bounds] = [0, 32_000];
        let mut random = Random(5);
        for _ in 0..4000 {
            // At a point of the edge that two of the corners share.
            let x = bounds as f64 * random.signed();
            let origin = [
                x + 900.0 * random.signed(),
                x + 900.0 * random.signed(),
                4000.0,
            ];
            let direction = [x - origin[0], x - origin[1], -4000.0];
            let ray = gridel_core::Ray::<N>::from_f64(scene.bounds(), origin, direction, 0.0, 1e9);
            let hit = scene.closest_hit(&ray.expect("a ray"), stack.as_view());
            let Some(weights) = hit.and_then(|hit| hit.barycentric(scene)) else {
                continue;
            };
            met += 1;
            assert_weights(&weights.map(N::ratio_to_f64));
        }
        assert!(met > 100, "{met}");
    }
    let corners = [[-1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, -0.9999, 0.0]];
    let narrow = Shape::Mesh {
        vertices: corners.map(DVec3::from_array).to_vec(),
        triangles: vec![[0, 1, 2]],
    };
    let blob = scenes::blob(&scenes::of([narrow]), 24);
    let scene = blob.scene().expect("a scene");
    every_format!(weights(&scene));
}

/// The weights of the corners make the point.
#[test]
fn barycentric_coordinates_lead_back_to_the_point() {
    fn weights<N: Number>(scene: &Scene<'_>, count: usize) {
        let mut stack = Stack::<MAX_STACK_DEPTH>::new();
        let mut triangles = 0;
        for ray in rays(scene, 2).take(count) {
            let ready = ray.ready::<N>(scene).expect("a ray");
            let Some(hit) = scene.closest_hit(&ready, stack.as_view()) else {
                continue;
            };
            let slot = (0..scene.count(Kind::Triangle))
                .find(|&slot| scene.primitive(Kind::Triangle, slot as u32) == hit.primitive);
            assert_eq!(hit.barycentric(scene).is_some(), slot.is_some());
            let Some((weights, slot)) = hit.barycentric(scene).zip(slot) else {
                continue;
            };
            // Where a ray runs along a triangle, the point may lie off it.
            let across: f64 = (0..3)
                .map(|k| hit.normal[k].ratio_to_f64() * ready.slope()[k].ratio_to_f64())
                .sum();
            if across.abs() < 0.1 {
                continue;
            }
            let weights = weights.map(N::ratio_to_f64);
            let corners = scene.triangle(slot).expect("a triangle");
            assert_weights(&weights);
            for (k, point) in hit.point.into_iter().enumerate() {
                let place: f64 = (0..3)
                    .map(|it| weights[it] * f64::from(corners[it][k]) / 256.0)
                    .sum();
                let point = point.length_to_f64();
                assert!(
                    (place - point).abs() < 0.5,
                    "{place} {point} {}",
                    N::FORMAT.name()
                );
            }
            triangles += 1;
        }
        assert!(triangles > count / 20, "{triangles}");
    }
    let blob = scenes::blob(&scenes::soup(11, 120, 0.6), 24);
    let scene = blob.scene().expect("a scene");
    every_format!(weights(&scene, 2000));
}
