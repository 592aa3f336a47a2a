//! Has a forged blob for every field that can be out of its range, and for every other reason to
//! reject one. The error names the place and what is wrong there.

mod header;
mod hierarchies;
mod instances;
mod morph;
mod records;
mod tables;
mod tracks;

use super::small_blob;
use glam::DVec3;
use gridel_core::Structure;
use gridel_core::format::record::{DualNode, Pair, Sphere24};
use gridel_core::format::{BlobError, Field, Reason, SectionKind};
use gridel_host::compile::{Options, compile};
use gridel_host::scene::Shape;
use gridel_host::shape::Sphere;
use gridel_tests::fuzz::{Base, speaks};
use header::{headers, names, prevalidated, section_tables};
use hierarchies::{deep_hierarchy, hierarchies, slabs, wide_hierarchies};
use instances::{instances, joints};
use morph::morph;
use records::{
    environments, lens_and_bounces, light_forms, media, primitives, rough, shading_data, textures,
};
use tables::{candidates, cells};
use tracks::{tracks, turned_camera};

/// A field of a record, and what puts it out of its range.
type Forgery<'f, R> = (Field, &'f dyn Fn(&mut R));

/// The errors that forged blobs were rejected with.
struct Errors {
    base: Base,
    fields: Vec<Field>,
    reasons: Vec<Reason>,
    /// Errors other than those that were expected.
    failures: Vec<String>,
}

impl Errors {
    fn of(base: Base) -> Self {
        Self {
            base,
            fields: Vec::new(),
            reasons: Vec::new(),
            failures: Vec::new(),
        }
    }

    fn forged(&self, forge: impl FnOnce(&mut Base)) -> BlobError {
        let mut base = self.base.clone();
        forge(&mut base);
        let error = base.sealed().scene().err();
        // A blob that is accepted has no error of the kind that is expected.
        let error = error.unwrap_or(BlobError::Misaligned);
        speaks(&error);
        error
    }

    /// Takes an error that must name a place and a field.
    fn take_field(&mut self, error: BlobError, place: &str, expected: Field) {
        let text = error.to_string();
        let begins = text.starts_with(&format!("{place}: its {expected} is "));
        let out_of_range = matches!(
            error,
            BlobError::OutOfRange { field, found, range: [low, high], .. }
                if field == expected && (found < low || found > high)
        );
        if begins && out_of_range {
            self.fields.push(expected);
        } else {
            self.failures.push(format!("{place}, {expected}: {text}"));
        }
    }

    /// Takes an error that must name a place and a reason.
    fn take_reason(&mut self, error: BlobError, place: &str, expected: Reason) {
        let text = error.to_string();
        let is_meant = matches!(error, BlobError::Invalid { reason, .. } if reason == expected);
        if is_meant && text == format!("{place}: {expected}") {
            self.reasons.push(expected);
        } else {
            self.failures.push(format!("{place}, {expected}: {text}"));
        }
    }

    fn field(&mut self, place: &str, field: Field, forge: impl FnOnce(&mut Base)) {
        let error = self.forged(forge);
        self.take_field(error, place, field);
    }

    fn reason(&mut self, place: &str, reason: Reason, forge: impl FnOnce(&mut Base)) {
        let error = self.forged(forge);
        self.take_reason(error, place, reason);
    }

    /// Changes a record until the blob is rejected for a reason.
    fn one_of(
        &mut self,
        reason: Reason,
        forgeries: impl Iterator<Item = (usize, u32)>,
        forge: impl Fn(&mut Base, usize, u32),
    ) {
        for (index, value) in forgeries {
            let mut base = self.base.clone();
            forge(&mut base, index, value);
            let error = base.sealed().scene().err();
            let is_meant = |error: &BlobError| matches!(error, BlobError::Invalid { reason: it, .. } if *it == reason);
            if let Some(error) = error.filter(is_meant) {
                speaks(&error);
                self.reasons.push(reason);
                return;
            }
        }
        self.failures.push(format!("{reason:?} was not met"));
    }
}

/// The error of what a picture at rest does not need, as `read` finds it.
fn aside<T>(base: Base, read: impl FnOnce(&[u8]) -> Result<T, BlobError>) -> BlobError {
    let blob = base.sealed();
    assert!(blob.scene().is_ok());
    let error = read(blob.bytes()).err();
    let error = error.unwrap_or(BlobError::Misaligned);
    speaks(&error);
    error
}

/// Every structure, effect and kind of primitive.
fn everything() -> Errors {
    Errors::of(Base::of(&small_blob(24)))
}

/// One structure.
fn alone(scene: &gridel_host::scene::Scene, structure: Structure, lattice_bits: u8) -> Errors {
    let options = Options {
        structures: vec![structure],
        lattice_bits,
        ..Options::default()
    };
    let blob = compile(scene, &options).expect("compiles").blob;
    Errors::of(Base::of(blob.bytes()))
}

fn balls(count: u32) -> impl Iterator<Item = Shape> {
    (0..count).map(|number| {
        Shape::Sphere(Sphere {
            center: DVec3::new(f64::from(number % 4), f64::from(number / 4), 0.0),
            radius: 0.3,
        })
    })
}

const LEAF: u32 = 1 << 31;

#[test]
fn every_field_and_reason_is_named_by_the_error_of_a_forged_blob() {
    let all = [
        headers(),
        section_tables(),
        prevalidated(),
        shading_data(),
        textures(),
        light_forms(),
        lens_and_bounces(),
        environments(),
        rough(),
        media(),
        primitives(),
        hierarchies(),
        deep_hierarchy(),
        slabs(),
        wide_hierarchies(),
        cells(),
        candidates(),
        names(),
        tracks(),
        turned_camera(),
        instances(),
        joints(),
        morph(),
    ];
    let failures: Vec<&String> = all.iter().flat_map(|errors| &errors.failures).collect();
    assert!(failures.is_empty(), "{failures:#?}");
    for field in Field::ALL {
        let is_met = all.iter().any(|errors| errors.fields.contains(field));
        assert!(is_met, "no forged blob has a wrong {field}");
    }
    for reason in Reason::ALL {
        let is_met = all.iter().any(|errors| errors.reasons.contains(reason));
        assert!(is_met, "no forged blob is rejected because {reason}");
    }
}

#[test]
fn errors_say_what_is_wrong_and_where() {
    let errors = everything();
    let radius = |it: &mut Base| {
        it.change(SectionKind::Spheres, 0, |it: &mut Sphere24| {
            it.radius = [0; 3]
        })
    };
    assert_eq!(
        errors.forged(radius).to_string(),
        "sphere 0: its radius is 0; it must be from 1 to 16776704"
    );
    let orphan = |it: &mut Base| {
        it.change(SectionKind::Pairs, 0, |it: &mut Pair| {
            it.children = [LEAF, LEAF | 1]
        })
    };
    assert_eq!(
        errors.forged(orphan).to_string(),
        "pair 1 of bvh: no node leads to it"
    );
    let unused = |it: &mut Base| {
        it.change(SectionKind::DualNodes, 2, |it: &mut DualNode| {
            it.word |= 1 << 31
        })
    };
    assert_eq!(
        errors.forged(unused).to_string(),
        "node 2 of dual-split: bits that have no meaning are set"
    );
    let deep = |it: &mut Base| it.header().stack_depth = 161;
    assert_eq!(
        errors.forged(deep).to_string(),
        "header: its stack depth is 161; it must be from 0 to 160"
    );
}
