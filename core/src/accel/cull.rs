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
//! Values are monotone in `p`, so a child's interval lies in its parent's, whatever was rounded. Hits lie
//! in these intervals or are clamped to them; what cores walk with may be wider, never narrower.

use crate::axis::pick;
use crate::format::record::{Gridels, Pair, UnitBox, plane_word};
use crate::number::{CullAxis, NARROW_PRODUCTS, Number};
use crate::ray::Ray;

/// The steps at which a ray enters and leaves something; it misses where `near > far`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Interval {
    /// The first step.
    pub near: i32,
    /// The last step.
    pub far: i32,
}

/// A form of a ray that culls boxes: [`Cull`] in integers, or lanes of floats where there is SIMD.
pub trait Culling<N: Number>: Copy + core::fmt::Debug + Default + Send + Sync {
    /// Sets up a ray.
    fn new(ray: &Ray<N>) -> Self;
    /// The integer form, whose intervals hits are clamped to.
    fn exact(&self, ray: &Ray<N>) -> Cull;
    /// What stands for a place on the ray in this form, in units, as events tell it.
    fn units(place: i32) -> f64;
    /// Whether t is certain to stay as it is, or below 0 where it is below 0, when it is clamped to
    /// the integer form's interval of a box; where that is cheaper to see than to set up that form.
    #[inline(always)]
    fn holds(_: &Ray<N>, _: N, _: &UnitBox) -> bool {
        false
    }
    /// Whether a ray has no hit up to a t in the box of a primitive whose test takes long; asked where
    /// no box was culled before.
    #[inline(always)]
    fn misses(_: &Ray<N>, _: N, _: &UnitBox) -> bool {
        false
    }
}

/// A form of a ray that culls the boxes of pairs.
pub trait PairCulling<N: Number>: Culling<N> {
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

impl<N: Number> Culling<N> for Cull {
    /// Costs three divisions and some fifty operations.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn new(ray: &Ray<N>) -> Self {
        let axis = |k: usize| N::cull_axis(ray.slope[k], ray.origin[k]);
        Self {
            axes: [axis(0), axis(1), axis(2)],
            start: ray.tmin.to_cull(),
        }
    }

    #[inline(always)]
    fn exact(&self, _: &Ray<N>) -> Cull {
        *self
    }

    fn units(step: i32) -> f64 {
        Self::told(step)
    }
}

impl<N: Number> PairCulling<N> for Cull {
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

/// The form of rays that walk lists of candidates and cull no boxes: nothing, until a hit lies so
/// near the side of its primitive's box that the integer form has to tell.
#[derive(Clone, Copy, Debug, Default)]
pub struct Deferred;

impl<N: Number> Culling<N> for Deferred {
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn new(_: &Ray<N>) -> Self {
        Self
    }

    // Out of line, because hardly any hit comes this far.
    #[inline(never)]
    fn exact(&self, ray: &Ray<N>) -> Cull {
        Culling::<N>::new(ray)
    }

    fn units(step: i32) -> f64 {
        Cull::told(step)
    }

    #[inline(always)]
    fn holds(ray: &Ray<N>, t: N, bounds: &UnitBox) -> bool {
        holds(ray, t, bounds)
    }

    /// The box is widened by more than a hit can lie beside it ([`Gridels::SPARE`] units, see
    /// [`gridels`](crate::accel::candidates::gridels)) and by what these few operations round, less than a unit. Seen along
    /// the major axis, on which a step is a step of t, the line moves on another axis by its slope
    /// there: what lies farther from the box's middle than half the box and half of that is beside it.
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

/// Where the upper half of a product comes for nothing, and there is no instruction for the upper
/// 32 of 48 bits, as the extension for signal processing has it: small cores without floats.
const UPPER_HALF: bool = cfg!(any(
    all(target_arch = "arm", not(target_abi = "eabihf")),
    target_arch = "riscv32"
));

/// Whether there is an instruction that rotates.
const ROTATES: bool = !cfg!(target_arch = "riscv32");

impl CullAxis {
    /// The step at which the ray enters through a plane.
    #[inline(always)]
    pub(crate) fn entry(&self, plane: i16) -> i32 {
        self.step(plane).wrapping_add(self.near)
    }

    /// The step at which the ray leaves through a plane.
    #[inline(always)]
    pub(crate) fn exit(&self, plane: i16) -> i32 {
        self.step(plane).wrapping_add(self.far)
    }

    /// Whether the ray runs down the axis.
    #[inline(always)]
    pub(crate) fn descends(&self) -> bool {
        self.rotation != 0
    }

    /// The upper half of a plane's product, the plane being the upper half of a word.
    #[inline(always)]
    fn upper_half(&self, word: u32) -> i32 {
        ((self.inverse as i64 * word as i32 as i64) >> 32) as i32
    }

    /// A plane's product: the upper bits of 48.
    #[inline(always)]
    fn step(&self, plane: i16) -> i32 {
        if NARROW_PRODUCTS {
            // Both products fit 32 bits.
            let (high, low) = (self.inverse >> 16, self.inverse & 0xffff);
            let plane = plane as i32;
            high.wrapping_mul(plane)
                .wrapping_add(low.wrapping_mul(plane) >> 16)
        } else if UPPER_HALF {
            self.upper_half((plane as u32) << 16)
        } else {
            ((self.inverse as i64 * plane as i64) >> 16) as i32
        }
    }

    /// The two planes of a word in the order in which the ray comes to them.
    #[inline(always)]
    pub(crate) fn ordered(&self, planes: u32) -> [i16; 2] {
        let ordered = planes.rotate_right(self.rotation);
        [ordered as i16, (ordered >> 16) as i16]
    }

    /// The steps at which the ray enters and leaves between the two planes of a word.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn between(&self, planes: u32) -> Interval {
        let [near, far] = self.ordered(planes);
        Interval {
            near: self.entry(near),
            far: self.exit(far),
        }
    }

    /// The same to cull with: up to a unit wider, where that is cheaper.
    #[inline(always)]
    pub(crate) fn around(&self, planes: u32) -> Interval {
        if ROTATES {
            self.between(planes)
        } else {
            self.around_by_shifts(planes)
        }
    }

    /// Each plane is shifted into the upper half of a word. Below it lies the other one or nothing, so that
    /// it counts as up to a unit higher. Below another lies the lower half of the given word alone: its
    /// upper half is where the ray leaves if it runs up the axis, and where it enters if it runs down.
    /// Either way the interval grows.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn around_by_shifts(&self, planes: u32) -> Interval {
        let near = planes.wrapping_shl(self.rotation ^ 16);
        let far = planes.wrapping_shl(self.rotation);
        Interval {
            near: self.upper_half(near).wrapping_add(self.near),
            far: self.upper_half(far).wrapping_add(self.far),
        }
    }
}

impl Interval {
    /// What two intervals share.
    #[inline(always)]
    pub(crate) fn and(self, other: Self) -> Self {
        Self {
            near: self.near.max(other.near),
            far: self.far.min(other.far),
        }
    }
}

impl Cull {
    /// A step in units.
    fn told(step: i32) -> f64 {
        f64::from(step) / 2.0
    }

    /// From where to where in units, as events tell it.
    pub(crate) fn span(interval: Interval) -> [f64; 2] {
        [interval.near, interval.far].map(Self::told)
    }

    /// The step at which the ray enters what begins at a plane, as it comes along an axis.
    #[inline(always)]
    pub(super) fn enters(&self, axis: usize, plane: i16) -> i32 {
        self.axes[axis].entry(plane)
    }

    /// The step at which the ray leaves what ends at a plane, as it comes along an axis.
    #[inline(always)]
    pub(super) fn leaves(&self, axis: usize, plane: i16) -> i32 {
        self.axes[axis].exit(plane)
    }

    /// Whether the ray runs down an axis.
    #[inline(always)]
    pub(super) fn descends(&self, axis: usize) -> bool {
        self.axes[axis].descends()
    }

    /// The step at which the ray starts.
    #[inline(always)]
    pub(super) fn start(&self) -> i32 {
        self.start
    }

    /// One bit an axis, set where the ray runs down it.
    #[inline(always)]
    pub(crate) fn descending(&self) -> u32 {
        let [x, y, z] = self.axes.map(|axis| axis.rotation);
        (x | y << 1 | z << 2) >> 4 & 7
    }

    /// The interval of a box, the ray's own aside.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn interval(&self, bounds: &UnitBox) -> Interval {
        let axis = |k: usize| self.axes[k].between(plane_word(bounds.0[k]));
        axis(0).and(axis(1)).and(axis(2))
    }
}

/// [`Culling::holds`] for float formats: the point lies within 1/8 unit of the box, and rounding
/// moved it by less than 2^-6, which is nearer than the 1/4 unit by which intervals are widened.
///
/// So a t that is not negative lies in the interval. Of one that is, the point lies behind the
/// origin, which so has no plane of the box farther ahead than 1/4 unit: every axis is entered below
/// 0, and so are the interval's start and whatever t is clamped to.
#[inline(always)]
pub(crate) fn holds<N: Number>(ray: &Ray<N>, t: N, bounds: &UnitBox) -> bool {
    let eighth = N::from_lattice(32);
    let within = |axis: usize| {
        let [low, high] = bounds.0[axis].map(N::from_unit);
        let along = ray.origin[axis] + t * ray.slope[axis];
        along >= low - eighth && along <= high + eighth
    };
    within(0) && within(1) && within(2)
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
pub(crate) type FloatCulling = crate::accel::lanes::Lanes;
/// The form in which rays of a float format cull on this machine.
#[cfg(not(any(
    target_arch = "x86_64",
    target_arch = "aarch64",
    all(target_arch = "wasm32", target_feature = "simd128")
)))]
pub(crate) type FloatCulling = Cull;

#[cfg(test)]
mod tests;
