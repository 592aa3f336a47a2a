//! Attributes of meshes other than shape and normals: colors of vertices, texture coordinates, and displacements.

use super::morph::Displacements;
use super::normals::cofactors;
use super::texture::Texture;
use glam::{DAffine3, DVec2};

/// Colors and displacements of vertices, and texture coordinates of corners; empty for a mesh that has none.
///
/// ```
/// use gridel_host::scene::Attributes;
///
/// assert!(Attributes::default().is_empty());
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Attributes {
    /// For each vertex its linear color, 0 to 1; empty for none.
    pub colors: Vec<[f64; 3]>,
    /// Texture coordinates: u to the right, v down; 1 is the width or the height of the image.
    pub coordinates: Vec<DVec2>,
    /// For each triangle which of the coordinates its corners have; [`Attributes::NONE`] for none. As many as the mesh
    /// has, or none.
    pub triangles: Vec<[u32; 3]>,
    /// Displacements of vertices by morph targets, at most one for each target.
    pub displacements: Vec<Displacements>,
}

impl Attributes {
    /// Stands for the coordinates of a triangle that has none.
    pub const NONE: [u32; 3] = [u32::MAX; 3];

    /// Returns whether there is nothing.
    pub fn is_empty(&self) -> bool {
        self.colors.is_empty() && self.triangles.is_empty() && self.displacements.is_empty()
    }

    /// Returns whether a triangle has texture coordinates.
    pub(crate) fn has_coordinates(&self) -> bool {
        self.triangles.iter().any(|it| *it != Self::NONE)
    }

    /// The attributes after a transform of the mesh: triangles that are mirrored are wound the other way round.
    #[must_use]
    pub(crate) fn transformed(&self, by: &DAffine3) -> Self {
        let mut transformed = self.clone();
        let moved = &mut transformed.displacements;
        for vector in moved.iter_mut().flat_map(|it| &mut it.vectors) {
            *vector = by.transform_vector3(*vector);
        }
        if !self.triangles.is_empty() && cofactors(by.matrix3).1 {
            for [_, b, c] in &mut transformed.triangles {
                std::mem::swap(b, c);
            }
        }
        transformed
    }

    /// The attributes that a mesh has with a texture or without one: its transform applied to the coordinates.
    #[must_use]
    pub(crate) fn placed_on(&self, texture: Option<&Texture>) -> Self {
        let Some(texture) = texture else {
            return Self {
                colors: self.colors.clone(),
                displacements: self.displacements.clone(),
                ..Self::default()
            };
        };
        let coordinates = self.coordinates.iter();
        Self {
            coordinates: coordinates
                .map(|it| texture.transform.transform_point2(*it))
                .collect(),
            ..self.clone()
        }
    }
}
