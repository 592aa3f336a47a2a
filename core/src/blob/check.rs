//! The proofs that [`Scene::from_bytes`] makes, in the order in which each relies on those before.

use super::record::{
    ALIGNMENT, Cone, Cuboid, Disc, ENDIANNESS, Header, Light, MAGIC, Material, UnitBox, VERSION,
    View,
};
use super::section::Sections;
use super::{BlobError, Indices, Scene, SectionKind, checksum};
use crate::accel::{Entry, Held, Leaf, MAX_STACK_DEPTH, Structure};
use crate::number::{Fixed, Number};
use crate::render::{MAX_RAY_DEPTH, MAX_SAMPLES};
use crate::shade::Effects;
#[cfg(feature = "wide")]
use crate::shape::{Clusters, Packs, Strips};
use crate::shape::{Kind, Shapes, Spheres, Triangles, Vertices, WIDE_INDICES, WIDE_LATTICE};
use core::mem::size_of;

/// Checks a blob; see [`Scene::from_bytes`].
pub(super) fn check(blob: &[u8]) -> Result<Scene<'_>, BlobError> {
    let header = check_header(blob)?;
    let sections = Sections::read(blob, header.section_count)?;
    let view = check_view(&sections)?;
    let lights = check_lights(&sections)?;
    let materials = check_materials(&sections, header)?;
    let shapes = read_shapes(&sections, header)?;
    check_shapes(&shapes, header)?;
    let scene = Scene {
        header,
        view,
        lights,
        materials,
        object_first: Indices::read(&sections, SectionKind::ObjectFirst)?,
        object_material: Indices::read(&sections, SectionKind::ObjectMaterial)?,
        order: Indices::read(&sections, SectionKind::Order)?,
        shapes,
        leaves: sections.records(SectionKind::Leaves)?,
        held: Held::read(&sections)?,
        needs_norm: shapes.count(Kind::Sphere) > 0 || shapes.count(Kind::Cone) > 0,
        #[cfg(feature = "all-structures")]
        chosen: Structure::List,
    };
    check_objects(&scene)?;
    check_structures(&scene, &sections)?;
    Ok(scene)
}

/// An error unless `found` lies in `0..=most`.
fn at_most(field: &'static str, found: u64, most: u64) -> Result<(), BlobError> {
    if found > most {
        return Err(BlobError::Header {
            field,
            found,
            expected: most,
        });
    }
    Ok(())
}

/// An error unless `found` is `expected`.
fn exactly(field: &'static str, found: u64, expected: u64) -> Result<(), BlobError> {
    if found != expected {
        return Err(BlobError::Header {
            field,
            found,
            expected,
        });
    }
    Ok(())
}

/// Errors for the records of one section.
#[derive(Clone, Copy)]
struct At {
    section: SectionKind,
    index: usize,
}

impl At {
    /// An error unless `found` lies in `low..=high`.
    fn within(self, what: &'static str, found: i64, low: i64, high: i64) -> Result<(), BlobError> {
        let expected = if found < low { low } else { high };
        if found < low || found > high {
            let Self { section, index } = self;
            return Err(BlobError::Record {
                section,
                index,
                what,
                found,
                expected,
            });
        }
        Ok(())
    }

    /// An error unless every one of `found` lies in `low..=high`.
    fn all_within<T: Into<i64> + Copy>(
        self,
        what: &'static str,
        found: &[T],
        low: i64,
        high: i64,
    ) -> Result<(), BlobError> {
        found
            .iter()
            .try_for_each(|&value| self.within(what, value.into(), low, high))
    }
}

fn check_header(blob: &[u8]) -> Result<&Header, BlobError> {
    // What it is comes before how long it is, so that a foreign file is called one.
    if !blob.starts_with(&MAGIC[..MAGIC.len().min(blob.len())]) || blob.is_empty() {
        return Err(BlobError::Magic);
    }
    let needed = size_of::<Header>();
    let bytes = blob.get(..needed).ok_or(BlobError::Truncated {
        needed,
        found: blob.len(),
    })?;
    if !(blob.as_ptr() as usize).is_multiple_of(ALIGNMENT) {
        return Err(BlobError::Misaligned);
    }
    let header: &Header = bytemuck::try_from_bytes(bytes).map_err(|_| BlobError::Misaligned)?;
    if header.endianness != ENDIANNESS {
        return Err(BlobError::Endianness {
            found: header.endianness,
        });
    }
    if header.version != VERSION {
        return Err(BlobError::Version {
            found: header.version,
        });
    }
    if header.blob_bytes as usize != blob.len() {
        return Err(BlobError::Truncated {
            needed: header.blob_bytes as usize,
            found: blob.len(),
        });
    }
    let found = checksum(blob);
    if found != header.checksum {
        return Err(BlobError::Checksum {
            found,
            expected: header.checksum,
        });
    }
    at_most(
        "set of effects",
        header.effects.into(),
        Effects::ALL.0.into(),
    )?;
    let missing = Effects(header.effects).without(Effects::AVAILABLE);
    if missing != Effects::NONE {
        return Err(BlobError::MissingEffects { missing });
    }
    let known = Structure::ALL
        .iter()
        .fold(0, |bits, structure| bits | structure.bit());
    exactly(
        "set of structures beyond those known",
        (header.structures & !known).into(),
        0,
    )?;
    at_most(
        "stack depth",
        header.stack_depth.into(),
        MAX_STACK_DEPTH as u64,
    )?;
    let stack_bytes = u64::from(header.stack_depth) * size_of::<Entry>() as u64;
    exactly(
        "number of stack bytes",
        header.stack_bytes.into(),
        stack_bytes,
    )?;
    at_most("number of lattice bits", header.lattice_bits.into(), 24)?;
    let storage_bits = if header.lattice_bits <= 16 { 16 } else { 24 };
    exactly(
        "number of storage bits",
        header.storage_bits.into(),
        storage_bits,
    )?;
    at_most(
        "magnitude of the unit's exponent",
        header.unit_exponent.unsigned_abs().into(),
        1000,
    )?;
    let finite = header
        .origin
        .iter()
        .filter(|origin| origin.is_finite())
        .count();
    exactly(
        "number of finite coordinates of the origin",
        finite as u64,
        3,
    )?;
    for axis in header.bounds.0 {
        exactly(
            "number of inverted sides of the scene's box",
            u64::from(axis[0] > axis[1]),
            0,
        )?;
        exactly(
            "number of sides at -32768",
            u64::from(axis[0] == i16::MIN),
            0,
        )?;
    }
    exactly("first spare word", header.spare[0].into(), 0)?;
    exactly("second spare word", header.spare[1].into(), 0)?;
    Ok(header)
}

/// Largest magnitude of a far coordinate, so that sums and products with ratios stay in 64 bits.
const FAR: i64 = 1 << 50;
/// The ratio 1.
const ONE: i64 = 1 << 30;
/// The largest radiance.
const RADIANCE: i64 = i32::MAX as i64;

fn check_view<'a>(sections: &Sections<'a>) -> Result<&'a View, BlobError> {
    let section = SectionKind::View;
    let views: &[View] = sections.records(section)?;
    let [view] = views else {
        return Err(BlobError::Count {
            section,
            found: views.len(),
            expected: 1,
        });
    };
    let at = At { section, index: 0 };
    at.all_within("eye", &view.eye, -FAR, FAR)?;
    for vector in [view.forward, view.right, view.up] {
        at.all_within("camera vector", &vector, -(1 << 28), 1 << 28)?;
    }
    at.all_within("background", &view.background, 0, RADIANCE)?;
    at.all_within("ambient light", &view.ambient, 0, RADIANCE)?;
    at.within("cutoff", view.cutoff.into(), 0, RADIANCE)?;
    at.within("width", view.width.into(), 1, u16::MAX.into())?;
    at.within("height", view.height.into(), 1, u16::MAX.into())?;
    at.within(
        "number of samples",
        view.samples.into(),
        1,
        MAX_SAMPLES.into(),
    )?;
    at.within("depth", view.depth.into(), 0, MAX_RAY_DEPTH as i64)?;
    at.within("spare byte", view.spare.into(), 0, 0)?;
    Ok(view)
}

fn check_lights<'a>(sections: &Sections<'a>) -> Result<&'a [Light], BlobError> {
    let section = SectionKind::Lights;
    let lights: &[Light] = sections.records(section)?;
    for (index, light) in lights.iter().enumerate() {
        let at = At { section, index };
        at.within("kind", light.directional.into(), 0, 1)?;
        at.all_within("colour", &light.color, 0, RADIANCE)?;
        let most = if light.directional == 1 { ONE } else { FAR };
        at.all_within("position or direction", &light.vector, -most, most)?;
        let zero = light.directional == 1 && light.vector == [0; 3];
        at.within("number of directions of length 0", zero.into(), 0, 0)?;
    }
    Ok(lights)
}

fn check_materials<'a>(
    sections: &Sections<'a>,
    header: &Header,
) -> Result<&'a [Material], BlobError> {
    let section = SectionKind::Materials;
    let materials: &[Material] = sections.records(section)?;
    if materials.is_empty() && header.primitives > 0 {
        return Err(BlobError::Count {
            section,
            found: 0,
            expected: 1,
        });
    }
    for (index, material) in materials.iter().enumerate() {
        let at = At { section, index };
        let colors = [
            ("diffuse colour", material.diffuse),
            ("odd colour", material.odd),
            ("highlight", material.highlight),
            ("mirror", material.mirror),
            ("transmittance", material.transmit),
        ];
        for (what, color) in colors {
            at.all_within(what, &color, 0, ONE)?;
        }
        at.within(
            "inverse index of refraction",
            material.inverse_ior.into(),
            ONE / 4,
            ONE,
        )?;
        at.within("shininess", material.shininess.into(), 1, 1024)?;
        at.within(
            "checkerboard's size",
            material.checker_size.into(),
            0,
            i32::MAX.into(),
        )?;
        at.all_within("checkerboard's origin", &material.checker_origin, -ONE, ONE)?;
        at.within("spare word", material.spare.into(), 0, 0)?;
        let uncalled = material.effects().without(Effects(header.effects));
        at.within(
            "set of effects that the header does not call for",
            uncalled.0.into(),
            0,
            0,
        )?;
    }
    Ok(materials)
}

fn read_shapes<'a>(sections: &Sections<'a>, header: &Header) -> Result<Shapes<'a>, BlobError> {
    let narrow = sections.get(SectionKind::Triangles).stride == size_of::<[u16; 3]>();
    let short = header.storage_bits == 16;
    let triangles = sections.len(SectionKind::Triangles);
    let kinds = [
        (Kind::Triangle, triangles),
        (Kind::Sphere, sections.len(SectionKind::Spheres)),
        (Kind::Box, sections.len(SectionKind::Boxes)),
        (Kind::Disc, sections.len(SectionKind::Discs)),
        (Kind::Cone, sections.len(SectionKind::Cones)),
    ];
    let kinds = kinds.map(|(kind, count)| (count > 0 && !kind.is_available(), kind.name()));
    let stored = [
        (!short && !WIDE_LATTICE, "wide-lattice"),
        (triangles > 0 && !narrow && !WIDE_INDICES, "wide-indices"),
    ];
    // Triangles and spheres that lie in clusters alone.
    let holds = |kind| sections.len(kind) > 0;
    let sole = holds(SectionKind::Strips) && triangles == 0
        || holds(SectionKind::Packs) && !holds(SectionKind::Spheres);
    if sole && cfg!(not(feature = "wide")) {
        return Err(BlobError::MissingShape { missing: "wide" });
    }
    for (is_missing, missing) in kinds.into_iter().chain(stored) {
        if is_missing {
            return Err(BlobError::MissingShape { missing });
        }
    }
    Ok(Shapes {
        vertices: if short {
            Vertices::V16(sections.records(SectionKind::Vertices)?)
        } else {
            Vertices::V24(sections.records(SectionKind::Vertices)?)
        },
        triangles: if narrow || triangles == 0 {
            Triangles::U16(sections.records(SectionKind::Triangles)?)
        } else {
            Triangles::U32(sections.records(SectionKind::Triangles)?)
        },
        spheres: if short {
            Spheres::S16(sections.records(SectionKind::Spheres)?)
        } else {
            Spheres::S24(sections.records(SectionKind::Spheres)?)
        },
        boxes: sections.records::<Cuboid>(SectionKind::Boxes)?,
        discs: sections.records::<Disc>(SectionKind::Discs)?,
        cones: sections.records::<Cone>(SectionKind::Cones)?,
        #[cfg(feature = "wide")]
        clusters: Clusters {
            strips: if short {
                Strips::S16(sections.records(SectionKind::Strips)?)
            } else {
                Strips::S24(sections.records(SectionKind::Strips)?)
            },
            packs: if short {
                Packs::P16(sections.records(SectionKind::Packs)?)
            } else {
                Packs::P24(sections.records(SectionKind::Packs)?)
            },
            members: Indices::read(sections, SectionKind::Members)?,
            homes: sections.records(SectionKind::Homes)?,
        },
    })
}

fn check_shapes(shapes: &Shapes<'_>, header: &Header) -> Result<(), BlobError> {
    at_most(
        "number of slots",
        shapes.total() as u64,
        header.primitives.into(),
    )?;
    let bounds = &header.bounds;
    // A point of the scene, in 1/256 unit.
    let point = |at: At, what, point: [i32; 3]| {
        bounds
            .0
            .iter()
            .zip(point)
            .try_for_each(|(sides, coordinate)| {
                let [low, high] = sides.map(|unit| i64::from(unit) << 8);
                at.within(what, coordinate.into(), low, high)
            })
    };
    let inside =
        |at: At, what, inner: &UnitBox| at.within(what, (!bounds.contains(inner)).into(), 0, 0);
    let radius = i64::from(i16::MAX) << 9;

    let vertices = if Kind::Triangle.is_available() {
        shapes.vertices.len()
    } else {
        0
    };
    for index in 0..vertices {
        let at = At {
            section: SectionKind::Vertices,
            index,
        };
        point(
            at,
            "coordinate",
            shapes.vertices.position(index).unwrap_or_default(),
        )?;
    }
    for index in 0..shapes.records(Kind::Triangle) {
        let at = At {
            section: SectionKind::Triangles,
            index,
        };
        let corners = shapes.triangles.corners(index).unwrap_or_default();
        at.all_within(
            "vertex",
            &corners.map(|corner| corner as i64),
            0,
            vertices as i64 - 1,
        )?;
    }
    for index in 0..shapes.records(Kind::Sphere) {
        let at = At {
            section: SectionKind::Spheres,
            index,
        };
        let (center, length) = shapes.spheres.get(index).unwrap_or_default();
        at.within("radius", length.into(), 1, radius)?;
        point(
            at,
            "lowest coordinate",
            center.map(|x| x.wrapping_sub(length)),
        )?;
        point(
            at,
            "highest coordinate",
            center.map(|x| x.wrapping_add(length)),
        )?;
    }
    for (index, cuboid) in (0..shapes.records(Kind::Box)).zip(shapes.boxes) {
        let at = At {
            section: SectionKind::Boxes,
            index,
        };
        point(at, "lowest coordinate", cuboid.lowest)?;
        point(at, "highest coordinate", cuboid.highest)?;
        let inverted = cuboid
            .lowest
            .iter()
            .zip(&cuboid.highest)
            .filter(|(low, high)| low > high);
        at.within("number of inverted sides", inverted.count() as i64, 0, 0)?;
    }
    for (index, disc) in (0..shapes.records(Kind::Disc)).zip(shapes.discs) {
        let at = At {
            section: SectionKind::Discs,
            index,
        };
        point(at, "centre", disc.center)?;
        at.all_within("normal", &disc.normal, -(1 << 24), 1 << 24)?;
        at.within(
            "number of normals of length 0",
            (disc.normal == [0; 3]).into(),
            0,
            0,
        )?;
        at.within("radius", disc.radius.into(), 1, radius)?;
        inside(at, "number of boxes outside the scene's", &disc.bounds)?;
    }
    for (index, cone) in (0..shapes.records(Kind::Cone)).zip(shapes.cones) {
        let at = At {
            section: SectionKind::Cones,
            index,
        };
        point(at, "centre of the base", cone.base)?;
        point(at, "centre of the apex", cone.apex)?;
        at.within(
            "number of axes of length 0",
            (cone.base == cone.apex).into(),
            0,
            0,
        )?;
        let radii = [cone.base_radius, cone.apex_radius];
        at.all_within("radius", &radii, 0, radius)?;
        at.within(
            "number of cones without a radius",
            (radii == [0; 2]).into(),
            0,
            0,
        )?;
        inside(at, "number of boxes outside the scene's", &cone.bounds)?;
    }
    Ok(())
}

fn check_objects(scene: &Scene<'_>) -> Result<(), BlobError> {
    let objects = scene.header.objects as usize;
    let primitives = i64::from(scene.header.primitives);
    let first = &scene.object_first;
    if first.is_empty() {
        let implied = objects as i64 == primitives || objects <= 1;
        exactly(
            "number of objects without an object-first section",
            u64::from(!implied),
            0,
        )?;
    } else {
        let section = SectionKind::ObjectFirst;
        if first.len() != objects {
            return Err(BlobError::Count {
                section,
                found: first.len(),
                expected: objects,
            });
        }
        let mut last = 0;
        for index in 0..objects {
            let value = first.get(index).unwrap_or(0).into();
            let most = if index == 0 { 0 } else { primitives };
            At { section, index }.within("first primitive", value, last, most)?;
            last = value;
        }
    }
    let material = &scene.object_material;
    if !material.is_empty() {
        let section = SectionKind::ObjectMaterial;
        if material.len() != objects {
            return Err(BlobError::Count {
                section,
                found: material.len(),
                expected: objects,
            });
        }
        for index in 0..objects {
            let value = material.get(index).unwrap_or(0).into();
            let most = scene.materials.len() as i64 - 1;
            At { section, index }.within("material", value, 0, most)?;
        }
    }
    let order = &scene.order;
    let slots = scene.shapes.total();
    if !order.is_empty() || slots as i64 != primitives {
        let section = SectionKind::Order;
        if order.len() != slots {
            return Err(BlobError::Count {
                section,
                found: order.len(),
                expected: slots,
            });
        }
        for index in 0..order.len() {
            let value = order.get(index).unwrap_or(0).into();
            At { section, index }.within("primitive", value, 0, primitives - 1)?;
        }
    }
    Ok(())
}

fn check_structures<'a>(scene: &Scene<'a>, sections: &Sections<'a>) -> Result<(), BlobError> {
    let longest = check_leaves(scene, Held::uses_leaves(scene))?;
    exactly(
        "longest leaf",
        scene.header.longest_leaf.into(),
        longest.into(),
    )?;
    let (depth, all_proved) = Held::check(scene, sections)?;
    let found = scene.header.stack_depth;
    if all_proved || usize::from(found) < depth {
        exactly("stack depth", found.into(), depth as u64)?;
    }
    Ok(())
}

/// Proves that every primitive lies in exactly one leaf, and returns the longest leaf's count:
/// leaves take the slots of each kind in order.
fn check_leaves(scene: &Scene<'_>, hierarchies: bool) -> Result<u32, BlobError> {
    let section = SectionKind::Leaves;
    if !hierarchies && !scene.leaves.is_empty() {
        return Err(BlobError::Count {
            section,
            found: scene.leaves.len(),
            expected: 0,
        });
    }
    let mut next = [0_u32; Kind::ALL.len()];
    let mut longest = 0;
    for (index, &word) in (0..scene.leaves.len()).zip(scene.leaves) {
        let at = At { section, index };
        let Some(leaf) = Leaf::from_word(word) else {
            let (what, expected) = ("kind", Kind::ALL.len() as i64 - 1);
            return Err(BlobError::Record {
                section,
                index,
                what,
                found: (word >> 29).into(),
                expected,
            });
        };
        at.within(
            "number of primitives",
            leaf.count.into(),
            1,
            Leaf::MAX_COUNT.into(),
        )?;
        let next = &mut next[leaf.kind as usize];
        at.within(
            "first slot",
            leaf.first.into(),
            (*next).into(),
            (*next).into(),
        )?;
        // Below 2^24 and 31.
        *next = next.wrapping_add(leaf.count);
        longest = longest.max(leaf.count);
        let most = scene.shapes.records(leaf.kind) as i64;
        at.within("end of the slots", (*next).into(), 0, most)?;
    }
    if hierarchies {
        for kind in Kind::ALL {
            // Those that lie in clusters alone would be missing.
            let (found, expected) = (next[kind as usize] as usize, scene.shapes.count(kind));
            if found != expected {
                return Err(BlobError::Count {
                    section,
                    found,
                    expected,
                });
            }
        }
    }
    Ok(longest)
}

// The checks above hold coordinates to what a `Fixed` length can be.
const _: () = assert!((i16::MAX as i64) << 13 < Fixed::FAR.0 as i64);
