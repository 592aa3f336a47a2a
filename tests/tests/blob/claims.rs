//! Records that are valid one by one and lie together, and headers that claim what no section proves.

use super::forged::{field, section};
use super::{small_blob, works};
use glam::DVec3;
use gridel_core::Structure;
use gridel_core::format::cluster::{Pack16, Strip24};
use gridel_core::format::record::Header;
use gridel_core::format::{Effects, SectionKind};
use gridel_host::compile::{Options, compile};
use gridel_host::scene::Shape;
use gridel_host::shape::Sphere;
use gridel_tests::fuzz::{Base, agree, sealed, some_rays, speaks};
use gridel_tests::scenes;
use std::mem::offset_of;

/// A blob of one structure.
fn alone(structure: Structure, scene: &gridel_host::scene::Scene, lattice_bits: u8) -> Vec<u8> {
    let options = Options {
        structures: vec![structure],
        lattice_bits,
        ..Options::default()
    };
    let blob = compile(scene, &options).expect("compiles").blob;
    blob.bytes().to_vec()
}

fn header_of(bytes: &[u8]) -> Header {
    bytemuck::pod_read_unaligned(&bytes[..size_of::<Header>()])
}

fn with_header(bytes: &[u8], header: &Header) -> Vec<u8> {
    [bytemuck::bytes_of(header), &bytes[size_of::<Header>()..]].concat()
}

/// A blob has a structure only if it has the structure's sections. In a blob of `wide` alone triangles and spheres have
/// no records, so a grid or an octree without any cells would list them all.
#[test]
fn structures_without_their_sections_are_rejected() {
    let ball = |x: f64| {
        Shape::Sphere(Sphere {
            center: DVec3::new(x, 0.0, 0.0),
            radius: 0.5,
        })
    };
    let scenes = [scenes::soup(3, 16, 0.4), scenes::of([ball(0.0), ball(2.0)])];
    for scene in &scenes {
        for held in [Structure::Wide, Structure::List] {
            let bytes = alone(held, scene, 24);
            for claimed in Structure::ALL {
                let mut header = header_of(&bytes);
                header.structures ^= claimed.bit();
                let error = sealed(&with_header(&bytes, &header)).scene().err();
                let (held, claimed) = (held.name(), claimed.name());
                let error = error.unwrap_or_else(|| panic!("{held} as {claimed} was accepted"));
                speaks(&error);
            }
        }
    }
}

#[test]
fn effects_that_nothing_calls_for_are_rejected() {
    let bytes = alone(Structure::List, &scenes::soup(3, 6, 0.4), 24);
    for (effect, name) in Effects::NAMED {
        let mut header = header_of(&bytes);
        if header.effects & effect.0 == 0 {
            header.effects |= effect.0;
            let blob = sealed(&with_header(&bytes, &header));
            speaks(&blob.scene().expect_err(name));
        }
    }
    // Without a light nothing is in the shadow.
    let mut dark = Base::of(&small_blob(24));
    dark.remove(&[SectionKind::Lights]);
    speaks(&dark.sealed().scene().expect_err("shadows without lights"));
    dark.header().effects &= !Effects::SHADOW.0;
    works(&dark.sealed().scene().expect("a dark scene"), 20);
}

/// If coordinates wrap, a radius of 65536 minus the old one has the old box, inside out. Among other spheres of the
/// pack it goes unnoticed.
#[test]
fn pack_radii_that_wrap_are_rejected() {
    let spheres = (0..16).map(|number| {
        Shape::Sphere(Sphere {
            center: DVec3::new(f64::from(number % 4), f64::from(number / 4), 0.0),
            radius: 0.3 + 0.01 * f64::from(number),
        })
    });
    let bytes = alone(Structure::Wide, &scenes::of(spheres), 16);
    let (_, packs) = section(&bytes, SectionKind::Packs);
    for pack in 0..packs.count as usize {
        let radii = field(&packs, pack, offset_of!(Pack16, radii));
        for place in (radii..radii + 16).step_by(2) {
            let mut forged = bytes.clone();
            let radius = u16::from_le_bytes([bytes[place], bytes[place + 1]]);
            assert!(radius > 1);
            forged[place..place + 2].copy_from_slice(&radius.wrapping_neg().to_le_bytes());
            let error = sealed(&forged).scene().err();
            speaks(&error.unwrap_or_else(|| panic!("pack {pack}: {radius} was accepted")));
        }
    }
}

/// A vertex beyond 32767 units has a box that ends at -32768, if it wraps. Among other triangles of the strip it goes
/// unnoticed.
#[test]
fn strip_vertices_that_wrap_are_rejected_or_in_no_triangle() {
    let bytes = alone(Structure::Wide, &scenes::of([scenes::sheet(4)]), 24);
    let (_, strips) = section(&bytes, SectionKind::Strips);
    let mut rejected = 0;
    for strip in 0..strips.count as usize {
        let low_bits = field(&strips, strip, offset_of!(Strip24, rows.low));
        let high_bits = field(&strips, strip, offset_of!(Strip24, rows.high));
        for (axis, lane) in (0..3).flat_map(|axis| (0..8).map(move |lane| (axis, lane))) {
            let mut forged = bytes.clone();
            let low = low_bits + 16 * axis + 2 * lane;
            forged[low..low + 2].copy_from_slice(&0xff80_u16.to_le_bytes());
            forged[high_bits + 8 * axis + 2 * (lane & 3) + (lane >> 2)] = 0x7f;
            match sealed(&forged).scene() {
                Ok(scene) => agree(&scene, &some_rays(&scene, lane as u64)),
                Err(error) => {
                    speaks(&error);
                    rejected += 1;
                }
            }
        }
    }
    assert!(rejected > 3 * strips.count, "{rejected}");
}

/// Slot locations lead to slots, so they need records in them.
#[test]
fn homes_of_triangles_without_records_are_rejected() {
    let triangles = scenes::sheet(3);
    let ball = Shape::Sphere(Sphere {
        center: DVec3::ZERO,
        radius: 1.0,
    });
    let scene = scenes::of([triangles, ball]);
    let shared = Options {
        structures: vec![Structure::Wide, Structure::Bvh],
        ..Options::default()
    };
    let shared = compile(&scene, &shared).expect("compiles").blob;
    works(&shared.scene().expect("a scene"), 20);
    assert!(section(shared.bytes(), SectionKind::SlotLocations).1.count > 0);
    // The blob without the pairs, the leaves and the triangles' records and slots.
    let mut base = Base::of(shared.bytes());
    base.remove(&[
        SectionKind::Pairs,
        SectionKind::Leaves,
        SectionKind::Triangles,
    ]);
    base.header().structures = Structure::List.bit() | Structure::Wide.bit();
    base.header().longest_leaf = 0;
    for kind in [SectionKind::Order, SectionKind::SlotLocations] {
        base.drop_first(kind, 18);
    }
    // Then nothing proves that the triangles' members are primitives.
    base.section(SectionKind::Members)[..2].fill(0xff);
    let stack = shared.scene().expect("a scene").stack_depth();
    let rejected = (0..=stack).all(|depth| {
        base.header().stack_depth = depth as u16;
        base.header().stack_bytes = 12 * depth as u32;
        base.sealed().scene().is_err()
    });
    assert!(rejected, "slot locations without records were accepted");
}
