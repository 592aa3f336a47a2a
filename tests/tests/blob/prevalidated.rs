//! Blobs that a program prevalidates: which properties are proved then, and that nothing depends on the rest.

use super::forged::section;
use super::{render_small, small_scene};
use gridel_core::accel::DynAccel;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::format::record::{DualNode, FlaggedPair, Header, Pair};
use gridel_core::format::{Leaf, SectionKind};
use gridel_core::number::let_numbers_wrap;
use gridel_core::{
    BlobError, Counters, Number, Prevalidated, Requirements, Scene, Settings, Stack, Structure,
    any_hit, closest_hit,
};
use gridel_host::blob::Blob;
use gridel_host::compile::{Options, compile};
use gridel_tests::fuzz::{sealed, speaks};
use gridel_tests::query::{held, through};
use gridel_tests::random::Random;
use gridel_tests::{every_format, rays, scenes};
use std::mem::offset_of;

/// Sections that are proved, with the size of a record and of the words in it that lead to others.
const LINKS: [(SectionKind, usize, usize); 3] = [
    (SectionKind::Pairs, size_of::<Pair>(), 8),
    (SectionKind::FlaggedPairs, size_of::<FlaggedPair>(), 4),
    (SectionKind::DualNodes, size_of::<DualNode>(), 4),
];

fn blob_for_boards(lattice_bits: u8) -> Vec<u8> {
    let options = Options {
        structures: Prevalidated::STRUCTURES.to_vec(),
        lattice_bits,
        ..Options::default()
    };
    let compiled = compile(&small_scene(), &options).expect("compiles");
    compiled.blob.bytes().to_vec()
}

fn prevalidated(blob: &Blob) -> Result<Scene<'_>, BlobError> {
    Scene::prevalidated(Prevalidated::of(blob.bytes())?)
}

#[test]
fn answers_are_those_of_a_blob_that_was_checked() {
    fn same<N: Number>(prevalidated: &Scene<'_>, checked: &Scene<'_>) {
        for ray in rays::rays(checked, 3).take(2000) {
            let Some(ready) = ray.ready::<N>(checked) else {
                continue;
            };
            for structure in held(checked) {
                let answer = through::<N>(structure, prevalidated, &ready);
                assert_eq!(answer, through(structure, checked, &ready), "{ray:?}");
            }
        }
    }
    for lattice_bits in [16, 24] {
        let blob = Blob::new(&blob_for_boards(lattice_bits));
        let checked = blob.scene().expect("a scene");
        let prevalidated = prevalidated(&blob).expect("a scene");
        assert_eq!(held(&prevalidated).count(), 3);
        every_format!(same(&prevalidated, &checked));
    }
}

/// A const evaluation, as firmware has the compiler do it.
#[test]
fn blobs_are_prevalidated_while_a_program_is_compiled() {
    const EMPTY: Result<Prevalidated<'static>, BlobError> = Prevalidated::of(&[]);
    const FOREIGN: Result<Prevalidated<'static>, BlobError> = Prevalidated::of(&[0x47; 24]);
    assert!(matches!(EMPTY, Err(BlobError::Truncated { found: 0, .. })));
    assert_eq!(FOREIGN.err(), Some(BlobError::Magic));
}

#[test]
fn damage_is_found() {
    let mut bytes = blob_for_boards(16);
    for bit in 0..8 * bytes.len() {
        bytes[bit / 8] ^= 1 << (bit % 8);
        speaks(&prevalidated(&Blob::new(&bytes)).expect_err("a flipped bit was prevalidated"));
        bytes[bit / 8] ^= 1 << (bit % 8);
    }
    for length in 0..bytes.len() {
        speaks(&prevalidated(&Blob::new(&bytes[..length])).expect_err("a part was prevalidated"));
        // With a checksum that fits, loading finds out.
        speaks(&prevalidated(&sealed(&bytes[..length])).expect_err("a part was loaded"));
    }
}

/// Whatever leads elsewhere is rejected.
#[test]
fn disorder_is_found() {
    let bytes = blob_for_boards(24);
    let leaves = section(&bytes, SectionKind::Leaves).1.count;
    for (kind, size, links) in LINKS {
        let (_, entry) = section(&bytes, kind);
        assert_eq!(usize::from(entry.stride), size);
        for record in 0..entry.count as usize {
            let end = entry.offset as usize + (record + 1) * size;
            for bit in 0..8 * links {
                let mut changed = bytes.clone();
                changed[end - links + bit / 8] ^= 1 << (bit % 8);
                // Owners of planes, and the axes of splits and carves, are no links.
                let leads = match kind {
                    SectionKind::FlaggedPairs => bit < 26,
                    SectionKind::DualNodes => bit < 24,
                    _ => true,
                };
                match prevalidated(&sealed(&changed)) {
                    Err(error) => speaks(&error),
                    Ok(scene) => {
                        assert!(!leads, "{kind:?} {record}: bit {bit}");
                        ends(&scene, leaves, 20);
                    }
                }
            }
        }
    }

    // A hierarchy that is deeper than the stack.
    let mut changed = bytes.clone();
    let place = offset_of!(Header, stack_depth);
    changed[place] -= 1;
    let error = Prevalidated::of(sealed(&changed).bytes()).expect_err("too deep a hierarchy");
    assert!(
        error.to_string().starts_with("header: its stack depth is "),
        "{error}"
    );
}

#[test]
fn tables_cannot_be_prevalidated() {
    for structure in Structure::ALL {
        let options = Options {
            structures: vec![Structure::Bvh, structure],
            gridels: Some(1),
            budget: Some(4096),
            ..Options::default()
        };
        let blob = compile(&small_scene(), &options).expect("compiles").blob;
        let result = Prevalidated::of(blob.bytes());
        if Prevalidated::STRUCTURES.contains(&structure) {
            assert!(result.is_ok(), "{}", structure.name());
        } else {
            speaks(&result.expect_err(structure.name()));
        }
    }
}

/// Fills every record with anything, except the words that lead from one record to another. Walks end within the work
/// that the order allows, and so do pictures.
#[test]
fn nothing_depends_on_unproved_sections() {
    // Numbers that are not proved leave their ranges. One thread, so that rows of pictures are rendered on it as well.
    let threads = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    threads
        .expect("a thread")
        .install(|| let_numbers_wrap(spoil_unproved_sections));
}

fn spoil_unproved_sections() {
    let mut random = Random(7);
    let valid = [16, 24].map(blob_for_boards);
    let (mut rejected, mut loaded) = (0, 0);
    for round in 0..6000 {
        let mut bytes = valid[round % 2].clone();
        let leaves = section(&bytes, SectionKind::Leaves).1.count;
        for kind in SectionKind::ALL {
            if kind > SectionKind::DualNodes || random.below(3) == 0 {
                continue;
            }
            // The view is proved: an invalid camera is rejected.
            let changes = if kind == SectionKind::View {
                1
            } else {
                1 << random.below(14)
            };
            let (_, entry) = section(&valid[round % 2], kind);
            let stride = usize::from(entry.stride);
            let links = LINKS.iter().find(|link| link.0 == kind);
            let links = links.map_or(0, |&(_, _, links)| links);
            let start = entry.offset as usize;
            for _ in 0..changes {
                let record = start + random.below(entry.count as usize) * stride;
                let free = &mut bytes[record..record + stride - links];
                spoil(free, &mut random);
            }
        }
        match prevalidated(&sealed(&bytes)) {
            Err(error) => {
                rejected += 1;
                speaks(&error);
            }
            Ok(scene) => {
                loaded += 1;
                ends(&scene, leaves, 40);
            }
        }
    }
    eprintln!("{loaded} blobs of any content loaded, {rejected} rejected");
    assert!(loaded > 2000);
}

/// Overwrites part of a record.
fn spoil(record: &mut [u8], random: &mut Random) {
    let extremes = [
        i64::MIN,
        i64::MAX,
        0,
        -1,
        1,
        0x7fff_ffff_7fff_ffff,
        -0x7fff_ffff_8000_0000,
        random.bits() as i64,
    ];
    let value = extremes[random.below(extremes.len())].to_le_bytes();
    let length = [1, 2, 4, 8][random.below(4)].min(record.len());
    if let Some(places) = record.len().checked_div(length) {
        let place = random.below(places.max(1)) * length;
        record[place..place + length].copy_from_slice(&value[..length]);
    }
}

/// Traces and renders: in the tests' build every overflow would panic.
fn ends(scene: &Scene<'_>, leaves: u32, rays_each: usize) {
    every_format!(walks_end(scene, leaves, rays_each));
    let settings = Settings {
        samples: 2,
        depth: 4,
        ..Settings::of(scene)
    };
    render_small(scene, settings);
}

fn walks_end<N: Number>(scene: &Scene<'_>, leaves: u32, rays_each: usize) {
    let mut stack = Stack::<MAX_STACK_DEPTH>::new();
    for ray in rays::rays(scene, 3).take(rays_each) {
        let Some(ready) = ray.ready::<N>(scene) else {
            continue;
        };
        for structure in Prevalidated::STRUCTURES {
            let Some(scene) = scene.choose(structure) else {
                continue;
            };
            let (mut first, mut any) = (Counters::default(), Counters::default());
            let stack = stack.as_view();
            closest_hit::<N, DynAccel, _>(&scene, &ready, stack, &mut first);
            any_hit::<N, DynAccel, _>(&scene, &ready, stack, &mut any);
            for count in [first, any] {
                // A tree of leaves has fewer nodes than twice as many. Each is visited once, with two carves and a
                // split; a pair has two boxes.
                let leaves = u64::from(leaves);
                assert!(count.boxes <= 1 + 8 * leaves, "{count:?}");
                assert!(
                    count.primitives <= u64::from(Leaf::MAX_COUNT) * leaves,
                    "{count:?}"
                );
            }
        }
    }
}

/// Requirements that are read while a program is compiled equal those of the scene.
#[test]
fn demands_are_those_of_the_scene() {
    for (name, scene) in scenes::fixtures() {
        for structure in Prevalidated::STRUCTURES {
            let options = Options {
                structures: vec![structure],
                ..Options::default()
            };
            let blob = compile(&scene, &options).expect("compiles").blob;
            let scene = blob.scene().expect("a scene");
            let (required, view) = (
                Requirements::of(blob.bytes()).expect("a whole blob"),
                scene.view(),
            );
            assert_eq!(required.stack_depth, scene.stack_depth(), "{name}");
            assert_eq!(required.effects, scene.effects(), "{name}");
            let work_depth = scene.effects().work_depth(view.depth);
            assert_eq!(required.work_depth, work_depth, "{name}");
            let size = [view.width, view.height].map(usize::from);
            assert_eq!([required.width, required.height], size, "{name}");
            for structure in Structure::ALL {
                assert_eq!(required.holds(structure), scene.holds(structure), "{name}");
            }
            let [exponent, own] = [required.coordinate_exponent, scene.coordinate_exponent()];
            assert_eq!(exponent, own, "{name}");
            let origin = scene.header().coordinate_origin();
            assert_eq!(required.coordinate_origin(), origin, "{name}");
            assert!(required.counts_as(exponent, origin), "{name}");
            assert!(!required.counts_as(exponent + 1, origin), "{name}");
            assert_eq!(required.instances, scene.instances().len(), "{name}");
            let bits = u32::from(scene.header().storage_bits);
            assert_eq!(required.vertex_bits(), bits, "{name}");
            // This build has every feature.
            assert_eq!(required.missing(), None, "{name}");
        }
    }
}

/// Reading the requirements of any blob terminates.
#[test]
fn requirements_of_broken_blobs_are_read_or_rejected() {
    let whole = blob_for_boards(24);
    for length in 0..whole.len() {
        let cut = &whole[..length];
        for error in [Requirements::of(cut).err(), Prevalidated::of(cut).err()] {
            let is_cut =
                matches!(error, Some(BlobError::Truncated { found, .. }) if found == length);
            assert!(is_cut, "{length} bytes: {error:?}");
        }
    }
    let longer = [&whole[..], &[0; 4]].concat();
    assert!(Requirements::of(&longer).is_err());
    let mut random = Random(9);
    for _ in 0..20_000 {
        let mut broken = whole.clone();
        for _ in 0..4 {
            let place = random.below(600);
            broken[place] = random.below(256) as u8;
        }
        let _ = Requirements::of(&broken);
    }
}
