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
