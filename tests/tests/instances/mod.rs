//! Parts and instances: hits lie where maps place them, and a part is exact and closed under every map.

mod all_hits;
mod blobs;
mod closed;
mod poses;
mod scales;

use glam::{DQuat, DVec3};
use gridel_core::format::instance::Instance as Record;
use gridel_core::{Format, Hit, Number, Ray, Scene as Loaded, Structure};
use gridel_host::blob::Blob;
use gridel_host::compile::{Options, compile};
use gridel_host::scene::{Instance, Part, Placement, Scene, Shape, SourceSpan};
use gridel_tests::effort::part_of;
use gridel_tests::every_format;
use gridel_tests::query::{HitBits, held, through};
use gridel_tests::random::Random;
use gridel_tests::scenes;

/// A placement within some distance, at a size.
fn placement(random: &mut Random, reach: f64, [least, most]: [f64; 2]) -> Placement {
    let axis = DVec3::from_array(random.direction());
    let angle = std::f64::consts::PI * random.signed();
    Placement {
        rotation: DQuat::from_axis_angle(axis, angle),
        translation: reach * DVec3::from_array([(); 3].map(|()| random.signed())),
        scale: random.magnitude(least, most),
    }
}

fn part(name: &str, shapes: impl IntoIterator<Item = Shape>) -> Part {
    Part {
        name: name.to_owned(),
        objects: scenes::of(shapes).objects,
        place: SourceSpan::default(),
    }
}

fn instance(part: usize, placement: Placement) -> Instance {
    Instance {
        name: String::from("copy"),
        part,
        placement,
        joint: None,
        place: SourceSpan::default(),
    }
}

/// A scene with some objects of its own, and instances of two parts.
fn random_scene(random: &mut Random, own: usize, instances: usize) -> Scene {
    let shapes = |random: &mut Random, count: usize| -> Vec<Shape> {
        (0..count)
            .map(|_| {
                let place = DVec3::from_array([(); 3].map(|()| random.signed()));
                let kind = random.below(5);
                scenes::shape(random, kind, place, 0.4)
            })
            .collect()
    };
    let mut scene = scenes::of(shapes(random, own));
    scene.parts = vec![
        part("some", shapes(random, 6)),
        part("one", shapes(random, 1)),
    ];
    scene.instances = (0..instances)
        .map(|_| instance(random.below(2), placement(random, 4.0, [0.2, 2.0])))
        .collect();
    scene
}

fn blob(scene: &Scene, structures: &[Structure]) -> Blob {
    let options = Options {
        structures: structures.to_vec(),
        budget: Some(1 << 20),
        ..Options::default()
    };
    compile(scene, &options).expect("a blob").blob
}

/// A point of the scene in a part, in units.
fn into_part(record: &Record, point: DVec3) -> DVec3 {
    let center = DVec3::from_array(record.center.map(|x| f64::from(x) / 256.0));
    linear(record, point - center)
}

fn linear(record: &Record, way: DVec3) -> DVec3 {
    let scale = f64::powi(2.0, i32::from(record.exponent) - 23);
    let rows = record
        .matrix
        .map(|row| DVec3::from_array(row.map(f64::from)).dot(way));
    DVec3::from_array(rows) * scale
}

/// The first hit of a ray with an instance by the part's own kernels in `f64`: its t, along the direction, and its
/// primitive.
fn alone(scene: &Loaded<'_>, record: &Record, from: DVec3, way: DVec3) -> Option<(f64, u32)> {
    let number = usize::from(record.part);
    let part = scene.parts()[number];
    let (origin, direction) = (into_part(record, from), linear(record, way));
    let bounds = part.bounds();
    let ray = Ray::<f64>::from_f64(bounds, origin.into(), direction.into(), 0.0, f64::INFINITY);
    let hit = through(Structure::List, &part, &ray.ok()?).0?;
    let first = scene.first_primitive_of_part(number).expect("a part");
    Some((hit.t / direction.abs().max_element(), first + hit.primitive))
}

/// A ray that starts around the scene's box or in it, and leads to a point in it.
fn random_ray(random: &mut Random, scene: &Loaded<'_>) -> (DVec3, DVec3) {
    let bounds = scene.bounds().0;
    let mut point = |reach: f64| {
        DVec3::from_array(bounds.map(|[low, high]| {
            let (low, high) = (f64::from(low), f64::from(high));
            low.midpoint(high) + reach * random.signed() * (high - low) / 2.0
        }))
    };
    let (from, mut to) = (point(3.0), point(1.0));
    if !random.one_in(4) {
        let instances = scene.instances();
        let instance = &instances[random.below(instances.len())];
        let part = &scene.parts()[usize::from(instance.part)];
        let sides = instance.around(part.bounds()).expect("a box").0;
        to = DVec3::from_array(sides.map(|[low, high]| {
            f64::from(low) + random.unit() * (f64::from(high) - f64::from(low))
        }));
    }
    (from, (to - from).normalize())
}

fn ray<N: Number>(scene: &Loaded<'_>, from: DVec3, way: DVec3) -> Ray<N> {
    Ray::from_f64(scene.bounds(), from.into(), way.into(), 0.0, 1e9).expect("a ray")
}

fn point<N: Number>(hit: &Hit<N>) -> DVec3 {
    DVec3::from_array(hit.point.map(N::length_to_f64))
}

fn hits_lie_where_maps_place_them_in<N: Number>(
    scene: &Loaded<'_>,
    rays: &[(DVec3, DVec3)],
    all: &mut usize,
) {
    let mut hits = 0;
    for &(from, way) in rays {
        let expected = scene
            .instances()
            .iter()
            .enumerate()
            .filter_map(|(index, record)| {
                let (t, primitive) = alone(scene, record, from, way)?;
                Some((t, primitive, index as u32))
            });
        let expected = expected.min_by(|a, b| a.0.total_cmp(&b.0));
        let found = through(Structure::DualSplit, scene, &ray::<N>(scene, from, way)).0;
        if N::FORMAT == Format::F64
            && let Some((t, ..)) = expected
        {
            // The hierarchy above loses no instance.
            let hit = found.as_ref().expect("a hit of some instance");
            let found = N::far_to_f64(hit.t) / way.abs().max_element();
            assert!(found <= t * (1.0 + 1e-9) + 1e-6, "{found} beyond {t}");
        }
        let (Some((t, primitive, index)), Some(hit)) = (expected, found) else {
            // Grazed, or nothing.
            continue;
        };
        // Where two surfaces are as near, either may be first.
        let place = point(&hit);
        let off = (place - (from + t * way)).length();
        let coordinate = place.abs().max_element().max(from.abs().max_element());
        let resolution = match N::FORMAT {
            Format::Fixed => 1e-2,
            Format::F32 => 1e-2 + 1e-5 * coordinate,
            Format::F64 => 1e-6,
        };
        if hit.instance() == Some(index) && hit.primitive == primitive {
            let cosine = DVec3::from_array(hit.normal.map(N::ratio_to_f64))
                .dot(way)
                .abs();
            let most = (hit.error.length_to_f64() + resolution) / cosine.max(1e-3);
            assert!(
                off <= most,
                "{:?}: off by {off}, at most {most}: {hit:?}",
                N::FORMAT
            );
            hits += 1;
        }
    }
    *all += hits;
}

#[test]
fn hits_lie_where_maps_place_them() {
    let random = &mut Random(1);
    let mut hits = 0;
    for _ in 0..part_of(12, 200) {
        let scene = random_scene(random, 0, 7);
        let blob = blob(&scene, &[Structure::DualSplit]);
        let loaded = blob.scene().expect("a scene");
        assert_eq!(loaded.instances().len(), 7);
        let rays: Vec<_> = (0..300).map(|_| random_ray(random, &loaded)).collect();
        every_format!(hits_lie_where_maps_place_them_in(&loaded, &rays, &mut hits));
    }
    assert!(hits > 1000, "{hits}");
}

fn structures_agree_in<N: Number>(scene: &Loaded<'_>, rays: &[(DVec3, DVec3)]) {
    for &(from, way) in rays {
        let ray = ray::<N>(scene, from, way);
        let (expected, any) = through(Structure::List, scene, &ray);
        assert_eq!(expected.is_some(), any, "{:?}", N::FORMAT);
        let expected = expected
            .as_ref()
            .map(|hit| (HitBits::of(hit), hit.instance()));
        for structure in held(scene) {
            let (hit, any) = through(structure, scene, &ray);
            let hit = hit.as_ref().map(|hit| (HitBits::of(hit), hit.instance()));
            assert_eq!(hit, expected, "{} in {:?}", structure.name(), N::FORMAT);
            assert_eq!(
                any,
                expected.is_some(),
                "{} in {:?}",
                structure.name(),
                N::FORMAT
            );
        }
    }
}

#[test]
fn structures_agree_bit_for_bit() {
    let random = &mut Random(2);
    for round in 0..part_of(3, 40) {
        let scene = random_scene(random, [0, 1, 9][round % 3], [1, 2, 30][round % 3]);
        let blob = blob(&scene, &Structure::ALL);
        let loaded = blob.scene().expect("a scene");
        let rays: Vec<_> = (0..200).map(|_| random_ray(random, &loaded)).collect();
        every_format!(structures_agree_in(&loaded, &rays));
    }
}
