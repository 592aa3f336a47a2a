//! Headers, section tables and hierarchies that lie, with a checksum that fits.

use super::{Fate, small_blob, works};
use glam::DVec3;
use gridel_core::format::cluster::Pack24;
use gridel_core::format::record::{DualNode, FlaggedPair, Header, Pair, SectionEntry, WideNode};
use gridel_core::format::{Link, NodeWord, SectionKind};
use gridel_core::{Names, Number, Scene, Structure, Tracks};
use gridel_host::compile::{Options, compile};
use gridel_host::scene::Shape;
use gridel_host::shape::Sphere;
use gridel_tests::fuzz::{sealed, speaks};
use gridel_tests::query::{UnitRay, held, through};
use gridel_tests::scenes;
use std::mem::offset_of;

/// A forged header must be rejected.
fn rejects_header(what: &str, forge: impl Fn(&mut Header)) {
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
fn forged_headers_are_rejected() {
    rejects_header("stack depth 0", |h| (h.stack_depth, h.stack_bytes) = (0, 0));
    rejects_header("stack depth 255", |h| {
        (h.stack_depth, h.stack_bytes) = (255, 255 * 12)
    });
    rejects_header("stack depth one too large", |h| {
        h.stack_depth += 1;
        h.stack_bytes += 12;
    });
    rejects_header("too few stack bytes", |h| h.stack_bytes -= 1);
    rejects_header("no primitives", |h| h.primitives = 0);
    rejects_header("4294967295 objects", |h| h.objects = u32::MAX);
    rejects_header("no objects", |h| h.objects = 0);
    rejects_header("65535 sections", |h| h.section_count = u16::MAX);
    rejects_header("another byte order", |h| {
        h.endianness = h.endianness.swap_bytes()
    });
    rejects_header("version 2", |h| h.version = 2);
    rejects_header("unknown effects", |h| h.effects |= 1 << 31);
    rejects_header("unknown structures", |h| h.structures |= 1 << 31);
    rejects_header("a missing effect", |h| h.effects = 0);
    rejects_header("longest leaf 0", |h| h.longest_leaf = 0);
    rejects_header("a box of -32768", |h| h.bounds.0[1][0] = i16::MIN);
    rejects_header("an inverted box", |h| h.bounds.0[2].reverse());
    rejects_header("an empty box", |h| h.bounds.0 = [[0; 2]; 3]);
    for (axis, value) in [(0, f64::NAN), (1, f64::INFINITY), (2, f64::NEG_INFINITY)] {
        rejects_header("an origin that is not finite", |h| h.origin[axis] = value);
    }
    rejects_header("unit exponent -32768", |h| h.unit_exponent = i16::MIN);
    rejects_header("unit exponent 32767", |h| h.unit_exponent = i16::MAX);
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

/// Returns the offset of a section's entry in the table, and the entry.
pub fn section(bytes: &[u8], kind: SectionKind) -> (usize, SectionEntry) {
    let header: Header = bytemuck::pod_read_unaligned(&bytes[..size_of::<Header>()]);
    let entries = bytes[size_of::<Header>()..].chunks_exact(size_of::<SectionEntry>());
    let mut entries =
        entries
            .take(header.section_count.into())
            .enumerate()
            .map(|(index, entry)| {
                let place = size_of::<Header>() + index * size_of::<SectionEntry>();
                (place, bytemuck::pod_read_unaligned::<SectionEntry>(entry))
            });
    entries
        .find(|(_, entry)| entry.kind == kind as u16)
        .expect("the section")
}

/// Returns the offset of a field of a record in the blob, given its offset in the record.
pub fn field(section: &SectionEntry, record: usize, offset: usize) -> usize {
    section.offset as usize + record * usize::from(section.stride) + offset
}

#[test]
fn forged_sections_are_rejected() {
    let bytes = small_blob(24);
    // Normals, parts and instances have tests of their own.
    let kinds = SectionKind::ALL.into_iter();
    for kind in kinds.filter(|&kind| kind < SectionKind::Normals) {
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
            changed[place..place + size_of_val(&forged)]
                .copy_from_slice(bytemuck::bytes_of(&forged));
            let blob = sealed(&changed);
            // Names and tracks are read, and proved, apart from the scene.
            let names = || Names::from_bytes(blob.bytes()).err();
            let tracks = || Tracks::from_bytes(blob.bytes()).err();
            let error = blob.scene().err().or_else(names).or_else(tracks);
            assert!(error.is_some(), "{kind:?}: {forged:?}");
            error.iter().for_each(speaks);
        }
    }
}

/// Children that lead to their own pair, backwards, beyond the end, or past a pair or a leaf.
#[test]
fn cycles_and_orphans_are_rejected() {
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
        let left = field(&pairs, index as usize, offset_of!(Pair, children));
        for place in [left, left + 4] {
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
        let place = field(&flagged, index as usize, offset_of!(FlaggedPair, link));
        let word = word_at(place);
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
                forge(place, link.0);
            }
        }
    }
    let dual = section(&bytes, SectionKind::DualNodes).1;
    for index in 0..dual.count {
        let place = field(&dual, index as usize, offset_of!(DualNode, word));
        let way = NodeWord(word_at(place));
        let carves = way.carves().map(|axis| axis as u32);
        for number in [
            0,
            index,
            index.wrapping_sub(1) & 0xff_ffff,
            way.number() + 1,
            dual.count,
            0xff_ffff,
        ] {
            for split in 0..4 {
                forge(place, NodeWord::new(number, split, carves).0);
            }
        }
        forge(place, way.0 | 1 << 31);
    }
    let nodes = section(&bytes, SectionKind::WideNodes).1;
    for index in 0..nodes.count {
        let first = field(&nodes, index as usize, offset_of!(WideNode, children));
        for place in (first..first + 32).step_by(4) {
            let word = word_at(place);
            for number in [
                0,
                index,
                word.wrapping_add(1),
                word ^ 1 << 31,
                word | 1 << 24,
                nodes.count,
            ] {
                forge(place, number);
                forge(place, number | 7 << 29);
            }
        }
    }
    eprintln!("forged links: {fate:?}");
    // A leaf's pair may count no pairs before it and mean the same.
    assert!(fate.rejected > 20 * fate.accepted);
}

/// Packs with holes, packs that are not full before the last, and radii that no sphere has.
#[test]
fn forged_packs_are_rejected() {
    let spheres = (0..21).map(|number| {
        Shape::Sphere(Sphere {
            center: DVec3::new(f64::from(number % 5), f64::from(number / 5), 0.0),
            radius: 0.3,
        })
    });
    let options = Options {
        structures: vec![Structure::Wide],
        ..Options::default()
    };
    let blob = compile(&scenes::of(spheres), &options).expect("compiles");
    let bytes = blob.blob.bytes().to_vec();
    let (place, radii) = section(&bytes, SectionKind::Radii);
    let start = radii.offset as usize;
    let words = || bytes[start..].chunks_exact(4);
    let radius = words().position(|word| word != [0; 4]).expect("a radius") as u8;
    let none = words().position(|word| word == [0; 4]).expect("no radius") as u8;
    let rejects = |what: &str, at: usize, forged: &[u8]| {
        let mut changed = bytes.clone();
        changed[at..at + forged.len()].copy_from_slice(forged);
        assert_ne!(changed, bytes, "{what}");
        let error = sealed(&changed).scene().err();
        speaks(&error.unwrap_or_else(|| panic!("{what} was accepted")));
    };
    let of_pack = |pack: usize| {
        let (_, packs) = section(&bytes, SectionKind::Packs);
        field(&packs, pack, offset_of!(Pack24, radii))
    };
    let two = |first: u8, second: u8| [first | second << 4];
    rejects("a pack with a hole", of_pack(0) + 1, &two(none, radius));
    rejects(
        "a first pack that ends early",
        of_pack(0) + 3,
        &two(radius, none),
    );
    rejects("a pack without spheres", of_pack(2), &[none * 17; 4]);
    rejects(
        "a sphere behind the last",
        of_pack(2) + 3,
        &two(none, radius),
    );
    rejects("a sphere too many", of_pack(2) + 2, &two(radius, radius));
    for forged in [-1, i32::MIN, i32::MAX, 16_776_705] {
        rejects("a radius out of range", start + 60, &forged.to_le_bytes());
    }
    let fewer = SectionEntry {
        stride: 8,
        count: radii.count / 2,
        ..radii
    };
    rejects("half the radii", place, bytemuck::bytes_of(&fewer));
}

/// A roof of many gables. All its triangles claim to be primitive 0; rays along the edges that two
/// of them share must meet the same one through every structure.
#[test]
fn slots_of_one_primitive_do_not_divide_structures() {
    let gables = 24;
    let corner = |number: u32| {
        let (row, side) = (number / 2, number % 2);
        DVec3::new(row.into(), f64::from(row % 2), 4.0 * f64::from(side))
    };
    let roof = scenes::of([Shape::Mesh {
        vertices: (0..2 * gables + 2).map(corner).collect(),
        triangles: (0..gables)
            .rev()
            .flat_map(|row| {
                let first = 2 * row;
                [[0, 1, 2], [1, 3, 2]].map(|face| face.map(|vertex| first + vertex))
            })
            .collect(),
    }]);
    // The last triangle first, so that slots and primitives differ and the blob has an order.
    let mut bytes = scenes::blob(&roof, 24).bytes().to_vec();
    let (_, order) = section(&bytes, SectionKind::Order);
    let place = order.offset as usize;
    bytes[place..place + order.count as usize * usize::from(order.stride)].fill(0);
    let blob = sealed(&bytes);
    let scene = blob.scene().expect("nothing in it is out of range");

    fn agree<N: Number>(scene: &Scene<'_>) -> usize {
        let [x, _, z] = scene.bounds().0.map(|sides| sides.map(f64::from));
        let mut met = 0;
        for step in 0..=480 {
            for along in [0.25, 0.5, 0.7] {
                let across = f64::from(step) / 480.0;
                let point = [x[0] + across * (x[1] - x[0]), z[0] + along * (z[1] - z[0])];
                let ray = UnitRay::new([point[0], 32_000.0, point[1]], [0.0, -1.0, 0.0]);
                let ray = ray.ready::<N>(scene).expect("a ray");
                let list = through(Structure::List, scene, &ray);
                met += usize::from(list.1);
                for structure in held(scene) {
                    let found = through(structure, scene, &ray);
                    assert_eq!(found, list, "{}, {}", N::FORMAT.name(), structure.name());
                }
            }
        }
        met
    }
    assert!(agree::<gridel_core::Fixed>(&scene) > 1400);
    assert!(agree::<f32>(&scene) > 1400);
    assert!(agree::<f64>(&scene) > 1400);
}
