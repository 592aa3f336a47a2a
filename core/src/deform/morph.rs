//! Morph targets: shapes that a mesh takes on by weights.
//!
//! A mesh at its weights has each vertex where it is at rest, displaced by each morph target times the difference of
//! its weight from that at rest. Normals change likewise, on the octahedron that they are stored on. All in integers:
//! sums with 24 fraction bits, rounded once. So the result is the same in every number format and on every machine.

use crate::deform::{DeformError, DeformationIn, Memory, fit};
use crate::format::limits::{LARGEST_DISPLACEMENT, LARGEST_WEIGHT};
use crate::format::range::At;
use crate::format::record::Pair;
use crate::format::width::Vertex;
use crate::format::{BlobError, Field, Indices, Reason, SectionKind, Sections};
use crate::geometry::smooth;
use crate::scene::{Scene, header};

/// Fraction bits of weights.
const WEIGHT_BITS: u32 = 24;

/// The morph targets of a scene's own meshes, or of a part's, read in place.
///
/// ```
/// # static BLOB: &[u8] =
/// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/bvh.gridel"));
/// use gridel_core::deform::MorphTargets;
/// use gridel_core::format::record::Vertex24;
/// use gridel_core::{Deformation, Scene, Tracks};
///
/// type Mesh = Deformation<Vertex24, 16, 16>;
///
/// /// The scene with its mesh as its tracks say.
/// fn at<'a>(
///     scene: &Scene<'a>,
///     (tracks, morph): (&Tracks<'_>, &MorphTargets<'_>),
///     time: i32,
///     mesh: &'a mut Mesh,
/// ) -> Result<Scene<'a>, Box<dyn std::error::Error>> {
///     let mut weights = [0; 2];
///     tracks.weights_at(time, &mut weights)?;
///     mesh.morph(scene, morph, &weights)?;
///     Ok(scene.with_deformation(mesh)?)
/// }
/// // This blob has no morph targets; one that has some is read likewise.
/// let morph = MorphTargets::from_bytes(BLOB)?;
/// assert!(morph.is_empty() && morph.weights_at_rest().is_empty());
/// # Ok::<(), gridel_core::BlobError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct MorphTargets<'a> {
    /// The checksum of the blob.
    blob: u32,
    rest: &'a [i32],
    vertices: Indices<'a>,
    numbers: Indices<'a>,
    displacements: Displacements<'a>,
    /// For each displacement; empty where no normal changes.
    normals: &'a [[i16; 3]],
}

/// Displacements, in steps of the vertices' storage.
#[derive(Clone, Copy, Debug)]
enum Displacements<'a> {
    Short(&'a [[i16; 3]]),
    Long(&'a [[i32; 3]]),
}

impl Displacements<'_> {
    fn len(&self) -> usize {
        match self {
            Self::Short(all) => all.len(),
            Self::Long(all) => all.len(),
        }
    }

    fn get(&self, index: usize) -> Option<[i32; 3]> {
        match self {
            Self::Short(all) => all.get(index).map(|steps| steps.map(i32::from)),
            Self::Long(all) => all.get(index).copied(),
        }
    }
}

impl<'a> MorphTargets<'a> {
    /// Checks the morph targets of a blob's own meshes and returns them. A blob without any is valid; nothing moves
    /// then.
    ///
    /// Costs time linear in the number of displacements.
    ///
    /// # Errors
    /// If a number is out of its range, vertices or their morph targets do not ascend, or the sections differ in
    /// length. Also if the header or the section table is invalid.
    pub fn from_bytes(blob: &'a [u8]) -> Result<Self, BlobError> {
        let header = header(blob)?;
        let sections = Sections::read(blob, header.section_count)?;
        let rest: &[i32] = sections.records(SectionKind::MorphWeights)?;
        for (index, &weight) in rest.iter().enumerate() {
            let section = SectionKind::MorphWeights;
            let most = i64::from(LARGEST_WEIGHT);
            At { section, index }.within(Field::Weight, weight.into(), -most, most)?;
        }
        Self::read(header.checksum, &sections, rest)
    }

    /// Checks the morph targets of a part's meshes and returns them, given the blob of the part: one of
    /// [`part_blobs`](crate::scene::part_blobs). Their weights are those of the whole scene.
    ///
    /// # Errors
    /// The errors of [`from_bytes`](Self::from_bytes).
    pub fn of_part(&self, part: &'a [u8]) -> Result<Self, BlobError> {
        let header = header(part)?;
        let sections = Sections::read(part, header.section_count)?;
        Self::read(header.checksum, &sections, self.rest)
    }

    fn read(blob: u32, sections: &Sections<'a>, rest: &'a [i32]) -> Result<Self, BlobError> {
        let section = SectionKind::Displacements;
        let displacements = if sections.get(section).stride == size_of::<[i16; 3]>() {
            Displacements::Short(sections.records(section)?)
        } else {
            Displacements::Long(sections.records(section)?)
        };
        let morph = Self {
            blob,
            rest,
            vertices: Indices::read(sections, SectionKind::MorphVertices)?,
            numbers: Indices::read(sections, SectionKind::MorphNumbers)?,
            displacements,
            normals: sections.records(SectionKind::NormalChanges)?,
        };
        morph.check(sections.len(SectionKind::Vertices))?;
        Ok(morph)
    }

    fn check(&self, vertices: usize) -> Result<(), BlobError> {
        let expected = self.displacements.len();
        let normals = match self.normals {
            [] => expected,
            normals => normals.len(),
        };
        for (section, found) in [
            (SectionKind::MorphVertices, self.vertices.len()),
            (SectionKind::MorphNumbers, self.numbers.len()),
            (SectionKind::NormalChanges, normals),
        ] {
            if found != expected {
                return Err(BlobError::Count {
                    section,
                    found,
                    expected,
                });
            }
        }
        if let Displacements::Long(all) = self.displacements {
            let section = SectionKind::Displacements;
            let most = i64::from(LARGEST_DISPLACEMENT);
            for (steps, index) in all.iter().zip(0..) {
                At { section, index }.all_within(Field::Displacement, steps, -most, most)?;
            }
        }
        let mut next = 0_u64;
        for index in 0..expected {
            let at = |section| At { section, index };
            let vertex = self.vertices.get(index).unwrap_or_default();
            let number = self.numbers.get(index).unwrap_or_default();
            let most = vertices as i64 - 1;
            at(SectionKind::MorphVertices).within(Field::Vertex, vertex.into(), 0, most)?;
            let most = self.rest.len() as i64 - 1;
            at(SectionKind::MorphNumbers).within(Field::MorphTarget, number.into(), 0, most)?;
            let place = u64::from(vertex) << 32 | u64::from(number);
            let follows = place >= next;
            at(SectionKind::Displacements).ensure(follows, Reason::DisplacementOrder)?;
            next = place.saturating_add(1);
        }
        Ok(())
    }

    /// Returns the weights at rest of all morph targets of the scene, with 24 fraction bits.
    pub fn weights_at_rest(&self) -> &'a [i32] {
        self.rest
    }

    /// Returns true if no vertex moves.
    pub fn is_empty(&self) -> bool {
        self.displacements.len() == 0
    }

    /// Returns true if morph targets change normals, so that a deformation needs room for these.
    pub fn changes_normals(&self) -> bool {
        !self.normals.is_empty()
    }

    /// Moves vertices and normals, which are at rest, to their places.
    fn place<V: Vertex>(
        &self,
        room: &fit::Room<V>,
        (vertices, normals): (&mut [V], &mut [[i16; 2]]),
        weights: &[i32],
    ) -> Result<(), DeformError> {
        let mut index = 0;
        while let Some(vertex) = self.vertices.get(index) {
            let (mut sum, mut turn) = ([0_i64; 3], [0_i64; 3]);
            // Those of one vertex follow each other.
            while self.vertices.get(index) == Some(vertex) {
                let number = self.numbers.get(index).unwrap_or_default() as usize;
                if let (Some(&weight), Some(&rest)) = (weights.get(number), self.rest.get(number)) {
                    let weight = i64::from(weight).wrapping_sub(rest.into());
                    let steps = self.displacements.get(index).unwrap_or_default();
                    add(&mut sum, steps, weight);
                    if let Some(change) = self.normals.get(index) {
                        add(&mut turn, change.map(i32::from), weight);
                    }
                }
                index = index.wrapping_add(1);
            }
            let vertex = vertex as usize;
            let Some(place) = vertices.get_mut(vertex) else {
                return Err(DeformError::NoVertex { vertex });
            };
            let mut axis = 0;
            let steps = sum.map(|sum| {
                let way = sum.saturating_add(1 << (WEIGHT_BITS - 1)) >> WEIGHT_BITS;
                let moved = way.wrapping_add(place.steps(axis).into());
                axis = axis.wrapping_add(1);
                moved.clamp(i32::MIN.into(), i32::MAX.into()) as i32
            });
            if !room.holds(steps) {
                return Err(DeformError::OutsideRoom { vertex });
            }
            *place = V::from_steps(steps);
            if let Some(normal) = normals.get_mut(vertex).filter(|_| turn != [0; 3]) {
                *normal = smooth::changed(*normal, turn);
            }
        }
        Ok(())
    }
}

/// Adds steps, at most 2^28 each, times a difference of weights, at most 2^31.
fn add(sum: &mut [i64; 3], steps: [i32; 3], weight: i64) {
    for (sum, step) in sum.iter_mut().zip(steps) {
        *sum = sum.saturating_add(i64::from(step).wrapping_mul(weight));
    }
}

impl<V: Vertex, A: Memory<V>, B: Memory<Pair>, C: Memory<[i16; 2]>> DeformationIn<V, A, B, C> {
    /// Moves all vertices to where morph targets have them with these weights, and [refits](Self::refit) the boxes.
    ///
    /// Weights are those of all morph targets of the scene, with 24 fraction bits: 2^24 is 1.
    /// [`Tracks::weights_at`](crate::Tracks::weights_at) has them at a time. `scene` is the scene, or the part, as it
    /// was loaded. Normals of vertices change with them, where the blob says how, and the mesh is shaded by them. With
    /// the weights at rest, all have the blob's own bits.
    ///
    /// Costs on a Cortex-M4F about 500 instructions per triangle of a mesh with two morph targets that change normals,
    /// 190 of them for the boxes.
    ///
    /// # Errors
    /// If the scene or the morph targets are of another blob, or there are more or fewer weights than morph targets.
    /// Also if a weight is beyond ±64, or there is no room for the normals. Then the mesh keeps its pose. Also if the
    /// new pose is one that [`refit`](Self::refit) rejects. Then [`Scene::with_deformation`] rejects the mesh. If a
    /// vertex would lie outside the scene's box, all vertices are at rest afterwards.
    pub fn morph(
        &mut self,
        scene: &Scene<'_>,
        morph: &MorphTargets<'_>,
        weights: &[i32],
    ) -> Result<(), DeformError> {
        self.check_scene(scene)?;
        if morph.blob != self.blob {
            return Err(DeformError::OtherScene);
        }
        let (found, expected) = (weights.len(), morph.rest.len());
        if found != expected {
            return Err(DeformError::Weights { found, expected });
        }
        let range = -LARGEST_WEIGHT..=LARGEST_WEIGHT;
        if let Some(number) = weights.iter().position(|weight| !range.contains(weight)) {
            return Err(DeformError::Weight { number });
        }
        let rest: &[V] = scene.stored_vertices().ok_or(DeformError::Storage)?;
        let normals = match morph.normals {
            [] => &[],
            _ => scene.geometry.shapes.normals(),
        };
        let (found, most) = (normals.len(), self.normals.room());
        if found > most {
            return Err(DeformError::Normals { found, most });
        }
        (self.refitted, self.keeps_normals) = (false, false);
        // There is room: the vertices are as many, and the normals were counted.
        if !self.vertices.copy_from(rest) || !self.normals.copy_from(normals) {
            return Err(DeformError::OtherScene);
        }
        let room = fit::Room::of(scene.bounds());
        let placed = morph.place(&room, (&mut self.vertices, &mut self.normals), weights);
        if placed.is_err() {
            // Some vertices have moved and others have not. A later `refit` would accept such a pose.
            self.vertices.copy_from(rest);
        }
        placed?;
        self.refit(scene)?;
        self.keeps_normals = true;
        Ok(())
    }
}
