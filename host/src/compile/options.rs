//! Options of the compiler.

use super::hierarchy::builder::Builder;
use super::wide::Quality;
use gridel_core::Structure;
use gridel_core::format::Leaf;

/// Most primitives of a leaf.
pub const LARGEST_LEAF: usize = Leaf::MAX_COUNT as usize;

/// Options of the compiler.
///
/// ```
/// use gridel_core::Structure;
/// use gridel_host::compile::Options;
///
/// let options = Options {
///     structures: vec![Structure::Flagged],
///     lattice_bits: 16,
///     names: true,
///     ..Options::default()
/// };
/// assert_eq!(options.max_bytes, None);
/// ```
#[derive(Clone, Debug)]
pub struct Options {
    /// Acceleration structures; the list is always there.
    pub structures: Vec<Structure>,
    /// Bits that coordinates are snapped to: see [`LATTICE_BITS`](crate::compile::LATTICE_BITS).
    pub lattice_bits: u8,
    /// The scene units by which vertices of meshes can move along each axis, for a
    /// [`Deformation`](gridel_core::Deformation). The box of a scene, and of each part, is wider by as much. Only the
    /// structure [`Bvh`](gridel_core::Bvh) can be refitted.
    pub room: f64,
    /// True if a closed mesh may lie in one plane once it is snapped. It then has no inside, and rays from within miss
    /// it. If false, such a mesh is an error.
    pub flat_meshes: bool,
    /// Primitives that make a leaf of a hierarchy whatever rays pay for it, at most
    /// [`LARGEST_LEAF`]: fewer nodes and more tests. With 0 the costs alone decide.
    pub leaf_size: usize,
    /// Time that the builder of the eight-wide hierarchy takes.
    pub quality: Quality,
    /// Builder of the hierarchy that all structures but the list, `wide`, the grid and the octree share.
    pub builder: Builder,
    /// Directions of slabs: 3, 7 or 13.
    pub slab_directions: usize,
    /// Divisions of the grid along each axis, 1 to 1024; four cells per primitive without.
    pub grid: Option<[u32; 3]>,
    /// Reject a blob that would be larger. Names that make it larger are left out.
    pub max_bytes: Option<u64>,
    /// Most bytes of all textures' texels, which are stored more coarsely to fit. Without it only rounding is lost.
    pub texture_bytes: Option<u64>,
    /// True if the blob has the names of objects, materials and lights.
    pub names: bool,
    /// Gridels along a side of a cylinder cube's faces, 1 to 64; otherwise as many as the budget
    /// holds.
    pub gridels: Option<u32>,
    /// Most bytes of each table of candidate lists, and in the apexes' of each point or direction;
    /// otherwise what [`usual_budget`](crate::compile::usual_budget) says. A scene and its parts share them by their
    /// numbers of primitives.
    pub budget: Option<u64>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            structures: vec![Structure::DualSplit],
            lattice_bits: 24,
            room: 0.0,
            flat_meshes: false,
            leaf_size: 0,
            quality: Quality::default(),
            builder: Builder::default(),
            slab_directions: 7,
            grid: None,
            max_bytes: None,
            texture_bytes: None,
            names: false,
            gridels: None,
            budget: None,
        }
    }
}

/// Called now and then, from any thread. The arguments are the structure, the number of finished cells of its table,
/// and the number of all its cells. A table is tried in several sizes where none is given.
pub type OnProgress<'t> = &'t (dyn Fn(Structure, u64, u64) + Sync);
