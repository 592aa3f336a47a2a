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

use crate::blob::record::{Pair, UnitBox, plane_word};
use crate::number::Number;
use crate::ray::Ray;

/// The steps at which a ray enters and leaves something; it misses where `near > far`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Interval {
    /// The first step.
    pub near: i32,
    /// The last step.
    pub far: i32,
}

impl Interval {
    /// From where to where, in units, as events tell it.
    pub(crate) fn units(self) -> [f64; 2] {
        [self.near, self.far].map(|step| f64::from(step) / 2.0)
    }
}

/// A form of a ray that culls boxes: [`Cull`] in integers, or lanes of floats where there is SIMD.
pub trait Culling<N: Number>: Copy + core::fmt::Debug + Default + Send + Sync {
    /// Sets up a ray.
    fn new(ray: &Ray<N>) -> Self;
    /// The integer form, whose intervals hits are clamped to.
    fn exact(&self, ray: &Ray<N>) -> Cull;
    /// The interval of a box, from the ray's start up to a limit.
    fn root(&self, bounds: &UnitBox, limit: i32) -> Interval;
    /// The limit for hits at or before a length.
    fn limit(t: N) -> i32;
    /// The intervals of a pair's children, from the ray's start up to a limit.
    fn children(&self, pair: &Pair, limit: i32) -> [Interval; 2];
}

/// The culling form of a ray in integers: 52 bytes.
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
    start: i32,
}

impl<N: Number> Culling<N> for Cull {
    /// Costs two divisions and some twenty operations.
    #[inline(always)]
    fn new(ray: &Ray<N>) -> Self {
        let mut cull = Self {
            start: ray.tmin.to_cull(),
            ..Self::default()
        };
        for axis in 0..3 {
            let form = N::cull_axis(ray.slope[axis], ray.origin[axis]);
            cull.inverse[axis] = form.inverse;
            cull.near[axis] = form.near;
            cull.far[axis] = form.far;
            cull.rotation[axis] = (form.inverse >> 31) as u32 & 16;
        }
        cull
    }

    #[inline(always)]
    fn exact(&self, _: &Ray<N>) -> Cull {
        *self
    }

    #[inline(always)]
    fn root(&self, bounds: &UnitBox, limit: i32) -> Interval {
        let whole = self.interval(bounds);
        Interval {
            near: whole.near.max(self.start),
            far: whole.far.min(limit),
        }
    }

    #[inline(always)]
    fn limit(t: N) -> i32 {
        t.to_cull().saturating_add(1)
    }

    #[inline(always)]
    fn children(&self, pair: &Pair, limit: i32) -> [Interval; 2] {
        let mut children = [Interval {
            near: self.start,
            far: limit,
        }; 2];
        for axis in 0..3 {
            let [lower, upper] = pair.planes[axis];
            let descending = self.rotation[axis] != 0;
            let (near, far) = if descending {
                (upper, lower)
            } else {
                (lower, upper)
            };
            for (child, interval) in children.iter_mut().enumerate() {
                let near = self.step(axis, near[child]).wrapping_add(self.near[axis]);
                let far = self.step(axis, far[child]).wrapping_add(self.far[axis]);
                interval.near = interval.near.max(near);
                interval.far = interval.far.min(far);
            }
        }
        children
    }
}

impl Cull {
    /// A plane's product.
    #[inline(always)]
    fn step(&self, axis: usize, plane: i16) -> i32 {
        ((self.inverse[axis] as i64 * plane as i64) >> 16) as i32
    }

    /// The steps at which the ray reaches the near and the far plane of a word of two.
    #[inline(always)]
    pub(crate) fn planes(&self, axis: usize, planes: u32) -> (i32, i32) {
        let ordered = planes.rotate_right(self.rotation[axis]);
        let (near, far) = (ordered as i16, (ordered >> 16) as i16);
        (
            self.step(axis, near).wrapping_add(self.near[axis]),
            self.step(axis, far).wrapping_add(self.far[axis]),
        )
    }

    /// One bit an axis, set where the ray runs down it.
    #[inline(always)]
    pub(crate) fn descending(&self) -> u32 {
        (self.rotation[0] | self.rotation[1] << 1 | self.rotation[2] << 2) >> 4 & 7
    }

    /// The interval of a box, the ray's own aside.
    #[inline(always)]
    pub(crate) fn interval(&self, bounds: &UnitBox) -> Interval {
        let (near_x, far_x) = self.planes(0, plane_word(bounds.0[0]));
        let (near_y, far_y) = self.planes(1, plane_word(bounds.0[1]));
        let (near_z, far_z) = self.planes(2, plane_word(bounds.0[2]));
        Interval {
            near: near_x.max(near_y).max(near_z),
            far: far_x.min(far_y).min(far_z),
        }
    }
}

/// The form in which rays of a float format cull on this machine.
///
/// Cores with SIMD registers take four planes at a time, the others integers. Neither can change
/// an answer; only how many boxes are visited for nothing may differ, by the width of a margin.
#[cfg(any(
    target_arch = "x86_64",
    target_arch = "aarch64",
    all(target_arch = "wasm32", target_feature = "simd128")
))]
pub(crate) type FloatCulling = super::lanes::Lanes;
/// The form in which rays of a float format cull on this machine.
#[cfg(not(any(
    target_arch = "x86_64",
    target_arch = "aarch64",
    all(target_arch = "wasm32", target_feature = "simd128")
)))]
pub(crate) type FloatCulling = Cull;

#[cfg(test)]
mod tests;
