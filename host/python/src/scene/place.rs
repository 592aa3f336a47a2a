//! Where rays meet triangles as they were given.

use super::NativeScene;
use crate::query::{Found, NONE};
use crate::rays::Rays;
use glam::DVec3;
use gridel_host::scene::Shape;
use gridel_host::trace::SceneRay;

/// Where a ray meets a triangle: its t, the place, and the weights of the second and third corner.
type Meeting = (f64, DVec3, [f64; 2]);

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
        } = &model.scene.objects.get(object)?.shape
        else {
            return None;
        };
        let corners = triangles.get((primitive - self.firsts[object]) as usize)?;
        Some(corners.map(|corner| vertices[corner as usize]))
    }

    /// Where a ray meets a triangle as it was given, in double precision; by the hit's own t where the triangle is not a
    /// mesh's, or nearly parallel to the ray. Never outside of the ray's interval.
    // Inlined, it computes what is used there, and nothing else.
    #[inline(always)]
    pub(super) fn place(&self, ray: &SceneRay, hit: &Found) -> Meeting {
        let triangle = match hit.instance {
            NONE => self.triangle(hit.primitive),
            _ => None,
        };
        let Some(corners) = triangle else {
            let t = ray.within(hit.t);
            return (t, ray.origin + ray.direction * t, [f64::NAN; 2]);
        };
        let [a, b, c] = corners;
        let is_ordinary = (b - a).cross(c - a).length_squared().is_normal()
            && (a - ray.origin).abs().max_element() < self.middle.far;
        if is_ordinary {
            meet(corners, ray, hit.t)
        } else {
            self.meet_extreme(corners, *ray, hit.t)
        }
    }

    /// [`meet`] for a triangle whose area leaves double precision, or a ray from far away, as precise as from near.
    #[cold]
    #[inline(never)]
    fn meet_extreme(&self, corners: [DVec3; 3], ray: SceneRay, own: f64) -> Meeting {
        let (near, begin) = self.middle.nearer(&ray);
        let [a, b, c] = corners;
        let size = (b - a).abs().max((c - a).abs()).max_element();
        // A power of two, so that it rounds nothing.
        let scale = (-size.log2().round()).exp2();
        let scaled = SceneRay {
            origin: near.origin * scale,
            direction: near.direction * scale,
            ..near
        };
        let (t, place, weights) = meet(corners.map(|it| it * scale), &scaled, own - begin);
        (ray.within(begin + t), place / scale, weights)
    }

    /// The t of a hit, and the weights of the corners of its triangle.
    #[inline(always)]
    pub(super) fn weights(&self, ray: &SceneRay, hit: &Found) -> (f64, [f32; 2]) {
        let (t, _, uv) = self.place(ray, hit);
        (t, uv.map(|weight| weight as f32))
    }

    /// Gives the hits of rays, ray by ray in their order, their t, and returns the weights of the corners of their
    /// triangles. Triangles closer to each other than the lattice moved them keep the order in which they are hit.
    pub(super) fn place_all(&self, rays: Rays<'_>, hits: &mut [(usize, Found)]) -> Vec<[f32; 2]> {
        let mut last = (usize::MAX, f64::NEG_INFINITY);
        let placed = hits.iter_mut().map(|(number, hit)| {
            let (t, _, uv) = self.place(&rays.get(*number), hit);
            hit.t = if last.0 == *number { t.max(last.1) } else { t };
            last = (*number, hit.t);
            uv.map(|weight| weight as f32)
        });
        placed.collect()
    }
}

/// Where a ray meets a triangle, by a t of its own where it is nearly parallel.
#[inline(always)]
fn meet([a, b, c]: [DVec3; 3], ray: &SceneRay, own: f64) -> Meeting {
    let (to_b, to_c) = (b - a, c - a);
    let normal = to_b.cross(to_c);
    let square = normal.length_squared();
    let approach = normal.dot(ray.direction);
    // Steeper than one in a thousand.
    let is_steep = approach * approach > 1e-6 * square * ray.direction.length_squared();
    let t = if is_steep {
        normal.dot(a - ray.origin) / approach
    } else {
        own
    };
    let t = ray.within(t);
    let place = ray.origin + ray.direction * t;
    let relative = place - a;
    let weight = |area: DVec3| (area.dot(normal) / square).clamp(0.0, 1.0);
    let weights = [weight(relative.cross(to_c)), weight(to_b.cross(relative))];
    (t, place, weights)
}
