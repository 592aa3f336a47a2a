//! Normals of meshes.

use super::Importer;
use super::place::Weighted;
use crate::scene::normals::cofactors;
use crate::scene::{Normals, SceneError};
use glam::{DMat3, DMat4, DVec3};
use gltf::Semantic;
use gltf::mesh::MorphTarget;

impl Importer<'_> {
    /// The normals of a mesh that is in its place.
    pub(super) fn normals(
        &self,
        place: &str,
        weighted: Weighted<'_>,
        world: &DMat4,
        mesh: (&[DVec3], &[[u32; 3]]),
    ) -> Result<Normals, SceneError> {
        let Some(accessor) = weighted.part.get(&Semantic::Normals) else {
            return Ok(Normals::default());
        };
        let normals = self.buffers.vectors(&accessor, "normals")?;
        let (vertices, triangles) = mesh;
        if normals.len() != vertices.len() {
            return Err(self.error(
                format!(
                    "{place} has {} vertices and {} normals",
                    vertices.len(),
                    normals.len()
                ),
                "export the file again",
            ));
        }
        let mut normals = self.morph(place, weighted, &normals, MorphTarget::normals)?;
        let (turn, _) = cofactors(DMat3::from_mat4(*world));
        for normal in &mut normals {
            *normal = turn * *normal;
        }
        let moves = weighted.moving.is_some();
        Ok(Normals::kept(normals, triangles.to_vec(), mesh, moves))
    }
}
