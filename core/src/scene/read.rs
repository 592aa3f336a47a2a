//! What loading does in constant time: the header, the table, the view, and where everything lies.

use crate::accel::StructureViews;
use crate::accel::space::Space;
use crate::accel::stack::Entry;
use crate::format::limits::{
    DISPLAY_VALUES, FARTHEST, MAX_RAY_DEPTH, MAX_SAMPLES, MAX_STACK_DEPTH,
};
use crate::format::range::{At, at_most, exactly};
use crate::format::record::{ALIGNMENT, ENDIANNESS, Header, MAGIC, VERSION, View};
use crate::format::{BlobError, Effects, Indices, SectionKind, Sections, Structure};
use crate::geometry::Shapes;
use crate::scene::Scene;
#[cfg(feature = "wide")]
use crate::simd::SimdLevel;
use core::mem::size_of;

/// Largest magnitude of a far coordinate, so that sums and products with ratios stay in 64 bits.
pub(crate) const FAR: i64 = FARTHEST;
/// The largest radiance.
pub(crate) const RADIANCE: i64 = i32::MAX as i64;

/// The header of what is a blob of this version and byte order, and as long as it says.
pub(crate) fn header(blob: &[u8]) -> Result<&Header, BlobError> {
    // What it is comes before how long it is, so that a foreign file is called one.
    if blob.is_empty() || blob.iter().zip(&MAGIC).any(|(found, magic)| found != magic) {
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
    Ok(header)
}

/// The view of a blob. Of its records only the one of the camera is read; that all others lie in the
/// blob is proved, and nothing of what is in them.
pub(crate) fn scene<'a>(
    header: &'a Header,
    sections: &Sections<'a>,
) -> Result<Scene<'a>, BlobError> {
    check_limits(header)?;
    let view = check_view(sections)?;
    let shapes = Shapes::read(sections, header)?;
    Ok(Scene {
        space: Space {
            header,
            shapes,
            leaves: sections.records(SectionKind::Leaves)?,
            #[cfg(feature = "all-structures")]
            chosen: Structure::List,
            #[cfg(feature = "wide")]
            simd: SimdLevel::Portable,
        },
        structures: StructureViews::read(sections)?,
        view,
        lights: sections.records(SectionKind::Lights)?,
        materials: sections.records(SectionKind::Materials)?,
        object_first: Indices::read(sections, SectionKind::ObjectFirst)?,
        object_material: Indices::read(sections, SectionKind::ObjectMaterial)?,
        order: Indices::read(sections, SectionKind::Order)?,
        needs_norm: shapes.needs_norm(),
    })
}

/// Proves the ranges of the header's fields, and that this build has what the scene calls for.
fn check_limits(header: &Header) -> Result<(), BlobError> {
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
    // The list is always there.
    let list = Structure::List.bit();
    exactly(
        "set of the list and of unknown structures",
        (header.structures & (!known | list)).into(),
        list.into(),
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
    for origin in header.origin {
        exactly(
            "number of coordinates of the origin that are no number",
            u64::from(!origin.is_finite()),
            0,
        )?;
    }
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
    Ok(())
}
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
    at.within("display values", view.display_values.into(), 0, 1)?;
    if !DISPLAY_VALUES && view.display_values != 0 {
        let missing = "display-values";
        return Err(BlobError::MissingPart { missing });
    }
    Ok(view)
}
