//! Parts and instances.

use super::tracks::forged;
use super::{Errors, Forgery, balls};
use glam::DVec3;
use gridel_core::format::instance::{Instance, Part};
use gridel_core::format::record::Header;
use gridel_core::format::track::{Interpolation, Joint, TrackTarget};
use gridel_core::format::{BlobError, Field, Reason, SectionKind};
use gridel_core::scene::part_blobs;
use gridel_core::{Parts, Prevalidated, Scene as Loaded, Structure};
use gridel_host::blob::Blob;
use gridel_host::compile::{Options, compile};
use gridel_host::scene::{self, Placement, Scene, Shape, SourceSpan};
use gridel_host::shape::Plane;
use gridel_tests::fuzz::Base;
use gridel_tests::scenes;

/// A scene that places a ball three times, and one ball of its own.
fn placed() -> Scene {
    let mut scene = scenes::of(balls(1));
    scene.parts = vec![scene::Part {
        name: String::from("ball"),
        objects: scene.objects.clone(),
        place: SourceSpan::default(),
    }];
    let instance = |x: f64| scene::Instance {
        name: String::from("copy"),
        part: 0,
        placement: Placement {
            translation: DVec3::X * x,
            ..Placement::IDENTITY
        },
        joint: None,
        place: SourceSpan::default(),
    };
    scene.instances = [2.0, 4.0, 6.0].map(instance).to_vec();
    scene
}

fn blob(scene: &Scene) -> Blob {
    let options = Options {
        structures: vec![Structure::DualSplit],
        ..Options::default()
    };
    compile(scene, &options).expect("compiles").blob
}

/// A blob with other bytes in place of its only part.
fn with_part(base: &Base, part: &Blob) -> Base {
    let mut base = base.clone();
    let bytes = base.bytes(SectionKind::PartBlobs);
    *bytes = part.bytes().to_vec();
    bytes.resize(bytes.len().next_multiple_of(16), 0);
    let length = bytes.len() as u32 / 16;
    base.change(SectionKind::Parts, 0, |it: &mut Part| it.length = length);
    base
}

pub(super) fn instances() -> Errors {
    let honest = blob(&placed());
    let mut errors = Errors::of(Base::of(honest.bytes()));
    let parts: [Forgery<'_, Part>; 2] = [
        (Field::Start, &|it| it.start = 1),
        (Field::Length, &|it| it.length = 0),
    ];
    for (field, change) in parts {
        errors.field("part 0", field, |it| {
            it.change(SectionKind::Parts, 0, change)
        });
    }
    let instances: [Forgery<'_, Instance>; 5] = [
        (Field::MatrixEntry, &|it| it.matrix[0][0] = 1 << 24),
        (Field::Center, &|it| it.center[2] = i32::MIN),
        (Field::InstanceExponent, &|it| it.exponent = 19),
        (Field::Part, &|it| it.part = 1),
        (Field::Instance, &|it| it.number = 3),
    ];
    for (field, change) in instances {
        errors.field("instance 1", field, |it| {
            it.change(SectionKind::Instances, 1, change)
        });
    }
    for (matrix, entry) in [([0, 0], 0), ([1, 2], 1 << 20), ([2, 2], -(1 << 23))] {
        errors.reason("instance 2", Reason::NotRotation, |it| {
            it.change(SectionKind::Instances, 2, |it: &mut Instance| {
                it.matrix[matrix[0]][matrix[1]] = entry
            })
        });
    }
    errors.reason("part 0", Reason::OtherStructures, |it| {
        it.header().structures |= Structure::Bvh.bit()
    });
    let plane = Shape::Plane(Plane {
        point: DVec3::ZERO,
        normal: DVec3::Y,
    });
    let unbounded = with_part(&errors.base, &blob(&scenes::of([plane])));
    errors.reason("part 0", Reason::UnboundedPart, |it| *it = unbounded);
    errors.others(&honest);
    errors.without_parts();
    errors
}

impl Errors {
    /// Takes the errors of parts that are not those of a blob.
    fn others(&mut self, honest: &Blob) {
        let copy = Blob::new(honest.bytes());
        let parts = Parts::<1>::from_bytes(copy.bytes()).expect("a part");
        let error = Loaded::with_parts(honest.bytes(), &parts).unwrap_err();
        self.take_reason(error, "part 0", Reason::OtherPart);
        // Rays would pass by the parts of a part.
        let outer = with_part(&self.base, honest).sealed();
        let mut parts = part_blobs(outer.bytes()).expect("a part");
        let part = parts.next().expect("a part");
        let inner = Parts::<1>::from_bytes(part).expect("a part of the part");
        let nested = [Loaded::with_parts(part, &inner).expect("a part with a part")];
        let error = Loaded::with_parts(outer.bytes(), &nested).unwrap_err();
        self.take_reason(error, "part 0", Reason::OtherPart);
        assert!(matches!(
            outer.scene(),
            Err(BlobError::Parts { found: 0, .. })
        ));
        let error = Parts::<0>::from_bytes(honest.bytes()).unwrap_err();
        let expected = BlobError::Memory {
            section: SectionKind::Parts,
            found: 0,
            needed: 1,
        };
        assert_eq!(error, expected);
        let none = Loaded::from_bytes(honest.bytes()).unwrap_err();
        let expected = BlobError::Parts {
            found: 0,
            expected: 1,
        };
        assert_eq!(none, expected);
    }

    /// Takes the errors of a blob that has instances and no parts.
    fn without_parts(&mut self) {
        let mut base = self.base.clone();
        base.remove(&[SectionKind::Parts, SectionKind::PartBlobs]);
        let blob = base.sealed();
        let error = Prevalidated::of(blob.bytes()).unwrap_err();
        let bytes = blob.bytes();
        let count =
            bytemuck::pod_read_unaligned::<Header>(&bytes[..size_of::<Header>()]).section_count;
        // Instances and the pairs above them come last.
        let line = format!("line {} of the section table", count - 2);
        self.take_reason(error, &line, Reason::NotPrevalidated);
        let expected = BlobError::Count {
            section: SectionKind::Parts,
            found: 0,
            expected: 1,
        };
        assert_eq!(blob.scene().unwrap_err(), expected);
    }
}

/// Instances that hang on a joint which grows.
pub(super) fn joints() -> Errors {
    let mut scene = placed();
    scene.joints = vec![scene::Joint {
        name: String::from("joint"),
        parent: None,
        pivot: DVec3::ZERO,
        place: SourceSpan::default(),
    }];
    scene.instances[0].joint = Some(0);
    scene.tracks = vec![scene::Track {
        target: TrackTarget::JointScale,
        index: 0,
        interpolation: Interpolation::Linear,
        keys: vec![scene::Key {
            value: [2.0, 0.0, 0.0, 0.0],
            ..scene::Key::default()
        }],
        place: SourceSpan::default(),
    }];
    let mut errors = Errors::of(Base::of(blob(&scene).bytes()));
    let base = errors.base.clone();
    let parent = forged(&base, SectionKind::Joints, 0, |it: &mut Joint| {
        it.parent = 0
    });
    errors.take_reason(parent, "joint 0 of tracks", Reason::JointOrder);
    let kind = SectionKind::InstanceJoints;
    let joint = forged(&base, kind, 1, |it: &mut u32| *it = 1);
    errors.take_field(joint, "instance 1 of tracks", Field::Joint);
    for scale in [0, 1023, (1 << 30) + 1] {
        let error = forged(&base, SectionKind::TrackWords, 0, |it: &mut i32| {
            *it = scale
        });
        errors.take_field(error, "word 0 of tracks", Field::Scale);
    }
    errors
}
