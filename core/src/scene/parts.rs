//! Parts: blobs in a blob, loaded once and lent to the scene that places them.

use crate::format::instance::{Instance, Part};
use crate::format::range::{At, exactly};
use crate::format::record::{Header, SECTION_ALIGNMENT, UnitBox};
use crate::format::{BlobError, Field, Location, Reason, SectionKind, Sections};
use crate::instances::check::{check_instance, check_top};
use crate::instances::placed::Placed;
use crate::scene::{Scene, read};
use heapless::Vec;

/// The parts of a blob, loaded: a view of a few hundred bytes for each, of at most `MOST`.
///
/// ```
/// # static BLOB: &[u8] =
/// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
/// use gridel_core::{Parts, Scene};
///
/// // This blob has no parts; one with parts is loaded likewise.
/// let mut parts = Parts::<4>::new();
/// parts.load(BLOB)?;
/// let scene = Scene::with_parts(BLOB, &parts)?;
/// assert_eq!(scene.instances().len(), 0);
/// # Ok::<(), gridel_core::BlobError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Parts<'a, const MOST: usize>(Vec<Scene<'a>, MOST>);

impl<'a, const MOST: usize> Parts<'a, MOST> {
    /// Returns room for parts.
    pub const fn new() -> Self {
        Self(Vec::new())
    }

    /// Loads the parts of a blob, each with the checks of [`Scene::from_bytes`], in place of those that were loaded
    /// before. If it fails, none are.
    ///
    /// # Errors
    /// If a part is invalid, or there are more than `MOST`.
    pub fn load(&mut self, blob: &'a [u8]) -> Result<(), BlobError> {
        self.0.clear();
        let loaded = part_blobs(blob)?.try_for_each(|part| {
            let part = Scene::from_bytes(part)?;
            self.0.push(part).map_err(|_| BlobError::Memory {
                section: SectionKind::Parts,
                found: MOST,
                needed: part_blobs(blob).map_or(0, Iterator::count),
            })
        });
        if loaded.is_err() {
            self.0.clear();
        }
        loaded
    }

    /// Returns the parts of a blob. In firmware [load](Self::load) them in place: what a function returns is copied, and
    /// takes up to three times the memory.
    ///
    /// # Errors
    /// As [`load`](Self::load).
    pub fn from_bytes(blob: &'a [u8]) -> Result<Self, BlobError> {
        let mut parts = Self::new();
        parts.load(blob)?;
        Ok(parts)
    }

    /// Returns the parts with one replaced by a changed view of it, such as one that
    /// [deforms](Scene::with_deformation). [`Scene::with_changed_parts`] takes them.
    ///
    /// # Errors
    /// If it is not a view of the same part's blob.
    pub fn with_part(&self, number: usize, part: Scene<'a>) -> Result<Self, BlobError> {
        let mut parts = self.clone();
        let held = parts.0.get_mut(number);
        let Some(held) = held.filter(|held| held.is_same_blob(&part)) else {
            let section = SectionKind::Parts;
            return Err(Location::Record(section, number).invalid(Reason::OtherPart));
        };
        *held = part;
        Ok(parts)
    }
}

impl<'a, const MOST: usize> core::ops::Deref for Parts<'a, MOST> {
    type Target = [Scene<'a>];

    fn deref(&self) -> &[Scene<'a>] {
        &self.0
    }
}

/// Returns the blobs of a blob's parts, in order, each a blob of its own.
///
/// ```
/// # static BLOB: &[u8] =
/// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
/// assert_eq!(gridel_core::scene::part_blobs(BLOB)?.count(), 0);
/// # Ok::<(), gridel_core::BlobError>(())
/// ```
///
/// # Errors
/// If header or section table are invalid, or a part does not lie in the section of parts.
pub fn part_blobs(blob: &[u8]) -> Result<impl Iterator<Item = &[u8]>, BlobError> {
    let header = read::header(blob)?;
    let sections = Sections::read(blob, header.section_count)?;
    let directory: &[Part] = sections.records(SectionKind::Parts)?;
    let bytes = sections.get(SectionKind::PartBlobs).bytes;
    check_directory(directory, bytes.len() / SECTION_ALIGNMENT)?;
    Ok(directory.iter().map(|part| blob_of(part, bytes)))
}

/// The bytes of a part; empty where it does not lie in the section.
fn blob_of<'a>(part: &Part, bytes: &'a [u8]) -> &'a [u8] {
    let start = (part.start as usize).saturating_mul(SECTION_ALIGNMENT);
    let end = start.saturating_add((part.length as usize).saturating_mul(SECTION_ALIGNMENT));
    let padded = bytes.get(start..end).unwrap_or_default();
    // A blob's own length is not a multiple of the alignment. The checks of a blob rely on the length that it states.
    let length =
        read::header_of_part(padded).map_or(padded.len(), |header| header.blob_bytes as usize);
    let needed = length.checked_next_multiple_of(SECTION_ALIGNMENT);
    if needed == Some(padded.len()) {
        padded.get(..length).unwrap_or(padded)
    } else {
        padded
    }
}

/// Proves that parts lie one behind the other and fill the section.
fn check_directory(directory: &[Part], words: usize) -> Result<(), BlobError> {
    let section = SectionKind::Parts;
    let mut end = 0_i64;
    for (index, part) in directory.iter().enumerate() {
        let at = At { section, index };
        at.within(Field::Start, part.start.into(), end, end)?;
        let left = (words as i64).saturating_sub(end);
        at.within(Field::Length, part.length.into(), 1, left)?;
        at.ensure(part.spare == 0, Reason::SpareNotZero)?;
        end = end.saturating_add(part.length.into());
    }
    if end != words as i64 {
        let range = [end; 2];
        let location = Location::Section(SectionKind::PartBlobs);
        return Err(location.out_of_range(Field::Length, words as i64, range));
    }
    Ok(())
}

/// Proves parts, instances and the hierarchy above them; see [`Scene::with_parts`].
pub(in crate::scene) fn check_placed<'a>(
    placed: &Placed<'a, Scene<'a>>,
    header: &Header,
    sections: &Sections<'a>,
) -> Result<(), BlobError> {
    let bytes = sections.get(SectionKind::PartBlobs).bytes;
    check_directory(placed.directory, bytes.len() / SECTION_ALIGNMENT)?;
    let section = SectionKind::Parts;
    let mut next = i64::from(placed.own_primitives(header.primitives));
    for (index, (part, scene)) in placed.directory.iter().zip(placed.parts).enumerate() {
        let at = At { section, index };
        let held: *const u8 = blob_of(part, bytes).as_ptr();
        let given: *const Header = scene.header();
        at.ensure(core::ptr::eq(held.cast(), given), Reason::OtherPart)?;
        at.within(
            Field::FirstPrimitive,
            part.first_primitive.into(),
            next,
            next,
        )?;
        next = next.saturating_add(scene.header().primitives.into());
        let same = scene.header().structures == header.structures;
        at.ensure(same, Reason::OtherStructures)?;
        at.ensure(!scene.has_unbounded, Reason::UnboundedPart)?;
        // A part has no parts of its own, because rays would miss them.
        at.ensure(scene.parts().is_empty(), Reason::OtherPart)?;
    }
    exactly(
        Field::Primitive,
        header.primitives,
        next.clamp(0, u32::MAX.into()) as u32,
    )?;
    check_instances(placed, &header.bounds)
}

/// Proves instances and the hierarchy above them, in a scene with this box.
pub(in crate::scene) fn check_instances(
    placed: &Placed<'_, Scene<'_>>,
    bounds: &UnitBox,
) -> Result<(), BlobError> {
    let section = SectionKind::Instances;
    let (parts, instances) = (placed.parts.len() as i64, placed.top.instances.len() as i64);
    for (index, instance) in placed.top.instances.iter().enumerate() {
        let at = At { section, index };
        at.within(Field::Part, instance.part.into(), 0, parts - 1)?;
        at.within(Field::Instance, instance.number.into(), 0, instances - 1)?;
        check_instance(index, instance)?;
    }
    check_top(&placed.top, bounds, |instance| {
        let (part, _) = placed.part(instance)?;
        instance.around(part.bounds())
    })
}

impl<'a> Scene<'a> {
    /// Number of primitives of the scene's own objects, which structures hold.
    pub(in crate::scene) fn own_primitives(&self) -> i64 {
        let all = self.geometry.header.primitives;
        let own = self
            .placed
            .get()
            .map_or(all, |placed| placed.own_primitives(all));
        own.into()
    }

    /// Entries of the traversal stack that a walk through the deepest part needs.
    pub(in crate::scene) fn stack_depth_of_parts(&self) -> usize {
        let depths = self.parts().iter().map(Scene::stack_depth);
        depths.max().unwrap_or(0)
    }

    /// Returns true if the scene has objects of its own.
    #[inline(always)]
    pub(crate) fn has_own(&self) -> bool {
        let parts = self.placed.get().map_or(&[][..], |placed| placed.directory);
        parts.first().is_none_or(|part| part.first_primitive > 0)
    }

    /// Returns true if two scenes are views of one blob.
    fn is_same_blob(&self, other: &Scene<'_>) -> bool {
        core::ptr::eq(self.header(), other.header())
    }

    /// Returns the scene with changed views of its parts, such as ones that [deform](Scene::with_deformation).
    ///
    /// # Errors
    /// If they are not views of the blobs of all parts, in their order.
    pub fn with_changed_parts(&self, parts: &'a [Scene<'a>]) -> Result<Self, BlobError> {
        let (found, expected) = (parts.len(), self.parts().len());
        if found != expected {
            return Err(BlobError::Parts { found, expected });
        }
        let mut pairs = self.parts().iter().zip(parts);
        if let Some(index) = pairs.position(|(part, other)| !part.is_same_blob(other)) {
            let section = SectionKind::Parts;
            return Err(Location::Record(section, index).invalid(Reason::OtherPart));
        }
        let mut placed = self.placed;
        if let Some(placed) = placed.get_mut() {
            placed.parts = parts;
        }
        Ok(Self { placed, ..*self })
    }

    /// Returns the instances, in the order of the hierarchy above them.
    // Every query calls it.
    #[cfg_attr(feature = "wide", inline(always))]
    pub fn instances(&self) -> &'a [Instance] {
        self.placed.get().map_or(&[], |placed| placed.top.instances)
    }

    /// Returns the parts that instances place.
    pub fn parts(&self) -> &'a [Scene<'a>] {
        self.placed.get().map_or(&[], |placed| placed.parts)
    }

    /// Returns the number of the first primitive of a part among all primitives of the scene.
    pub fn first_primitive_of_part(&self, part: usize) -> Option<u32> {
        let directory = self.placed.get()?.directory;
        directory.get(part).map(|part| part.first_primitive)
    }
}
