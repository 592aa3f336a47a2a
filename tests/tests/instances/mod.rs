//! Parts and instances: hits lie where maps place them, and a part is exact and closed under every map.

use glam::{DQuat, DVec3};
use gridel_core::format::instance::Instance as Record;
use gridel_core::format::record::{Header, SectionEntry};
use gridel_core::format::{SectionKind, checksum};
use gridel_core::{BlobError, Fixed, Format, Hit, Number, Parts, Ray, Scene as Loaded, Structure};
use gridel_host::blob::Blob;
use gridel_host::compile::{Options, compile};
use gridel_host::scene::{Instance, Part, Placement, Scene, Shape, SourceSpan};
use gridel_tests::effort::part_of;
use gridel_tests::every_format;
use gridel_tests::query::{HitBits, held, through};
use gridel_tests::random::Random;
use gridel_tests::scenes;
use std::mem::offset_of;

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

/// Of rays to and from points inside a closed part, how many miss it or meet the wrong side.
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

/// Whether a shape has an inside, and is convex.
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

#[test]
fn instances_have_their_own_numbers_and_objects_of_parts_are_counted_once() {
    let random = &mut Random(5);
    let scene = random_scene(random, 3, 12);
    let blob = blob(&scene, &[Structure::DualSplit]);
    let loaded = blob.scene().expect("a scene");
    let numbers = (0..12).map(|index| loaded.instances()[index].number);
    let mut numbers: Vec<_> = numbers.collect();
    numbers.sort_unstable();
    assert!(numbers.iter().copied().eq(0..12));
    assert_eq!(loaded.header().objects, 3 + 6 + 1);
    let (first, second) = (
        loaded.first_primitive_of_part(0),
        loaded.first_primitive_of_part(1),
    );
    assert_eq!(loaded.object(first.expect("a part")), 3);
    assert_eq!(loaded.object(second.expect("a part")), 9);
}

/// A blob whose bytes were changed at a place of a section, with a checksum that fits.
fn forged(blob: &Blob, kind: SectionKind, at: usize, byte: u8) -> Blob {
    let mut bytes = blob.bytes().to_vec();
    let entries = bytes[size_of::<Header>()..].chunks_exact(size_of::<SectionEntry>());
    let mut entries = entries.map(bytemuck::pod_read_unaligned::<SectionEntry>);
    let entry = entries
        .find(|entry| entry.kind == kind as u16)
        .expect("the section");
    bytes[entry.offset as usize + at] ^= byte;
    let place = offset_of!(Header, checksum);
    bytes[place..place + 4].fill(0);
    let sum = checksum(&bytes);
    bytes[place..place + 4].copy_from_slice(&sum.to_le_bytes());
    Blob::new(&bytes)
}

#[test]
fn forged_instances_are_rejected_or_answer_without_a_panic() {
    let random = &mut Random(6);
    let scene = random_scene(random, 2, 9);
    let honest = blob(&scene, &[Structure::DualSplit]);
    let mut loaded = 0;
    for (kind, bytes) in [
        (SectionKind::Parts, 2 * 16),
        (SectionKind::Instances, 9 * size_of::<Record>()),
        (SectionKind::InstancePairs, 8 * 32),
        (SectionKind::PartBlobs, 96),
    ] {
        for at in 0..bytes {
            let bit = 1 << random.below(8);
            let forged = forged(&honest, kind, at, bit);
            let Ok(scene) = forged.scene() else { continue };
            loaded += 1;
            for _ in 0..10 {
                let (from, way) = random_ray(random, &scene);
                let ray = ray::<f32>(&scene, from, way);
                let (expected, any) = through(Structure::List, &scene, &ray);
                let (found, found_any) = through(Structure::DualSplit, &scene, &ray);
                assert_eq!((found, found_any), (expected, any));
            }
        }
    }
    // Maps that differ by a bit are as valid.
    assert!(loaded > 20, "{loaded}");
}

#[test]
fn blob_with_parts_is_rejected_without_them_and_with_others() {
    let random = &mut Random(7);
    let [one, other] = [3, 4].map(|count| {
        let scene = random_scene(random, 1, count);
        blob(&scene, &[Structure::DualSplit])
    });
    let error = Loaded::from_bytes(one.bytes()).unwrap_err();
    assert!(
        matches!(
            error,
            BlobError::Parts {
                found: 0,
                expected: 2
            }
        ),
        "{error}"
    );
    let parts = Parts::<2>::from_bytes(one.bytes()).expect("two parts");
    assert!(Loaded::with_parts(one.bytes(), &parts).is_ok());
    assert!(Loaded::with_parts(other.bytes(), &parts).is_err());
    assert!(Parts::<1>::from_bytes(one.bytes()).is_err());
}
