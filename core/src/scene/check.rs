//! The proofs that [`Scene::from_bytes`] makes, in the order in which each relies on those before.

use crate::accel::StructureViews;
use crate::format::limits::{FARTHEST, LEAST_ROUGHNESS, MAX_MEDIA};
use crate::format::range::{At, ONE, Ranges, exactly};
use crate::format::record::{Header, Light, Material};
use crate::format::{
    BlobError, Effects, Field, Kind, Leaf, Location, Reason, SectionKind, Sections, checksum,
};
use crate::number::Fixed;
use crate::number::Scalar;
use crate::scene::Scene;
use crate::scene::parts::check_placed;
use crate::target::ENVIRONMENT;

/// Proves that no byte of a blob was changed since it was written.
pub(crate) fn check_sum(blob: &[u8], header: &Header) -> Result<(), BlobError> {
    let found = checksum(blob);
    if found != header.checksum {
        return Err(BlobError::Checksum {
            found,
            expected: header.checksum,
        });
    }
    Ok(())
}

/// Proves all records of a scene; see [`Scene::from_bytes`].
pub(crate) fn check<'a>(scene: &Scene<'a>, sections: &Sections<'a>) -> Result<(), BlobError> {
    check_lights(scene)?;
    check_materials(scene)?;
    if let Some(textures) = scene.textures.get() {
        textures.validate()?;
    }
    scene.geometry.shapes.validate(scene.geometry.header)?;
    check_objects(scene)?;
    if let Some(placed) = scene.placed.get() {
        check_placed(placed, scene.geometry.header, sections)?;
    }
    check_structures(scene, sections)?;
    check_own_primitives(scene)
}

fn check_lights(scene: &Scene<'_>) -> Result<(), BlobError> {
    for (index, form) in scene.light_forms().iter().enumerate() {
        let section = SectionKind::LightForms;
        form.check_ranges(At { section, index }.location())?;
    }
    if let Some(environment) = scene.environment.get() {
        environment.validate()?;
    }
    let mut lights = scene.lights.iter().enumerate();
    lights.try_for_each(|(index, light)| check_light(index, light, scene))
}

/// Proves the ranges of a light.
#[inline(always)]
pub(super) fn check_light(index: usize, light: &Light, scene: &Scene<'_>) -> Result<(), BlobError> {
    let forms = scene.light_forms().len();
    let section = SectionKind::Lights;
    let at = At { section, index };
    light.check_ranges(at.location())?;
    match light.form() {
        Some(form) if forms > 0 => {
            at.within(Field::LightForm, form.into(), 0, forms as i64 - 1)?;
        }
        None if ENVIRONMENT && scene.environment.get().is_some_and(|it| it.has(light)) => (),
        _ => at.within(Field::Kind, light.kind.into(), 0, 1)?,
    }
    let is_directional = light.kind == Light::DIRECTIONAL;
    let most = if is_directional { ONE } else { FARTHEST };
    let vector = light.vector;
    at.all_within(Field::PositionOrDirection, &vector, -most, most)?;
    let zero = is_directional && vector == [0; 3];
    at.ensure(!zero, Reason::ZeroDirection)
}

fn check_materials(scene: &Scene<'_>) -> Result<(), BlobError> {
    let section = SectionKind::Materials;
    let (header, materials) = (scene.geometry.header, scene.materials);
    let mut required = Effects::NONE;
    if materials.is_empty() && header.primitives > 0 {
        return Err(BlobError::Count {
            section,
            found: 0,
            expected: 1,
        });
    }
    for (index, material) in materials.iter().enumerate() {
        check_material(index, material, scene.maps())?;
        let uncalled = material.effects().without(Effects(header.effects));
        let at = At { section, index };
        at.ensure(uncalled == Effects::NONE, Reason::MissingEffect)?;
        required = required.with(material.effects());
    }
    let shapes = &scene.geometry.shapes;
    // One by one, so that effects without code in this build leave no code here.
    let own = !shapes.normals().is_empty();
    let smooth = check_vertices(scene, SectionKind::Normals, own, Effects::SMOOTH)?;
    let own = !shapes.colors().is_empty();
    let colors = check_vertices(
        scene,
        SectionKind::VertexColors,
        own,
        Effects::VERTEX_COLORS,
    )?;
    required = required.with(smooth).with(colors);
    required = required.with(check_glow(scene)?);
    let lens = Effects::DEPTH_OF_FIELD.only_if(scene.lens().is_some());
    required = required.with(check_called(scene, SectionKind::Lens, lens)?);
    let bounces = Effects::INDIRECT.only_if(scene.bounces() > 0);
    required = required.with(check_called(scene, SectionKind::Indirect, bounces)?);
    let environment = Effects::ENVIRONMENT.only_if(scene.environment().is_some());
    required = required.with(check_called(scene, SectionKind::Environment, environment)?);
    required = required.with(check_roughness(scene)?);
    required = required.with(check_media(scene)?);
    let view = scene.view.effects();
    let called = Effects(header.effects).contains(view);
    Location::Section(SectionKind::View).ensure(called, Reason::MissingEffect)?;
    required = required.with(view);
    // Without objects lights require nothing.
    if header.objects > 0 {
        let lights = scene.lights.iter();
        required = lights.fold(required, |required, light| required.with(light.effects()));
    }
    let unneeded = Effects(header.effects).without(required);
    Location::Header.ensure(unneeded == Effects::NONE, Reason::UnneededEffects)
}

/// Returns the effects that a section requires; an error where the header does not require them.
#[inline(always)]
fn check_called(
    scene: &Scene<'_>,
    section: SectionKind,
    required: Effects,
) -> Result<Effects, BlobError> {
    let is_known = Effects(scene.geometry.header.effects).contains(required);
    Location::Section(section).ensure(is_known, Reason::MissingEffect)?;
    Ok(required)
}

/// Returns the effect that a section of data of vertices requires, of the scene's own or in its parts; an error where the
/// header does not require it.
#[inline(always)]
fn check_vertices(
    scene: &Scene<'_>,
    section: SectionKind,
    own: bool,
    effect: Effects,
) -> Result<Effects, BlobError> {
    let mut parts = scene.parts().iter();
    let mut in_parts = || parts.any(|part| part.effects().contains(effect));
    let is_available = Effects::AVAILABLE.contains(effect);
    let required = effect.only_if(is_available && (own || in_parts()));
    let section = if own { section } else { SectionKind::Parts };
    check_called(scene, section, required)
}

/// Returns the effects that emitting materials require; an error where their light is out of its range, or the header
/// does not require the effects.
fn check_glow(scene: &Scene<'_>) -> Result<Effects, BlobError> {
    let section = SectionKind::Emissions;
    for (index, emission) in (0..scene.emissions().len()).zip(scene.emissions()) {
        emission.check_ranges(At { section, index }.location())?;
    }
    let required = Effects::EMISSION.only_if(!scene.emissions().is_empty());
    check_called(scene, section, required)
}

/// Returns the effects that rough materials require; an error where a roughness is out of its range, or the header does
/// not require them.
fn check_roughness(scene: &Scene<'_>) -> Result<Effects, BlobError> {
    let Some(rough) = scene.rough.get() else {
        return Ok(Effects::NONE);
    };
    let section = SectionKind::Roughnesses;
    for (index, &alpha) in (0..rough.alphas.len()).zip(rough.alphas) {
        let least = if alpha == 0 { 0 } else { LEAST_ROUGHNESS };
        At { section, index }.within(Field::Roughness, alpha.into(), least.into(), ONE)?;
    }
    for (index, &mark) in (0..rough.shown_forms.len()).zip(rough.shown_forms) {
        let section = SectionKind::ShownForms;
        At { section, index }.within(Field::ShownForm, mark.into(), 0, 1)?;
    }
    let required = Effects::GLOSSY.only_if(!rough.alphas.is_empty());
    check_called(scene, section, required)
}

/// Returns the effects that nested dielectrics require; an error where one is no glass, comes twice, or the header does
/// not require them.
fn check_media(scene: &Scene<'_>) -> Result<Effects, BlobError> {
    let section = SectionKind::Media;
    let media = scene.media();
    if media.len() > MAX_MEDIA {
        return Err(BlobError::TooMany {
            section,
            found: media.len(),
            most: MAX_MEDIA,
        });
    }
    for (index, &number) in media.iter().enumerate() {
        let at = At { section, index };
        let most = scene.materials.len() as i64 - 1;
        at.within(Field::Material, number.into(), 0, most)?;
        let material = scene.materials.get(number as usize);
        let is_glass = material.is_some_and(Material::is_glass);
        at.ensure(is_glass, Reason::OpaqueMedium)?;
        let is_new = !media.iter().take(index).any(|&other| other == number);
        at.ensure(is_new, Reason::RepeatedMedium)?;
    }
    let required = Effects::NESTED.only_if(!media.is_empty());
    check_called(scene, section, required)
}

/// Proves the ranges of a material.
#[inline(always)]
pub(super) fn check_material(
    index: usize,
    material: &Material,
    maps: usize,
) -> Result<(), BlobError> {
    let section = SectionKind::Materials;
    let at = At { section, index };
    material.check_ranges(at.location())?;
    at.within(Field::Shininess, material.exponent().into(), 1, 1024)?;
    let number = material.maps & Material::MAPS_NUMBER;
    at.within(Field::Maps, number.into(), 0, maps as i64)?;
    let flags = material.maps & !Material::MAPS_NUMBER;
    at.ensure(flags == 0 || number > 0, Reason::MissingMaps)
}

fn check_objects(scene: &Scene<'_>) -> Result<(), BlobError> {
    let objects = scene.geometry.header.objects as usize;
    let primitives = i64::from(scene.geometry.header.primitives);
    let first = &scene.object_first;
    if first.is_empty() {
        let implied = objects as i64 == primitives || objects <= 1;
        Location::Header.ensure(implied, Reason::MissingObjectFirst)?;
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
            At { section, index }.within(Field::FirstPrimitive, value, last, most)?;
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
            At { section, index }.within(Field::Material, value, 0, most)?;
        }
    }
    let order = &scene.order;
    let slots = scene.geometry.shapes.total();
    let own = scene.own_primitives();
    if !order.is_empty() || slots as i64 != own {
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
            At { section, index }.within(Field::Primitive, value, 0, own - 1)?;
        }
    }
    Ok(())
}

/// Proves that no slot of a scene with parts claims a primitive of the parts. Those of clusters are already read.
fn check_own_primitives(scene: &Scene<'_>) -> Result<(), BlobError> {
    if scene.parts().is_empty() {
        return Ok(());
    }
    let own = scene.own_primitives();
    for kind in Kind::ALL {
        for index in 0..scene.count(kind) {
            let found = i64::from(scene.primitive(kind, index as u32));
            let section = SectionKind::Parts;
            At { section, index }.within(Field::Primitive, found, 0, own - 1)?;
        }
    }
    Ok(())
}

fn check_structures<'a>(scene: &Scene<'a>, sections: &Sections<'a>) -> Result<(), BlobError> {
    let longest = check_leaves(scene, StructureViews::uses_leaves(&scene.geometry))?;
    exactly(
        Field::LongestLeaf,
        scene.geometry.header.longest_leaf.into(),
        longest,
    )?;
    let (depth, all_proved) = scene.structures.check(&scene.geometry, sections)?;
    let depth = depth.max(scene.stack_depth_of_parts());
    let found = scene.geometry.header.stack_depth;
    if all_proved || usize::from(found) < depth {
        exactly(Field::StackDepth, found.into(), depth as u32)?;
    }
    Ok(())
}

/// Proves that every primitive lies in exactly one leaf, and returns the longest leaf's count. Leaves hold the slots of
/// each kind in order.
fn check_leaves(scene: &Scene<'_>, hierarchies: bool) -> Result<u32, BlobError> {
    let section = SectionKind::Leaves;
    if !hierarchies && !scene.geometry.leaves.is_empty() {
        return Err(BlobError::Count {
            section,
            found: scene.geometry.leaves.len(),
            expected: 0,
        });
    }
    let mut next = [0_u32; Kind::ALL.len()];
    let mut longest = 0;
    for (index, &word) in (0..scene.geometry.leaves.len()).zip(scene.geometry.leaves) {
        let at = At { section, index };
        let Some(leaf) = Leaf::from_word(word).filter(|leaf| leaf.kind.is_bounded()) else {
            let range = [0, Kind::LAST_BOUNDED as i64];
            let location = Location::Record(section, index);
            return Err(location.out_of_range(Field::Kind, (word >> 29).into(), range));
        };
        at.within(
            Field::Primitives,
            leaf.count.into(),
            1,
            Leaf::MAX_COUNT.into(),
        )?;
        let next = &mut next[leaf.kind as usize];
        at.within(
            Field::FirstSlot,
            leaf.first.into(),
            (*next).into(),
            (*next).into(),
        )?;
        // Below 2^24 and 31.
        *next = next.wrapping_add(leaf.count);
        longest = longest.max(leaf.count);
        let most = scene.geometry.shapes.records(leaf.kind) as i64;
        at.within(Field::EndSlot, (*next).into(), 0, most)?;
    }
    if hierarchies {
        for kind in Kind::ALL.into_iter().filter(|kind| kind.is_bounded()) {
            // Primitives that only clusters hold would be missing.
            let (found, expected) = (
                next[kind as usize] as usize,
                scene.geometry.shapes.count(kind),
            );
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

// The checks above limit coordinates to the range of a `Fixed` length.
const _: () = assert!((i16::MAX as i64) << 13 < Fixed::FAR.0 as i64);
