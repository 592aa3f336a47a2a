//! A forged blob for every field that can be out of its range, and for every other reason to reject
//! one: the error names the place and says what is wrong there.

use super::small_blob;
use glam::DVec3;
use gridel_core::format::record::{
    ApexDirection, ApexPoint, ApexWindow, DualNode, FlaggedPair, GridShape, Gridels, Light,
    Material, Pair, SectionEntry, Sphere24, Vertex24, View, WideNode,
};
use gridel_core::format::{
    BlobError, Child, Effects, Field, Kind, Leaf, Link, Reason, SectionKind,
};
use gridel_core::geometry::{cone::Cone, cuboid::Cuboid, disc::Disc, plane::Plane, torus::Torus};
use gridel_core::{Names, Prevalidated, Structure};
use gridel_host::compile::{Options, compile};
use gridel_host::scene::Shape;
use gridel_host::shape::Sphere;
use gridel_tests::fuzz::{Base, sealed, speaks};
use gridel_tests::scenes;

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

fn headers() -> Errors {
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
    for word in 0..2 {
        errors.reason(header, Reason::SpareNotZero, |it| {
            it.header().spare[word] = 1
        });
    }
    errors.reason(header, Reason::MissingObjectFirst, |it| {
        it.remove(&[SectionKind::ObjectFirst])
    });
    errors
}

fn section_tables() -> Errors {
    let mut errors = everything();
    let bytes = errors.base.sealed().bytes().to_vec();
    let sections = SectionKind::ALL.len() - 1;
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

fn prevalidated() -> Errors {
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

fn surroundings() -> Errors {
    let mut errors = everything();
    let far = (1 << 50) + 1;
    let view = "section view";
    let fields: [Forgery<View>; 12] = [
        (Field::Eye, &|it| it.eye[1] = far),
        (Field::Eye, &|it| it.eye[1] = -far),
        (Field::CameraVector, &|it| it.up[2] = i32::MAX),
        (Field::Background, &|it| it.background[0] = -1),
        (Field::AmbientLight, &|it| it.ambient[0] = -1),
        (Field::Cutoff, &|it| it.cutoff = -1),
        (Field::Width, &|it| it.width = 0),
        (Field::Height, &|it| it.height = 0),
        (Field::Samples, &|it| it.samples = 0),
        (Field::Samples, &|it| it.samples = 257),
        (Field::RayDepth, &|it| it.depth = 17),
        (Field::DisplayValues, &|it| it.display_values = 2),
    ];
    for (field, forge) in fields {
        errors.field(view, field, |it| it.change(SectionKind::View, 0, forge));
    }
    let lights: [Forgery<Light>; 3] = [
        (Field::Kind, &|it| it.directional = 2),
        (Field::Color, &|it| it.color[2] = -1),
        (Field::PositionOrDirection, &|it| it.vector[0] = far),
    ];
    for (field, forge) in lights {
        errors.field("light 0", field, |it| {
            it.change(SectionKind::Lights, 0, forge)
        });
    }
    errors.reason("light 1", Reason::ZeroDirection, |it| {
        it.change(SectionKind::Lights, 1, |it: &mut Light| it.vector = [0; 3])
    });
    let above = (1 << 30) + 1;
    let materials: [Forgery<Material>; 9] = [
        (Field::Diffuse, &|it| it.diffuse[0] = above),
        (Field::Odd, &|it| it.odd[1] = -1),
        (Field::Highlight, &|it| it.highlight[2] = above),
        (Field::Mirror, &|it| it.mirror[0] = above),
        (Field::Transmittance, &|it| it.transmit[0] = above),
        (Field::InverseIor, &|it| it.inverse_ior = above),
        (Field::Shininess, &|it| it.shininess = 0),
        (Field::CheckerSize, &|it| it.checker_size = -1),
        (Field::CheckerOrigin, &|it| it.checker_origin[0] = above),
    ];
    for (field, forge) in materials {
        errors.field("material 1", field, |it| {
            it.change(SectionKind::Materials, 1, forge)
        });
    }
    errors.reason("material 0", Reason::SpareNotZero, |it| {
        it.change(SectionKind::Materials, 0, |it: &mut Material| it.spare = 1)
    });
    errors.reason("material 0", Reason::MissingEffect, |it| {
        it.header().effects &= !Effects::MIRROR.0
    });
    errors
}

fn primitives() -> Errors {
    let mut errors = everything();
    let far = 1 << 24;
    errors.field("vertex 2", Field::Coordinate, |it| {
        it.change(SectionKind::Vertices, 2, |it: &mut Vertex24| it.0[1] = far)
    });
    errors.field("triangle 1", Field::Vertex, |it| {
        it.change(SectionKind::Triangles, 1, |it: &mut [u16; 3]| {
            it[2] = u16::MAX
        })
    });
    errors.field("sphere 0", Field::Radius, |it| {
        it.change(SectionKind::Spheres, 0, |it: &mut Sphere24| {
            it.radius = [0; 3]
        })
    });
    errors.field("sphere 1", Field::LowestCoordinate, |it| {
        it.change(SectionKind::Spheres, 1, |it: &mut Sphere24| {
            it.center[0] = [0, 0, 0x80]
        })
    });
    errors.field("box 0", Field::HighestCoordinate, |it| {
        it.change(SectionKind::Boxes, 0, |it: &mut Cuboid| it.highest[0] = far)
    });
    errors.reason("box 0", Reason::InvertedBox, |it| {
        it.change(SectionKind::Boxes, 0, |it: &mut Cuboid| {
            std::mem::swap(&mut it.lowest[1], &mut it.highest[1])
        })
    });
    let discs: [Forgery<Disc>; 3] = [
        (Field::Center, &|it| it.center[0] = far),
        (Field::Normal, &|it| it.normal[0] = far + 1),
        (Field::Radius, &|it| it.radius = 0),
    ];
    for (field, forge) in discs {
        errors.field("disc 0", field, |it| {
            it.change(SectionKind::Discs, 0, forge)
        });
    }
    errors.reason("disc 0", Reason::ZeroNormal, |it| {
        it.change(SectionKind::Discs, 0, |it: &mut Disc| it.normal = [0; 3])
    });
    errors.reason("disc 0", Reason::OutsideScene, |it| {
        it.change(SectionKind::Discs, 0, |it: &mut Disc| {
            it.bounds.0[0][0] = i16::MIN
        })
    });
    let cones: [Forgery<Cone>; 3] = [
        (Field::BaseCenter, &|it| it.base[0] = far),
        (Field::ApexCenter, &|it| it.apex[0] = far),
        (Field::Radius, &|it| it.base_radius = -1),
    ];
    for (field, forge) in cones {
        errors.field("cone 0", field, |it| {
            it.change(SectionKind::Cones, 0, forge)
        });
    }
    let tori: [Forgery<Torus>; 4] = [
        (Field::Center, &|it| it.center[0] = i32::MAX),
        (Field::Axis, &|it| it.axis[1] = (1 << 24) + 1),
        (Field::Radius, &|it| it.minor_radius = 0),
        (Field::Radius, &|it| it.major_radius = -1),
    ];
    for (field, forge) in tori {
        errors.field("torus 0", field, |it| {
            it.change(SectionKind::Tori, 0, forge)
        });
    }
    errors.reason("torus 0", Reason::ZeroAxis, |it| {
        it.change(SectionKind::Tori, 0, |it: &mut Torus| it.axis = [0; 3])
    });
    let planes: [Forgery<Plane>; 3] = [
        (Field::Point, &|it| it.point[2] = (1 << 25) + 1),
        (Field::Point, &|it| it.point[0] = i32::MIN),
        (Field::Normal, &|it| it.normal[1] = -(1 << 24) - 1),
    ];
    for (field, forge) in planes {
        errors.field("plane 0", field, |it| {
            it.change(SectionKind::Planes, 0, forge)
        });
    }
    errors.reason("plane 0", Reason::ZeroNormal, |it| {
        it.change(SectionKind::Planes, 0, |it: &mut Plane| it.normal = [0; 3])
    });
    errors.reason("cone 0", Reason::ZeroAxis, |it| {
        it.change(SectionKind::Cones, 0, |it: &mut Cone| it.apex = it.base)
    });
    errors.reason("cone 0", Reason::ZeroRadii, |it| {
        it.change(SectionKind::Cones, 0, |it: &mut Cone| {
            (it.base_radius, it.apex_radius) = (0, 0)
        })
    });
    errors.field("object 1", Field::FirstPrimitive, |it| {
        it.set(SectionKind::ObjectFirst, 1, u32::MAX)
    });
    errors.field("object 0", Field::Material, |it| {
        it.set(SectionKind::ObjectMaterial, 0, u32::MAX)
    });
    errors.field("slot 0", Field::Primitive, |it| {
        it.set(SectionKind::Order, 0, u32::MAX)
    });
    let leaves: [Forgery<u32>; 3] = [
        (Field::Kind, &|it| *it |= 7 << 29),
        (Field::Primitives, &|it| *it &= !(31 << 24)),
        (Field::FirstSlot, &|it| *it += 1),
    ];
    for (field, forge) in leaves {
        errors.field("leaf 0", field, |it| {
            it.change(SectionKind::Leaves, 0, forge)
        });
    }
    // The last leaf is the last one of its kind.
    let last = errors.base.records(SectionKind::Leaves) - 1;
    errors.field(&format!("leaf {last}"), Field::EndSlot, |it| {
        it.change(SectionKind::Leaves, last, |it: &mut u32| *it += 1 << 24)
    });
    errors
}

const LEAF: u32 = 1 << 31;

fn hierarchies() -> Errors {
    let mut errors = everything();
    let pairs = errors.base.records(SectionKind::Pairs);
    let mut base = errors.base.clone();
    let mut pair = |number| base.record::<Pair>(SectionKind::Pairs, number);
    let change = |it: &mut Base, number: usize, forge: &dyn Fn(&mut Pair)| {
        it.change(SectionKind::Pairs, number, forge)
    };
    errors.field("pair 0 of bvh", Field::Child, |it| {
        change(it, 0, &|it| it.children[0] = 9)
    });
    errors.field("pair 0 of bvh", Field::Leaf, |it| {
        change(it, 0, &|it| it.children[0] = LEAF | 9)
    });
    errors.reason("pair 1 of bvh", Reason::NotReached, |it| {
        change(it, 0, &|it| it.children = [LEAF, LEAF | 1])
    });
    let last = pairs - 1;
    let [left, _] = pair(last).children;
    let place = format!("pair {last} of bvh");
    errors.reason(&place, Reason::BeyondLast, |it| {
        change(it, last, &|it| it.children = [pairs as u32, left])
    });
    for (side, reason) in [Reason::LeftOutside, Reason::RightOutside]
        .into_iter()
        .enumerate()
    {
        errors.reason("pair 0 of bvh", reason, |it| {
            change(it, 0, &|it| it.planes[0][0][side] = -i16::MAX)
        });
    }
    errors.reason("pair 0 of flagged", Reason::RightOutside, |it| {
        it.change(SectionKind::FlaggedPairs, 0, |it: &mut FlaggedPair| {
            it.link = Link(it.link).with_owners(1).0;
            it.planes[0] = it.planes[0] & 0xffff_0000 | 0x8001;
        })
    });
    let above = (0..pairs).find(|&number| pair(number).children[0] & LEAF != 0);
    let above = above.expect("a leaf");
    let place = format!("pair {above} of bvh");
    errors.reason(&place, Reason::PrimitiveOutside, |it| {
        change(it, above, &|it| {
            for [low, high] in &mut it.planes {
                high[0] = low[0];
            }
        })
    });
    let dual = |it: &mut Base, number: usize, forge: &dyn Fn(&mut DualNode)| {
        it.change(SectionKind::DualNodes, number, forge)
    };
    errors.reason("node 0 of dual-split", Reason::UnusedBits, |it| {
        dual(it, 0, &|it| it.way |= 1 << 30)
    });
    let nodes = errors.base.records(SectionKind::DualNodes);
    let mut base = errors.base.clone();
    let mut node = |number| base.record::<DualNode>(SectionKind::DualNodes, number);
    let leaf = (0..nodes).find(|&number| node(number).way >> 24 & 3 == 3);
    let leaf = leaf.expect("a leaf");
    let place = format!("node {leaf} of dual-split");
    errors.reason(&place, Reason::PrimitiveOutsideRegion, |it| {
        dual(it, leaf, &|it| {
            // Cut down to nothing on the x axis.
            it.way &= !(15 << 26);
            it.way |= 3 << 28;
            it.carves[0] = 0x8000_7fff;
        })
    });
    errors
}

/// A hierarchy of 49 levels, each of which has a leaf.
fn deep_hierarchy() -> Errors {
    const LEAVES: u32 = 50;
    let mut errors = alone(&scenes::of(balls(LEAVES)), Structure::Bvh, 24);
    let leaves = (0..LEAVES).map(|first| {
        let (kind, count) = (Kind::Sphere, 1);
        Leaf { kind, first, count }.to_word()
    });
    let pair = errors.base.record::<Pair>(SectionKind::Pairs, 0);
    let pairs = (0..LEAVES - 1).map(|number| Pair {
        children: match number {
            number if number + 2 < LEAVES => [LEAF | number, number + 1],
            number => [LEAF | number, LEAF | (number + 1)],
        },
        ..pair
    });
    let leaves: Vec<u32> = leaves.collect();
    let pairs: Vec<Pair> = pairs.collect();
    errors.field("section pairs", Field::Levels, |it| {
        it.header().longest_leaf = 1;
        *it.bytes(SectionKind::Leaves) = bytemuck::cast_slice(&leaves).to_vec();
        *it.bytes(SectionKind::Pairs) = bytemuck::cast_slice(&pairs).to_vec();
    });
    errors
}

fn wide_hierarchies() -> Errors {
    let shapes = balls(12).chain([scenes::sheet(7)]);
    let mut errors = alone(&scenes::of(shapes), Structure::Wide, 16);
    let byte = |it: &mut Base, kind, place: usize, forge: &dyn Fn(u8) -> u8| {
        let bytes = it.section(kind);
        bytes[place] = forge(bytes[place]);
    };
    errors.field("strip 0 of wide", Field::FirstMember, |it| {
        byte(it, SectionKind::Strips, 48, &|first| first + 1)
    });
    errors.reason("strip 0 of wide", Reason::UnknownArrangement, |it| {
        byte(it, SectionKind::Strips, 51, &|corners| corners | 7)
    });
    // Eight spheres in the first pack and four in the second; a radius takes two bytes.
    assert_eq!(errors.base.records(SectionKind::Packs), 2);
    let radii = |it: &mut Base, pack: usize, places: std::ops::Range<usize>, value: u8| {
        let start = 64 * pack + 48;
        it.section(SectionKind::Packs)[start..start + 16][places].fill(value);
    };
    errors.field("pack 0 of wide", Field::Radius, |it| {
        radii(it, 0, 0..2, 0xff)
    });
    errors.reason("pack 1 of wide", Reason::EmptyPack, |it| {
        radii(it, 1, 0..16, 0)
    });
    errors.reason("pack 0 of wide", Reason::PartialPack, |it| {
        radii(it, 0, 14..16, 0)
    });
    errors.reason("pack 1 of wide", Reason::RadiusAfterLast, |it| {
        radii(it, 1, 14..16, 1)
    });
    errors.field("member 0 of wide", Field::Primitive, |it| {
        it.set(SectionKind::Members, 0, u32::MAX)
    });
    let nodes = errors.base.records(SectionKind::WideNodes);
    let node = |it: &mut Base, number: usize, forge: &dyn Fn(&mut WideNode)| {
        it.change(SectionKind::WideNodes, number, forge)
    };
    let root = "node 0 of wide";
    let cluster = |kind, first, count| Leaf { kind, first, count }.to_word();
    errors.field(root, Field::Child, |it| {
        node(it, 0, &|it| it.children[0] = Child::node(9).0)
    });
    errors.field(root, Field::Leaf, |it| {
        let leaf = cluster(Kind::Triangle, 9, 0);
        node(it, 0, &|it| it.children[0] = leaf)
    });
    errors.field(root, Field::LeafKind, |it| {
        node(it, 0, &|it| it.children[0] = 6 << 29)
    });
    for (kind, count) in [(Kind::Triangle, 1), (Kind::Box, 0), (Kind::Box, 2)] {
        let leaf = cluster(kind, 0, count);
        errors.field(root, Field::LeafSlots, |it| {
            node(it, 0, &|it| it.children[0] = leaf)
        });
    }
    errors.reason(root, Reason::NoChild, |it| {
        node(it, 0, &|it| it.children[0] = Child::NONE.0)
    });
    errors.reason(root, Reason::ChildOutside, |it| {
        node(it, 0, &|it| it.planes[0][0][0] = -i16::MAX)
    });
    let mut base = errors.base.clone();
    let mut read = |number| base.record::<WideNode>(SectionKind::WideNodes, number);
    let is_none = |child: &u32| *child == Child::NONE.0;
    let with_gap = (0..nodes).find(|&number| read(number).children.iter().any(is_none));
    let with_gap = with_gap.expect("a node of fewer than eight children");
    let first_gap = read(with_gap).children.iter().position(is_none);
    let first_gap = first_gap.expect("a lane without a child");
    let place = format!("node {with_gap} of wide");
    errors.reason(&place, Reason::LaneNotEmpty, |it| {
        node(it, with_gap, &|it| it.planes[1][0][first_gap] = 0)
    });
    let crowded = (0..nodes).find(|&number| read(number).children[2] != Child::NONE.0);
    let crowded = crowded.expect("a node of three children");
    let place = format!("node {crowded} of wide");
    errors.reason(&place, Reason::ChildAfterGap, |it| {
        node(it, crowded, &|it| {
            it.children[1] = Child::NONE.0;
            for [low, high] in &mut it.planes {
                (low[1], high[1]) = (i16::MAX, i16::MIN);
            }
        })
    });
    let last = nodes - 1;
    let place = format!("node {last} of wide");
    let children = read(last).children;
    let end = children.iter().position(is_none).unwrap_or(8) - 1;
    errors.reason(&place, Reason::BeyondLast, |it| {
        node(it, last, &|it| {
            it.children[end] = Child::node(nodes as u32).0
        })
    });
    let mut shared = everything();
    shared.reason("home 0 of wide", Reason::WrongHome, |it| {
        it.set(SectionKind::Homes, 0, u32::MAX)
    });
    errors.reasons.append(&mut shared.reasons);
    errors.failures.append(&mut shared.failures);
    errors
}

fn cells() -> Errors {
    let mut errors = everything();
    let shape = "section grid-shape";
    errors.field(shape, Field::Divisions, |it| {
        it.change(SectionKind::GridShape, 0, |it: &mut GridShape| {
            it.divisions[2] = 0
        })
    });
    errors.reason(shape, Reason::SpareNotZero, |it| {
        it.change(SectionKind::GridShape, 0, |it: &mut GridShape| it.spare = 1)
    });
    errors.field("list 1 of grid", Field::FirstEntry, |it| {
        it.set(SectionKind::GridStarts, 1, u32::MAX)
    });
    let (lists, entries) = (
        errors.base.records(SectionKind::GridStarts) - 1,
        errors.base.records(SectionKind::GridSlots),
    );
    errors.field("section grid-slots", Field::Entries, |it| {
        let stride = it.bytes(SectionKind::GridSlots).len() / entries;
        it.bytes(SectionKind::GridSlots)
            .extend(std::iter::repeat_n(0, stride));
        it.set(SectionKind::GridStarts, lists, entries as u32 + 1);
    });
    errors.field("node 1 of octree", Field::List, |it| {
        it.set(SectionKind::OctreeNodes, 1, LEAF | 99_999)
    });
    errors.field("node 0 of octree", Field::Child, |it| {
        it.set(SectionKind::OctreeNodes, 0, 9)
    });
    // Eight nodes on each of seven levels, the first of which has children.
    errors.field("section octree-nodes", Field::Levels, |it| {
        let mut nodes = vec![1];
        for level in 0..7 {
            let first = if level < 6 { 9 + 8 * level } else { u32::MAX };
            nodes.push(first);
            nodes.extend([u32::MAX; 7]);
        }
        *it.bytes(SectionKind::OctreeNodes) = bytemuck::cast_slice(&nodes).to_vec();
    });
    let slots = errors.base.records(SectionKind::Order) as u32;
    let all = |kind, errors: &Errors| {
        let entries = errors.base.records(kind);
        (0..entries).flat_map(move |index| (0..slots).map(move |slot| (index, slot)))
    };
    let forgeries = all(SectionKind::GridSlots, &errors);
    errors.one_of(Reason::MissingPrimitive, forgeries, |it, index, slot| {
        it.set(SectionKind::GridSlots, index, slot)
    });
    for reason in [Reason::OutsideCell, Reason::SlotOrder] {
        let forgeries = all(SectionKind::OctreeSlots, &errors);
        errors.one_of(reason, forgeries, |it, index, slot| {
            it.set(SectionKind::OctreeSlots, index, slot)
        });
    }
    errors
}

fn candidates() -> Errors {
    let mut errors = everything();
    errors.reason("section cylinder-gridels", Reason::WrongPartition, |it| {
        it.change(SectionKind::CylinderGridels, 0, |it: &mut Gridels| {
            it.low[0] += 1
        })
    });
    errors.field("cell 0 of cylinder-cube", Field::List, |it| {
        it.set(SectionKind::CylinderCells, 0, u32::MAX)
    });
    errors.field("list 0 of cylinder-cube-tight", Field::FirstEntry, |it| {
        it.set(SectionKind::TightStarts, 0, 1)
    });
    errors.field("entry 0 of cylinder-cube-entry", Field::Candidate, |it| {
        it.set(SectionKind::EntryNodes, 0, u32::MAX)
    });
    let keys = errors.base.records(SectionKind::TightKeys);
    let pairs = (1..keys).map(|index| (index, 0));
    errors.one_of(Reason::KeyOrder, pairs, |it, index, _| {
        it.set(SectionKind::TightKeys, index - 1, 0xff);
        it.set(SectionKind::TightKeys, index, 0);
    });
    let point = |it: &mut Base, forge: &dyn Fn(&mut ApexPoint)| {
        it.change(SectionKind::ApexPoints, 0, forge)
    };
    errors.field("point 0 of apex", Field::Coordinate, |it| {
        point(it, &|it| it.at[0] = i32::MIN)
    });
    errors.field("point 0 of apex", Field::Window, |it| {
        point(it, &|it| it.windows[3] = 0xfff0)
    });
    let directions: [Forgery<ApexDirection>; 3] = [
        (Field::Plane, &|it| it.plane = i32::MIN),
        (Field::MajorAxis, &|it| it.major = 3),
        (Field::Window, &|it| it.window = 0xffff),
    ];
    for (field, forge) in directions {
        errors.field("direction 0 of apex", field, |it| {
            it.change(SectionKind::ApexDirections, 0, forge)
        });
    }
    let windows: [Forgery<ApexWindow>; 2] = [
        (Field::FirstCell, &|it| it.first_cell = 1),
        (Field::SideCells, &|it| it.cells[1] = 0),
    ];
    for (field, forge) in windows {
        errors.field("window 0 of apex", field, |it| {
            it.change(SectionKind::ApexWindows, 0, forge)
        });
    }
    // A word is a dimension, or 7 for a leaf, and from bit 3 on the first child or the cell.
    let words = [
        (Field::Dimension, 5 | 6 << 3),
        (Field::Child, 99 << 3),
        (Field::Cell, 7 | 99 << 3),
    ];
    for (field, word) in words {
        errors.field("node 0 of ray-classes", field, |it| {
            it.set(SectionKind::ClassNodes, 0, word)
        });
    }
    errors
}

fn names() -> Errors {
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

#[test]
fn every_field_and_reason_is_named_by_the_error_of_a_forged_blob() {
    let all = [
        headers(),
        section_tables(),
        prevalidated(),
        surroundings(),
        primitives(),
        hierarchies(),
        deep_hierarchy(),
        wide_hierarchies(),
        cells(),
        candidates(),
        names(),
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
            it.way |= 1 << 31
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
