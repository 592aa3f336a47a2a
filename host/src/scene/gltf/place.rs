//! Where nodes stand.

use glam::{DMat4, DQuat, DVec3};
use gltf::{Mesh, Node};
use gltf::scene::Transform;

/// Where a node stands in its parent, computed in double precision.
pub(super) fn transform(node: &Node<'_>) -> DMat4 {
    match node.transform() {
        Transform::Matrix { matrix } => {
            DMat4::from_cols_array_2d(&matrix.map(|column| column.map(f64::from)))
        }
        Transform::Decomposed {
            translation,
            rotation,
            scale,
        } => DMat4::from_scale_rotation_translation(
            DVec3::from_array(scale.map(f64::from)),
            DQuat::from_array(rotation.map(f64::from)).normalize(),
            DVec3::from_array(translation.map(f64::from)),
        ),
    }
}

/// The name of a mesh, or one made of its number.
pub(super) fn mesh_name(mesh: &Mesh<'_>) -> String {
    let name = mesh.name().map(str::to_owned);
    name.unwrap_or_else(|| format!("mesh {}", mesh.index()))
}
