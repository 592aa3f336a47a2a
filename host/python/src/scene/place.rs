//! Where rays meet triangles as they were given.

use super::NativeScene;
use crate::query::{Found, NONE};
use glam::DVec3;
use gridel_host::scene::Shape;
use gridel_host::trace::SceneRay;

impl NativeScene {
    /// The corners of a triangle of a mesh as they were given, by its number; `None` of other primitives, and of those of
    /// instances.
    pub(super) fn triangle(&self, primitive: u32) -> Option<[DVec3; 3]> {
        let model = self.model.as_ref()?;
        let object = self.firsts.partition_point(|&first| first <= primitive);
        let object = object.checked_sub(1)?;
        let Shape::Mesh {
            vertices,
            triangles,
        } = &model.objects.get(object)?.shape
        else {
            return None;
        };
        let corners = triangles.get((primitive - self.firsts[object]) as usize)?;
        Some(corners.map(|corner| vertices[corner as usize]))
    }

    /// Returns where a ray meets a triangle as it was given, in double precision, and the weights of its second and
    /// third corner. Uses the hit's own t where the triangle is not a mesh's, or is nearly parallel to the ray.
    // Inlining lets the compiler compute only the values that are used there.
    #[inline(always)]
    pub(super) fn place(&self, ray: &SceneRay, hit: &Found) -> (f64, DVec3, [f64; 2]) {
        let own = ray.origin + ray.direction * hit.t;
        if hit.instance != NONE {
            return (hit.t, own, [f64::NAN; 2]);
        }
        let Some([a, b, c]) = self.triangle(hit.primitive) else {
            return (hit.t, own, [f64::NAN; 2]);
        };
        let (to_b, to_c) = (b - a, c - a);
        let normal = to_b.cross(to_c);
        let approach = normal.dot(ray.direction);
        // Steeper than one in a thousand.
        let is_steep =
            approach * approach > 1e-6 * normal.length_squared() * ray.direction.length_squared();
        let (t, place) = if is_steep {
            let t = normal.dot(a - ray.origin) / approach;
            (t, ray.origin + ray.direction * t)
        } else {
            (hit.t, own)
        };
        let relative = place - a;
        let square = normal.length_squared();
        let weight = |area: DVec3| (area.dot(normal) / square).clamp(0.0, 1.0);
        let (u, v) = (weight(relative.cross(to_c)), weight(to_b.cross(relative)));
        (t, place, [u, v])
    }

    /// The t of a hit, and the weights of the corners of its triangle.
    pub(super) fn weights(&self, ray: &SceneRay, hit: &Found) -> (f64, [f32; 2]) {
        let (t, _, uv) = self.place(ray, hit);
        (t, uv.map(|weight| weight as f32))
    }
}
