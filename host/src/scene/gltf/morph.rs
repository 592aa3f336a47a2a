//! Morph targets: differences of positions and normals, which a mesh adds by its weights.
//!
//! The weights are those of the node, or else of the mesh. An animation does not change them.

use super::Importer;
use crate::scene::SceneError;
use glam::DVec3;
use gltf::mesh::MorphTarget;
use gltf::{Accessor, Mesh, Node, Primitive};

/// A part of a mesh, and the weights of its morph targets.
#[derive(Clone, Copy)]
pub(super) struct Weighted<'p> {
    pub(super) part: &'p Primitive<'p>,
    pub(super) weights: &'p [f32],
}

/// What a morph target changes.
pub(super) type Changed<'t> = fn(&MorphTarget<'t>) -> Option<Accessor<'t>>;

/// The weights of a node's mesh.
pub(super) fn weights<'n>(node: &Node<'n>, mesh: &Mesh<'n>) -> &'n [f32] {
    let own = node.weights().or(mesh.weights());
    own.unwrap_or_default()
}

impl Importer<'_> {
    /// Adds the differences of a part's morph targets to positions or normals, times their weights.
    pub(super) fn morph<'p>(
        &self,
        place: &str,
        weighted: Weighted<'p>,
        vectors: &mut [DVec3],
        changed: Changed<'p>,
    ) -> Result<(), SceneError> {
        let targets = weighted.part.morph_targets().zip(weighted.weights);
        for (number, (target, &weight)) in targets.enumerate() {
            let Some(accessor) = changed(&target).filter(|_| weight != 0.0) else {
                continue;
            };
            let differences = self
                .buffers
                .vectors(&accessor, "differences of a morph target")?;
            if differences.len() != vectors.len() {
                return Err(self.error(
                    format!(
                        "{place} has {} vertices, and its morph target {number} {}",
                        vectors.len(),
                        differences.len()
                    ),
                    "export the file again",
                ));
            }
            for (vector, difference) in vectors.iter_mut().zip(differences) {
                *vector += f64::from(weight) * DVec3::from_array(difference.map(f64::from));
            }
        }
        Ok(())
    }
}
