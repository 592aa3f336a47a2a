//! Single triangles: hard cases D6 to D10. Meshes without holes are in `watertight`.

use super::{hold_all, of_every_sort};
use glam::DVec3;
use gridel_core::{List, NoCount, Number, Scene};
use gridel_host::scene::Shape;
use gridel_host::shape::Cuboid;
use gridel_host::shape::Solid;
use gridel_tests::cases::{Case, lattice, slope};
use gridel_tests::effort::part_of;
use gridel_tests::every_format;
use gridel_tests::query::{UnitRay, closest};
use gridel_tests::random::Random;
use gridel_tests::scenes;

fn point(random: &mut Random, size: f64) -> DVec3 {
    DVec3::from_array([0; 3].map(|_| random.signed() * size)).map(lattice)
}

#[test]
fn triangles_and_rays_of_every_sort_hold_the_bounds() {
    of_every_sort(1);
}

/// Needles a step of the lattice wide, and triangles of the least area that the lattice has. t
/// comes from the plane, so it is as accurate as that of any other (D6, D7, D9).
#[test]
fn needles_and_specks_hold_the_bounds() {
    let mut random = Random(7);
    let step = 1.0 / 256.0;
    let cases: Vec<Case> = (0..part_of(80, 4000))
        .map(|number| {
            let (long, place) = if number % 2 == 0 {
                (9000.0, 9000.0)
            } else {
                (0.02, 25_000.0)
            };
            let corners = loop {
                let a = point(&mut random, place);
                let b = (a + point(&mut random, long)).map(lattice);
                let aside = DVec3::from_array([0; 3].map(|_| random.within(-1, 1).into())) * step;
                let c = (a + (b - a) * random.unit()).map(lattice) + aside;
                if (b - a).cross(c - a) != DVec3::ZERO {
                    break [a, b, c];
                }
            };
            let rays = (0..40).map(|_| {
                let [a, b, c] = corners;
                let (s, t) = (random.unit(), random.unit());
                let target = a + ((b - a) * s + (c - a) * (1.0 - s)) * t;
                let distance = random.magnitude(1.0, 9000.0);
                let origin = target + point(&mut random, distance);
                (
                    origin.map(lattice).to_array(),
                    slope(target - origin + DVec3::X * 1e-9),
                )
            });
            Case {
                class: "needle",
                rays: rays.collect(),
                solid: Solid::Triangle(corners),
            }
        })
        .collect();
    hold_all("needles and specks", "triangle", &cases);
}

/// Rays in a triangle's plane have a hit with a finite t in the triangle's own range, or none.
/// Triangles without area have no hits and do no harm (D8).
#[test]
fn coplanar_rays_have_a_finite_hit_or_none() {
    fn trace<N: Number>(scene: &Scene<'_>, corners: [DVec3; 3], random: &mut Random) {
        for _ in 0..100 {
            let [a, b, c] = corners;
            let mix = |s: f64, t: f64| a + (b - a) * s + (c - a) * t;
            let from = mix(3.0 * random.signed(), 3.0 * random.signed());
            let to = mix(random.unit(), random.unit());
            if from == to {
                continue;
            }
            let ray = UnitRay::new(from.to_array(), (to - from).to_array());
            let ray = ray.ready::<N>(scene).expect("a ray");
            if let Some(hit) = closest::<N, List>(scene, &ray, &mut NoCount) {
                let t = N::far_to_f64(hit.t);
                assert!((0.0..1e6).contains(&t), "{t}");
                assert!(
                    hit.normal
                        .iter()
                        .all(|x| x.ratio_to_f64().abs() <= 1.000_001)
                );
            }
        }
    }
    let mut random = Random(8);
    for number in 0..part_of(60, 2000) {
        let a = point(&mut random, 9000.0);
        let (b, c) = match number % 3 {
            0 => (point(&mut random, 9000.0), point(&mut random, 9000.0)),
            // On a line, and at one point.
            1 => (a + DVec3::splat(4.0), a - DVec3::splat(8.0)),
            _ => (a, a),
        };
        let shapes = [
            Shape::Mesh {
                vertices: vec![a, b, c],
                triangles: vec![[0, 1, 2], [0, 0, 1], [2, 2, 2]],
            },
            Shape::Box(Cuboid {
                min: DVec3::splat(32_000.0),
                max: DVec3::splat(32_700.0),
            }),
        ];
        let blob = scenes::blob(&scenes::of(shapes), 24);
        let scene = blob.scene().expect("a scene");
        let unit = f64::powi(2.0, scene.header().unit_exponent.into());
        let place = DVec3::from_array(scene.header().origin);
        let corners = [a, b, c].map(|corner| (corner - place) / unit);
        every_format!(trace(&scene, corners, &mut random));
    }
}

/// Triangles on which other tracers failed (D10). No ray hits three corners on a line (pbrt's
/// `Triangle.BadCases`). Another ray is shot at a vertex that two triangles share.
#[test]
fn rays_miss_corners_on_a_line_and_hit_shared_vertices() {
    let line = [
        DVec3::new(-1_113.454_59, -79.049_614, -56.243_190_8),
        DVec3::new(-1_113.454_59, -87.092_269_9, -56.243_190_8),
        DVec3::new(-1_113.454_59, -79.209_014_9, -56.243_190_8),
    ];
    let quad = [
        DVec3::new(0.0, 0.0, 0.0),
        DVec3::new(1.0, 0.0, 0.0),
        DVec3::new(1.0, 1.0, 0.0),
        DVec3::new(0.0, 1.0, 0.0),
    ];
    fn hits<N: Number>(scene: &Scene<'_>, origin: DVec3, direction: DVec3, expected: bool) {
        let unit = f64::powi(2.0, scene.header().unit_exponent.into());
        let place = DVec3::from_array(scene.header().origin);
        let origin = (origin - place) / unit;
        let ray = UnitRay::new(origin.to_array(), direction.to_array());
        let ray = ray.ready::<N>(scene).expect("a ray");
        let hit = closest::<N, List>(scene, &ray, &mut NoCount);
        assert_eq!(hit.is_some(), expected, "{}", N::FORMAT.name());
    }
    let blob = scenes::blob(
        &scenes::of([Shape::Mesh {
            vertices: line.to_vec(),
            triangles: vec![[0, 1, 2]],
        }]),
        24,
    );
    let scene = blob.scene().expect("a scene");
    every_format!(hits(
        &scene,
        DVec3::new(-1_081.479_25, 99.999_954_2, 87.770_111_1),
        DVec3::new(-32.107_299_8, -183.355_865, -144.607_635),
        false
    ));
    let blob = scenes::blob(
        &scenes::of([Shape::Mesh {
            vertices: quad.to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
        }]),
        24,
    );
    let scene = blob.scene().expect("a scene");
    for corner in [quad[0], quad[2], (quad[0] + quad[2]) * 0.5] {
        every_format!(hits(&scene, corner + DVec3::Z, -DVec3::Z, true));
    }
}
