//! Morph targets: differences of positions and normals, which a mesh adds by its weights.
//!
//! The weights are those of the node, or else of the mesh. Where the animation moves them, positions and normals keep
//! their targets; normals without one turn with the faces around.

use super::Importer;
use super::buffers::MOST;
use super::place::Weighted;
use crate::scene::normals::cofactors;
use crate::scene::{
    Displacements, MorphTarget, NormalChanges, Normals, SceneError, Track, TrackTarget,
};
use glam::{DMat3, DMat4, DVec3};
use gltf::mesh::MorphTarget as Target;
use gltf::{Accessor, Mesh, Node, Semantic};

/// A function that returns what a morph target changes.
pub(super) type Changed<'t> = fn(&Target<'t>) -> Option<Accessor<'t>>;

impl Importer<'_> {
    /// Returns positions or normals with the differences of a part's morph targets, times their weights.
    pub(super) fn morph<'p>(
        &self,
        place: &str,
        weighted: Weighted<'p>,
        vectors: &[[f32; 3]],
        changed: Changed<'p>,
    ) -> Result<Vec<DVec3>, SceneError> {
        let mut morphed: Vec<_> = vectors.iter().map(precise).collect();
        let targets = weighted.part.morph_targets().zip(weighted.weights);
        for (number, (target, &weight)) in targets.enumerate() {
            let Some(accessor) = changed(&target).filter(|_| weight != 0.0) else {
                continue;
            };
            let differences = self.differences(place, number, &accessor, vectors.len())?;
            for (vector, difference) in morphed.iter_mut().zip(&differences) {
                *vector += f64::from(weight) * precise(difference);
            }
        }
        Ok(morphed)
    }

    /// Reads the differences of a morph target, one for each vertex.
    fn differences(
        &self,
        place: &str,
        number: usize,
        accessor: &Accessor<'_>,
        vertices: usize,
    ) -> Result<Vec<[f32; 3]>, SceneError> {
        let differences = self
            .buffers
            .vectors(accessor, "differences of a morph target")?;
        if differences.len() != vertices {
            return Err(self.error(
                format!(
                    "{place} has {vertices} vertices, and its morph target {number} {}",
                    differences.len()
                ),
                "export the file again",
            ));
        }
        Ok(differences)
    }

    /// Makes morph targets and their tracks, if the animation moves the weights of a node's mesh. Returns the number of
    /// the first.
    pub(super) fn moving_targets(&mut self, node: &Node<'_>, mesh: &Mesh<'_>) -> Option<usize> {
        let curves = self.motion.weights(node.index())?;
        let first = self.scene.morph_targets.len();
        let name = node.name().or(mesh.name());
        let name = name.map_or_else(|| format!("node {}", node.index()), str::to_owned);
        let at_rest = super::weights(node, mesh);
        for (number, curve) in curves.iter().enumerate() {
            let weight = at_rest.get(number).copied().unwrap_or(0.0);
            self.scene.morph_targets.push(MorphTarget {
                name: format!("{name}/{number}"),
                weight: weight.into(),
                // That of the track.
                range: [weight.into(); 2],
                place: self.place.clone(),
            });
            self.scene.tracks.push(Track {
                target: TrackTarget::MorphWeight,
                index: first + number,
                interpolation: curve.interpolation,
                keys: curve.keys.clone(),
                place: self.place.clone(),
            });
        }
        Some(first)
    }

    /// The displacements of a mesh in this place by its morph targets, if they move.
    pub(super) fn displacements(
        &mut self,
        place: &str,
        weighted: Weighted<'_>,
        world: &DMat4,
        vertices: usize,
    ) -> Result<Vec<Displacements>, SceneError> {
        let Some(first) = weighted.moving else {
            return Ok(Vec::new());
        };
        let mut all = Vec::new();
        for (number, target) in weighted.part.morph_targets().enumerate() {
            let Some(accessor) = target.positions() else {
                continue;
            };
            self.displaced += vertices;
            if self.displaced > MOST {
                return Err(self.error(
                    format!("up to {place}, the morph targets that move displace more than {MOST} vertices"),
                    "animate fewer morph targets, or coarser meshes",
                ));
            }
            let differences = self.differences(place, number, &accessor, vertices)?;
            let vectors: Vec<_> = differences
                .iter()
                .map(|difference| world.transform_vector3(precise(difference)))
                .collect();
            if let Some(vertex) = vectors.iter().position(|it| !it.is_finite()) {
                return Err(self.error(
                    format!(
                        "the displacement of vertex {vertex} (from 0) of {place} by its morph target {number} is not finite"
                    ),
                    "export the file again, or repair the vertex",
                ));
            }
            all.push(Displacements {
                target: first + number,
                vectors,
            });
        }
        Ok(all)
    }

    /// Adds to the normals of a mesh what its morph targets say about them, if they move.
    pub(super) fn change_normals(
        &self,
        place: &str,
        weighted: Weighted<'_>,
        world: &DMat4,
        triangles: &[[u32; 3]],
        normals: &mut Normals,
    ) -> Result<(), SceneError> {
        let given = weighted.part.get(&Semantic::Normals);
        let (Some(first), Some(given)) = (weighted.moving, given.filter(|_| !normals.is_flat()))
        else {
            return Ok(());
        };
        let given = self.buffers.vectors(&given, "normals")?;
        let given = self.morph(place, weighted, &given, Target::normals)?;
        let (turn, _) = cofactors(DMat3::from_mat4(*world));
        for (number, target) in weighted.part.morph_targets().enumerate() {
            let Some(accessor) = target.normals() else {
                continue;
            };
            let differences = self.differences(place, number, &accessor, given.len())?;
            let mut vectors = vec![DVec3::ZERO; normals.vectors.len()];
            for (corners, triangle) in normals.triangles.iter().zip(triangles) {
                for (&normal, &vertex) in corners.iter().zip(triangle) {
                    let Some(vector) = vectors.get_mut(normal as usize) else {
                        continue;
                    };
                    let length = (turn * given[vertex as usize]).length();
                    let change = turn * precise(&differences[vertex as usize]) / length;
                    // Those of triangles that are wound the other way round are behind the file's own.
                    let sign = if normal == vertex { 1.0 } else { -1.0 };
                    *vector = if change.is_finite() {
                        sign * change
                    } else {
                        DVec3::ZERO
                    };
                }
            }
            normals.changes.push(NormalChanges {
                target: first + number,
                vectors,
            });
        }
        Ok(())
    }
}

fn precise(vector: &[f32; 3]) -> DVec3 {
    DVec3::from_array(vector.map(f64::from))
}
