//! Broken blobs: refused with words that name the place, or else a scene that works.

use glam::DVec3;
use gridel_core::accel::Link;
use gridel_core::blob::record::{FlaggedPair, Header, Pair, SectionEntry};
use gridel_core::blob::{BlobError, SectionKind, checksum};
use gridel_core::{Bvh, Flagged, Format, Hit, List, NoCount, Number, Scene, Settings, Structure};
use gridel_host::blob::Blob;
use gridel_host::render::{Job, render};
use gridel_host::scene::{Camera, Diffuse, Light, Material, Shape};
use gridel_tests::query::{UnitRay, any, closest};
use gridel_tests::random::Random;
use gridel_tests::{every_format, rays, scenes};
use std::mem::offset_of;

/// Every kind of record, every effect, and a hierarchy of a few levels.
fn small_scene() -> gridel_host::scene::Scene {
    let mut scene = scenes::soup(21, 16, 0.4);
    scene.objects.push(
        scenes::of([Shape::Mesh {
            vertices: [
                [0.0, 0.0, 0.0],
                [1.0, 0.0, 0.2],
                [0.0, 1.0, 0.1],
                [1.0, 1.0, 0.9],
            ]
            .map(DVec3::from_array)
            .to_vec(),
            triangles: vec![[0, 1, 2], [1, 3, 2]],
        }])
        .objects
        .remove(0),
    );
    scene.materials.push(Material {
        name: String::from("everything"),
        diffuse: Diffuse::Checker {
            even: [0.9, 0.1, 0.1],
            odd: [0.1, 0.9, 0.1],
            size: 0.2,
            origin: DVec3::splat(0.05),
        },
        highlight: [0.5; 3],
        mirror: [0.2; 3],
        transmit: [0.7; 3],
        absorption: [0.1, 0.2, 0.3],
        ..Material::default()
    });
    for object in scene.objects.iter_mut().step_by(3) {
        object.material = 1;
    }
    let color = [0.8; 3];
    let position = DVec3::new(3.0, 4.0, 5.0);
    let direction = DVec3::new(-1.0, -2.0, -0.5);
    scene.lights = vec![
        Light::Point { position, color },
        Light::Directional { direction, color },
    ];
    scene.camera = Some(Camera {
        eye: DVec3::new(0.5, 0.7, 4.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        fov_degrees: 50.0,
    });
    scene
}

fn small_blob(lattice_bits: u8) -> Vec<u8> {
    scenes::blob(&small_scene(), lattice_bits).bytes().to_vec()
}

/// Gives changed bytes a length and a checksum that fit.
fn sealed(bytes: &[u8]) -> Blob {
    let mut bytes = bytes.to_vec();
    let length = bytes.len() as u32;
    let mut put = |offset: usize, word: u32| {
        if let Some(place) = bytes.get_mut(offset..offset + 4) {
            place.copy_from_slice(&word.to_le_bytes());
        }
    };
    put(offset_of!(Header, blob_bytes), length);
    let sum = checksum(&bytes);
    let place = offset_of!(Header, checksum);
    if let Some(place) = bytes.get_mut(place..place + 4) {
        place.copy_from_slice(&sum.to_le_bytes());
    }
    Blob::new(&bytes)
}

/// Holds an error to what errors promise: words that say where.
fn speaks(error: &BlobError) {
    let text = error.to_string();
    let named = match error {
        BlobError::Header { field, .. } => text.contains(field),
        BlobError::Table { index, what, .. } => {
            text.contains(what) && text.contains(&index.to_string())
        }
        BlobError::Stride { section, .. } | BlobError::Count { section, .. } => {
            text.contains(section.name())
        }
        BlobError::Record {
            section,
            index,
            what,
            ..
        } => {
            text.contains(section.name())
                && text.contains(what)
                && text.contains(&index.to_string())
        }
        _ => text.len() > 20,
    };
    assert!(named, "{error:?}: {text}");
}

/// Uses a scene that was accepted: all its structures agree, and pictures come to an end.
fn works(scene: &Scene<'_>, rays_each: usize) {
    every_format!(structures_agree(scene, rays_each));
    let settings = Settings {
        width: 4,
        height: 3,
        samples: 1,
        ..Settings::of(scene)
    };
    for (format, structure) in Format::ALL.into_iter().zip(Structure::ALL) {
        if scene.holds(structure) {
            let job = Job {
                format,
                structure,
                settings,
                rows: 0..settings.height,
                count: false,
            };
            let picture = render(scene, &job, &|| ()).expect("a picture");
            assert_eq!(picture.pixels.len(), 12);
        }
    }
}

fn structures_agree<N: Number>(scene: &Scene<'_>, rays_each: usize) {
    // What a hit's place and primitive are; slots may share a number in a forged blob.
    let answer =
        |hit: Option<Hit<N>>| hit.map(|hit| (N::far_to_f64(hit.t).to_bits(), hit.primitive));
    for ray in rays::rays(scene, 3).take(rays_each) {
        let Some(ready) = ray.ready::<N>(scene) else {
            continue;
        };
        let listed = answer(closest::<N, List>(scene, &ready, &mut NoCount));
        let check = |other, any: bool| {
            assert_eq!(listed, answer(other), "{}: {ray:?}", N::FORMAT.name());
            assert_eq!(listed.is_some(), any);
        };
        check(
            closest::<N, List>(scene, &ready, &mut NoCount),
            any::<N, List>(scene, &ready),
        );
        if scene.holds(Structure::Bvh) {
            check(
                closest::<N, Bvh>(scene, &ready, &mut NoCount),
                any::<N, Bvh>(scene, &ready),
            );
        }
        if scene.holds(Structure::Flagged) {
            check(
                closest::<N, Flagged>(scene, &ready, &mut NoCount),
                any::<N, Flagged>(scene, &ready),
            );
        }
    }
}

/// Counts of what became of forged blobs.
#[derive(Debug, Default)]
struct Fate {
    refused: usize,
    accepted: usize,
}

impl Fate {
    fn of(&mut self, blob: &Blob, rays_each: usize) {
        match blob.scene() {
            Ok(scene) => {
                self.accepted += 1;
                works(&scene, rays_each);
            }
            Err(error) => {
                self.refused += 1;
                speaks(&error);
            }
        }
    }
}

#[test]
fn the_blob_itself_works() {
    for lattice_bits in [16, 24] {
        let blob = Blob::new(&small_blob(lattice_bits));
        eprintln!("{lattice_bits} bits: {} bytes", blob.bytes().len());
        works(&blob.scene().expect("a scene"), 1000);
        assert_eq!(sealed(blob.bytes()).bytes(), blob.bytes());
    }
}

#[test]
fn a_blob_cut_off_anywhere_is_refused() {
    for lattice_bits in [16, 24] {
        let bytes = small_blob(lattice_bits);
        for length in 0..bytes.len() {
            for blob in [Blob::new(&bytes[..length]), sealed(&bytes[..length])] {
                speaks(&blob.scene().expect_err("a part of a blob was accepted"));
            }
        }
        let longer = [&bytes[..], &[0; 16]].concat();
        speaks(&sealed(&longer).scene().expect_err("trailing bytes"));
    }
}

#[test]
fn a_flipped_bit_is_refused_or_after_sealing_harmless() {
    for lattice_bits in [16, 24] {
        let mut bytes = small_blob(lattice_bits);
        let mut fate = Fate::default();
        for bit in 0..8 * bytes.len() {
            bytes[bit / 8] ^= 1 << (bit % 8);
            speaks(
                &Blob::new(&bytes)
                    .scene()
                    .expect_err("a flipped bit was accepted"),
            );
            fate.of(&sealed(&bytes), 12);
            bytes[bit / 8] ^= 1 << (bit % 8);
        }
        eprintln!("{lattice_bits} bits: bits flipped and sealed again: {fate:?}");
        assert!(fate.refused > 1000 && fate.accepted > 1000);
    }
}

#[test]
fn words_of_extreme_value_are_refused_or_harmless() {
    let bytes = small_blob(24);
    let mut fate = Fate::default();
    let mut put = |offset: usize, value: &[u8]| {
        let mut forged = bytes.clone();
        if let Some(place) = forged.get_mut(offset..offset + value.len()) {
            place.copy_from_slice(value);
            fate.of(&sealed(&forged), 12);
        }
    };
    for offset in (0..bytes.len()).step_by(2) {
        for word in [i16::MIN, i16::MAX, 0, -1] {
            put(offset, &word.to_le_bytes());
        }
    }
    for offset in (0..bytes.len()).step_by(4) {
        for word in [i32::MIN, i32::MIN + 1, i32::MAX, -1, -2, 0] {
            put(offset, &word.to_le_bytes());
        }
    }
    for offset in (0..bytes.len()).step_by(8) {
        for word in [i64::MIN, i64::MAX, 1 << 50, -(1 << 50), 1 << 62] {
            put(offset, &word.to_le_bytes());
        }
    }
    eprintln!("words of extreme value: {fate:?}");
}

#[test]
fn random_bytes_are_refused() {
    let mut random = Random(5);
    let valid = small_blob(24);
    for round in 0..20_000 {
        let length = random.below(600);
        let mut bytes: Vec<u8> = (0..length).map(|_| random.bits() as u8).collect();
        // As far as a true header, every other time.
        let kept = if round % 2 == 0 {
            0
        } else {
            length.min(random.below(200))
        };
        bytes[..kept].copy_from_slice(&valid[..kept]);
        speaks(
            &sealed(&bytes)
                .scene()
                .expect_err("random bytes were accepted"),
        );
    }
}

#[test]
fn bytes_changed_at_random_are_refused_or_harmless() {
    let mut random = Random(6);
    let valid = small_blob(24);
    let mut fate = Fate::default();
    for _ in 0..20_000 {
        let mut bytes = valid.clone();
        for _ in 0..=random.below(4) {
            let (place, bits) = (random.below(bytes.len()), random.bits());
            bytes[place] = [
                bits as u8,
                0,
                0x80,
                0xff,
                0x7f,
                valid[place].wrapping_add(1),
            ][random.below(6)];
        }
        fate.of(&sealed(&bytes), 6);
    }
    eprintln!("bytes changed at random: {fate:?}");
}

#[test]
fn a_misaligned_blob_is_refused() {
    let bytes = small_blob(24);
    let padded = Blob::new(&[&[0; 16][..], &bytes, &[0; 16]].concat());
    for offset in 1..16 {
        let shifted = Blob::new(&[&vec![0; offset], &bytes[..]].concat());
        let result = Scene::from_bytes(&shifted.bytes()[offset..]);
        assert_eq!(result.err(), Some(BlobError::Misaligned), "offset {offset}");
    }
    assert!(Scene::from_bytes(&padded.bytes()[16..16 + bytes.len()]).is_ok());
}

/// A forged header must be refused.
fn refuses_header(what: &str, forge: impl Fn(&mut Header)) {
    let mut bytes = small_blob(24);
    let (start, _) = bytes.split_at_mut(size_of::<Header>());
    let mut header: Header = bytemuck::pod_read_unaligned(start);
    forge(&mut header);
    start.copy_from_slice(bytemuck::bytes_of(&header));
    let error = sealed(&bytes).scene().err();
    eprintln!(
        "{what}: {}",
        error.map_or(String::from("ACCEPTED"), |e| e.to_string())
    );
    assert!(error.is_some(), "{what} was accepted");
}

#[test]
fn forged_headers_are_refused() {
    refuses_header("stack depth 0", |h| (h.stack_depth, h.stack_bytes) = (0, 0));
    refuses_header("stack depth 255", |h| {
        (h.stack_depth, h.stack_bytes) = (255, 255 * 12)
    });
    refuses_header("stack depth one too large", |h| {
        h.stack_depth += 1;
        h.stack_bytes += 12;
    });
    refuses_header("too few stack bytes", |h| h.stack_bytes -= 1);
    refuses_header("no primitives", |h| h.primitives = 0);
    refuses_header("4294967295 objects", |h| h.objects = u32::MAX);
    refuses_header("no objects", |h| h.objects = 0);
    refuses_header("65535 sections", |h| h.section_count = u16::MAX);
    refuses_header("another byte order", |h| {
        h.endianness = h.endianness.swap_bytes()
    });
    refuses_header("version 2", |h| h.version = 2);
    refuses_header("unknown effects", |h| h.effects |= 1 << 31);
    refuses_header("unknown structures", |h| h.structures |= 1 << 31);
    refuses_header("a missing effect", |h| h.effects = 0);
    refuses_header("longest leaf 0", |h| h.longest_leaf = 0);
    refuses_header("a box of -32768", |h| h.bounds.0[1][0] = i16::MIN);
    refuses_header("an inverted box", |h| h.bounds.0[2].reverse());
    refuses_header("an empty box", |h| h.bounds.0 = [[0; 2]; 3]);
    for (axis, value) in [(0, f64::NAN), (1, f64::INFINITY), (2, f64::NEG_INFINITY)] {
        refuses_header("an origin that is not finite", |h| h.origin[axis] = value);
    }
    refuses_header("unit exponent -32768", |h| h.unit_exponent = i16::MIN);
    refuses_header("unit exponent 32767", |h| h.unit_exponent = i16::MAX);
}

/// Primitives that the lattice took keep their numbers, so a scene may count more than there are.
#[test]
fn primitives_that_have_no_record_are_harmless() {
    let mut bytes = small_blob(24);
    let place = offset_of!(Header, primitives);
    bytes[place..place + 4].copy_from_slice(&u32::MAX.to_le_bytes());
    works(&sealed(&bytes).scene().expect("a scene"), 50);
}

#[test]
fn odd_but_finite_origins_are_harmless() {
    for value in [
        0.0,
        -0.0,
        f64::MIN_POSITIVE / 4.0,
        f64::MAX,
        -f64::MAX,
        1e-300,
    ] {
        let mut bytes = small_blob(24);
        let place = offset_of!(Header, origin);
        bytes[place..place + 8].copy_from_slice(&value.to_le_bytes());
        works(&sealed(&bytes).scene().expect("a scene"), 50);
    }
}

/// Where a section lies, and its entry's place in the table.
fn section(bytes: &[u8], kind: SectionKind) -> (usize, SectionEntry) {
    let header: Header = bytemuck::pod_read_unaligned(&bytes[..size_of::<Header>()]);
    let places = (0..usize::from(header.section_count)).map(|index| 96 + 16 * index);
    let mut entries = places.map(|place| {
        let entry: SectionEntry = bytemuck::pod_read_unaligned(&bytes[place..place + 16]);
        (place, entry)
    });
    entries
        .find(|(_, entry)| entry.kind == kind as u16)
        .expect("the section")
}

#[test]
fn forged_sections_are_refused() {
    let bytes = small_blob(24);
    for kind in SectionKind::ALL {
        let (place, entry) = section(&bytes, kind);
        let forgeries = [
            SectionEntry {
                count: u32::MAX,
                ..entry
            },
            SectionEntry {
                count: (u32::MAX / u32::from(entry.stride)).saturating_add(1),
                ..entry
            },
            SectionEntry {
                count: entry.count + 1,
                ..entry
            },
            SectionEntry {
                count: entry.count - 1,
                ..entry
            },
            SectionEntry { stride: 0, ..entry },
            SectionEntry {
                stride: u16::MAX,
                ..entry
            },
            SectionEntry {
                stride: entry.stride + 1,
                ..entry
            },
            SectionEntry { offset: 0, ..entry },
            SectionEntry {
                offset: u32::MAX - 15,
                ..entry
            },
            SectionEntry {
                offset: entry.offset + 16,
                ..entry
            },
            SectionEntry { kind: 0, ..entry },
            SectionEntry {
                kind: u16::MAX,
                ..entry
            },
            SectionEntry {
                kind: entry.kind + 1,
                ..entry
            },
        ];
        for forged in forgeries {
            let mut changed = bytes.clone();
            changed[place..place + 16].copy_from_slice(bytemuck::bytes_of(&forged));
            let blob = sealed(&changed);
            let error = blob.scene().err();
            assert!(error.is_some(), "{kind:?}: {forged:?}");
            error.iter().for_each(speaks);
        }
    }
}

/// Children that lead to their own pair, backwards, beyond the end, or past a pair or a leaf.
#[test]
fn cycles_and_orphans_are_refused() {
    let bytes = small_blob(24);
    let mut fate = Fate::default();
    let mut forge = |place: usize, forged: u32| {
        let mut changed = bytes.clone();
        changed[place..place + 4].copy_from_slice(&forged.to_le_bytes());
        if changed != bytes {
            fate.of(&sealed(&changed), 100);
        }
    };
    let word_at = |place: usize| bytemuck::pod_read_unaligned::<u32>(&bytes[place..place + 4]);
    let pairs = section(&bytes, SectionKind::Pairs).1;
    for index in 0..pairs.count {
        let end = pairs.offset as usize + (index as usize + 1) * size_of::<Pair>();
        for place in [end - 8, end - 4] {
            let word = word_at(place);
            for number in [
                0,
                index,
                index.wrapping_sub(1),
                word + 1,
                word ^ 1 << 31,
                pairs.count,
            ] {
                forge(place, number);
                forge(place, number | 1 << 31);
            }
            forge(place, u32::MAX);
        }
    }
    let flagged = section(&bytes, SectionKind::FlaggedPairs).1;
    for index in 0..flagged.count {
        let end = flagged.offset as usize + (index as usize + 1) * size_of::<FlaggedPair>();
        let word = word_at(end - 4);
        let next = Link(word).first_pair() + 1;
        for first in [
            0,
            index,
            index.wrapping_sub(1) & 0xff_ffff,
            next,
            flagged.count,
            0xff_ffff,
        ] {
            for (left, right) in [(false, false), (true, false), (false, true), (true, true)] {
                let link = Link::new(first, left, right).with_owners(word >> 26);
                forge(end - 4, link.0);
            }
        }
    }
    eprintln!("forged links: {fate:?}");
    // A leaf's pair may count no pairs before it and mean the same.
    assert!(fate.refused > 20 * fate.accepted);
}

/// A ray that is none is refused, whatever is wrong with it.
#[test]
fn what_is_no_ray_is_refused() {
    let blob = Blob::new(&small_blob(24));
    let scene = blob.scene().expect("a scene");
    fn refused<N: Number>(scene: &Scene<'_>) {
        let good = UnitRay::new([0.0; 3], [1.0, 0.5, 0.25]);
        assert!(good.ready::<N>(scene).is_some());
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for axis in 0..3 {
                let (mut origin, mut direction) = (good, good);
                origin.origin[axis] = bad;
                direction.direction[axis] = bad;
                assert!(origin.ready::<N>(scene).is_none());
                assert!(direction.ready::<N>(scene).is_none());
            }
        }
        let windows = [
            (f64::NAN, 1.0),
            (0.0, f64::NAN),
            (1.0, 0.5),
            (f64::INFINITY, 0.0),
        ];
        for (tmin, tmax) in windows {
            assert!(UnitRay { tmin, tmax, ..good }.ready::<N>(scene).is_none());
        }
        for zero in [0.0, -0.0] {
            let direction = [zero; 3];
            assert!(UnitRay { direction, ..good }.ready::<N>(scene).is_none());
        }
    }
    every_format!(refused(&scene));
}
