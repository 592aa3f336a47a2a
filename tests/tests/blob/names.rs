//! Names: an optional part of a blob that no query reads.

use super::forged::section;
use super::{small_scene, works};
use glam::DVec3;
use gridel_core::format::record::SectionEntry;
use gridel_core::format::{BlobError, SectionKind};
use gridel_core::{Names, Scene};
use gridel_host::blob::Blob;
use gridel_host::compile::{self, Options, compile};
use gridel_host::scene::{Light, Shape};
use gridel_host::shape::Sphere;
use gridel_tests::fuzz::{Base, sealed, speaks};
use gridel_tests::random::Random;
use gridel_tests::scenes;

/// Names of every sort: equal, empty, long, with characters of several bytes, with control characters.
const NAMES: [&str; 6] = ["ball", "", "ball", "Größe/球", "a\u{1b}[31m\n\0b", "x y"];

fn named_scene() -> gridel_host::scene::Scene {
    let mut scene = small_scene();
    for (object, name) in scene.objects.iter_mut().zip(NAMES.iter().cycle()) {
        object.name = String::from(*name);
    }
    scene.materials[1].name = String::from("glass");
    scene.light_names = vec![String::new(), String::from("sun")];
    scene
}

fn built(scene: &gridel_host::scene::Scene, names: bool) -> Blob {
    let options = Options {
        names,
        ..Options::default()
    };
    compile(scene, &options).expect("compiles").blob
}

fn error(blob: &Blob) -> BlobError {
    // Queries have nothing to do with names.
    assert!(Scene::from_bytes(blob.bytes()).is_ok());
    Names::from_bytes(blob.bytes()).expect_err("a forged name")
}

#[test]
fn names_are_read_as_they_were_written() {
    let scene = named_scene();
    let blob = built(&scene, true);
    let names = Names::from_bytes(blob.bytes()).expect("names");
    assert!(!names.is_empty());
    for (number, object) in (0..).zip(&scene.objects) {
        assert_eq!(names.object(number), object.name);
    }
    let count = scene.objects.len() as u32;
    assert_eq!(names.object(count), "");
    assert_eq!(names.object(u32::MAX), "");
    let read = blob.scene().expect("a scene");
    for object in 0..count {
        let number = scene.objects[object as usize].material;
        let found = names.material(read.material_number(object));
        assert_eq!(found, scene.materials[number].name);
    }
    assert_eq!(names.material(3), "");
    let lights = [0, 1, 2, u32::MAX].map(|light| names.light(light));
    assert_eq!(lights, ["", "sun", "", ""]);
    works(&read, 20);
}

#[test]
fn blob_without_names_has_the_same_sections_and_hits() {
    let scene = named_scene();
    let (with, without) = (built(&scene, true), built(&scene, false));
    assert!(Names::from_bytes(without.bytes()).expect("none").is_empty());
    let mut base = Base::of(with.bytes());
    base.remove(&[SectionKind::NameStarts, SectionKind::NameText]);
    assert_eq!(base.sealed().bytes(), without.bytes());
}

#[test]
fn scene_where_nothing_has_a_name_has_no_sections_of_names() {
    let mut scene = named_scene();
    for object in &mut scene.objects {
        object.name.clear();
    }
    for material in &mut scene.materials {
        material.name.clear();
    }
    scene.light_names.clear();
    assert_eq!(built(&scene, true).bytes(), built(&scene, false).bytes());
}

#[test]
fn name_of_more_than_255_bytes_is_cut_between_characters() {
    let mut scene = scenes::of([Shape::Sphere(Sphere {
        center: DVec3::ZERO,
        radius: 1.0,
    })]);
    for (name, kept) in [
        ("a".repeat(255), 255),
        ("a".repeat(256), 255),
        ("球".repeat(86), 255),
        (format!("a{}", "球".repeat(85)), 253),
    ] {
        scene.objects[0].name = name.clone();
        let options = Options {
            names: true,
            ..Options::default()
        };
        let compiled = compile(&scene, &options).expect("compiles");
        let names = Names::from_bytes(compiled.blob.bytes()).expect("names");
        assert_eq!(names.object(0), &name[..kept]);
        let report = compiled.report.names.expect("names");
        assert_eq!(report.shortened, usize::from(name.len() > kept));
    }
}

#[test]
fn names_that_exceed_the_largest_size_are_left_out() {
    let scene = named_scene();
    let (with, without) = (built(&scene, true), built(&scene, false));
    for (most, names) in [
        (with.bytes().len(), true),
        (with.bytes().len() - 1, false),
        (without.bytes().len(), false),
    ] {
        let options = Options {
            names: true,
            max_bytes: Some(most as u64),
            ..Options::default()
        };
        let compiled = compile(&scene, &options).expect("compiles");
        let expected = if names { &with } else { &without };
        assert_eq!(compiled.blob.bytes(), expected.bytes());
        let report = compiled.report.names.expect("a report");
        assert_eq!(report.left_out, !names);
        let grown = with.bytes().len() - without.bytes().len();
        assert_eq!(report.bytes > 0, names);
        assert!(report.bytes == 0 || report.bytes <= grown);
    }
    let options = Options {
        names: true,
        max_bytes: Some(without.bytes().len() as u64 - 1),
        ..Options::default()
    };
    let rejected = compile(&scene, &options).expect_err("too large");
    assert!(matches!(
        rejected,
        compile::CompileError::TooLarge { over: 1, .. }
    ));
}

#[test]
fn lights_that_the_compiler_adds_have_no_name() {
    let mut scene = named_scene();
    (scene.lights, scene.light_names) = (Vec::<Light>::new(), Vec::new());
    scene.tracks.clear();
    scene.ambient = [0.0; 3];
    let blob = built(&scene, true);
    assert_eq!(blob.scene().expect("a scene").lights().len(), 1);
    let names = Names::from_bytes(blob.bytes()).expect("names");
    assert_eq!((names.light(0), names.object(0)), ("", "ball"));
}

/// A record of a section as another number, or another byte.
fn forged(blob: &Blob, kind: SectionKind, record: usize, value: u8) -> Blob {
    let mut bytes = blob.bytes().to_vec();
    let (_, entry) = section(&bytes, kind);
    bytes[entry.offset as usize + record * usize::from(entry.stride)] = value;
    sealed(&bytes)
}

#[test]
fn forged_names_are_errors_that_name_the_record() {
    let blob = built(&named_scene(), true);
    let bytes = blob.bytes();
    let starts = section(bytes, SectionKind::NameStarts).1;
    let last = starts.count as usize - 1;
    assert_eq!(starts.stride, 1);
    let text = section(bytes, SectionKind::NameText).1;
    let place = text.offset as usize;
    let letters = std::str::from_utf8(&bytes[place..][..text.count as usize]).expect("UTF-8");
    let inside = letters.find('ö').expect("a character of two bytes") as u8 + 1;
    for (what, forged) in [
        (
            "a first name behind the start",
            forged(&blob, SectionKind::NameStarts, 0, 1),
        ),
        (
            "a name that ends before it starts",
            forged(&blob, SectionKind::NameStarts, 2, 0),
        ),
        (
            "a start behind the text",
            forged(&blob, SectionKind::NameStarts, 3, 255),
        ),
        (
            "a start inside a character",
            forged(&blob, SectionKind::NameStarts, 4, inside),
        ),
        (
            "an end before the text's",
            forged(&blob, SectionKind::NameStarts, last, 1),
        ),
        (
            "a byte that is not UTF-8",
            forged(&blob, SectionKind::NameText, 1, 0xff),
        ),
        (
            "half a character",
            forged(&blob, SectionKind::NameText, inside.into(), b'a'),
        ),
    ] {
        let error = error(&forged);
        speaks(&error);
        assert!(error.to_string().contains("name-"), "{what}: {error}");
    }
    for kinds in [[SectionKind::NameText], [SectionKind::NameStarts]] {
        let mut base = Base::of(bytes);
        base.remove(&kinds);
        speaks(&error(&base.sealed()));
    }
    // A name of more than 255 bytes, in starts of two bytes.
    let mut long = named_scene();
    for object in &mut long.objects[..2] {
        object.name = "a".repeat(200);
    }
    let blob = built(&long, true);
    let (_, entry) = section(blob.bytes(), SectionKind::NameStarts);
    assert_eq!(entry.stride, 2);
    let mut bytes = blob.bytes().to_vec();
    let place = entry.offset as usize + 2;
    bytes[place..place + 2].copy_from_slice(&0_u16.to_le_bytes());
    speaks(&error(&sealed(&bytes)));
}

#[test]
fn damaged_names_never_panic() {
    let blob = built(&named_scene(), true);
    let mut random = Random(5);
    let (table, starts) = section(blob.bytes(), SectionKind::NameStarts);
    let (_, text) = section(blob.bytes(), SectionKind::NameText);
    let end = text.offset as usize + text.count as usize;
    let mut accepted = 0;
    for _ in 0..20_000 {
        let mut bytes = blob.bytes().to_vec();
        for _ in 0..=random.below(3) {
            let place = match random.below(3) {
                // The entries of both sections in the table.
                0 => table + random.below(2 * size_of::<SectionEntry>()),
                _ => starts.offset as usize + random.below(end - starts.offset as usize),
            };
            bytes[place] = random.bits() as u8;
        }
        let blob = Blob::new(&bytes);
        let Ok(names) = Names::from_bytes(blob.bytes()) else {
            continue;
        };
        accepted += 1;
        for number in (0..40).chain([u32::MAX]) {
            for name in [
                names.object(number),
                names.material(number),
                names.light(number),
            ] {
                assert!(name.len() <= 255);
            }
        }
    }
    assert!(accepted > 500, "{accepted}");
}
