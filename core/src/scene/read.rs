//! The part of loading that takes constant time: it reads the header, the table, the view, and the location of every
//! section.

use crate::accel::StructureViews;
use crate::accel::scene_geometry::SceneGeometry;
use crate::accel::stack::Entry;
use crate::format::instance::Part;
use crate::format::lens::Lens;
use crate::format::limits::{DISPLAY_VALUES, FARTHEST, INDIRECT, INSTANCES, MAX_BOUNCES, NESTED};
use crate::format::range::{At, Ranges, exactly};
use crate::format::record::{ALIGNMENT, ENDIANNESS, Header, MAGIC, VERSION, View};
use crate::format::{
    BlobError, Effects, Field, Indices, Location, Reason, SectionKind, Sections, Structure,
};
use crate::geometry::Shapes;
use crate::instances::placed::Placed;
use crate::instances::top::Top;
use crate::scene::Scene;
use crate::scene::blob::Rough;
use crate::scene::environment::EnvironmentMap;
use crate::scene::textures::Textures;
use crate::simd::SimdLevel;
use crate::target::{
    AllStructuresOnly, DepthOfFieldOnly, ENVIRONMENT, EmissionOnly, EnvironmentOnly, FalloffOnly,
    GlossyOnly, IndirectOnly, InstancesOnly, NestedOnly, TEXTURE, TextureOnly, WideOnly,
};
use core::mem::size_of;

/// Returns the header of a blob of this version and byte order, and of the stated length.
pub(crate) fn header(blob: &[u8]) -> Result<&Header, BlobError> {
    // The kind of file is checked before its length, so that a foreign file is reported as one.
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

/// Returns instances and parts, of which there are as many as the blob has. Proves nothing else.
fn placed<'a>(
    sections: &Sections<'a>,
    parts: &'a [Scene<'a>],
) -> Result<InstancesOnly<Placed<'a, Scene<'a>>>, BlobError> {
    if !INSTANCES {
        // A table with sections of parts was rejected.
        return Ok(InstancesOnly::new(|| Placed::NONE));
    }
    let directory: &[Part] = sections.records(SectionKind::Parts)?;
    if directory.len() != parts.len() {
        let (found, expected) = (parts.len(), directory.len());
        return Err(BlobError::Parts { found, expected });
    }
    let placed = Placed {
        top: Top {
            instances: sections.records(SectionKind::Instances)?,
            pairs: sections.records(SectionKind::InstancePairs)?,
        },
        directory,
        parts,
    };
    if directory.is_empty() && !placed.top.is_empty() {
        return Err(BlobError::Count {
            section: SectionKind::Parts,
            found: 0,
            expected: 1,
        });
    }
    Ok(InstancesOnly::new(|| placed))
}

/// Returns the header of a part, of which nothing is proved.
pub(in crate::scene) fn header_of_part(blob: &[u8]) -> Option<&Header> {
    bytemuck::try_from_bytes(blob.get(..size_of::<Header>())?).ok()
}

/// Returns the view of a blob. It reads only one record, that of the camera. It proves that all others lie in the blob,
/// but not their content.
pub(crate) fn scene<'a>(
    header: &'a Header,
    sections: &Sections<'a>,
    parts: &'a [Scene<'a>],
) -> Result<Scene<'a>, BlobError> {
    check_limits(header)?;
    let view = the_view(sections)?;
    let shapes = Shapes::read(sections, header)?;
    let textures = match TEXTURE {
        true => Textures::read(sections)?,
        false => Textures::none(),
    };
    let light_forms = match const { Effects::AVAILABLE.contains(Effects::FALLOFF) } {
        true => sections.records(SectionKind::LightForms)?,
        false => &[],
    };
    let emissions = match const { Effects::AVAILABLE.contains(Effects::EMISSION) } {
        true => sections.records(SectionKind::Emissions)?,
        false => &[],
    };
    let lens = match const { Effects::AVAILABLE.contains(Effects::DEPTH_OF_FIELD) } {
        true => the_lens(sections, view)?,
        false => &[],
    };
    let bounces = match INDIRECT {
        true => the_bounces(sections)?,
        false => 0,
    };
    let media = match NESTED {
        true => sections.records(SectionKind::Media)?,
        false => &[],
    };
    let environment = match ENVIRONMENT {
        true => EnvironmentMap::read(sections)?,
        false => EnvironmentMap::default(),
    };
    let mut rough = Rough {
        alphas: &[],
        shown_forms: &[],
    };
    if const { Effects::AVAILABLE.contains(Effects::GLOSSY) } {
        rough.alphas = sections.records(SectionKind::Roughnesses)?;
        rough.shown_forms = sections.records(SectionKind::ShownForms)?;
    }
    Ok(Scene {
        geometry: SceneGeometry {
            header,
            shapes,
            leaves: sections.records(SectionKind::Leaves)?,
            chosen: AllStructuresOnly::new(|| Structure::best_of(header.structures)),
            simd: WideOnly::new(SimdLevel::default),
        },
        structures: StructureViews::read(sections)?,
        effects: Effects(header.effects),
        view,
        lights: sections.records(SectionKind::Lights)?,
        light_forms: FalloffOnly::new(|| light_forms),
        materials: sections.records(SectionKind::Materials)?,
        emissions: EmissionOnly::new(|| emissions),
        lens: DepthOfFieldOnly::new(|| lens),
        bounces: IndirectOnly::new(|| bounces),
        media: NestedOnly::new(|| media),
        object_first: Indices::read(sections, SectionKind::ObjectFirst)?,
        object_material: Indices::read(sections, SectionKind::ObjectMaterial)?,
        order: Indices::read(sections, SectionKind::Order)?,
        rough: GlossyOnly::new(|| rough),
        textures: TextureOnly::new(|| textures),
        environment: EnvironmentOnly::new(|| environment),
        placed: placed(sections, parts)?,
        needs_norm: shapes.needs_norm(),
        has_unbounded: shapes.has_unbounded(),
    })
}

/// Proves the ranges of the header's fields, and that this build has everything that the scene requires.
fn check_limits(header: &Header) -> Result<(), BlobError> {
    let header_has = |holds, reason| Location::Header.ensure(holds, reason);
    let unknown = header.effects & !Effects::ALL.0;
    header_has(unknown == 0, Reason::UnknownEffects)?;
    let missing = Effects(header.effects).without(Effects::AVAILABLE);
    if missing != Effects::NONE {
        return Err(BlobError::MissingEffects { missing });
    }
    let known = Structure::ALL
        .iter()
        .fold(0, |bits, structure| bits | structure.bit());
    let unknown = header.structures & !known;
    header_has(unknown == 0, Reason::UnknownStructures)?;
    let list = header.structures & Structure::List.bit();
    header_has(list != 0, Reason::MissingList)?;
    header.check_ranges(Location::Header)?;
    let stack_bytes = u32::from(header.stack_depth) * size_of::<Entry>() as u32;
    exactly(Field::StackBytes, header.stack_bytes, stack_bytes)?;
    let storage_bits = if header.lattice_bits <= 16 { 16 } else { 24 };
    exactly(Field::StorageBits, header.storage_bits.into(), storage_bits)?;
    let origin = header.origin;
    let finite = origin.iter().all(|origin| origin.is_finite());
    header_has(finite, Reason::OriginNotFinite)?;
    let mut sides = header.bounds.0.iter();
    header_has(sides.all(|[low, high]| low <= high), Reason::InvertedBounds)?;
    let mut sides = header.bounds.0.iter();
    header_has(
        sides.all(|[low, _]| *low != i16::MIN),
        Reason::ReservedBounds,
    )?;
    header_has(header.spare == [0; 3], Reason::SpareNotZero)?;
    Ok(())
}

fn the_view<'a>(sections: &Sections<'a>) -> Result<&'a View, BlobError> {
    let section = SectionKind::View;
    let views: &[View] = sections.records(section)?;
    let [view] = views else {
        return Err(BlobError::Count {
            section,
            found: views.len(),
            expected: 1,
        });
    };
    check_view(view)?;
    Ok(view)
}

/// The camera's lens, if it has one.
fn the_lens<'a>(sections: &Sections<'a>, view: &View) -> Result<&'a [Lens], BlobError> {
    let section = SectionKind::Lens;
    let lenses: &[Lens] = sections.records(section)?;
    if lenses.len() > 1 {
        return Err(BlobError::Count {
            section,
            found: lenses.len(),
            expected: 1,
        });
    }
    check_lens(lenses.first(), view)?;
    Ok(lenses)
}

/// Proves that rays can start from all of a lens where a view has its eye.
pub(super) fn check_lens(lens: Option<&Lens>, view: &View) -> Result<(), BlobError> {
    let Some(lens) = lens else {
        return Ok(());
    };
    let section = SectionKind::Lens;
    let at = At { section, index: 0 };
    lens.check_ranges(at.location())?;
    let most = FARTHEST.wrapping_sub(lens.radius);
    at.all_within(Field::Eye, &{ view.eye }, -most, most)
}

/// The number of diffuse reflections of light.
fn the_bounces(sections: &Sections<'_>) -> Result<u8, BlobError> {
    let section = SectionKind::Indirect;
    let bounces: &[u32] = sections.records(section)?;
    match *bounces {
        [] => Ok(0),
        [bounces] => {
            let at = At { section, index: 0 };
            at.within(Field::Bounces, bounces.into(), 1, MAX_BOUNCES as i64)?;
            Ok(bounces as u8)
        }
        _ => Err(BlobError::Count {
            section,
            found: bounces.len(),
            expected: 1,
        }),
    }
}

/// Proves the ranges of a view, and that this build has everything that it requires.
pub(super) fn check_view(view: &View) -> Result<(), BlobError> {
    let section = SectionKind::View;
    let at = At { section, index: 0 };
    view.check_ranges(at.location())?;
    if !DISPLAY_VALUES && view.encoding == View::DISPLAY_VALUES {
        let missing = "display-values";
        return Err(BlobError::MissingPart { missing });
    }
    Ok(())
}
