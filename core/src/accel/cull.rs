//! Which boxes a ray can meet, in integers, whatever the number format of the ray.
//!
//! A plane at unit `p` on axis `k` is reached at `t = p * inverse[k] + offset[k]`, counted in
//! *culling steps* of half a unit along the ray's major axis. All values stay below 2^31: a slope
//! below 2^-12 is treated as 2^-12, so `inverse` (16 fraction bits) is at most 2^29.
//!
//! **Culling is conservative.** Let the ray's coordinate be `x(t) = o + s t` for `t` in
//! \[0, 2^16\] units, and a kernel's hits lie within 1/4 unit of it (see the lateral errors below).
//! For a slope of at least 2^-12 a box `[p, q]` widened by 1/4 unit is entered no earlier than
//! `(p - 1/4 - o) / s`; `near` holds `-(o + 1/4) / s` less three steps for the roundings of
//! `inverse` (half a step), of the product `o / s` (one) and of `p * inverse` (one), and `far`
//! the same outward. For a smaller slope `|s| < s' = 2^-12`, entry at `(p - o) / s'` is no later
//! than at `(p - o) / s` because both have the sign of `p - o` and t is not negative; and a box is
//! left no earlier than at `t = 2^16` or not before `(q - o) / s' + 2^16`, if it is met at all. So
//! `far` gets 2^17 steps more. No product is NaN and no case is special: boxes are closed, a ray
//! in a face meets the box, and an axis along which the ray does not move is a containment test
//! with 16 units to spare.
//!
//! Lateral errors: coordinates are below 2^17 units. `f32` rounds a projected coordinate by less
//! than 2^-4 unit and `o / s` by 2^-5; `fixed` by 2^-12 and 2^-13; `f64` by less than either.
//!
//! Values are monotone in `p`, so a child's interval lies in its parent's, whatever was rounded.

use crate::blob::record::UnitBox;
use crate::number::Number;
use crate::ray::Ray;

/// The culling form of a ray: 52 bytes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cull {
    /// Steps a unit with 16 fraction bits, a value an axis, with the slope's sign.
    inverse: [i32; 3],
    /// What the near plane's product lacks to the entry's step.
    near: [i32; 3],
    /// What the far plane's product lacks to the exit's step.
    far: [i32; 3],
    /// 16 where the ray runs down the axis and the planes of a word change roles, else 0.
    rotation: [u32; 3],
    /// The step at or below the ray's tmin.
    pub(crate) start: i32,
    /// The step above the ray's tmax.
    pub(crate) end: i32,
}

/// The steps at which a ray enters and leaves something; it misses where `near > far`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Interval {
    /// The first step.
    pub(crate) near: i32,
    /// The last step.
    pub(crate) far: i32,
}

/// The step above a length: anything that lies at most at `t` is entered at or before it.
#[inline(always)]
pub(crate) fn step_above<N: Number>(t: N) -> i32 {
    t.to_cull_floor().saturating_add(1)
}

impl Cull {
    /// Sets up a ray. Costs two divisions and some twenty operations.
    pub(crate) fn new<N: Number>(ray: &Ray<N>) -> Self {
        let mut cull = Self {
            start: ray.tmin.to_cull_floor(),
            end: step_above(ray.tmax),
            ..Self::default()
        };
        for axis in 0..3 {
            let slope = ray.slope[axis];
            let (inverse, offset) = N::cull_axis(slope, ray.origin[axis]);
            let margin = (inverse.abs() >> 18) + 3;
            let parallel = if inverse.abs() == 1 << 29 { 1 << 17 } else { 0 };
            cull.inverse[axis] = inverse;
            cull.near[axis] = -offset - margin;
            cull.far[axis] = -offset + margin + parallel;
            cull.rotation[axis] = if inverse < 0 { 16 } else { 0 };
        }
        cull
    }

    /// The near and the far plane of a word of two.
    #[inline(always)]
    fn order(&self, axis: usize, planes: u32) -> (i16, i16) {
        let ordered = planes.rotate_right(self.rotation[axis]);
        (ordered as i16, (ordered >> 16) as i16)
    }

    /// The steps at which the ray reaches the near and the far plane of a word of two.
    #[inline(always)]
    pub(crate) fn planes(&self, axis: usize, planes: u32) -> (i32, i32) {
        let (near, far) = self.order(axis, planes);
        let inverse = self.inverse[axis] as i64;
        let step = |plane: i16| ((inverse * plane as i64) >> 16) as i32;
        (step(near).wrapping_add(self.near[axis]), step(far).wrapping_add(self.far[axis]))
    }

    /// One bit an axis, set where the ray runs down it.
    #[inline(always)]
    pub(crate) fn descending(&self) -> u32 {
        (self.rotation[0] | self.rotation[1] << 1 | self.rotation[2] << 2) >> 4
    }

    /// The interval of a box, within the ray's own from `start` to `limit`.
    #[inline(always)]
    pub(crate) fn clip(&self, planes: &[u32; 3], start: i32, limit: i32) -> Interval {
        let (near_x, far_x) = self.planes(0, planes[0]);
        let (near_y, far_y) = self.planes(1, planes[1]);
        let (near_z, far_z) = self.planes(2, planes[2]);
        Interval {
            near: near_x.max(near_y).max(near_z.max(start)),
            far: far_x.min(far_y).min(far_z.min(limit)),
        }
    }

    /// The interval of a primitive's own box, tmin and tmax aside.
    #[inline(always)]
    pub(crate) fn interval(&self, bounds: &UnitBox) -> Interval {
        let words = bounds.0.map(crate::blob::record::plane_word);
        self.clip(&words, i32::MIN, i32::MAX)
    }
}
