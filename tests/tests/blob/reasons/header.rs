//! The header, the section table, names, and the errors of a program that verifies at compile time.

use super::{Errors, everything};
use glam::DVec3;
use gridel_core::format::record::SectionEntry;
use gridel_core::format::{Field, Reason, SectionKind};
use gridel_core::{Names, Prevalidated, Structure};
use gridel_host::compile::{Options, compile};
use gridel_host::scene::Shape;
use gridel_host::shape::Sphere;
use gridel_tests::fuzz::{Base, sealed};
use gridel_tests::scenes;

pub(super) fn headers() -> Errors {
    let mut errors = everything();
    let header = "header";
    errors.field(header, Field::StackDepth, |it| {
        it.header().stack_depth = 161
    });
    errors.field(header, Field::StackDepth, |it| {
        it.header().stack_depth += 1;
        it.header().stack_bytes += 12;
    });
    errors.field(header, Field::StackBytes, |it| it.header().stack_bytes += 1);
    errors.field(header, Field::LatticeBits, |it| {
        it.header().lattice_bits = 25
    });
    errors.field(header, Field::StorageBits, |it| {
        it.header().storage_bits = 16
    });
    for exponent in [-1001, 1001] {
        errors.field(header, Field::UnitExponent, |it| {
            it.header().unit_exponent = exponent
        });
    }
    errors.field(header, Field::LongestLeaf, |it| {
        it.header().longest_leaf = 99
    });
    errors.field(header, Field::Slots, |it| it.header().primitives = 1);
    errors.reason(header, Reason::UnknownEffects, |it| {
        it.header().effects |= 1 << 31
    });
    errors.reason(header, Reason::UnneededEffects, |it| {
        it.remove(&[SectionKind::Lights])
    });
    errors.reason(header, Reason::MissingList, |it| {
        it.header().structures &= !Structure::List.bit()
    });
    errors.reason(header, Reason::UnknownStructures, |it| {
        it.header().structures |= 1 << 31
    });
    errors.reason(header, Reason::OriginNotFinite, |it| {
        it.header().origin[1] = f64::NAN
    });
    errors.reason(header, Reason::InvertedBounds, |it| {
        it.header().bounds.0[2].reverse()
    });
    errors.reason(header, Reason::ReservedBounds, |it| {
        it.header().bounds.0[1][0] = i16::MIN
    });
    errors.field(header, Field::CoordinateShift, |it| {
        it.header().coordinate_shift = 20
    });
    errors.field(header, Field::CoordinateOrigin, |it| {
        it.header().counted_from = 2
    });
    for word in 0..3 {
        errors.reason(header, Reason::SpareNotZero, |it| {
            it.header().spare[word] = 1
        });
    }
    errors.reason(header, Reason::MissingObjectFirst, |it| {
        it.remove(&[SectionKind::ObjectFirst])
    });
    errors
}

pub(super) fn section_tables() -> Errors {
    let mut errors = everything();
    let bytes = errors.base.sealed().bytes().to_vec();
    let sections = usize::from(errors.base.header().section_count) - 1;
    let forged = |line: usize, forge: &dyn Fn(&mut SectionEntry)| {
        let mut bytes = bytes.clone();
        let place = 96 + line * size_of::<SectionEntry>();
        let entry = &mut bytes[place..place + size_of::<SectionEntry>()];
        let mut forged = bytemuck::pod_read_unaligned(entry);
        forge(&mut forged);
        entry.copy_from_slice(bytemuck::bytes_of(&forged));
        let error = sealed(&bytes).scene().err();
        error.expect("a forged table was accepted")
    };
    let line = |number: usize| format!("line {number} of the section table");
    for kind in [0, 1, 999] {
        let number = if kind == 1 { 1 } else { 0 };
        let error = forged(number, &|entry| entry.kind = kind);
        errors.take_field(error, &line(number), Field::Kind);
    }
    let error = forged(2, &|entry| entry.offset += 16);
    errors.take_field(error, &line(2), Field::Offset);
    let error = forged(3, &|entry| entry.count = u32::MAX);
    errors.take_field(error, &line(3), Field::End);
    let error = forged(sections, &|entry| entry.spare = 1);
    errors.take_reason(error, &line(sections), Reason::SpareNotZero);
    errors
}

pub(super) fn prevalidated() -> Errors {
    let mut errors = everything();
    let error = |base: &Base| Prevalidated::of(base.sealed().bytes()).err();
    let rejected = error(&errors.base).expect("a grid was verified");
    errors.take_reason(rejected, "header", Reason::NotPrevalidated);
    let mut base = errors.base.clone();
    base.header().structures = Structure::List.bit() | Structure::Bvh.bit();
    let rejected = error(&base).expect("the sections of a grid were verified");
    let first = SectionKind::DualNodes as usize;
    let line = format!("line {first} of the section table");
    errors.take_reason(rejected, &line, Reason::NotPrevalidated);
    errors
}

pub(super) fn names() -> Errors {
    let mut scene = scenes::of([Shape::Sphere(Sphere {
        center: DVec3::ZERO,
        radius: 1.0,
    })]);
    scene.objects[0].name = String::from("ö");
    let options = Options {
        names: true,
        ..Options::default()
    };
    let blob = compile(&scene, &options).expect("compiles").blob;
    let mut errors = Errors::of(Base::of(blob.bytes()));
    let forged = |base: &Base, kind, record, value| {
        let mut base = base.clone();
        base.set(kind, record, value);
        let blob = base.sealed();
        // Queries do not need names.
        assert!(blob.scene().is_ok());
        Names::from_bytes(blob.bytes()).expect_err("a forged name")
    };
    let start = forged(&errors.base, SectionKind::NameStarts, 0, 1);
    let inside = forged(&errors.base, SectionKind::NameStarts, 1, 1);
    let text = forged(&errors.base, SectionKind::NameText, 1, 0xff);
    errors.take_field(start, "name 0 of name-starts", Field::NameStart);
    errors.take_reason(inside, "name 1 of name-starts", Reason::InsideCharacter);
    errors.take_reason(text, "byte 0 of name-text", Reason::NotUtf8);
    errors
}
