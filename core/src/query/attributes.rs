//! Colors and texture coordinates of hits.

use crate::accel::Number;
use crate::format::instance::MATRIX_BITS;
use crate::geometry::Shapes;
use crate::geometry::attributes::{COORDINATE_BITS, Weights};
use crate::instances::map::{Map, PlacedSurface};
use crate::number::log2::{log2, log2_of_length, log2_of_power};
use crate::query::hit::{Hit, find};
use crate::scene::Scene;
use crate::target::{TEXTURE, TEXTURE_LEVELS, VERTEX_COLORS, inline_on_boards};

/// The placement of an image on a triangle: see [`Hit::tangent`].
pub(crate) struct Tangent<N> {
    pub(crate) direction: [N; 3],
    pub(crate) is_mirrored: bool,
    pub(crate) coordinates: [i32; 2],
}

/// Twice the area of a triangle in texture coordinates, with twice [`COORDINATE_BITS`] fraction bits. It is positive if
/// the image is seen unmirrored from the triangle's front. It is limited, because a number of 2^62 less another can
/// overflow.
#[inline(always)]
fn mapped_area([a, b, c]: [[i32; 2]; 3]) -> i64 {
    // At most 2^31 in magnitude.
    let apart = |to: [i32; 2], k: usize| i64::from(to[k]).wrapping_sub(i64::from(a[k]));
    let product = |i: usize, j: usize| apart(b, i).wrapping_mul(apart(c, j));
    product(0, 1).saturating_sub(product(1, 0))
}

/// Twice the area of a triangle, as a vector along its normal: places with 8 fraction bits, and so a square of them.
fn area([a, b, c]: [[i32; 3]; 3]) -> [i64; 3] {
    // Edges of places are below 2^25.
    let edge = |to: [i32; 3], k: usize| i64::from(to[k]).wrapping_sub(i64::from(a[k]));
    let product = |i: usize, j: usize| edge(b, i).wrapping_mul(edge(c, j));
    let axis = |i: usize, j: usize| product(i, j).wrapping_sub(product(j, i));
    [axis(1, 2), axis(2, 0), axis(0, 1)]
}

/// Returns the direction in which u grows over a triangle, below 2^52 in magnitude, and true if the image is seen
/// mirrored from its front. Places have 8 fraction bits, coordinates [`COORDINATE_BITS`].
#[inline(always)]
fn along_u(corners: [[i32; 3]; 3], coordinates: [[i32; 2]; 3]) -> Option<([i64; 3], bool)> {
    let [a, b, c] = corners;
    let [at_a, at_b, at_c] = coordinates;
    // At most 2^31 in magnitude, and edges of places 2^25.
    let apart = |to: [i32; 2]| i64::from(to[1]).wrapping_sub(i64::from(at_a[1]));
    let v = [apart(at_b), apart(at_c)];
    let edge = |to: [i32; 3], k: usize| i64::from(to[k]).wrapping_sub(i64::from(a[k]));
    let area = mapped_area(coordinates);
    let along = |k: usize| {
        let sum = edge(b, k)
            .wrapping_mul(v[1])
            .wrapping_sub(edge(c, k).wrapping_mul(v[0]));
        if area < 0 { sum.wrapping_neg() } else { sum }
    };
    let along = [along(0), along(1), along(2)];
    let all = along.iter().fold(0, |all, it| all | it.unsigned_abs());
    let along = if all >> 51 == 0 {
        along
    } else {
        along.map(|it| it >> 6)
    };
    (area != 0 && all != 0).then_some((along, area > 0))
}

impl<N: Number> Hit<N> {
    /// Returns the texture coordinates at the hit, u to the right and v down: a multiple of 2^-20 each, from -1024 to
    /// 1024. `scene` is that of the query. `None` unless the hit is of a mesh whose material has a texture: the
    /// compiler leaves other coordinates out. Those of a mesh within -2 to 2 are rounded to multiples of 2^-14 at its
    /// vertices.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{Ray, Scene, Stack};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let mut stack = Stack::<32>::new();
    /// let down = Ray::<f32>::from_f64(scene.bounds(), [0.0, 1e6, 0.0], [0.0, -1.0, 0.0], 0.0, 1e9)?;
    /// let hit = scene.closest_hit(&down, stack.as_view()).expect("a sphere");
    /// assert_eq!(hit.texture_coordinates(&scene), None);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn texture_coordinates(&self, scene: &Scene<'_>) -> Option<[f64; 2]> {
        let found = self.coordinates(scene)?;
        Some(found.map(|it| f64::from(it) / f64::from(1 << COORDINATE_BITS)))
    }

    /// The texture coordinates with [`COORDINATE_BITS`] fraction bits; `None` where there are none.
    #[inline(always)]
    pub(crate) fn coordinates(&self, scene: &Scene<'_>) -> Option<[i32; 2]> {
        if !TEXTURE {
            return None;
        }
        let (shapes, vertices, weights) = self.weights(scene)?;
        let corners = shapes.coordinates().corners(vertices)?;
        Some(weights.coordinates(corners))
    }

    inline_on_boards!(
        /// Returns the direction in which the u of texture coordinates grows, of any length. Returns also their values
        /// at the hit, and true if the image is seen mirrored from the triangle's front. `None` if there are no
        /// coordinates, or if they lie on a line.
        pub(crate) fn tangent(&self, scene: &Scene<'_>) -> Option<Tangent<N>> {
            if !TEXTURE {
                return None;
            }
            let (shapes, vertices, weights) = self.weights(scene)?;
            let coordinates = shapes.coordinates().corners(vertices)?;
            let position = |vertex| shapes.vertices.position(vertex);
            let [a, b, c] = vertices;
            let corners = [position(a)?, position(b)?, position(c)?];
            let (along_u, is_mirrored) = along_u(corners, coordinates)?;
            let mut direction = N::direction(along_u);
            if self.instance().is_some() {
                let (instance, _) = find(scene, self.instance()?)?;
                direction = Map::<N>::new(instance).normal(direction).0;
            }
            Some(Tangent {
                direction,
                is_mirrored,
                coordinates: weights.coordinates(coordinates),
            })
        }
    );

    /// Returns the distance of texture coordinates per unit of length around the hit. It is the binary logarithm of the
    /// root of the ratio of their areas, with 8 fraction bits. `None` if there are no coordinates, or if they lie on a
    /// line.
    ///
    /// Out of line: it is long, and only textures with levels need it.
    #[inline(never)]
    pub(crate) fn log2_density(&self, scene: &Scene<'_>) -> Option<i32> {
        if !TEXTURE_LEVELS {
            return None;
        }
        let placed = match self.instance() {
            Some(index) => Some(find(scene, index)?),
            None => None,
        };
        let geometry = &placed.map_or(scene, |(_, part)| part).geometry;
        let shapes = &geometry.shapes;
        let vertices = shapes.triangles.corners(self.triangle_slot()?)?;
        let [a, b, c] = vertices;
        let position = |vertex| shapes.vertices.position(vertex);
        let corners = [position(a)?, position(b)?, position(c)?];
        let mapped = mapped_area(shapes.coordinates().corners(vertices)?).unsigned_abs();
        if mapped == 0 {
            return None;
        }
        // Twice the fraction bits of each, and 8 of places.
        let bits = COORDINATE_BITS.wrapping_sub(8).cast_signed();
        let areas = log2(mapped).wrapping_sub(log2_of_length(area(corners)));
        let density = (areas >> 1).wrapping_sub(log2_of_power(bits));
        // The part's units per unit of the scene.
        let stretch = placed.map_or(0, |(instance, _)| {
            let row = log2_of_length(instance.matrix[0].map(i64::from));
            let bits = MATRIX_BITS.cast_signed();
            row.wrapping_add(log2_of_power(
                i32::from(instance.exponent).wrapping_sub(bits),
            ))
        });
        Some(density.wrapping_add(stretch))
    }

    /// The color of the vertices at the hit: linear ratios with 30 fraction bits. `None` where there is none.
    #[inline(always)]
    pub(crate) fn vertex_color(&self, scene: &Scene<'_>) -> Option<[i32; 3]> {
        if !VERTEX_COLORS {
            return None;
        }
        let (shapes, vertices, weights) = self.weights(scene)?;
        let all = shapes.colors();
        if vertices.iter().all(|&vertex| vertex >= all.len()) {
            return None;
        }
        let color = |vertex: usize| all.get(vertex).copied().unwrap_or([255; 4]);
        Some(weights.color(vertices.map(color)))
    }

    /// The primitives that hold the triangle that was hit, its vertices, and the weights of these.
    #[inline(always)]
    fn weights<'s>(&self, scene: &'s Scene<'_>) -> Option<(&'s Shapes<'s>, [usize; 3], Weights)> {
        let slot = self.triangle_slot()?;
        let (shapes, point, normal) = if self.instance().is_some() {
            self.placed_point(scene)?
        } else {
            (&scene.geometry.shapes, self.point, self.normal)
        };
        let vertices = shapes.triangles.corners(slot)?;
        let position = |vertex| shapes.vertices.position(vertex);
        let [a, b, c] = vertices;
        let corners = [position(a)?, position(b)?, position(c)?];
        Some((shapes, vertices, Weights::at(corners, point, normal)))
    }

    /// The primitives of the part, and point and normal there.
    #[cold]
    #[inline(never)]
    fn placed_point<'s>(&self, scene: &'s Scene<'_>) -> Option<(&'s Shapes<'s>, [N; 3], [N; 3])> {
        let (instance, part) = find(scene, self.instance()?)?;
        let there = Map::<N>::new(instance).in_part(&PlacedSurface {
            point: self.point,
            normal: self.normal,
            error: self.error,
        });
        Some((&part.geometry.shapes, there.point, there.normal))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest triangle, with coordinates as far apart as can be, upright, in a mirror, and turned.
    #[test]
    fn directions_of_u_have_room_in_every_format() {
        const FAR: i32 = 1024 << COORDINATE_BITS;
        const END: i32 = 1 << 24;
        let corners = [[-END; 3], [END, -END, END], [END, END, -END]];
        for (coordinates, mirrored) in [
            ([[-FAR, FAR], [FAR, FAR], [FAR, -FAR]], false),
            ([[FAR, FAR], [-FAR, FAR], [-FAR, -FAR]], true),
            ([[FAR, FAR], [-FAR, -FAR], [FAR, -FAR]], true),
        ] {
            let (along, is_mirrored) = along_u(corners, coordinates).expect("an area");
            assert!(
                along.iter().all(|it| it.unsigned_abs() < 1 << 52),
                "{along:?}"
            );
            assert_eq!(is_mirrored, mirrored, "{coordinates:?}");
            // The edge along which v stays shows which way u grows.
            let edge = |to: usize| [0, 1, 2].map(|k| f64::from(corners[to][k] - corners[0][k]));
            let grows = |to: usize| {
                let dot: f64 = (0..3).map(|k| edge(to)[k] * along[k] as f64).sum();
                (dot > 0.0) == (coordinates[to][0] > coordinates[0][0])
            };
            if coordinates[1][1] == coordinates[0][1] {
                assert!(grows(1), "{coordinates:?}");
            }
        }
        assert_eq!(along_u(corners, [[0, 0], [1, 1], [2, 2]]), None);
    }
}
