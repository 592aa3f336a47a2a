//! Distinct vertices of meshes: places on the lattice, with the normals that they are shaded with.

use crate::scene::Normals;
use crate::shape::unit;
use glam::DVec3;
use gridel_core::geometry::smooth::{LARGEST, encode};
use std::collections::HashMap;

/// A place in 1/256 unit.
type Place = [i32; 3];

/// A normal as a blob holds it.
pub type Stored = [i16; 2];

/// Vertices that were numbered, in order.
#[derive(Debug, Default)]
pub struct Vertices {
    numbers: HashMap<(Place, Option<Stored>), u32>,
    places: Vec<Place>,
    /// Empty until there is one.
    normals: Vec<Option<Stored>>,
}

impl Vertices {
    /// The number of a vertex.
    pub fn number(&mut self, place: Place, normal: Option<Stored>) -> u32 {
        *self.numbers.entry((place, normal)).or_insert_with(|| {
            if normal.is_some() || !self.normals.is_empty() {
                self.normals.resize(self.places.len(), None);
                self.normals.push(normal);
            }
            self.places.push(place);
            self.places.len() as u32 - 1
        })
    }

    /// A vertex that was numbered.
    pub fn get(&self, number: u32) -> (Place, Option<Stored>) {
        let normal = self.normals.get(number as usize).copied().flatten();
        (self.places[number as usize], normal)
    }

    /// All places, and all normals or none.
    pub fn into_parts(self) -> (Vec<Place>, Vec<Option<Stored>>) {
        (self.places, self.normals)
    }
}

/// The stored normals of the corners of each triangle of a mesh, `None` for one that is flat; nothing for a flat mesh.
pub fn stored(normals: &Normals) -> Vec<Option<[Stored; 3]>> {
    let vectors: Vec<Stored> = normals
        .vectors
        .iter()
        .map(|it| encode(it.to_array()))
        .collect();
    let corner = |it: u32| vectors.get(it as usize).copied();
    let triangles = normals.triangles.iter();
    triangles
        .map(|&[a, b, c]| Some([corner(a)?, corner(b)?, corner(c)?]))
        .collect()
}

/// The normal of a point on an edge of a triangle, or at a corner.
pub fn normal_at(
    point: Place,
    corners: [Place; 3],
    normals: [Option<Stored>; 3],
) -> Option<Stored> {
    let [Some(a), Some(b), Some(c)] = normals else {
        return None;
    };
    let normals = [a, b, c];
    if let Some(corner) = corners.iter().position(|it| *it == point) {
        return Some(normals[corner]);
    }
    let place = |place: Place| DVec3::from_array(place.map(f64::from));
    // The edge that it lies on, and how far along it.
    let (mut nearest, mut mean) = (f64::INFINITY, DVec3::Z);
    for (from, to) in [(0, 1), (1, 2), (2, 0)] {
        let (start, way) = (
            place(corners[from]),
            place(corners[to]) - place(corners[from]),
        );
        let along = (place(point) - start).dot(way) / way.length_squared();
        let apart = (start + way * along - place(point)).length();
        if apart < nearest {
            nearest = apart;
            mean = decoded(normals[from]).lerp(decoded(normals[to]), along.clamp(0.0, 1.0));
        }
    }
    Some(encode(mean.to_array()))
}

/// The direction of length 1 that a stored normal stands for.
fn decoded([x, y]: Stored) -> DVec3 {
    let [x, y] = [x, y].map(|it| f64::from(it) / f64::from(LARGEST));
    let z = 1.0 - x.abs() - y.abs();
    if z < 0.0 {
        let sign = |x: f64| if x < 0.0 { -1.0 } else { 1.0 };
        return unit(DVec3::new(
            (1.0 - y.abs()) * sign(x),
            (1.0 - x.abs()) * sign(y),
            z,
        ));
    }
    unit(DVec3::new(x, y, z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_are_those_of_the_nearest_edge() {
        let corners = [[0, 0, 0], [1024, 0, 0], [0, 1024, 0]];
        let vectors = [
            DVec3::Z,
            DVec3::new(0.6, 0.0, 0.8),
            DVec3::new(0.0, -0.6, -0.8),
        ];
        let normals = vectors.map(|it| encode(it.to_array()));
        let found = |point| decoded(normal_at(point, corners, normals.map(Some)).unwrap());
        for (corner, vector) in corners.into_iter().zip(vectors) {
            assert!((found(corner) - vector).length() < 1e-4);
        }
        let halfway = unit(DVec3::new(0.3, 0.0, 0.9));
        assert!((found([512, 0, 0]) - halfway).length() < 1e-4);
        let flat = [Some(normals[0]), None, Some(normals[1])];
        assert_eq!(normal_at([0, 0, 0], corners, flat), None);
    }

    #[test]
    fn places_with_different_normals_are_different_vertices() {
        let mut vertices = Vertices::default();
        let numbers = [None, Some([1, 2]), None, Some([1, 2]), Some([2, 1])];
        let numbers = numbers.map(|normal| vertices.number([7, 8, 9], normal));
        assert_eq!(numbers, [0, 1, 0, 1, 2]);
        assert_eq!(vertices.get(0), ([7, 8, 9], None));
        let (places, normals) = vertices.into_parts();
        assert_eq!(places, [[7, 8, 9]; 3]);
        assert_eq!(normals, [None, Some([1, 2]), Some([2, 1])]);
    }
}
