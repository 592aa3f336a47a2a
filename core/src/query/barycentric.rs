//! Barycentric coordinates of hits.

use crate::accel::Number;
use crate::geometry::smooth::barycentric;
use crate::instances::map::{Map, PlacedSurface};
use crate::query::hit::{Hit, find};
use crate::scene::Scene;

impl<N: Number> Hit<N> {
    /// Returns the weights of a triangle's corners at the hit's point; `None` if the hit is not of a triangle. The
    /// order of corners is the blob's, which can begin with another corner than the scene file. Each weight is at least
    /// 0, and their sum is 1, except for rounding. `scene` is that of the query.
    ///
    /// The weights come from the point. They are off by some six roundings of its coordinates over the triangle's least
    /// height. A rounding is 2^-24 of the coordinate in `f32`, 2^-53 in `f64`, and 2^-13 unit in `fixed`.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{Ray, Scene, Stack};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let mut stack = Stack::<32>::new();
    /// let down = Ray::<f32>::from_f64(scene.bounds(), [0.0, 1e6, 0.0], [0.0, -1.0, 0.0], 0.0, 1e9)?;
    /// let ball = scene.closest_hit(&down, stack.as_view()).expect("a sphere");
    /// assert_eq!(ball.barycentric(&scene), None);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn barycentric(&self, scene: &Scene<'_>) -> Option<[N; 3]> {
        let slot = self.triangle_slot()?;
        let Some(instance) = self.instance() else {
            let corners = scene.geometry.shapes.triangle(slot)?;
            return Some(barycentric(corners, self.point, self.normal));
        };
        let (instance, part) = find(scene, instance)?;
        let there = Map::<N>::new(instance).in_part(&PlacedSurface {
            point: self.point,
            normal: self.normal,
            error: self.error,
        });
        let corners = part.geometry.shapes.triangle(slot)?;
        Some(barycentric(corners, there.point, there.normal))
    }
}
