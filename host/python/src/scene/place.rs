//! Where rays meet triangles as they were given.

use super::NativeScene;
use crate::query::{Hit, NONE, Placed};
use crate::rays::Rays;
use glam::DVec3;
use gridel_host::scene::Shape;
use gridel_host::trace::SceneRay;
use std::collections::TryReserveError;

/// Weights of corners below which a place is beside its triangle, by more than is rounded.
const BESIDE: f64 = 1e-6;

/// Where a ray meets a triangle.
pub(super) struct Meeting {
    pub t: f64,
    pub place: DVec3,
    /// The weights of the second and third corner.
    weights: [f64; 2],
    /// The normal, with length 1.
    normal: Option<DVec3>,
}

impl NativeScene {
    /// True if [`corners`](Self::corners) has the corners of whatever rays hit.
    pub(super) fn has_all_triangles(&self) -> bool {
        self.model
            .as_ref()
            .is_some_and(|model| model.file.is_none())
    }

    /// Starts to load the triangle of a hit: those of rays side by side are far apart in memory.
    #[inline(always)]
    pub(super) fn load_ahead(&self, hit: &Hit) {
        #[cfg(target_arch = "x86_64")]
        if hit.primitive != NONE
            && hit.instance == NONE
            && let Some(corners) = self.corners(hit.primitive)
        {
            corners.into_iter().for_each(gridel_cpu::prefetch);
        }
        #[cfg(not(target_arch = "x86_64"))]
        let _ = hit;
    }

    /// The corners of a triangle of a mesh as they were given, by its number; `None` of other primitives, and of those of
    /// instances.
    #[inline(always)]
    fn corners(&self, primitive: u32) -> Option<[&DVec3; 3]> {
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
        let [a, b, c] = *triangles.get((primitive - self.firsts[object]) as usize)?;
        let corner = |number: u32| vertices.get(number as usize);
        Some([corner(a)?, corner(b)?, corner(c)?])
    }

    /// Where a ray meets a triangle as it was given, in double precision; by the hit's own t where the triangle is not a
    /// mesh's, or the ray passes beside it. Never outside of the ray's interval.
    // Inlined, it computes what is used there, and nothing else.
    #[inline(always)]
    pub(super) fn place(&self, ray: &SceneRay, hit: &Hit) -> Meeting {
        let triangle = match hit.instance {
            NONE => self.corners(hit.primitive),
            _ => None,
        };
        let Some(corners) = triangle else {
            let t = ray.within(hit.t);
            return Meeting {
                t,
                place: ray.origin + ray.direction * t,
                weights: [f64::NAN; 2],
                normal: None,
            };
        };
        // One by one, because copies of what was just written in parts are slow.
        let [a, b, c] = corners;
        let (a, b, c) = (*a, *b, *c);
        // Products of two such squares stay in double precision.
        let ordinary = 1e-140..1e140;
        let is_ordinary = ordinary.contains(&(b - a).cross(c - a).length_squared())
            && ordinary.contains(&ray.direction.length_squared())
            && (a - ray.origin).abs().max_element() < self.middle.far;
        if is_ordinary {
            meet([a, b, c], ray, (hit.t, self.moved))
        } else {
            self.meet_extreme([a, b, c], *ray, hit.t)
        }
    }

    /// [`meet`] for a triangle or a direction of an extreme size, or a ray from far away, as precise as from near.
    #[cold]
    #[inline(never)]
    fn meet_extreme(&self, corners: [DVec3; 3], ray: SceneRay, own: f64) -> Meeting {
        let (near, begin) = self.middle.nearer(&ray);
        let [a, b, c] = corners;
        let size = (b - a).abs().max((c - a).abs()).max_element();
        // Powers of two, so that they round nothing.
        let to_one = |size: f64| (-size.log2().round()).clamp(-1000.0, 1000.0).exp2();
        let scale = to_one(size);
        let stretch = to_one(near.direction.abs().max_element());
        let scaled = SceneRay {
            origin: near.origin * scale,
            direction: near.direction * stretch * scale,
            tmin: near.tmin / stretch,
            tmax: near.tmax / stretch,
        };
        let own = (own - begin) / stretch;
        let moved = self.moved * scale;
        let met = meet(corners.map(|it| it * scale), &scaled, (own, moved));
        Meeting {
            t: ray.within(begin + met.t * stretch),
            place: met.place / scale,
            ..met
        }
    }

    /// The t and normal of a hit, and the weights of the corners of its triangle.
    #[inline(always)]
    pub(super) fn placed(&self, ray: &SceneRay, hit: &Hit) -> Placed {
        let met = self.place(ray, hit);
        Placed {
            t: met.t,
            uv: met.weights.map(|weight| weight as f32),
            normal: met.normal.map(|normal| normal.as_vec3().to_array()),
        }
    }

    /// Gives the hits of rays, ray by ray in their order, their t and normals, and returns the weights of the corners of
    /// their triangles. Leaves out what lies beyond the limits of rays. Triangles closer to each other than the lattice
    /// moved them keep the order in which they are hit.
    pub(super) fn place_all(
        &self,
        rays: Rays<'_>,
        hits: &mut Vec<(usize, Hit)>,
    ) -> Result<Vec<[f32; 2]>, TryReserveError> {
        let mut all = Vec::new();
        all.try_reserve_exact(hits.len())?;
        let mut last = (usize::MAX, f64::NEG_INFINITY);
        hits.retain_mut(|(number, hit)| {
            let placed = self.placed(&rays.searched(*number), hit);
            if !rays.holds(*number, placed.t) {
                return false;
            }
            hit.t = placed.t;
            if last.0 == *number {
                hit.t = hit.t.max(last.1);
            }
            last = (*number, hit.t);
            hit.normal = placed.normal.unwrap_or(hit.normal);
            all.push(placed.uv);
            true
        });
        Ok(all)
    }
}

/// Where a ray meets a triangle; `own` is the hit's t as the query has it, and `moved` how far the lattice may have moved
/// the triangle.
#[inline(always)]
fn meet(corners: [DVec3; 3], ray: &SceneRay, (own, moved): (f64, f64)) -> Meeting {
    let [a, b, c] = corners;
    let (to_b, to_c) = (b - a, c - a);
    let normal = to_b.cross(to_c);
    let square = normal.length_squared();
    let approach = normal.dot(ray.direction);
    // Steeper than one in a thousand.
    let is_steep = approach * approach > 1e-6 * square * ray.direction.length_squared();
    let inverse = 1.0 / square;
    let weights_at = |place: DVec3| {
        let relative = place - a;
        [
            relative.cross(to_c).dot(normal) * inverse,
            to_b.cross(relative).dot(normal) * inverse,
        ]
    };
    let mut t = ray.within(normal.dot(a - ray.origin) / approach);
    let mut place = ray.origin + ray.direction * t;
    let mut weights = weights_at(place);
    let [of_b, of_c] = weights;
    let is_beside = of_b.min(of_c).min(1.0 - of_b - of_c) < -BESIDE;
    if is_beside || !is_steep {
        let margin = if is_steep { moved } else { 0.0 };
        t = ray.within(meet_near(corners, (normal, approach), ray, (own, margin)));
        place = ray.origin + ray.direction * t;
        weights = weights_at(place);
        let [of_b, of_c] = weights;
        if of_b.min(of_c).min(1.0 - of_b - of_c) < -BESIDE {
            weights = nearest(corners, place);
        }
    }
    let of_b = weights[0].clamp(0.0, 1.0);
    let of_c = weights[1].clamp(0.0, 1.0).min(1.0 - of_b);
    // A triangle without an area, of which the lattice made one, has any normal across its longer side.
    let across = || {
        let is_longer = to_c.length_squared() > to_b.length_squared();
        if is_longer { to_c } else { to_b }.any_orthogonal_vector()
    };
    Meeting {
        t,
        place,
        weights: [of_b, of_c],
        normal: if square >= f64::MIN_POSITIVE {
            Some(normal * inverse.sqrt())
        } else {
            across().try_normalize()
        },
    }
}

/// The weights of the second and third corner at the point of a triangle's sides that is nearest to a place. Weights that
/// are cut off one by one are those of a point far away, if the triangle is narrow.
#[cold]
#[inline(never)]
fn nearest(corners: [DVec3; 3], place: DVec3) -> [f64; 2] {
    let mut least = f64::INFINITY;
    let mut weights = [0.0; 3];
    for side in 0..3 {
        let next = (side + 1) % 3;
        let along = corners[next] - corners[side];
        let from = place - corners[side];
        let part = from.dot(along) / along.length_squared();
        // Not a number where two corners are in one place.
        let part = if part.is_nan() {
            0.0
        } else {
            part.clamp(0.0, 1.0)
        };
        let distance = (from - along * part).length_squared();
        if distance < least {
            least = distance;
            weights = [0.0; 3];
            (weights[side], weights[next]) = (1.0 - part, part);
        }
    }
    [weights[1], weights[2]]
}

/// The t at which a ray meets the plane of a triangle, or the nearest t at which it is above or below the triangle made
/// wider by a margin: the lattice may have moved the triangle so that the ray meets the plane far beside it. The hit's own
/// t where it never is.
#[cold]
#[inline(never)]
fn meet_near(
    corners: [DVec3; 3],
    (normal, approach): (DVec3, f64),
    ray: &SceneRay,
    (own, margin): (f64, f64),
) -> f64 {
    let [mut enters, mut leaves] = [f64::NEG_INFINITY, f64::INFINITY];
    for side in 0..3 {
        let [from, to] = [corners[side], corners[(side + 1) % 3]];
        let inward = normal.cross(to - from);
        let height = inward.dot(ray.origin - from) + margin * inward.length();
        let change = inward.dot(ray.direction);
        let crosses = -height / change;
        if change > 0.0 {
            enters = enters.max(crosses);
        } else if change < 0.0 {
            leaves = leaves.min(crosses);
        } else if height < 0.0 {
            return own;
        }
    }
    let t = match approach {
        0.0 => own,
        _ => normal.dot(corners[0] - ray.origin) / approach,
    };
    if enters <= leaves {
        t.clamp(enters, leaves)
    } else {
        own
    }
}
