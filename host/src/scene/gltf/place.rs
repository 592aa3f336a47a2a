//! The transforms of nodes, and the meshes that they place.

use glam::{DMat4, DQuat, DVec3, DVec4};
use gltf::scene::Transform;
use gltf::{Mesh, Node, Primitive};

/// Returns the transform of a node in its parent, computed in double precision.
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

/// Translation, rotation and scale of a node; `None` for a matrix that is sheared or flat.
pub(super) fn parts(node: &Node<'_>) -> Option<[DVec4; 3]> {
    /// Relative to the largest entry.
    const TOLERANCE: f64 = 1e-5;
    if let Transform::Decomposed {
        translation,
        rotation,
        scale,
    } = node.transform()
    {
        let [translation, scale] =
            [translation, scale].map(|it| DVec3::from_array(it.map(f64::from)).extend(0.0));
        let rotation = DQuat::from_array(rotation.map(f64::from)).normalize();
        return Some([translation, rotation.into(), scale]);
    }
    let matrix = transform(node);
    let (scale, rotation, translation) = matrix.to_scale_rotation_translation();
    let again = DMat4::from_scale_rotation_translation(scale, rotation, translation);
    let largest = scale.abs().max_element();
    let near = |one: DVec4, other: DVec4| one.abs_diff_eq(other, TOLERANCE * largest);
    let sound = near(matrix.x_axis, again.x_axis)
        && near(matrix.y_axis, again.y_axis)
        && near(matrix.z_axis, again.z_axis);
    (sound && scale.recip().is_finite())
        .then(|| [translation.extend(0.0), rotation.into(), scale.extend(0.0)])
}

/// The name of a mesh, or one made of its number.
pub(super) fn mesh_name(mesh: &Mesh<'_>) -> String {
    let name = mesh.name().map(str::to_owned);
    name.unwrap_or_else(|| format!("mesh {}", mesh.index()))
}

/// The name of a part of a mesh in messages.
pub(super) fn place_of(mesh: &Mesh<'_>, part: &Primitive<'_>) -> String {
    format!("mesh {}, primitive {}", mesh.index(), part.index())
}

/// A part of a mesh, the weights of its morph targets at rest, and which of the scene's morph targets is its first if
/// they move.
#[derive(Clone, Copy)]
pub(super) struct Weighted<'p> {
    pub(super) part: &'p Primitive<'p>,
    pub(super) weights: &'p [f32],
    pub(super) moving: Option<usize>,
}

/// The weights of a node's mesh.
pub(super) fn weights<'n>(node: &Node<'n>, mesh: &Mesh<'n>) -> &'n [f32] {
    let own = node.weights().or(mesh.weights());
    own.unwrap_or_default()
}
