//! Smooth normals of hits.

use crate::accel::Number;
use crate::format::limits::SMOOTH;
use crate::format::{Kind, Leaf};
use crate::geometry::smooth::SmoothTriangle;
use crate::instances::map::{Map, PlacedSurface};
use crate::query::hit::{Hit, find};
use crate::scene::Scene;

impl<N: Number> Hit<N> {
    /// Returns the normal for shading, of length 1, on the side from which the ray came. `scene` is that of the query.
    /// It is the [geometric normal](Hit::normal) or its opposite, except in meshes with [smooth
    /// normals](crate::geometry::smooth).
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
    /// assert_eq!(hit.shading_normal(&scene), hit.normal);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn shading_normal(&self, scene: &Scene<'_>) -> [N; 3] {
        let facing = self.facing_normal();
        self.smooth_normal(scene, facing).unwrap_or(facing)
    }

    /// The geometric normal, on the side from which the ray came.
    #[inline(always)]
    pub(crate) fn facing_normal(&self) -> [N; 3] {
        if self.front {
            self.normal
        } else {
            self.normal.map(|x| -x)
        }
    }

    /// Returns the smooth normal on the side of `facing`, the geometric normal or its opposite; `None` if there is
    /// none.
    #[inline(always)]
    pub(crate) fn smooth_normal(&self, scene: &Scene<'_>, facing: [N; 3]) -> Option<[N; 3]> {
        if !SMOOTH {
            return None;
        }
        if self.instance().is_some() {
            return self.placed_normal(scene, facing);
        }
        let slot = self.triangle_slot()?;
        let triangle = scene.geometry.shapes.smooth_triangle(slot)?;
        triangle.normal(self.point, facing)
    }

    /// Returns the way from the point to the curved surface that a smooth triangle approximates, on the side of
    /// `facing`: see [`SmoothTriangle::lift`]. `None` if the triangle is not smooth.
    #[cold]
    pub(crate) fn lift(&self, scene: &Scene<'_>, facing: [N; 3]) -> Option<[N; 3]> {
        if self.instance().is_none() {
            let triangle = scene
                .geometry
                .shapes
                .smooth_triangle(self.triangle_slot()?)?;
            return Some(triangle.lift(self.point, facing));
        }
        let (map, triangle, there) = self.in_part(scene, facing)?;
        let way = triangle.lift(there.point, there.normal);
        Some(map.step(way))
    }

    /// Returns the smooth normal at a hit of an instance.
    #[cold]
    #[inline(never)]
    fn placed_normal(&self, scene: &Scene<'_>, facing: [N; 3]) -> Option<[N; 3]> {
        let (map, triangle, there) = self.in_part(scene, facing)?;
        let normal = triangle.normal(there.point, there.normal)?;
        Some(map.normal(normal).0)
    }

    /// The instance's map, the triangle, and the surface in the part, whose normal is the mapped `facing`.
    fn in_part(
        &self,
        scene: &Scene<'_>,
        facing: [N; 3],
    ) -> Option<(Map<N>, SmoothTriangle, PlacedSurface<N>)> {
        let (instance, part) = find(scene, self.instance()?)?;
        let triangle = part
            .geometry
            .shapes
            .smooth_triangle(self.triangle_slot()?)?;
        let map = Map::<N>::new(instance);
        let there = map.in_part(&PlacedSurface {
            point: self.point,
            normal: facing,
            error: self.error,
        });
        Some((map, triangle, there))
    }

    /// The slot of a triangle with smooth normals.
    #[inline(always)]
    pub(super) fn triangle_slot(&self) -> Option<usize> {
        let leaf = Leaf::from_word(self.place)?;
        (leaf.kind == Kind::Triangle).then_some(leaf.first as usize)
    }
}
