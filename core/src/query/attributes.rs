//! Colors and texture coordinates of hits.

use crate::accel::Number;
use crate::geometry::Shapes;
use crate::geometry::attributes::{COORDINATE_BITS, Weights};
use crate::instances::map::{Map, PlacedSurface};
use crate::query::hit::{Hit, find};
use crate::scene::Scene;
use crate::target::{TEXTURE, VERTEX_COLORS, inline_on_boards};

/// How an image lies on a triangle: see [`Hit::tangent`].
pub(crate) struct Tangent<N> {
    pub(crate) direction: [N; 3],
    pub(crate) is_mirrored: bool,
    pub(crate) coordinates: [i32; 2],
}

/// The direction in which u grows over a triangle, below 2^52 in magnitude, and whether the image is seen mirrored from
/// its front: places with 8 fraction bits, coordinates with [`COORDINATE_BITS`].
#[inline(always)]
fn along_u(corners: [[i32; 3]; 3], coordinates: [[i32; 2]; 3]) -> Option<([i64; 3], bool)> {
    let [a, b, c] = corners;
    let [at_a, at_b, at_c] = coordinates;
    // At most 2^31 in magnitude, and edges of places 2^25.
    let apart = |to: [i32; 2], k: usize| i64::from(to[k]).wrapping_sub(i64::from(at_a[k]));
    let (u, v) = (
        [apart(at_b, 0), apart(at_c, 0)],
        [apart(at_b, 1), apart(at_c, 1)],
    );
    let edge = |to: [i32; 3], k: usize| i64::from(to[k]).wrapping_sub(i64::from(a[k]));
    // Of 2^62 and 2^62, which may not fit.
    let area = u[0]
        .wrapping_mul(v[1])
        .saturating_sub(u[1].wrapping_mul(v[0]));
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
    (area != 0 && along != [0; 3]).then_some((along, area > 0))
}

impl<N: Number> Hit<N> {
    /// Returns the texture coordinates at the hit, u to the right and v down: a multiple of 2^-20 each, from -1024 to
    /// 1024. `scene` is that of the query. `None` unless the hit is of a mesh in a scene with texture coordinates.
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
    /// assert_eq!(hit.mapped_coordinates(&scene), None);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn mapped_coordinates(&self, scene: &Scene<'_>) -> Option<[f64; 2]> {
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
        /// The direction in which the u of texture coordinates grows, of any length, with their values at the hit and
        /// whether the image is seen mirrored from the triangle's front. `None` where there are none, or they are the
        /// same along a line.
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

    /// The primitives among which the triangle is that was hit, its vertices, and the weights of these.
    #[inline(always)]
    fn weights<'s>(&self, scene: &'s Scene<'_>) -> Option<(&'s Shapes<'s>, [usize; 3], Weights)> {
        let slot = self.triangle_slot()?;
        let (shapes, point, normal) = if self.instance().is_some() {
            self.placed_point(scene)?
        } else {
            (&scene.space.shapes, self.point, self.normal)
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
        Some((&part.space.shapes, there.point, there.normal))
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
