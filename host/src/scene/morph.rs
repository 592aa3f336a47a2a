//! Changes of meshes by morph targets.

use glam::DVec3;
use gridel_core::format::limits;

/// The greatest magnitude of the weight of a morph target.
pub const LARGEST_WEIGHT: f64 = (limits::LARGEST_WEIGHT >> 24) as f64;

/// The displacements of a mesh's vertices by a morph target.
#[derive(Clone, Debug, PartialEq)]
pub struct Displacements {
    /// Index into [`Scene::morph_targets`](crate::scene::Scene::morph_targets).
    pub target: usize,
    /// For each vertex, its displacement with a weight of 1. The mesh has its vertices where they are with the
    /// target's weight at rest.
    pub vectors: Vec<DVec3>,
}

/// The changes of normals by a morph target.
#[derive(Clone, Debug, PartialEq)]
pub struct NormalChanges {
    /// Index into [`Scene::morph_targets`](crate::scene::Scene::morph_targets).
    pub target: usize,
    /// For each normal, the vector that a weight that is greater by 1 adds to it.
    pub vectors: Vec<DVec3>,
}
