//! What morph targets do to meshes.

use glam::DVec3;
use gridel_core::format::limits;

/// The greatest magnitude of the weight of a morph target.
pub const LARGEST_WEIGHT: f64 = (limits::LARGEST_WEIGHT >> 24) as f64;

/// How a morph target displaces the vertices of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Displacements {
    /// Index into [`Scene::morph_targets`](crate::scene::Scene::morph_targets).
    pub target: usize,
    /// For each vertex, by how much it is displaced with a weight of 1. The mesh has its vertices where they are with the
    /// target's weight at rest.
    pub vectors: Vec<DVec3>,
}

/// How a morph target changes normals.
#[derive(Clone, Debug, PartialEq)]
pub struct NormalChanges {
    /// Index into [`Scene::morph_targets`](crate::scene::Scene::morph_targets).
    pub target: usize,
    /// For each normal, what a weight that is greater by 1 adds to it.
    pub vectors: Vec<DVec3>,
}
