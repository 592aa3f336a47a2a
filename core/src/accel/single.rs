//! A ray's culling form in single precision, for lanes.
//!
//! The rule is that of [`Cull`](crate::accel::cull::Cull), with wider margins. The lateral margin is half a unit
//! instead of a quarter. The margin along the ray is four units, where the integers' three steps and roundings come to
//! less than three. Rounding moves `p / s - o / s` by less than 2^-5 unit laterally (coordinates are below 2^17), and
//! less where product and sum are rounded together, so a box's interval here holds its interval there. Hits are clamped
//! to the latter, so the answers are the same. The margins lie in the ray's constants, so they cost nothing per box. No
//! number is NaN: an inverse slope is at most 4096 in magnitude, and all products are finite.

use crate::accel::cull_axis::CullArithmetic;
use crate::ray::Ray;
use glam::Vec4;

/// The factors of planes, and the offsets from the products to t in units, per axis.
pub(super) struct Single {
    /// One over the slope, at least 1 in magnitude; below zero where the ray runs down the axis and
    /// the planes change roles.
    pub(super) inverse: Vec4,
    /// The offset of the plane through which the ray enters.
    pub(super) near: Vec4,
    /// The offset of the plane through which it leaves.
    pub(super) far: Vec4,
}

impl Single {
    #[inline(always)]
    pub(super) fn of<N: CullArithmetic>(ray: &Ray<N>) -> Self {
        let lanes = |v: [N; 3]| Vec4::new(v[0].to_f32(), v[1].to_f32(), v[2].to_f32(), 1.0);
        let (origin, slope) = (lanes(ray.origin), lanes(ray.slope));
        Self::of_lanes(origin, slope)
    }

    /// The factors and the offsets for coordinates and slopes in lanes.
    #[inline(always)]
    pub(super) fn of_lanes(origin: Vec4, slope: Vec4) -> Self {
        let level = Vec4::splat(1.0 / 4096.0);
        let steepness = slope.abs();
        let parallel = steepness.cmple(level);
        let magnitude = Vec4::ONE / steepness.max(level);
        let inverse = magnitude.copysign(slope);
        let middle = -(origin * inverse);
        let margin = magnitude * 0.5 + 4.0;
        Self {
            inverse,
            near: middle - margin,
            far: middle + margin + Vec4::select(parallel, Vec4::splat(65_536.0), Vec4::ZERO),
        }
    }

    /// Returns the limit for hits at or before a length, as the bits of a number. It is the next number above, whatever
    /// the conversion rounded. Below 0 no hit is possible.
    #[inline(always)]
    pub(super) fn limit<N: CullArithmetic>(t: N) -> i32 {
        let t = t.to_f32();
        // The sum of two zeros has no sign.
        if t < 0.0 {
            -1
        } else {
            (t + 0.0).to_bits() as i32 + 1
        }
    }

    /// Returns the t of these bits; -1 for the limit below 0, whose bits are a NaN.
    pub(super) fn units(bits: i32) -> f64 {
        let t = f32::from_bits(bits as u32);
        if t.is_nan() { -1.0 } else { t.into() }
    }
}
