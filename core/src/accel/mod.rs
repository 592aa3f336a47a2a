//! Acceleration structures: which primitives a ray might meet.
//!
//! The answer to a query is defined without them: the least `t` over the exact test of every
//! primitive, a tie going to the primitive that comes first in the scene file. A structure only
//! leaves primitives out that cannot be met, so it cannot change a bit of the answer. What makes
//! this certain, and not only likely: a primitive's `t` lies in the culling interval of the
//! primitive's own box, or is clamped to it, [`Scene::from_bytes`](crate::Scene::from_bytes) proves
//! that this box lies in the leaf's and every box in its parent's, and culling is monotone (see
//! [`cull`]). Whatever was rounded on the way, a primitive that is met lies in boxes that are met.

pub mod candidates;
pub mod cells;
pub mod cull;
pub mod hierarchy;
#[cfg(any(
    target_arch = "x86_64",
    target_arch = "aarch64",
    all(target_arch = "wasm32", target_feature = "simd128")
))]
mod lanes;
pub mod list;
mod registry;
#[cfg(any(
    feature = "wide",
    target_arch = "x86_64",
    target_arch = "aarch64",
    all(target_arch = "wasm32", target_feature = "simd128")
))]
mod single;
#[cfg(feature = "wide")]
pub mod wide;

#[cfg(feature = "apex")]
pub use candidates::apex::Apex;
#[cfg(feature = "cylinder-cube")]
pub use candidates::cylinder_cube::CylinderCube;
#[cfg(feature = "cylinder-cube-entry")]
pub use candidates::cylinder_cube_entry::CylinderCubeEntry;
#[cfg(feature = "cylinder-cube-tight")]
pub use candidates::cylinder_cube_tight::CylinderCubeTight;
#[cfg(feature = "ray-classes")]
pub use candidates::ray_classes::RayClasses;
#[cfg(feature = "grid")]
pub use cells::grid::Grid;
#[cfg(feature = "octree")]
pub use cells::octree::Octree;
#[cfg(feature = "bvh")]
pub use hierarchy::bvh::Bvh;
#[cfg(feature = "dual-split")]
pub use hierarchy::dual_split::DualSplit;
#[cfg(feature = "flagged")]
pub use hierarchy::flagged::Flagged;
#[cfg(feature = "flagged-slabs")]
pub use hierarchy::flagged_slabs::FlaggedSlabs;
#[cfg(any(
    feature = "bvh",
    feature = "flagged",
    feature = "slabs",
    feature = "spheres"
))]
pub use hierarchy::link::Link;
#[cfg(feature = "slabs")]
pub use hierarchy::slabs::Slabs;
#[cfg(feature = "spheres")]
pub use hierarchy::spheres::Spheres;
pub use list::List;
#[cfg(feature = "all-structures")]
pub use registry::Chosen;
pub(crate) use registry::{Held, Records};
pub use registry::{Structure, StructureVisitor};
#[cfg(feature = "wide")]
pub use wide::Wide;

use crate::SMALL;
use crate::geometry::Kind;
use crate::number::Number;
use crate::observe::count::Count;
use crate::ray::Ray;
use crate::scene::Scene;
use core::ops::Range;
use cull::Culling;
use heapless::{Vec, VecView};

/// A structure, as a type: the code of those that are not named is not in the program.
pub trait Accel: Send + Sync {
    /// Its name; the list's of one that has none.
    const STRUCTURE: Structure;
    /// The form in which its rays cull.
    type Cull<N: Number>: Culling<N>;
    /// Whether its leaves can be [clusters](crate::format::cluster): code for these is only compiled
    /// where they are.
    const HAS_CLUSTERS: bool = false;
    /// Whether one copy of a query's code serves the closest hit and any hit: less code, and a branch
    /// per leaf.
    const ONE_COPY: bool = SMALL;

    /// What a scene must hold to be walked.
    fn needs(_: &Scene<'_>) -> Structure {
        Self::STRUCTURE
    }

    /// Calls `leaf` for every leaf whose box the ray can meet, nearer ones first where the
    /// structure knows. `leaf` returns the t beyond which nothing counts any more, or `None` to
    /// end the walk.
    fn walk<N: Number, C: Count>(
        scene: &Scene<'_>,
        ray: &Ray<N>,
        cull: &Self::Cull<N>,
        stack: &mut StackView,
        count: &mut C,
        leaf: impl FnMut(Leaf, &mut C) -> Option<N>,
    );

    /// The same for any hit: in any order, up to the first leaf of which `hits` is true.
    #[inline(always)]
    fn walk_any<N: Number, C: Count>(
        scene: &Scene<'_>,
        ray: &Ray<N>,
        cull: &Self::Cull<N>,
        stack: &mut StackView,
        count: &mut C,
        mut hits: impl FnMut(Leaf, &mut C) -> bool,
    ) {
        let tmax = ray.tmax;
        Self::walk(scene, ray, cull, stack, count, |leaf, count| {
            (!hits(leaf, count)).then_some(tmax)
        });
    }
}

/// A child that waits for its turn: 12 bytes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Entry {
    node: u32,
    near: i32,
    far: i32,
}

/// The traversal stack, owned by the caller: 12 bytes an entry and one word.
///
/// `DEPTH` must be at least the blob's [`stack_depth`](crate::Scene::stack_depth), which
/// [`Scene::from_bytes`](crate::Scene::from_bytes) proves. A smaller stack is never overrun:
/// queries on it have no hit, and
/// [`Renderer::check_workspace`](crate::Renderer::check_workspace) refuses it.
#[derive(Debug, Default)]
pub struct Stack<const DEPTH: usize>(Vec<Entry, DEPTH>);

/// A [`Stack`] whose depth is not part of its type.
pub type StackView = VecView<Entry>;

impl<const DEPTH: usize> Stack<DEPTH> {
    /// An empty stack.
    pub const fn new() -> Self {
        Self(Vec::new())
    }

    /// The stack as queries take it.
    pub fn as_view(&mut self) -> &mut StackView {
        &mut self.0
    }
}

/// The largest stack depth that a blob may need.
pub const MAX_STACK_DEPTH: usize = 160;

/// Most levels of a hierarchy of pairs, and the largest stack depth that one needs.
pub const MAX_LEVELS: usize = 48;

/// A range of slots, all of one kind of primitive: one word.
///
/// Bits 0 to 23 are the first slot of that kind, 24 to 28 the number of slots (1 to 31), 29 to 31
/// the kind. No slots stand for a [cluster](crate::format::cluster) of the kind, by its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Leaf {
    /// The kind of its primitives.
    pub kind: Kind,
    /// Its first slot among those of the kind.
    pub first: u32,
    /// Number of slots.
    pub count: u32,
}

impl Leaf {
    /// Most primitives that a leaf can hold.
    pub const MAX_COUNT: u32 = 31;
    /// Number of slots of one kind that leaves can tell apart.
    pub const SLOTS: u32 = 1 << 24;

    /// Its slots among those of the kind.
    #[inline(always)]
    pub(crate) const fn slots(self) -> Range<usize> {
        // Below 2^24 and 31.
        self.first as usize..self.first.wrapping_add(self.count) as usize
    }

    /// The leaf as a word.
    pub const fn to_word(self) -> u32 {
        self.first | self.count << 24 | (self.kind as u32) << 29
    }

    /// The leaf of a word; `None` for a kind that does not exist.
    #[inline(always)]
    pub fn from_word(word: u32) -> Option<Self> {
        let kind = Kind::from_number(word >> 29)?;
        Some(Self {
            kind,
            first: word & 0xff_ffff,
            count: word >> 24 & 31,
        })
    }
}
