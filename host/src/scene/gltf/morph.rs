//! Morph targets: differences of positions and normals, which a mesh adds by its weights.
//!
//! The weights are those of the node, or else of the mesh. An animation does not change them.

use super::Importer;
use super::place::Weighted;
use crate::scene::SceneError;
use glam::DVec3;
use gltf::Accessor;
use gltf::mesh::MorphTarget;

/// What a morph target changes.
pub(super) type Changed<'t> = fn(&MorphTarget<'t>) -> Option<Accessor<'t>>;

impl Importer<'_> {
    /// Returns positions or normals with the differences of a part's morph targets, times their weights.
    pub(super) fn morph<'p>(
        &self,
        place: &str,
        weighted: Weighted<'p>,
        vectors: &[[f32; 3]],
        changed: Changed<'p>,
    ) -> Result<Vec<DVec3>, SceneError> {
        let precise = |vector: [f32; 3]| DVec3::from_array(vector.map(f64::from));
        let mut morphed: Vec<_> = vectors.iter().copied().map(precise).collect();
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
            for (vector, difference) in morphed.iter_mut().zip(differences) {
                *vector += f64::from(weight) * precise(difference);
            }
        }
        Ok(morphed)
    }
}
