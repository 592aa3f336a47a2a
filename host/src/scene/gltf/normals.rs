//! Normals of meshes.

use super::Importer;
use crate::scene::normals::cofactors;
use crate::scene::{Normals, SceneError};
use glam::{DMat3, DMat4, DVec3};
use gltf::Accessor;

impl Importer<'_> {
    /// The normals of a mesh that is in its place.
    pub(super) fn normals(
        &self,
        place: &str,
        accessor: &Accessor<'_>,
        world: &DMat4,
        mesh: (&[DVec3], &[[u32; 3]]),
    ) -> Result<Normals, SceneError> {
        let normals = self.buffers.vectors(accessor, "normals")?;
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
        let (turn, _) = cofactors(DMat3::from_mat4(*world));
        let turned = |normal: [f32; 3]| turn * DVec3::from_array(normal.map(f64::from));
        let normals = normals.into_iter().map(turned).collect();
        Ok(Normals::given(normals, triangles.to_vec(), mesh))
    }
}
