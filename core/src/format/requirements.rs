//! The memory and features that a program must provide for its own blob, read at compile time.

use crate::format::effects::enable;
use crate::format::instance::Part;
use crate::format::kind::shapes;
use crate::format::record::{Header, SECTION_ALIGNMENT, SectionEntry, View, exponent_of_step};
use crate::format::word::{complete, half, proved, word};
use crate::format::{BlobError, Effects, SectionKind, Structure};
use core::mem::offset_of;

/// The requirements of a blob, with its parts, on the program that it is compiled into.
///
/// [`Requirements::of`] is a `const fn`. A program can compare it with its own memory and features, as the modules of
/// `gridel build --emit-rust` do. Such a program does not compile with a blob that requires more.
///
/// ```
/// # macro_rules! scene { () => { concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel") } }
/// static BLOB: &[u8] = gridel_core::include_blob!(scene!());
/// const STACK_DEPTH: usize = 32;
///
/// const _: () = {
///     let Ok(requirements) = gridel_core::Requirements::of(BLOB) else {
///         panic!("the blob was damaged")
///     };
///     assert!(requirements.stack_depth <= STACK_DEPTH);
/// };
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Requirements {
    /// Entries of the traversal stack.
    pub stack_depth: usize,
    /// Places for rays that wait: [`Effects::work_depth`] at the scene's ray depth.
    pub work_depth: usize,
    /// The effects that the scene requires.
    pub effects: Effects,
    /// Parts that instances place; [`Parts`](crate::Parts) has room for them.
    pub parts: usize,
    /// Instances, for [`Poses`](crate::Poses).
    pub instances: usize,
    /// Joints on which instances hang.
    pub joints: usize,
    /// Pixels of a row of the scene's own picture.
    pub width: usize,
    /// Its rows.
    pub height: usize,
    /// Vertices of the scene's own meshes, without those of parts, for a [`Deformation`](crate::deform::Deformation).
    pub vertices: usize,
    /// Pairs of the scene's own structure [`Bvh`](crate::accel), for a [`Deformation`](crate::deform::Deformation).
    pub pairs: usize,
    /// Normals of the scene's own vertices that morph targets change, for a [`Deformation`](crate::deform::Deformation).
    pub moving_normals: usize,
    /// Morph targets, for [`Tracks::weights_at`](crate::Tracks::weights_at).
    pub morph_targets: usize,
    /// A coordinate step is 2 to this power scene units: [`Scene::coordinate_exponent`](crate::Scene::coordinate_exponent).
    pub coordinate_exponent: i32,
    /// Bits of the numbers of [`Requirements::coordinate_origin`].
    origin: [u64; 3],
    structures: u32,
    /// A bit for each [`SectionKind`] of which there are records.
    sections: u128,
    /// True if only clusters hold triangles or spheres.
    clusters_alone: bool,
    wide_lattice: bool,
    wide_indices: bool,
    display_values: bool,
}

impl Requirements {
    /// Reads the requirements: a few operations per section and part.
    ///
    /// # Errors
    /// If the bytes are not a blob, or it is cut off. Nothing else is proved: use
    /// [`Prevalidated`](crate::scene::Prevalidated) for that.
    pub const fn of(blob: &[u8]) -> Result<Self, BlobError> {
        proved!(complete(blob));
        let (mut required, [directory, blobs]) = proved!(Self::without_parts(blob));
        let mut part = 0;
        while part < required.parts {
            let entry = directory.saturating_add(part * size_of::<Part>());
            let start = proved!(word(blob, entry.saturating_add(offset_of!(Part, start))));
            let start = blobs.saturating_add((start as usize).saturating_mul(SECTION_ALIGNMENT));
            let Some((_, blob_of_part)) = blob.split_at_checked(start) else {
                return Err(BlobError::Truncated {
                    needed: start,
                    found: blob.len(),
                });
            };
            let (of_part, _) = proved!(Self::without_parts(blob_of_part));
            required = required.with_part(&of_part);
            part += 1;
        }
        Ok(required)
    }

    /// The requirements of a blob and of a part in it. A part's picture is not rendered.
    const fn with_part(self, part: &Self) -> Self {
        Self {
            stack_depth: if part.stack_depth > self.stack_depth {
                part.stack_depth
            } else {
                self.stack_depth
            },
            effects: self.effects.with(part.effects),
            structures: self.structures & part.structures,
            sections: self.sections | part.sections,
            clusters_alone: self.clusters_alone || part.clusters_alone,
            wide_lattice: self.wide_lattice || part.wide_lattice,
            wide_indices: self.wide_indices || part.wide_indices,
            display_values: self.display_values || part.display_values,
            ..self
        }
    }

    /// The requirements of a blob without its parts, and where its sections of parts begin: directory and blobs.
    const fn without_parts(blob: &[u8]) -> Result<(Self, [usize; 2]), BlobError> {
        let lattice_bits = proved!(half(blob, offset_of!(Header, lattice_bits))) & 0xff;
        let mut required = Self {
            stack_depth: proved!(half(blob, offset_of!(Header, stack_depth))) as usize,
            work_depth: 0,
            effects: Effects(proved!(word(blob, offset_of!(Header, effects)))),
            parts: 0,
            instances: 0,
            joints: 0,
            width: 0,
            height: 0,
            vertices: 0,
            pairs: 0,
            moving_normals: 0,
            morph_targets: 0,
            coordinate_exponent: proved!(exponent(blob)),
            origin: proved!(origin(blob)),
            structures: proved!(word(blob, offset_of!(Header, structures))),
            sections: 0,
            clusters_alone: false,
            wide_lattice: lattice_bits > 16,
            wide_indices: false,
            display_values: false,
        };
        let sections = proved!(half(blob, offset_of!(Header, section_count))) as usize;
        let (mut places, mut normals) = ([0; 2], 0);
        let mut index = 0;
        while index < sections {
            let entry = size_of::<Header>() + index * size_of::<SectionEntry>();
            let kind = proved!(half(blob, entry + offset_of!(SectionEntry, kind)));
            let stride = proved!(half(blob, entry + offset_of!(SectionEntry, stride))) as usize;
            let count = proved!(word(blob, entry + offset_of!(SectionEntry, count)));
            let start = proved!(word(blob, entry + offset_of!(SectionEntry, offset))) as usize;
            if count > 0 && kind < u128::BITS as u16 {
                required.sections |= 1 << kind;
            }
            if kind == SectionKind::View as u16 {
                // Fields of half a word and less lie two and three to a word.
                let size = proved!(word(blob, start.saturating_add(offset_of!(View, width))));
                let rays = proved!(word(blob, start.saturating_add(offset_of!(View, samples))));
                (required.width, required.height) = (size as usize & 0xffff, size as usize >> 16);
                // The last byte of the word that begins with the depth.
                required.display_values = rays >> 24 == View::DISPLAY_VALUES as u32;
                required.work_depth = required.effects.work_depth((rays >> 16) as u8);
            } else if kind == SectionKind::Vertices as u16 {
                required.vertices = count as usize;
            } else if kind == SectionKind::Pairs as u16 {
                required.pairs = count as usize;
            } else if kind == SectionKind::Normals as u16 {
                normals = count as usize;
            } else if kind == SectionKind::NormalChanges as u16 {
                // The normals come before.
                required.moving_normals = normals;
            } else if kind == SectionKind::MorphWeights as u16 {
                required.morph_targets = count as usize;
            } else if kind == SectionKind::Triangles as u16 {
                required.wide_indices = stride > size_of::<[u16; 3]>();
            } else if kind == SectionKind::Parts as u16 {
                (required.parts, places[0]) = (count as usize, start);
            } else if kind == SectionKind::Instances as u16 {
                required.instances = count as usize;
            } else if kind == SectionKind::Joints as u16 {
                required.joints = count as usize;
            } else if kind == SectionKind::PartBlobs as u16 {
                places[1] = start;
            }
            index += 1;
        }
        use SectionKind::{Packs, Spheres, Strips, Triangles};
        required.clusters_alone = required.has(Strips) && !required.has(Triangles)
            || required.has(Packs) && !required.has(Spheres);
        Ok((required, places))
    }

    const fn has(&self, kind: SectionKind) -> bool {
        self.sections >> kind as u16 & 1 != 0
    }

    /// Returns true if the blob holds a structure.
    pub const fn holds(&self, structure: Structure) -> bool {
        self.structures & structure.bit() != 0
    }

    /// Returns the place from which scene coordinates are counted, in scene units:
    /// [`Header::coordinate_origin`](crate::format::record::Header::coordinate_origin).
    pub const fn coordinate_origin(&self) -> [f64; 3] {
        let [x, y, z] = self.origin;
        [f64::from_bits(x), f64::from_bits(y), f64::from_bits(z)]
    }

    /// Returns true if a scene unit and the place 0 are the same steps in another scene, whose exponent and origin of
    /// coordinates these are.
    pub const fn counts_as(&self, exponent: i32, [x, y, z]: [f64; 3]) -> bool {
        let [own_x, own_y, own_z] = self.origin;
        self.coordinate_exponent == exponent
            && own_x == x.to_bits()
            && own_y == y.to_bits()
            && own_z == z.to_bits()
    }

    /// Returns the bits of a vertex's coordinates in a [`Deformation`](crate::deform::Deformation), 16 or 24.
    pub const fn vertex_bits(&self) -> u32 {
        if self.wide_lattice { 24 } else { 16 }
    }

    /// Returns a sentence about a Cargo feature that the scene requires and that this build lacks. Loading rejects a
    /// blob that requires one.
    pub const fn missing(&self) -> Option<&'static str> {
        macro_rules! parts {
            ($($required:expr => $feature:literal,)*) => {
                [$((
                    $required && !cfg!(feature = $feature),
                    enable!($feature),
                ),)*]
            };
        }
        use SectionKind::{Spheres, Triangles};
        macro_rules! all {
            (
                forms { $($form:tt)* }
                records { $(
                    $(#[doc = $doc:literal])* $kind:ident = $number:literal, $name:literal,
                    $record:tt, [$section:ident = $id:literal, $section_name:literal];
                )* }
            ) => { parts! {
            self.has(Triangles) => "triangle",
            self.has(Spheres) => "sphere",
            $(self.has(SectionKind::$section) => $name,)*
            self.wide_lattice => "wide-lattice",
            self.wide_indices => "wide-indices",
            self.display_values => "display-values",
            self.clusters_alone => "wide",
            self.has(SectionKind::Instances) || self.has(SectionKind::Parts) => "instances",
            } };
        }
        let parts = shapes!(all);
        let mut index = 0;
        while index < parts.len() {
            if parts[index].0 {
                return Some(parts[index].1);
            }
            index += 1;
        }
        self.effects.missing()
    }
}

/// The exponent of a coordinate step.
const fn exponent(blob: &[u8]) -> Result<i32, BlobError> {
    let unit = proved!(half(blob, offset_of!(Header, unit_exponent)));
    let shift = proved!(half(blob, offset_of!(Header, coordinate_shift)));
    Ok(exponent_of_step(unit as i16, shift as u8))
}

/// The bits of the place from which coordinates are counted.
const fn origin(blob: &[u8]) -> Result<[u64; 3], BlobError> {
    let counted_from = proved!(half(blob, offset_of!(Header, coordinate_shift))) >> 8;
    let mut origin = [0; 3];
    let mut axis = 0;
    while counted_from == 0 && axis < origin.len() {
        let place = offset_of!(Header, origin) + axis * size_of::<f64>();
        let low = proved!(word(blob, place)) as u64;
        origin[axis] = (proved!(word(blob, place + 4)) as u64) << 32 | low;
        axis += 1;
    }
    Ok(origin)
}
