//! The arithmetic of a kernel: one sealed trait, three number formats.
//!
//! Every kernel is written once, over [`Number`], and reads the same in `fixed`, `f32` and `f64`.
//! A number stands for one of four quantities. In the float formats all four are plain floats; in
//! [`Fixed`] each has its own binary point, and the operations are defined so that the same
//! expression keeps it:
//!
//! | quantity | unit | [`Fixed`] | range |
//! |---|---|---|---|
//! | length (coordinate, t, radius) | one step of the 16-bit box lattice, the *unit* | 13 fraction bits | +-2^18 units |
//! | ratio (slope, cosine, reflectance) | 1 | 30 fraction bits | -2 to 2 |
//! | radiance | display white | 20 fraction bits | +-2048 |
//! | [`Number::Wide`] (any product of two of these, a far coordinate) | | an `i64` | |
//!
//! The operator `*` multiplies by a *ratio*: length by ratio is a length, ratio by ratio a ratio,
//! radiance by ratio a radiance. Products of two lengths go through [`Number::wide`].
//!
//! The operators of [`Fixed`] wrap and never panic. That no kernel wraps is a matter of ranges,
//! which the ray's set-up establishes (see [`crate::ray`]) and every kernel keeps.

mod fixed;
mod float;

pub use fixed::Fixed;
pub(crate) use fixed::product;

use crate::accel::cull::PairCulling;
#[cfg(feature = "wide")]
use crate::accel::wide::cull::WideCulling;
use core::fmt::Debug;
use core::ops::{Add, Mul, Neg, Sub};

/// Which arithmetic a kernel runs in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Integers only: no floating-point instruction from the camera to the pixel.
    Fixed,
    /// IEEE 754 single precision.
    F32,
    /// IEEE 754 double precision.
    F64,
}

impl Format {
    /// All formats, in the order of their names.
    pub const ALL: [Format; 3] = [Format::Fixed, Format::F32, Format::F64];

    /// The name that command lines and tables use.
    pub const fn name(self) -> &'static str {
        match self {
            Format::Fixed => "fixed",
            Format::F32 => "f32",
            Format::F64 => "f64",
        }
    }
}

/// Whether this core multiplies 32 bits to 32 and no more: the Cortex-M0, the one family of Arm's
/// without an instruction that compares and swaps.
pub(crate) const NARROW_PRODUCTS: bool =
    cfg!(all(target_arch = "arm", not(target_has_atomic = "32")));

mod sealed {
    pub trait Sealed {}
    impl Sealed for crate::Fixed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

/// Arithmetic for kernels; see the [module](self) for the four quantities.
///
/// Sealed: a fourth format would have to keep the exactness that the watertight tests rely on.
pub trait Number:
    sealed::Sealed
    + Copy
    + Default
    + Debug
    + PartialEq
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Neg<Output = Self>
    + Mul<Output = Self>
    + Send
    + Sync
    + 'static
{
    /// Products of two numbers, and coordinates beyond the scene.
    type Wide: Copy
        + Default
        + Debug
        + PartialEq
        + PartialOrd
        + Add<Output = Self::Wide>
        + Sub<Output = Self::Wide>
        + Neg<Output = Self::Wide>
        + Send
        + Sync
        + 'static + 'static;

    /// A number over another: in integers exactly, since they divide slowly and compare fast.
    type Quotient: Copy + PartialOrd;

    /// The name of this format.
    const FORMAT: Format;
    /// How rays of this format cull boxes on this machine.
    type Cull: PairCulling<Self>;
    /// How rays of this format cull eight boxes at once.
    #[cfg(feature = "wide")]
    type WideCull: WideCulling<Self>;
    /// Zero of every quantity.
    const ZERO: Self;
    /// The ratio 1.
    const ONE: Self;
    /// A length beyond every scene, for a ray without end.
    const FAR: Self;
    /// The slope of [`error_bound`](Self::error_bound): zero in [`Fixed`], whose resolution is the same
    /// everywhere.
    const RELATIVE_ERROR: Self;
    /// The constant part of [`error_bound`](Self::error_bound), a length.
    const ABSOLUTE_ERROR: Self;

    // Conversions

    /// A length from a coordinate of the storage lattice, in 1/256 unit; exact for 24 bits.
    fn from_lattice(steps: i32) -> Self;
    /// A length from whole units; exact.
    fn from_unit(unit: i16) -> Self;
    /// A ratio from an integer with 30 fraction bits.
    fn ratio(q30: i32) -> Self;
    /// A radiance from an integer with 20 fraction bits.
    fn radiance(q20: i32) -> Self;
    /// Radiance clamped to \[0, 1\] as an integer of 16 bits: 65535 is display white. NaN is 0.
    fn to_linear16(self) -> u16;
    /// A length from culling steps, which are half units (see [`crate::accel::cull`]); exact.
    fn from_cull(steps: i32) -> Self;
    /// A length in culling steps, rounded towards zero or down; saturates.
    fn to_cull(self) -> i32;
    /// A length from scene data in double precision: rounded, saturating, NaN to 0.
    fn length_from_f64(units: f64) -> Self;
    /// A far coordinate in units from double precision: rounded, saturating, NaN to 0.
    fn far_from_f64(units: f64) -> Self::Wide;
    /// A far coordinate in units in double precision, for reports.
    fn far_to_f64(wide: Self::Wide) -> f64;
    /// A ratio in -2 to 2 from double precision: rounded, saturating, NaN to 0.
    fn ratio_from_f64(value: f64) -> Self;
    /// A length or a ratio in single precision, for culling on machines with SIMD registers.
    fn to_f32(self) -> f32;
    /// A length as an integer with 13 fraction bits, rounded towards zero; saturates.
    fn to_q13(self) -> i32;
    /// A ratio as an integer with 30 fraction bits, rounded towards zero; saturates.
    fn to_q30(self) -> i32;
    /// A length in units in double precision, for reports.
    fn length_to_f64(self) -> f64;
    /// A ratio in double precision, for reports.
    fn ratio_to_f64(self) -> f64;
    /// A radiance in double precision, for reports.
    fn radiance_to_f64(self) -> f64;

    // Single numbers

    /// Magnitude; the most negative number becomes the largest.
    fn abs(self) -> Self;
    /// Half; exact in floats, rounded down in [`Fixed`].
    fn half(self) -> Self;
    /// A coordinate without digits so small that exact products would lose them: 0 in their place.
    fn settle(self) -> Self;
    /// The smaller; the first where they are equal.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if other < self { other } else { self }
    }
    /// The larger; the first where they are equal.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if other > self { other } else { self }
    }
    /// Square root of a ratio in \[0, 2\]; 0 for anything negative.
    fn sqrt(self) -> Self;
    /// Undoes `*`: length over ratio is a length, and two of one quantity make a ratio. Saturates
    /// at the range's end; anything over 0 saturates, 0 over 0 is 0.
    #[inline(always)]
    fn over(self, divisor: Self) -> Self {
        Self::rounded(self.quotient(divisor))
    }
    /// The same before it is rounded, to be compared.
    fn quotient(self, divisor: Self) -> Self::Quotient;
    /// What [`over`](Self::over) gives.
    fn rounded(quotient: Self::Quotient) -> Self;
    /// e to the power of minus the product of a non-negative length and a coefficient in 1/unit,
    /// given with 32 fraction bits: a ratio in \[0, 1\].
    fn exp_neg(self, coefficient_q32: u32) -> Self;
    /// The greatest integer at or below `self / size`, for lengths and `size` above 0.
    fn cell(self, size: Self) -> i32;

    /// The bound of what one hit's arithmetic can be off by, where all coordinates of ray and surface
    /// are below a magnitude.
    #[inline(always)]
    fn error_bound(magnitude: Self) -> Self {
        magnitude * Self::RELATIVE_ERROR + Self::ABSOLUTE_ERROR
    }
    /// A length that leads from a coordinate to the next number, whichever way it is taken; beside 0
    /// the least that keeps products exact.
    fn step_beside(coordinate: Self) -> Self;
    /// The error bound of a point of a plane: `normal` has the length 1, and `relative` leads from the
    /// point to that of the plane with which t is computed. Derived where it is implemented.
    fn plane_error(normal: [Self; 3], relative: [Self; 3], point: [Self; 3]) -> Self;
    /// The error bound of a point of a sphere, whose radius is `size`. Derived where it is implemented.
    fn curve_error(size: Self, normal: [Self; 3], point: [Self; 3]) -> Self;

    // Wide products

    /// Product of two numbers.
    fn wide(self, other: Self) -> Self::Wide;
    /// A number as a wide one with the same binary point: a length as a far coordinate.
    fn widen(self) -> Self::Wide;
    /// The inverse of [`widen`](Self::widen); saturates.
    fn narrow(wide: Self::Wide) -> Self;
    /// Whether a wide number is an ordinary one: false for NaN and infinities.
    fn is_finite(wide: Self::Wide) -> bool;
    /// A wide number times an integer.
    fn wide_times(wide: Self::Wide, factor: i32) -> Self::Wide;
    /// A wide number over a positive integer below 2^24, towards zero.
    fn wide_over(wide: Self::Wide, divisor: i32) -> Self::Wide;
    /// The upper half of a wide number that fills its bits, in a unit of its own: enough for a
    /// direction. Floats have no halves.
    fn upper(wide: Self::Wide) -> Self;
    /// A far coordinate from an integer with 13 fraction bits.
    fn far(q13: i64) -> Self::Wide;
    /// `a - b` of far coordinates that may be any: wraps in [`Fixed`].
    fn difference(a: Self::Wide, b: Self::Wide) -> Self::Wide;
    /// `a - b` of far coordinates, of which `a` is not the smaller, as a length: at most
    /// [`FAR`](Self::FAR).
    fn excess(a: Self::Wide, b: Self::Wide) -> Self;
    /// Where a line comes to a plane far away, on one axis: `origin + (plane - from) * step / stride`
    /// in twice the precision of a far coordinate. `from` is the origin's coordinate on the plane's own
    /// axis, `step` and `stride` are the direction's on this axis and on that; `stride` is not 0 and
    /// `step` no larger. Coordinates are at most 2^37 units; saturates.
    fn carry(
        origin: Self::Wide,
        from: Self::Wide,
        plane: Self,
        step: Self::Wide,
        stride: Self::Wide,
    ) -> Self;
    /// Three products added: `a . b`.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn dot(a: [Self; 3], b: [Self; 3]) -> Self::Wide {
        a[0].wide(b[0]) + a[1].wide(b[1]) + a[2].wide(b[2])
    }
    /// A product with a ratio as a single number: undoes one [`wide`](Self::wide) by a ratio; saturates.
    fn from_wide(product: Self::Wide) -> Self;
    /// Product of a `Wide` (length by ratio, or length squared) with a ratio, as the same kind of `Wide`.
    fn wide_scale(wide: Self::Wide, ratio: Self) -> Self::Wide;
    /// Quotient of two products whose kinds differ by one factor: (length by ratio) over (ratio by
    /// ratio), or (length by length) over (length by ratio): a length; saturates, and 0 / 0 is 0.
    fn divide(numerator: Self::Wide, denominator: Self::Wide) -> Self;
    /// Square root of length squared: a length; 0 for anything negative.
    fn root(square: Self::Wide) -> Self;
    /// Length of a vector of three products, as the same kind of product.
    fn wide_norm(v: [Self::Wide; 3]) -> Self::Wide;
    /// Square root of the product of two non-negative products, as the same kind of product.
    fn geometric_mean(a: Self::Wide, b: Self::Wide) -> Self::Wide;

    // Projections along a ray: see `geometry/triangle.rs`

    /// How vertices whose coordinates count `2^bits` steps a unit are seen along an axis, from a ray's
    /// origin and with its slope there.
    fn sight(origin: Self, slope: Self, bits: u32) -> Sight<Self>;
    /// The same along the ray's major axis, for depths to [`stray`](Self::stray) over.
    #[inline(always)]
    fn depth_sight(origin: Self, slope: Self, bits: u32) -> Sight<Self> {
        Self::sight(origin, slope, bits)
    }
    /// Where a coordinate, of at most 24 bits, lies as seen so: in floats in steps, in [`Fixed`] a
    /// length, and in the direction in which the ray runs.
    fn seen(coordinate: i32, sight: &Sight<Self>) -> Self;
    /// How far what is [seen](Self::seen) strays from a ray along a minor axis for each step along its
    /// major one, given the slopes there.
    fn shear(slope: Self, major: Self) -> Self;
    /// How far it strays over a depth, of less than 2^17 units, by the same arithmetic for every
    /// vertex; in [`Fixed`] rounded down.
    fn stray(depth: Self, shear: Self) -> Self;

    // Vectors

    /// Whether the triangle of three points of the plane holds the origin, edges included; not if
    /// all edges lead through it. Whichever way the points run, and always exact.
    fn surround(a: [Self; 2], b: [Self; 2], c: [Self; 2]) -> bool;
    /// Whether three numbers are certain to be all above or all below zero, where that is cheaper to
    /// see than what comes of it.
    #[inline(always)]
    fn beside(_: [Self; 3]) -> bool {
        false
    }
    /// Whether the product of such a [`direction`](Self::direction) with a slope says that a ray comes at
    /// a surface of this normal steeply, where that is known to bound the error of t: at least 2^-8 in
    /// [`Fixed`], see `geometry/triangle.rs`.
    #[inline(always)]
    fn is_steep(_: Self::Wide) -> bool {
        false
    }
    /// A vector of integers (below 2^52) as ratios: exact up to one common factor and two roundings
    /// each; the largest magnitude in \[1/4, 1\] in [`Fixed`], unscaled in floats.
    fn direction(v: [i64; 3]) -> [Self; 3];
    /// A direction of any length as slopes: divided by the magnitude of its largest component, with
    /// that component's axis. `None` for zero, NaN and infinite vectors.
    fn slopes(v: [Self::Wide; 3]) -> Option<([Self; 3], usize)>;
    /// [`slopes`](Self::slopes) of a direction whose components are single numbers of any one unit.
    fn slopes_of(v: [Self; 3]) -> Option<([Self; 3], usize)>;
    /// 1 / (d . d) for slopes, whose d . d lies in \[1, 3\].
    fn recip_norm2(d: [Self; 3]) -> Self;
    /// A vector of one quantity scaled to length 1 (ratios), and its length. A zero vector stays zero.
    fn normalize(v: [Self; 3]) -> ([Self; 3], Self);
    /// For lengths up to `size`, how many bits they can be shifted up before products overflow;
    /// 0 in floats, which need no such thing.
    fn headroom(size: Self) -> u32;
    /// Shifts a length up by [`headroom`](Self::headroom).
    fn scale_up(self, bits: u32) -> Self;
    /// Undoes [`scale_up`](Self::scale_up), rounding to nearest.
    fn scale_down(self, bits: u32) -> Self;
    /// The culling form of one axis (see [`cull`](crate::accel)): for a slope and the origin's
    /// coordinate, of at most 2^17 units, the inverse slope in culling steps a unit with 16 fraction
    /// bits, limited to 2^29, with the sign of the slope; and what that times a plane lacks to the
    /// step of entry and to that of exit, the margins included.
    fn cull_axis(slope: Self, origin: Self) -> CullAxis;
}

/// How vertices are seen along one axis of a ray: see [`Number::sight`].
#[derive(Clone, Copy, Debug)]
pub struct Sight<N> {
    /// What moves a coordinate, in the measure of what is seen, to where it lies as seen from the origin.
    pub(crate) offset: N,
    /// What makes a coordinate a length, with the sign of the slope; for integers.
    scale: i32,
}

/// The culling form of one axis: see [`Number::cull_axis`].
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct CullAxis {
    /// Steps a unit with 16 fraction bits, with the slope's sign.
    pub(crate) inverse: i32,
    /// What a near plane's product lacks to the step of entry.
    pub(crate) near: i32,
    /// What a far plane's product lacks to the step of exit.
    pub(crate) far: i32,
    /// 16 where the ray runs down the axis and the planes of a word change roles, else 0.
    pub(crate) rotation: u32,
}

impl CullAxis {
    #[inline(always)]
    fn new(inverse: i32, near: i32, far: i32) -> Self {
        Self {
            inverse,
            near,
            far,
            rotation: (inverse >> 31) as u32 & 16,
        }
    }
}
