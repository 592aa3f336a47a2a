//! Maps of every exponent: parts that are a speck of their scene, and parts that are larger than it.

use super::{blob, instance, linear, part, placement, point, ray};
use crate::instances::blobs::patched;
use glam::{DQuat, DVec3};
use gridel_core::format::instance::Instance as Record;
use gridel_core::format::record::UnitBox;
use gridel_core::{Fixed, Kind, Number, Scene as Loaded, Structure};
use gridel_host::blob::Blob;
use gridel_host::scene::{Placement, Scene, Shape};
use gridel_host::shape::Cuboid;
use gridel_tests::effort::part_of;
use gridel_tests::query::{held, through};
use gridel_tests::random::Random;
use gridel_tests::scenes;
use std::collections::BTreeSet;

const STRUCTURES: [Structure; 2] = [Structure::DualSplit, Structure::Wide];

fn ball() -> Shape {
    let (vertices, triangles) = scenes::icosphere(2);
    Shape::Mesh {
        vertices,
        triangles,
    }
}

/// A placed ball: its middle and radius, in units of the scene.
fn placed_ball(scene: &Loaded<'_>, record: &Record) -> (DVec3, f64) {
    let sides = scene.parts()[usize::from(record.part)].bounds().0;
    let half = sides.map(|[low, high]| (f64::from(high) - f64::from(low)) / 2.0);
    // Boxes are off by up to a unit.
    let radius = half.into_iter().fold(0.0, f64::max);
    let middle =
        DVec3::from_array(sides.map(|[low, high]| (f64::from(low) + f64::from(high)) / 2.0));
    let center = DVec3::from_array(record.center.map(|x| f64::from(x) / 256.0));
    let scale = linear(record, DVec3::X).length();
    let rows = record
        .matrix
        .map(|row| DVec3::from_array(row.map(f64::from)));
    let back = rows[0] * middle.x + rows[1] * middle.y + rows[2] * middle.z;
    let turned = back / rows[0].length() / scale;
    (center + turned, radius / scale)
}

/// Returns how far a hit's point is from the plane of its triangle, in units of the scene. Uses exact integers of the
/// map and double precision.
fn off_the_surface<N: Number>(scene: &Loaded<'_>, hit: &gridel_core::Hit<N>) -> f64 {
    let index = hit.instance().expect("an instance");
    let record = &scene.instances()[index as usize];
    let part = &scene.parts()[usize::from(record.part)];
    let first = scene
        .first_primitive_of_part(record.part.into())
        .expect("a part");
    let own = hit.primitive - first;
    let mut slots = 0..part.count(Kind::Triangle);
    let slot = slots.find(|&slot| part.primitive(Kind::Triangle, slot as u32) == own);
    let corners = part
        .triangle(slot.expect("a triangle"))
        .expect("its corners");
    let [a, b, c] = corners.map(|it| DVec3::from_array(it.map(|x| f64::from(x) / 256.0)));
    let normal = (b - a).cross(c - a).normalize();
    let place = super::into_part(record, point(hit));
    (place - a).dot(normal).abs() / linear(record, DVec3::X).length()
}

/// Tests rays to and from points inside every placed ball. Each hits the right side, and hits lie near their surface.
/// Rays that continue from a hit neither hit it again nor lose it.
fn check_in<N: Number>(scene: &Loaded<'_>, random: &mut Random, count: usize) {
    for (index, record) in (0_u32..).zip(scene.instances()) {
        let (middle, radius) = placed_ball(scene, record);
        for _ in 0..count {
            let inside = middle + 0.3 * radius * DVec3::from_array(random.direction());
            let way = DVec3::from_array(random.direction());
            let far = radius * random.magnitude(2.0, 1e3);
            let outside = inside - far * way;
            for (from, front) in [(inside, false), (outside, true)] {
                let ray = ray::<N>(scene, from, way);
                let what = || format!("{:?} from {from} along {way}: {record:?}", N::FORMAT);
                let mut first = None;
                for structure in held(scene) {
                    let (hit, any) = through(structure, scene, &ray);
                    let hit = hit.unwrap_or_else(|| panic!("no hit: {}", what()));
                    assert!(any, "{}", what());
                    if hit.instance() == Some(index) {
                        assert_eq!(hit.front, front, "{}", what());
                    }
                    first = Some(hit);
                }
                let hit = first.expect("a structure");
                if hit.instance() != Some(index) {
                    // Another lies before it.
                    continue;
                }
                let (off, error) = (off_the_surface(scene, &hit), hit.error.length_to_f64());
                assert!(off <= error, "off by {off}, bound {error}: {}", what());
                let normal = DVec3::from_array(hit.normal.map(N::ratio_to_f64));
                if 4.0 * error > radius {
                    continue;
                }
                let beside = DVec3::from_array(hit.outside().map(N::length_to_f64));
                let mut away = DVec3::from_array(random.direction());
                away *= away.dot(normal).signum();
                let again = through(
                    Structure::List,
                    scene,
                    &super::ray::<N>(scene, beside, away),
                )
                .0;
                let again = again.filter(|again| again.instance() == Some(index));
                assert_eq!(again, None, "{} and away {away}", what());
                let beneath = DVec3::from_array(hit.inside(scene).map(N::length_to_f64));
                let opposite = through(
                    Structure::List,
                    scene,
                    &super::ray::<N>(scene, beneath, -normal),
                )
                .0;
                // Unless another ball is there.
                let is_left = opposite.is_some_and(|it| it.instance() != Some(index) || !it.front);
                assert!(is_left, "{} beneath {beneath}", what());
            }
        }
    }
}

fn check(blob: &Blob, random: &mut Random, count: usize) -> BTreeSet<i16> {
    let scene = blob.scene().expect("a scene");
    check_in::<Fixed>(&scene, random, count);
    check_in::<f32>(&scene, random, count);
    check_in::<f64>(&scene, random, count);
    scene.instances().iter().map(|it| it.exponent).collect()
}

/// Two boxes so far apart, which make the scene large.
fn far_apart(reach: f64) -> Scene {
    let cube = |middle: f64| {
        let half = reach / 1000.0;
        Shape::Box(Cuboid {
            min: DVec3::splat(middle - half),
            max: DVec3::splat(middle + half),
        })
    };
    scenes::of([cube(reach), cube(-reach)])
}

#[test]
fn parts_are_closed_however_large_the_scene_around_them_is() {
    let random = &mut Random(31);
    let mut exponents = BTreeSet::new();
    for power in 0..19 {
        for _ in 0..part_of(4, 20) {
            let reach = random.magnitude(1.0, 2.0) * f64::from(1_u32 << power);
            let mut scene = far_apart(reach);
            scene.parts = vec![part("ball", [ball()])];
            scene.instances = (0..2)
                .map(|_| instance(0, placement(random, 0.6 * reach, [1.0, 1.5])))
                .collect();
            exponents.extend(check(&blob(&scene, &STRUCTURES), random, part_of(30, 100)));
        }
    }
    assert!(
        exponents.contains(&18) && exponents.len() > 16,
        "{exponents:?}"
    );
}

/// A rod along an axis takes less room along a diagonal, so the lattice of its scene is finer than its own.
#[test]
fn parts_are_closed_where_the_lattice_of_the_scene_is_finer() {
    let random = &mut Random(32);
    let Shape::Mesh {
        mut vertices,
        triangles,
    } = ball()
    else {
        panic!("a mesh");
    };
    for vertex in &mut vertices {
        *vertex *= DVec3::new(1.0, 0.01, 0.01);
    }
    let rod = Shape::Mesh {
        vertices,
        triangles,
    };
    let mut scene = scenes::of([]);
    scene.parts = vec![part("rod", [rod])];
    let turn = DQuat::from_rotation_arc(DVec3::X, DVec3::ONE.normalize());
    scene.instances = vec![instance(
        0,
        Placement {
            rotation: turn,
            ..Placement::IDENTITY
        },
    )];
    let blob = blob(&scene, &STRUCTURES);
    let loaded = blob.scene().expect("a scene");
    assert!(
        loaded.instances()[0].exponent < 0,
        "{:?}",
        loaded.instances()
    );
    // From points on the axis of the rod.
    let along = DVec3::ONE.normalize();
    let (middle, radius) = placed_ball(&loaded, &loaded.instances()[0]);
    for _ in 0..part_of(300, 3000) {
        let inside = middle + 0.5 * random.signed() * radius * along;
        let way = DVec3::from_array(random.direction());
        for structure in held(&loaded) {
            fn leaves<N: Number>(
                scene: &Loaded<'_>,
                by: Structure,
                from: DVec3,
                way: DVec3,
            ) -> bool {
                let (hit, any) = through(by, scene, &ray::<N>(scene, from, way));
                any && hit.is_some_and(|hit| {
                    !hit.front && off_the_surface(scene, &hit) <= hit.error.length_to_f64()
                })
            }
            assert!(leaves::<Fixed>(&loaded, structure, inside, way));
            assert!(leaves::<f32>(&loaded, structure, inside, way));
            assert!(leaves::<f64>(&loaded, structure, inside, way));
        }
    }
}

/// A part whose lattice is mostly empty can be placed larger than the compiler would place it.
#[test]
fn parts_are_closed_with_every_exponent_below_zero() {
    let random = &mut Random(33);
    let nothing = |place: f64| Shape::Mesh {
        vertices: vec![DVec3::splat(place); 3],
        triangles: vec![[0, 1, 2]],
    };
    let mut scene = scenes::of([]);
    scene.parts = vec![part("ball", [ball(), nothing(30.0), nothing(-30.0)])];
    scene.instances = vec![instance(
        0,
        Placement {
            rotation: DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 1.0),
            ..Placement::IDENTITY
        },
    )];
    let honest = blob(&scene, &STRUCTURES);
    for exponent in -4..=0 {
        let blob = patched(&honest, |header, instances| {
            header.bounds = UnitBox([[-32_700, 32_700]; 3]);
            instances[0].exponent = exponent;
        });
        let exponents = check(&blob, random, part_of(60, 600));
        assert_eq!(exponents, BTreeSet::from([exponent]));
    }
}
