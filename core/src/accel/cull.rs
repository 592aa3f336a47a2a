//! Culling of boxes in integers, for rays of every number format.
//!
//! A plane at unit `p` on axis `k` is reached at `t = p * inverse[k] + offset[k]`, counted in
//! *culling steps* of half a unit along the ray's major axis. All values stay below 2^31: a slope
//! below 2^-12 is treated as 2^-12, so `inverse` (16 fraction bits) is at most 2^29.
//!
//! **Culling is conservative.** Let the ray's coordinate be `x(t) = o + s t` for `t` in \[0, 2^16\] units. Let a
//! kernel's hits lie within 1/4 unit of it (see the lateral errors below).
//!
//! - For a slope of at least 2^-12, a box `[p, q]` widened by 1/4 unit is entered no earlier than `(p - 1/4 - o) / s`.
//!   `near` holds `-(o + 1/4) / s` less three steps for the roundings of `inverse` (half a step), of the product
//!   `o / s` (one) and of `p * inverse` (one). `far` holds the same outward.
//! - For a smaller slope `|s| < s' = 2^-12`, entry at `(p - o) / s'` is no later than at `(p - o) / s`. Both have the
//!   sign of `p - o`, and t is not negative. A box that the ray meets is left no earlier than at `t = 2^16`, or not
//!   before `(q - o) / s' + 2^16`. So `far` gets 2^17 steps more.
//!
//! No product is NaN and no case is special. Boxes are closed, so a ray in a face meets the box. An axis along which
//! the ray does not move is a containment test with a margin of 16 units.
//!
//! Lateral errors: coordinates are below 2^17 units. `f32` rounds a projected coordinate by less
//! than 2^-4 unit and `o / s` by 2^-5; `fixed` by 2^-12 and 2^-13; `f64` by less than either.
//!
//! Values are monotone in `p`, so a child's interval lies in its parent's, whatever was rounded. Hits lie in these
//! intervals or are clamped to them. The intervals with which cores walk can be wider, never narrower.

use crate::accel::cull_axis::CullArithmetic;
use crate::accel::cull_axis::CullAxis;
use crate::accel::cull_axis::Interval;
use crate::axis::pick;
use crate::format::record::{Gridels, Pair, UnitBox, plane_word};
use crate::ray::Ray;
use crate::target::inline_unless_small;

/// A form of a ray that culls boxes: [`Cull`] in integers, or SIMD lanes of floats.
pub trait Culling<N: CullArithmetic>: Copy + core::fmt::Debug + Default + Send + Sync {
    /// Sets up a ray.
    fn new(ray: &Ray<N>) -> Self;
    /// The integer form, to whose intervals hits are clamped.
    fn exact(&self, ray: &Ray<N>) -> Cull;
    /// Returns a place on the ray in units, from its form here; for events.
    fn units(place: i32) -> f64;
    /// Returns true if clamping to the integer form's interval of a box certainly keeps t, or keeps a t below 0
    /// below 0. Returns true only where this test is cheaper than to set up the integer form.
    #[inline(always)]
    fn holds(_: &Ray<N>, _: N, _: &UnitBox) -> bool {
        false
    }

    /// Returns true if a ray has no hit up to a t in the box of a primitive whose test is expensive. Called where no
    /// box was culled before.
    #[inline(always)]
    fn misses(_: &Ray<N>, _: N, _: &UnitBox) -> bool {
        false
    }
}

/// A form of a ray that culls the boxes of pairs.
pub trait PairCulling<N: CullArithmetic>: Culling<N> {
    /// The interval of a box, from the ray's start up to a limit.
    fn root(&self, bounds: &UnitBox, limit: i32) -> Interval;
    /// The limit for hits at or before a length.
    fn limit(t: N) -> i32;
    /// The intervals of a pair's children, from the ray's start up to a limit.
    fn children(&self, pair: &Pair, limit: i32) -> [Interval; 2];
}

/// The culling form of a ray in integers: 52 bytes.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct Cull {
    /// The step at or below the ray's tmin.
    start: i32,
    pub(crate) axes: [CullAxis; 3],
}

impl<N: CullArithmetic> Culling<N> for Cull {
    inline_unless_small!(
        /// Costs three divisions and some fifty operations.
        fn new(ray: &Ray<N>) -> Self {
            let axis = |k: usize| N::cull_axis(ray.slope[k], ray.origin[k]);
            Self {
                axes: [axis(0), axis(1), axis(2)],
                start: ray.tmin.to_cull(),
            }
        }
    );

    #[inline(always)]
    fn exact(&self, _: &Ray<N>) -> Cull {
        *self
    }

    fn units(step: i32) -> f64 {
        Self::units_of(step)
    }
}

impl<N: CullArithmetic> PairCulling<N> for Cull {
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
        for (axis, [lower, upper]) in self.axes.iter().zip(pair.planes) {
            let (near, far) = if axis.rotation != 0 {
                (upper, lower)
            } else {
                (lower, upper)
            };
            for (child, interval) in children.iter_mut().enumerate() {
                interval.near = interval.near.max(axis.entry(near[child]));
                interval.far = interval.far.min(axis.exit(far[child]));
            }
        }
        children
    }
}

/// The form of rays that walk lists of candidates and cull no boxes. It is empty until a hit lies so near a side of its
/// primitive's box that the integer form must decide.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoBoxCulling;

impl<N: CullArithmetic> Culling<N> for NoBoxCulling {
    inline_unless_small!(
        fn new(_: &Ray<N>) -> Self {
            Self
        }
    );

    // Out of line, because hardly any hit needs it.
    #[inline(never)]
    fn exact(&self, ray: &Ray<N>) -> Cull {
        Culling::<N>::new(ray)
    }

    fn units(step: i32) -> f64 {
        Cull::units_of(step)
    }

    #[inline(always)]
    fn holds(ray: &Ray<N>, t: N, bounds: &UnitBox) -> bool {
        holds(ray, t, bounds)
    }

    /// The box is widened by more than the distance of a hit from it ([`Gridels::SPARE`] units, see
    /// [`gridels`](crate::accel::candidates::gridels)). It is also widened by the rounding of these few operations,
    /// less than a unit. Along the major axis, a step is a step of t. The line moves on another axis by its slope
    /// there. The ray misses the box if it lies farther from the box's middle than half the box and half of that move.
    ///
    /// Cost: four multiplications.
    #[inline(always)]
    fn misses(ray: &Ray<N>, tmax: N, bounds: &UnitBox) -> bool {
        /// In 1/256 unit.
        const SPARE: i32 = (Gridels::SPARE as i32 + 2) << 8;
        let axis = |k: usize| {
            let [low, high] = pick(bounds.0, k).map(i32::from);
            let middle = N::from_lattice(low.wrapping_add(high).wrapping_shl(7));
            let half = high.wrapping_sub(low).wrapping_shl(7).wrapping_add(SPARE);
            (middle - pick(ray.origin, k), N::from_lattice(half))
        };
        let (ahead, deep) = axis(ray.major);
        let t = if pick(ray.slope, ray.major) < N::ZERO {
            -ahead
        } else {
            ahead
        };
        let beside = |k: usize| {
            let ((aside, half), slope) = (axis(k), pick(ray.slope, k));
            (aside - t * slope).abs() > half + deep * slope.abs()
        };
        let [a, b] = Gridels::across(ray.major);
        t + deep < ray.tmin || t - deep > tmax || beside(a) || beside(b)
    }
}

impl Cull {
    /// A step in units.
    fn units_of(step: i32) -> f64 {
        f64::from(step) / 2.0
    }

    /// The first and the last place in units, as events report them.
    pub(crate) fn span(interval: Interval) -> [f64; 2] {
        [interval.near, interval.far].map(Self::units_of)
    }

    /// Returns the step at which the ray enters a box whose near plane this is, along an axis.
    #[inline(always)]
    pub(super) fn enters(&self, axis: usize, plane: i16) -> i32 {
        self.axes[axis].entry(plane)
    }

    /// Returns the step at which the ray leaves a box whose far plane this is, along an axis.
    #[inline(always)]
    pub(super) fn leaves(&self, axis: usize, plane: i16) -> i32 {
        self.axes[axis].exit(plane)
    }

    /// Returns true if the ray runs down the axis.
    #[inline(always)]
    pub(super) fn descends(&self, axis: usize) -> bool {
        self.axes[axis].descends()
    }

    /// The step at which the ray starts.
    #[inline(always)]
    pub(super) fn start(&self) -> i32 {
        self.start
    }

    /// Returns one bit per axis, set if the ray runs down it.
    #[inline(always)]
    pub(crate) fn descending(&self) -> u32 {
        let [x, y, z] = self.axes.map(|axis| axis.rotation);
        (x | y << 1 | z << 2) >> 4 & 7
    }

    inline_unless_small!(
        /// Returns the interval of a box, without the ray's own limits.
        pub(crate) fn interval(&self, bounds: &UnitBox) -> Interval {
            let axis = |k: usize| self.axes[k].between(plane_word(bounds.0[k]));
            axis(0).and(axis(1)).and(axis(2))
        }
    );
}

/// [`Culling::holds`] for float formats. The point lies within 1/8 unit of the box, and rounding moved it by less than
/// 2^-6. That is less than the 1/4 unit by which intervals are widened.
///
/// So a t that is not negative lies in the interval. For a negative t, the point lies behind the origin. So no plane of
/// the box lies farther ahead of the origin than 1/4 unit, and the ray enters every axis below 0. So the start of the
/// interval is below 0, and a clamped t is too.
#[inline(always)]
pub(crate) fn holds<N: CullArithmetic>(ray: &Ray<N>, t: N, bounds: &UnitBox) -> bool {
    let eighth = N::from_lattice(32);
    let within = |axis: usize| {
        let [low, high] = bounds.0[axis].map(N::from_unit);
        let along = ray.origin[axis] + t * ray.slope[axis];
        along >= low - eighth && along <= high + eighth
    };
    within(0) && within(1) && within(2)
}

#[cfg(test)]
mod tests;
