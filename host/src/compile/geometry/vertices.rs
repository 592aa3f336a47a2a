//! Distinct vertices of meshes: places on the lattice, with normals, colors and texture coordinates.

use crate::compile::shading;
use crate::scene::{Attributes, Color, Normals};
use crate::shape::unit;
use glam::DVec3;
use gridel_core::geometry::smooth::{LARGEST, encode};
use std::collections::HashMap;

/// A place in 1/256 unit.
type Place = [i32; 3];

/// A normal as a blob holds it.
pub type Stored = [i16; 2];

/// The attributes of a vertex other than its position.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Corner {
    pub normal: Option<Stored>,
    /// Red, green, blue and alpha as a blob holds them.
    pub color: Option<[u8; 4]>,
    /// Texture coordinates with 20 fraction bits.
    pub coordinates: Option<[i32; 2]>,
    /// Its [motion](crate::compile::motion::morph::Motions); 0 for one that stays.
    pub motion: u32,
}

impl Corner {
    const PLAIN: Self = Self {
        normal: None,
        color: None,
        coordinates: None,
        motion: 0,
    };

    /// Returns the rank. The first vertices of a blob have the lowest rank.
    pub fn rank(&self) -> usize {
        usize::from(self.normal.is_none()) << 2
            | usize::from(self.coordinates.is_none()) << 1
            | usize::from(self.color.is_none())
    }

    /// The most that a rank can be.
    pub const RANKS: usize = 8;
}

/// Vertices that were numbered, in order.
#[derive(Debug, Default)]
pub struct Vertices {
    plain: HashMap<Place, u32>,
    numbers: HashMap<(Place, Corner), u32>,
    places: Vec<Place>,
    /// Empty until there is one that is not plain.
    corners: Vec<Corner>,
}

impl Vertices {
    /// Returns the number of a vertex.
    pub fn number(&mut self, place: Place, corner: Corner) -> u32 {
        let next = self.places.len() as u32;
        let number = if corner == Corner::PLAIN {
            *self.plain.entry(place).or_insert(next)
        } else {
            *self.numbers.entry((place, corner)).or_insert(next)
        };
        if number == next {
            if corner != Corner::PLAIN || !self.corners.is_empty() {
                self.corners.resize(self.places.len(), Corner::PLAIN);
                self.corners.push(corner);
            }
            self.places.push(place);
        }
        number
    }

    /// Returns the vertex with a number.
    pub fn get(&self, number: u32) -> (Place, Corner) {
        let corner = self.corners.get(number as usize).copied();
        (self.places[number as usize], corner.unwrap_or_default())
    }

    /// Returns all places, and the corners' attributes at all of them, or none.
    pub fn into_parts(self) -> (Vec<Place>, Vec<Corner>) {
        (self.places, self.corners)
    }
}

/// The attributes of the corners of a mesh's triangles other than their positions.
#[derive(Debug, Default)]
pub struct Corners {
    normals: Vec<Option<[Stored; 3]>>,
    /// For each vertex.
    colors: Vec<[u8; 4]>,
    /// For each triangle.
    coordinates: Vec<Option<[[i32; 2]; 3]>>,
    /// For each triangle.
    pub motions: Vec<[u32; 3]>,
}

/// Greatest magnitude of texture coordinates, so that the difference of two has 32 bits: 1024 repetitions.
pub const MOST_COORDINATE: f64 = 1024.0;

impl Corners {
    /// Returns the corners of a mesh, whose attributes are in place. `None` if texture coordinates are out of range.
    pub fn of(normals: &Normals, attributes: &Attributes, display_values: bool) -> Option<Self> {
        let coordinates = attributes.coordinates.iter().map(|it| {
            let is_valid = it.abs().max_element() < MOST_COORDINATE;
            is_valid.then(|| {
                (*it * f64::from(1 << 20))
                    .round()
                    .to_array()
                    .map(|it| it as i32)
            })
        });
        let coordinates: Vec<[i32; 2]> = coordinates.collect::<Option<_>>()?;
        let at = |corner: u32| coordinates.get(corner as usize).copied();
        let of_triangle = |&[a, b, c]: &[u32; 3]| Some([at(a)?, at(b)?, at(c)?]);
        let root = |channel: f64| shading::root(channel, display_values);
        let color = |it: &Color| [root(it[0]), root(it[1]), root(it[2]), 255];
        Some(Self {
            normals: stored(normals),
            colors: attributes.colors.iter().map(color).collect(),
            coordinates: attributes.triangles.iter().map(of_triangle).collect(),
            motions: Vec::new(),
        })
    }

    /// Returns whether no corner has attributes.
    pub fn is_plain(&self) -> bool {
        let is_plain = self.normals.is_empty() && self.colors.is_empty();
        is_plain && self.coordinates.is_empty() && self.motions.is_empty()
    }

    /// Returns the corners of a triangle, given its number and vertices.
    pub fn of_triangle(&self, number: usize, vertices: [u32; 3]) -> [Corner; 3] {
        let normals = self.normals.get(number).copied().flatten();
        let coordinates = self.coordinates.get(number).copied().flatten();
        [0, 1, 2].map(|k: usize| Corner {
            normal: normals.map(|it| it[k]),
            color: self.colors.get(vertices[k] as usize).copied(),
            coordinates: coordinates.map(|it| it[k]),
            motion: self.motions.get(number).map_or(0, |it| it[k]),
        })
    }
}

/// The stored normals of the corners of each triangle of a mesh, `None` for one that is flat; nothing for a flat mesh.
fn stored(normals: &Normals) -> Vec<Option<[Stored; 3]>> {
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

/// Returns the attributes of a point on an edge of a triangle, or at a corner. On an edge it has this motion.
pub fn corner_at(
    (point, motion): (Place, u32),
    places: [Place; 3],
    corners: [Corner; 3],
) -> Corner {
    if let Some(corner) = places.iter().position(|it| *it == point) {
        return corners[corner];
    }
    let place = |place: Place| DVec3::from_array(place.map(f64::from));
    // The edge that it lies on, and how far along it.
    let (mut nearest, mut edge) = (f64::INFINITY, (0, 1, 0.0));
    for (from, to) in [(0, 1), (1, 2), (2, 0)] {
        let (start, way) = (place(places[from]), place(places[to]) - place(places[from]));
        let along = (place(point) - start).dot(way) / way.length_squared();
        let apart = (start + way * along - place(point)).length();
        if apart < nearest {
            nearest = apart;
            edge = (from, to, along.clamp(0.0, 1.0));
        }
    }
    let (from, to, along) = edge;
    let (from, to) = (corners[from], corners[to]);
    let is_smooth = corners.iter().all(|it| it.normal.is_some());
    let normal = from.normal.zip(to.normal).filter(|_| is_smooth);
    let mixed = |from: f64, to: f64| from + (to - from) * along;
    let color = from.color.zip(to.color);
    let coordinates = from.coordinates.zip(to.coordinates);
    Corner {
        normal: normal.map(|(from, to)| {
            let mean = decoded(from).lerp(decoded(to), along);
            encode(mean.to_array())
        }),
        color: color.map(|(from, to)| {
            [0, 1, 2, 3].map(|k: usize| {
                // Roots of linear light, except for alpha.
                let power = if k < 3 { 2.0 } else { 1.0 };
                let light = |it: u8| libm::pow(f64::from(it), power);
                libm::pow(mixed(light(from[k]), light(to[k])), 1.0 / power).round() as u8
            })
        }),
        coordinates: coordinates.map(|(from, to)| {
            [0, 1].map(|k: usize| mixed(from[k].into(), to[k].into()).round() as i32)
        }),
        motion,
    }
}

/// Returns the direction of length 1 of a stored normal.
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
        let smooth = |normal: Option<Stored>| Corner {
            normal,
            ..Corner::default()
        };
        let all = normals.map(|it| smooth(Some(it)));
        let found = |point| decoded(corner_at((point, 0), corners, all).normal.unwrap());
        for (corner, vector) in corners.into_iter().zip(vectors) {
            assert!((found(corner) - vector).length() < 1e-4);
        }
        let halfway = unit(DVec3::new(0.3, 0.0, 0.9));
        assert!((found([512, 0, 0]) - halfway).length() < 1e-4);
        let flat = [Some(normals[0]), None, Some(normals[1])].map(smooth);
        assert_eq!(corner_at(([512, 0, 0], 0), corners, flat).normal, None);
    }

    #[test]
    fn colors_and_coordinates_are_mixed_along_the_edge() {
        let places = [[0, 0, 0], [1024, 0, 0], [0, 1024, 0]];
        let corner = |color, coordinates| Corner {
            normal: None,
            color: Some(color),
            coordinates,
            motion: 0,
        };
        let corners = [
            corner([0, 0, 0, 255], Some([0, 0])),
            corner([255, 0, 0, 255], Some([1 << 20, -4])),
            corner([0, 255, 0, 255], None),
        ];
        assert_eq!(corner_at(([1024, 0, 0], 0), places, corners), corners[1]);
        let halfway = corner_at(([512, 0, 0], 0), places, corners);
        // The root of half the light.
        let half = corner([180, 0, 0, 255], Some([1 << 19, -2]));
        assert_eq!(halfway, half);
        assert_eq!(
            corner_at(([0, 512, 0], 0), places, corners).coordinates,
            None
        );
    }

    #[test]
    fn places_with_different_normals_are_different_vertices() {
        let mut vertices = Vertices::default();
        let smooth = |normal: [i16; 2]| Corner {
            normal: Some(normal),
            ..Corner::default()
        };
        let plain = Corner::default();
        let numbers = [plain, smooth([1, 2]), plain, smooth([1, 2]), smooth([2, 1])];
        let numbers = numbers.map(|corner| vertices.number([7, 8, 9], corner));
        assert_eq!(numbers, [0, 1, 0, 1, 2]);
        assert_eq!(vertices.get(0), ([7, 8, 9], plain));
        let (places, corners) = vertices.into_parts();
        assert_eq!(places, [[7, 8, 9]; 3]);
        assert_eq!(corners, [plain, smooth([1, 2]), smooth([2, 1])]);
    }
}
