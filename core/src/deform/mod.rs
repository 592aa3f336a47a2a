//! Deforming meshes: vertices and boxes in RAM, everything else in the blob.
//!
//! A [`Deformation`] copies the data that change when a mesh moves: the vertices, and the pairs of the structure
//! [`Bvh`](crate::Bvh). The program moves vertices, and [`refit`](Deformation::refit) computes the boxes again.
//! [`Scene::with_deformation`] returns a scene whose queries read RAM in place of the blob. Hits are those of a blob
//! that is compiled with the moved vertices, bit for bit, because an answer is defined without the hierarchy.
//!
//! Rules of a pose, which `refit` proves:
//!
//! - Vertices lie in the scene's box, the *room*. The compiler widens it by `--room`.
//! - No triangle is a *needle*: three different places on a line. A ray never hits a triangle without an area. Where
//!   two corners coincide, the neighbors share the other edge, and the mesh stays closed. The corner in the middle of a
//!   needle is rounded laterally on its own, so a ray could slip between the needle's neighbors.
//!
//! No other data of a blob depend on vertices but the lights of a mesh that glows, which stay where they are: normals,
//! hit bounds and offsets come from the corners when a ray hits.
//! Other structures would not fit the moved mesh, so blobs that hold any are rejected. Instances keep their boxes,
//! because those hold the whole room of a part.

mod error;
mod fit;
mod morph;

pub use error::DeformError;
pub use morph::MorphTargets;

use crate::format::Structure;
use crate::format::record::Pair;
use crate::format::width::Vertex;
use crate::scene::{Position, Scene};
use core::marker::PhantomData;
use core::ops::DerefMut;
use heapless::Vec;

/// The vertices and the boxes of a deforming mesh, in RAM.
///
/// `V` is [`Vertex16`](crate::format::record::Vertex16) for a blob of at most 16 lattice bits, and
/// [`Vertex24`](crate::format::record::Vertex24) for others. [`Requirements`](crate::Requirements) states `VERTICES`
/// and `PAIRS` of a blob, so the size is known at compile time. It is 6 or 12 bytes per vertex, 32 bytes per pair, and
/// a few words. Where [morph targets](MorphTargets) change normals, `NORMALS` is the number of normals, 4 bytes each.
///
/// ```
/// use gridel_core::format::record::Vertex24;
/// use gridel_core::{Deformation, Requirements, Scene, Stack};
///
/// # static BLOB: &[u8] =
/// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/bvh.gridel"));
/// const NEEDS: Requirements = match Requirements::of(BLOB) {
///     Ok(needs) => needs,
///     Err(_) => panic!("the blob was damaged"),
/// };
/// type Mesh = Deformation<Vertex24, { NEEDS.vertices }, { NEEDS.pairs }>;
///
/// let scene = Scene::from_bytes(BLOB)?;
/// let mut mesh = Mesh::of(&scene)?;
/// // A unit to the right, in 1/256 unit.
/// for vertex in mesh.vertices_mut() {
///     vertex.0[0] += 256;
/// }
/// mesh.refit(&scene)?;
/// let moved = scene.with_deformation(&mesh)?;
/// let corner = |scene: &Scene<'_>| scene.triangle(0).map(|[[x, _, _], _, _]| x);
/// assert_eq!(corner(&moved), corner(&scene).map(|x| x + 256));
/// // Queries and pictures of `moved` see the mesh there.
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub type Deformation<V, const VERTICES: usize, const PAIRS: usize, const NORMALS: usize = 0> =
    DeformationIn<V, Vec<V, VERTICES>, Vec<Pair, PAIRS>, Vec<[i16; 2], NORMALS>>;

/// A [`Deformation`] in memory of any sort. On hosts it grows with the scene.
#[derive(Clone, Debug)]
pub struct DeformationIn<V, A, B, C> {
    vertices: A,
    pairs: B,
    /// Empty unless morph targets change them.
    normals: C,
    /// The checksum of the blob that it was made of.
    blob: u32,
    /// True if the boxes are those of the vertices.
    refitted: bool,
    /// True if the mesh is shaded by normals of vertices.
    keeps_normals: bool,
    vertex: PhantomData<V>,
}

impl<V, A: Default, B: Default, C: Default> Default for DeformationIn<V, A, B, C> {
    fn default() -> Self {
        Self {
            vertices: A::default(),
            pairs: B::default(),
            normals: C::default(),
            blob: 0,
            refitted: false,
            keeps_normals: false,
            vertex: PhantomData,
        }
    }
}

/// Memory for the records of a deformation.
pub trait Memory<T>: DerefMut<Target = [T]> {
    /// Replaces all records by copies of these. Returns true if there is enough capacity.
    fn copy_from(&mut self, records: &[T]) -> bool;

    /// Number of records that the memory can hold.
    fn room(&self) -> usize;
}

impl<T: Copy, const MOST: usize> Memory<T> for Vec<T, MOST> {
    fn copy_from(&mut self, records: &[T]) -> bool {
        self.clear();
        self.extend_from_slice(records).is_ok()
    }

    fn room(&self) -> usize {
        MOST
    }
}

impl<V, const VERTICES: usize, const PAIRS: usize, const NORMALS: usize>
    Deformation<V, VERTICES, PAIRS, NORMALS>
{
    /// Returns a deformation without a scene, for a `static`: [`reset`](DeformationIn::reset) makes it the deformation
    /// of a scene.
    pub const fn new() -> Self {
        Self {
            vertices: Vec::new(),
            pairs: Vec::new(),
            normals: Vec::new(),
            blob: 0,
            refitted: false,
            keeps_normals: false,
            vertex: PhantomData,
        }
    }

    /// Returns a deformation of a scene, at rest.
    ///
    /// # Errors
    /// The errors of [`reset`](DeformationIn::reset).
    pub fn of(scene: &Scene<'_>) -> Result<Self, DeformError>
    where
        V: Vertex,
    {
        let mut deformation = Self::new();
        deformation.reset(scene)?;
        Ok(deformation)
    }
}

/// The structures that a deforming scene can hold.
pub const STRUCTURES: [Structure; 2] = [Structure::List, Structure::Bvh];

impl<V: Vertex, A: Memory<V>, B: Memory<Pair>, C: Memory<[i16; 2]>> DeformationIn<V, A, B, C> {
    /// Copies vertices and boxes of a scene, or of a part, and replaces the present ones.
    ///
    /// # Errors
    /// If the blob holds other structures than [`STRUCTURES`], its vertices have another type, or the capacity is too
    /// small.
    pub fn reset(&mut self, scene: &Scene<'_>) -> Result<(), DeformError> {
        self.refitted = false;
        let held = STRUCTURES.iter();
        let can = held.fold(0, |bits, structure| bits | structure.bit());
        if scene.header().structures & !can != 0 {
            return Err(DeformError::Structures);
        }
        let vertices: &[V] = scene.stored_vertices().ok_or(DeformError::Storage)?;
        let pairs = scene.structures.pairs();
        if !self.vertices.copy_from(vertices) {
            return Err(DeformError::Vertices {
                found: vertices.len(),
                most: self.vertices.room(),
            });
        }
        if !self.pairs.copy_from(pairs) {
            return Err(DeformError::Pairs {
                found: pairs.len(),
                most: self.pairs.room(),
            });
        }
        self.blob = scene.header().checksum;
        self.keeps_normals = false;
        self.refitted = true;
        Ok(())
    }

    /// Returns the vertices.
    pub fn vertices(&self) -> &[V] {
        &self.vertices
    }

    /// Returns the vertices for writing. Coordinates of [`Vertex16`](crate::format::record::Vertex16) are units, and
    /// those of [`Vertex24`](crate::format::record::Vertex24) 1/256 unit. The order is the blob's own;
    /// [`Scene::stored_vertices`] returns their places at rest. Call [`refit`](Self::refit) afterwards.
    pub fn vertices_mut(&mut self) -> &mut [V] {
        (self.refitted, self.keeps_normals) = (false, false);
        &mut self.vertices
    }

    /// Returns the normals that morph targets have changed, as the blob [stores](crate::geometry::smooth) them; none
    /// where they change none, and none of a pose that they did not make.
    pub fn normals(&self) -> &[[i16; 2]] {
        if self.keeps_normals {
            &self.normals
        } else {
            &[]
        }
    }

    /// Returns the pairs of the hierarchy, with the boxes of the pose that was refitted last.
    pub fn pairs(&self) -> &[Pair] {
        &self.pairs
    }

    /// Moves a vertex to the place of the lattice that is nearest to a place in scene coordinates. Call
    /// [`refit`](Self::refit) afterwards.
    ///
    /// # Errors
    /// If there is no such vertex, or the place lies outside the scene's box. Then the vertex stays.
    pub fn place(
        &mut self,
        scene: &Scene<'_>,
        vertex: usize,
        position: Position,
    ) -> Result<(), DeformError> {
        // Of units with 13 fraction bits.
        let drop = 13_u32.saturating_sub(V::STEP_BITS);
        let half = (1_i64 << drop) >> 1;
        let place = scene.on_lattice(position);
        // At most 2^51.
        let steps = place.map(|x| x.wrapping_add(half).wrapping_shr(drop));
        let steps = steps.map(|x| x.clamp(i32::MIN.into(), i32::MAX.into()) as i32);
        if !fit::Room::<V>::of(scene.bounds()).holds(steps) {
            return Err(DeformError::OutsideRoom { vertex });
        }
        let Some(held) = self.vertices.get_mut(vertex) else {
            return Err(DeformError::NoVertex { vertex });
        };
        *held = V::from_steps(steps);
        (self.refitted, self.keeps_normals) = (false, false);
        Ok(())
    }

    /// Proves that the pose is valid, and computes the boxes again: one pass from the last pair to the first, without
    /// a stack.
    ///
    /// Costs on a Cortex-M4F about 190 instructions per triangle, and is linear in vertices, triangles and pairs.
    ///
    /// # Errors
    /// If the deformation was made of another scene, or a vertex lies outside the scene's box. Also if the corners of a
    /// triangle are three places on a line. Then the vertices keep their new places, and [`Scene::with_deformation`]
    /// rejects them.
    pub fn refit(&mut self, scene: &Scene<'_>) -> Result<(), DeformError> {
        self.refitted = false;
        self.check_scene(scene)?;
        fit::check_room(scene, &self.vertices)?;
        fit::refit(scene, &self.vertices, &mut self.pairs)?;
        self.refitted = true;
        Ok(())
    }

    /// Proves that this was made of a scene.
    fn check_scene(&self, scene: &Scene<'_>) -> Result<(), DeformError> {
        let same = scene.header().checksum == self.blob
            && scene.vertices() == self.vertices.len()
            && scene.structures.pairs().len() == self.pairs.len();
        if same {
            Ok(())
        } else {
            Err(DeformError::OtherScene)
        }
    }
}

impl<'a> Scene<'a> {
    /// Returns the vertices in the blob; `None` if they have another type.
    pub fn stored_vertices<V: Vertex>(&self) -> Option<&'a [V]> {
        self.geometry.shapes.vertices.stored()
    }

    /// Number of pairs of the structure [`Bvh`](crate::Bvh).
    pub fn pairs(&self) -> usize {
        self.structures.pairs().len()
    }

    /// Returns the scene with the vertices and boxes of a deformation in place of the blob's own. Costs nothing per
    /// ray.
    ///
    /// Triangles are shaded flat, because the normals of a blob are those at rest. After
    /// [`morph`](DeformationIn::morph) they are shaded by the normals that it makes.
    ///
    /// A part is deformed likewise: pass it to [`Parts::with_part`](crate::Parts::with_part).
    ///
    /// # Errors
    /// If the deformation was made of another scene, or vertices moved since it was refitted.
    pub fn with_deformation<V: Vertex, A, B, C>(
        &self,
        deformation: &'a DeformationIn<V, A, B, C>,
    ) -> Result<Self, DeformError>
    where
        A: Memory<V>,
        B: Memory<Pair>,
        C: Memory<[i16; 2]>,
    {
        deformation.check_scene(self)?;
        if !deformation.refitted {
            return Err(DeformError::NotRefitted);
        }
        let mut scene = *self;
        scene
            .geometry
            .shapes
            .vertices
            .replace(&deformation.vertices);
        if !deformation.keeps_normals {
            scene.geometry.shapes.drop_normals();
        } else if !deformation.normals.is_empty() {
            scene.geometry.shapes.replace_normals(&deformation.normals);
        }
        scene.structures.replace_pairs(&deformation.pairs);
        Ok(scene)
    }
}
