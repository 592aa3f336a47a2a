//! The records of parts and instances in a blob, and what loading rejects.

use super::{blob, instance, part, random_ray, random_scene, ray};
use glam::DVec3;
use gridel_core::format::instance::Instance as Record;
use gridel_core::format::record::{Header, SectionEntry};
use gridel_core::format::{SectionKind, checksum};
use gridel_core::{BlobError, Parts, Requirements, Scene as Loaded, Structure};
use gridel_host::blob::Blob;
use gridel_host::scene::Placement;
use gridel_tests::query::through;
use gridel_tests::random::Random;
use gridel_tests::scenes;
use std::mem::offset_of;
use std::ops::Range;

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
    let place = section(&bytes, kind).start + at;
    bytes[place] ^= byte;
    sealed(bytes)
}

/// A blob whose header and instances were changed, with a checksum that fits.
pub fn patched(blob: &Blob, change: impl FnOnce(&mut Header, &mut [Record])) -> Blob {
    let mut bytes = blob.bytes().to_vec();
    let (head, _) = bytes.split_at(size_of::<Header>());
    let mut header: Header = bytemuck::pod_read_unaligned(head);
    let places = section(&bytes, SectionKind::Instances);
    let records = bytes[places.clone()].chunks_exact(size_of::<Record>());
    let mut records: Vec<Record> = records.map(bytemuck::pod_read_unaligned).collect();
    header.checksum = 0;
    change(&mut header, &mut records);
    bytes[..size_of::<Header>()].copy_from_slice(bytemuck::bytes_of(&header));
    bytes[places].copy_from_slice(bytemuck::cast_slice(&records));
    sealed(bytes)
}

/// Returns the byte range of a section.
fn section(bytes: &[u8], kind: SectionKind) -> Range<usize> {
    let entries = bytes[size_of::<Header>()..].chunks_exact(size_of::<SectionEntry>());
    let mut entries = entries.map(bytemuck::pod_read_unaligned::<SectionEntry>);
    let entry = entries
        .find(|entry| entry.kind == kind as u16)
        .expect("the section");
    let start = entry.offset as usize;
    start..start + entry.count as usize * usize::from(entry.stride)
}

/// A blob with a checksum that fits.
fn sealed(mut bytes: Vec<u8>) -> Blob {
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

/// The content of a part counts: its kinds of primitives, the depth of its hierarchy, and the parts themselves.
#[test]
fn requirements_hold_those_of_parts() {
    let random = &mut Random(8);
    for structure in [Structure::DualSplit, Structure::Wide, Structure::List] {
        let mut scene = random_scene(random, 0, 5);
        let cone = scenes::shape(random, 5, DVec3::ZERO, 1.0);
        scene.parts.push(part("cone", [cone]));
        scene.instances.push(instance(2, Placement::IDENTITY));
        let blob = blob(&scene, &[structure]);
        let loaded = blob.scene().expect("a scene");
        let required = Requirements::of(blob.bytes()).expect("requirements");
        assert_eq!(required.parts, 3);
        assert_eq!(required.stack_depth, loaded.stack_depth());
        assert_eq!(required.effects, loaded.effects_with_parts());
        assert!(required.holds(structure));
        assert_eq!(required.missing(), None);
        // Cut off within its parts it is rejected.
        let whole = blob.bytes();
        let parts = section(whole, SectionKind::PartBlobs);
        assert!(Requirements::of(&whole[..parts.start + 64]).is_err());
        // A deeper part requires a deeper stack, whatever the header of the whole says.
        let mut deep = whole.to_vec();
        let place = parts.start + offset_of!(Header, stack_depth);
        deep[place..place + 2].copy_from_slice(&77_u16.to_le_bytes());
        let required = Requirements::of(&deep).expect("requirements");
        assert_eq!(required.stack_depth, 77);
    }
}
