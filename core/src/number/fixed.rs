//! Fixed point in 32 bits, products in 64: for cores without a floating-point unit.

mod exponential;
mod halves;
mod quotient;
mod root;
mod vector;
mod wide;

use self::exponential::exp_neg;
pub(crate) use self::halves::product;
use self::halves::{leading_zeros, product_unsigned, quotient};
use self::quotient::Quotient;
use self::root::{nearest_root, scaled_root};
use self::wide::Product;
use crate::SMALL;
use crate::accel::cull::Cull;
use crate::number::{CullAxis, Format, NARROW_PRODUCTS, Number, Sight};
use core::ops::{Add, Mul, Neg, Sub};

/// A number in fixed point. Where its binary point lies depends on what it stands for: a length
/// has 13 fraction bits, a ratio 30, a radiance 20 (see [`Number`]).
///
/// All operators wrap; none panics, whatever the build's overflow checks. Kernels stay within ranges
/// that they document, and tests hold them to that with the feature `strict-ranges`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(transparent)]
pub struct Fixed(pub i32);

/// Nothing, or with the feature `strict-ranges` a panic where a kernel left the range that its
/// documentation says it keeps.
#[inline(always)]
fn keep(in_range: impl FnOnce() -> bool) {
    if cfg!(feature = "strict-ranges") {
        assert!(in_range(), "a number left its range");
    }
}

/// Fraction bits of a length.
pub(crate) const LENGTH_BITS: u32 = 13;
/// Fraction bits of a ratio.
const RATIO_BITS: u32 = 30;
/// Fraction bits of a radiance.
const RADIANCE_BITS: u32 = 20;

/// A product's `bits` lowest bits, 1 to 31, rounded away: to nearest, ties away from zero, so that a
/// mirrored scene gives mirrored numbers.
#[inline(always)]
const fn round_off(product: i64, bits: u32) -> i64 {
    // A half, less 1 where that turns a tie down: not negative, so that 64 bits are added up once.
    let half = (1_u32 << (bits & 31) >> 1).wrapping_add((product >> 63) as u32);
    product.wrapping_add(half as i64) >> (bits & 31)
}

#[inline(always)]
const fn saturate(value: i64) -> Fixed {
    if value > i32::MAX as i64 {
        Fixed(i32::MAX)
    } else if value < -(i32::MAX as i64) {
        Fixed(-i32::MAX)
    } else {
        Fixed(value as i32)
    }
}

/// Gives a magnitude the sign of `sign`.
#[inline(always)]
const fn with_sign(magnitude: u64, sign: i64) -> Fixed {
    let magnitude = if magnitude > i32::MAX as u64 {
        i32::MAX
    } else {
        magnitude as i32
    };
    Fixed(if sign < 0 { -magnitude } else { magnitude })
}

/// 2^61 / `d` for `d` in \[2^30, 2^31), to a part in 2^29: a division in 32 bits, which small cores
/// have or emulate cheaply, and one step of Newton's iteration.
#[cfg_attr(not(feature = "small"), inline(always))]
fn reciprocal(d: u32) -> u32 {
    let coarse = quotient(d.wrapping_add(1 << 14) >> 15) << 14;
    // d * coarse is 2^61 but for a part in 2^15.
    let excess = (product_unsigned(d, coarse) >> 29) as u32 as i32;
    coarse.wrapping_sub((product(coarse as i32, excess) >> 32) as u32)
}

/// [`Number::surround`] by the sides on which the edges leave the origin, where they differ: those that
/// lead through it are on neither.
fn surround_by_sides(sides: [i64; 3]) -> bool {
    let negative = sides.iter().any(|&side| side < 0);
    let positive = sides.iter().any(|&side| side > 0);
    negative != positive
}

/// Sums and differences that wrap, of numbers and of their products.
macro_rules! wrapping_sums {
    ($number:ident) => {
        impl Add for $number {
            type Output = Self;
            #[inline(always)]
            fn add(self, other: Self) -> Self {
                keep(|| self.0.checked_add(other.0).is_some());
                Self(self.0.wrapping_add(other.0))
            }
        }

        impl Sub for $number {
            type Output = Self;
            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                keep(|| self.0.checked_sub(other.0).is_some());
                Self(self.0.wrapping_sub(other.0))
            }
        }

        impl Neg for $number {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                keep(|| self.0.checked_neg().is_some());
                Self(self.0.wrapping_neg())
            }
        }
    };
}
wrapping_sums!(Fixed);
wrapping_sums!(Product);

impl Mul for Fixed {
    type Output = Self;
    #[inline(always)]
    fn mul(self, ratio: Self) -> Self {
        let product = round_off(product(self.0, ratio.0), RATIO_BITS);
        keep(|| i32::try_from(product).is_ok());
        Self(product as i32)
    }
}

impl Number for Fixed {
    type Wide = Product;
    type Quotient = Quotient;
    type Cull = Cull;
    #[cfg(feature = "wide")]
    type WideCull = Cull;

    const FORMAT: Format = Format::Fixed;
    const ZERO: Self = Fixed(0);
    const ONE: Self = Fixed(1 << RATIO_BITS);
    const FAR: Self = Fixed(i32::MAX);
    const RELATIVE_ERROR: Self = Fixed(0);
    // Eight sub-steps: two from the slopes over the longest ray, one each from t, the point's three
    // products and the plane's normal, and one to spare.
    const ABSOLUTE_ERROR: Self = Fixed(8);

    #[inline(always)]
    fn from_lattice(steps: i32) -> Self {
        Fixed(steps.wrapping_shl(LENGTH_BITS - 8))
    }

    #[inline(always)]
    fn from_unit(unit: i16) -> Self {
        Fixed((unit as i32) << LENGTH_BITS)
    }

    #[inline(always)]
    fn ratio(q30: i32) -> Self {
        Fixed(q30)
    }

    #[inline(always)]
    fn radiance(q20: i32) -> Self {
        Fixed(q20)
    }

    #[inline(always)]
    fn to_linear16(self) -> u16 {
        let clamped = self.0.clamp(0, 1 << RADIANCE_BITS) as u64;
        ((clamped * 65535 + (1 << (RADIANCE_BITS - 1))) >> RADIANCE_BITS) as u16
    }

    #[inline(always)]
    fn from_cull(steps: i32) -> Self {
        saturate((steps as i64) << (LENGTH_BITS - 1))
    }

    #[inline(always)]
    fn to_cull(self) -> i32 {
        self.0 >> (LENGTH_BITS - 1)
    }

    fn length_from_f64(units: f64) -> Self {
        let q13 = libm::round(units * f64::from(1 << LENGTH_BITS));
        Fixed((q13 as i32).max(-i32::MAX))
    }

    fn ratio_from_f64(value: f64) -> Self {
        let q30 = libm::round(value * f64::from(1 << RATIO_BITS));
        Fixed((q30 as i32).max(-i32::MAX))
    }

    fn far_from_f64(units: f64) -> Product {
        Product(libm::round(units * f64::from(1 << LENGTH_BITS)) as i64)
    }

    fn far_to_f64(wide: Product) -> f64 {
        wide.0 as f64 / f64::from(1 << LENGTH_BITS)
    }

    fn to_f32(self) -> f32 {
        self.0 as f32 / (1 << LENGTH_BITS) as f32
    }

    #[inline(always)]
    fn to_q13(self) -> i32 {
        self.0
    }

    #[inline(always)]
    fn to_q30(self) -> i32 {
        self.0
    }

    fn length_to_f64(self) -> f64 {
        f64::from(self.0) / f64::from(1 << LENGTH_BITS)
    }

    fn ratio_to_f64(self) -> f64 {
        f64::from(self.0) / f64::from(1 << RATIO_BITS)
    }

    fn radiance_to_f64(self) -> f64 {
        f64::from(self.0) / f64::from(1 << RADIANCE_BITS)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Fixed(self.0.saturating_abs())
    }

    #[inline(always)]
    fn half(self) -> Self {
        Fixed(self.0 >> 1)
    }

    #[inline(always)]
    fn settle(self) -> Self {
        self
    }

    fn sqrt(self) -> Self {
        Fixed(nearest_root((self.0.max(0) as u64) << RATIO_BITS) as i32)
    }

    #[inline(always)]
    fn quotient(self, divisor: Self) -> Quotient {
        Quotient::new(self, divisor)
    }

    #[inline(always)]
    fn rounded(quotient: Quotient) -> Self {
        quotient.rounded()
    }

    #[inline(always)]
    fn exp_neg(self, coefficient_q32: u32) -> Self {
        exp_neg(self, coefficient_q32)
    }

    fn cell(self, size: Self) -> i32 {
        self.0.checked_div_euclid(size.0).unwrap_or(0)
    }

    #[inline(always)]
    fn step_beside(_: Self) -> Self {
        Fixed(1)
    }

    // In sub-steps. A normal's components are cut off below 2^-30 of a vector whose length is at least 1/2,
    // and once more when it is normalised: 3 parts in 2^30 of the way to `relative`'s point, which moves the
    // point by .5 less than it should, and each coordinate is rounded by .5, so all three by .9. The start of
    // a ray rounds by .9 more. The next test is exact but for the normal, the same one, and for t: it rounds
    // to 0 what is within 1 of the plane. 3.3 in all, and 3 sum|r| / 2^30.
    #[inline(always)]
    fn plane_error(_: [Self; 3], relative: [Self; 3], _: [Self; 3]) -> Self {
        let [x, y, z] = relative.map(|component| component.0.unsigned_abs());
        // Three lengths within the scene: below 2^31.
        Fixed((x.wrapping_add(y).wrapping_add(z) >> 28).wrapping_add(4) as i32)
    }

    // In sub-steps, for a sphere. The point is off by .8, 3 parts in 2^30 of a radius of up to 2^28, and by
    // .9 for what rounds its coordinates; the start of a ray by .9 more. The next test's closest point is off
    // by 1, half the chord by 1, and what lies across by .9. Together 5.5, and 1 for a t that is below 0.
    #[inline(always)]
    fn curve_error(_: Self, _: [Self; 3], _: [Self; 3]) -> Self {
        Self::ABSOLUTE_ERROR
    }

    #[inline(always)]
    fn wide(self, other: Self) -> Product {
        Product(product(self.0, other.0))
    }

    #[inline(always)]
    fn widen(self) -> Product {
        Product(self.0 as i64)
    }

    #[inline(always)]
    fn narrow(wide: Product) -> Self {
        saturate(wide.0)
    }

    #[inline(always)]
    fn is_finite(_: Product) -> bool {
        true
    }

    #[inline(always)]
    fn wide_times(wide: Product, factor: i32) -> Product {
        wide.times(factor)
    }

    #[inline(always)]
    fn wide_over(wide: Product, divisor: i32) -> Product {
        wide.over(divisor)
    }

    #[inline(always)]
    fn upper(wide: Product) -> Self {
        Fixed((wide.0 >> 32) as i32)
    }

    #[inline(always)]
    fn far(q13: i64) -> Product {
        Product(q13)
    }

    #[inline(always)]
    fn difference(a: Product, b: Product) -> Product {
        Product(a.0.wrapping_sub(b.0))
    }

    #[inline(always)]
    fn excess(a: Product, b: Product) -> Self {
        // Without a sign every difference has room.
        let excess = a.0.wrapping_sub(b.0) as u64;
        Fixed(excess.min(i32::MAX as u64) as i32)
    }

    #[cold]
    #[inline(never)]
    fn carry(origin: Product, from: Product, plane: Self, step: Product, stride: Product) -> Self {
        let depth = plane.widen() - from;
        Self::narrow(origin + depth.times_ratio(step, stride))
    }

    #[cfg_attr(not(feature = "small"), inline(always))]
    fn from_wide(product: Product) -> Self {
        saturate(round_off(product.0, RATIO_BITS))
    }

    #[inline(always)]
    fn wide_scale(wide: Product, ratio: Self) -> Product {
        wide.scaled(ratio)
    }

    #[inline(always)]
    fn divide(numerator: Product, denominator: Product) -> Self {
        numerator.divided_by(denominator)
    }

    fn root(square: Product) -> Self {
        with_sign(nearest_root(square.0.max(0) as u64), 0)
    }

    #[inline(always)]
    fn wide_norm(v: [Product; 3]) -> Product {
        vector::wide_norm(v)
    }

    fn geometric_mean(a: Product, b: Product) -> Product {
        let (root_a, shift_a) = scaled_root(a.0.max(0) as u64);
        let (root_b, shift_b) = scaled_root(b.0.max(0) as u64);
        // Roots have 32 bits.
        let product = root_a.wrapping_mul(root_b);
        Product((product >> (shift_a.wrapping_add(shift_b) & 63)) as i64)
    }

    #[inline(always)]
    fn sight(origin: Self, slope: Self, bits: u32) -> Sight<Self> {
        // All that is seen is counted in the direction in which the ray runs, so that what is rounded
        // down is rounded alike in a mirrored scene.
        let turned = slope.0 >> 31;
        let turn = |x: i32| (x ^ turned).wrapping_sub(turned);
        Sight {
            offset: Fixed(turn(origin.0.wrapping_neg())),
            scale: turn(1_i32.wrapping_shl(LENGTH_BITS.wrapping_sub(bits))),
        }
    }

    // Twice as far: with the 31 fraction bits of a shear, the upper half of a product is a length.
    #[inline(always)]
    fn depth_sight(origin: Self, slope: Self, bits: u32) -> Sight<Self> {
        let Sight { offset, scale } = Self::sight(origin, slope, bits);
        keep(|| offset.0.unsigned_abs() < 1 << 30);
        Sight {
            offset: Fixed(offset.0.wrapping_shl(1)),
            scale: scale.wrapping_shl(1),
        }
    }

    #[inline(always)]
    fn seen(coordinate: i32, sight: &Sight<Self>) -> Self {
        Fixed(coordinate.wrapping_mul(sight.scale)) + sight.offset
    }

    #[inline(always)]
    fn shear(slope: Self, _: Self) -> Self {
        // With 31 fraction bits, of which -1 has room.
        Fixed((slope.0.unsigned_abs() << 1).wrapping_neg() as i32)
    }

    #[inline(always)]
    fn stray(depth: Self, shear: Self) -> Self {
        // The upper half of a product, which costs least.
        Fixed((product(depth.0, shear.0) >> 32) as i32)
    }

    #[cfg_attr(not(feature = "small"), inline(always))]
    fn surround(a: [Self; 2], b: [Self; 2], c: [Self; 2]) -> bool {
        if NARROW_PRODUCTS && let Some(surround) = halves::surround(a, b, c) {
            return surround;
        }
        let cross = |a: [Self; 2], b: [Self; 2]| (a[0].wide(b[1]) - a[1].wide(b[0])).0;
        let (u, v) = (cross(b, c), cross(c, a));
        // Few triangles come further. Where an upper half is not 0, neither is the whole.
        let (upper_u, upper_v) = ((u >> 32) as i32, (v >> 32) as i32);
        if upper_u ^ upper_v < 0 && upper_u != 0 && upper_v != 0 {
            return false;
        }
        let w = cross(a, b);
        if (u ^ v | u ^ w) < 0 {
            return surround_by_sides([u, v, w]);
        }
        u | v | w != 0
    }

    #[inline(always)]
    fn beside(v: [Self; 3]) -> bool {
        let zero = Self::ZERO;
        v[0] < zero && v[1] < zero && v[2] < zero || v[0] > zero && v[1] > zero && v[2] > zero
    }

    #[inline(always)]
    fn is_steep(approach: Product) -> bool {
        // 2^-8 with 60 fraction bits; the upper half tells. Small code has one way for all.
        const LEAST: i32 = 1 << (2 * RATIO_BITS - 8 - 32);
        let upper = (approach.0 >> 32) as i32;
        !SMALL && !(-LEAST..LEAST).contains(&upper)
    }

    #[inline(always)]
    fn direction(v: [i64; 3]) -> [Self; 3] {
        vector::direction(v)
    }

    #[inline(always)]
    fn slopes(v: [Product; 3]) -> Option<([Self; 3], usize)> {
        vector::slopes(v)
    }

    #[inline(always)]
    fn slopes_of(v: [Self; 3]) -> Option<([Self; 3], usize)> {
        vector::slopes_of(v)
    }

    #[inline(always)]
    fn recip_norm2(d: [Self; 3]) -> Self {
        vector::recip_norm2(d)
    }

    #[inline(always)]
    fn normalize(v: [Self; 3]) -> ([Self; 3], Self) {
        vector::normalize(v)
    }

    #[inline(always)]
    fn headroom(size: Self) -> u32 {
        size.0.leading_zeros().saturating_sub(3)
    }

    #[inline(always)]
    fn scale_up(self, bits: u32) -> Self {
        keep(|| self.0.unsigned_abs().leading_zeros() > bits);
        Fixed(self.0.wrapping_shl(bits))
    }

    #[inline(always)]
    fn scale_down(self, bits: u32) -> Self {
        if bits == 0 {
            self
        } else {
            Fixed(round_off(self.0 as i64, bits) as i32)
        }
    }

    #[inline(always)]
    fn cull_axis(slope: Self, origin: Self) -> CullAxis {
        let magnitude = slope.0.unsigned_abs();
        let (steepness, parallel) = if magnitude == 1 << RATIO_BITS {
            (1 << 17, 0)
        } else if magnitude > 1 << 18 {
            // 2^47 / magnitude; from 1 to 12 leading zeros, since slopes are at most 1.
            let up = leading_zeros(magnitude).wrapping_sub(1) & 15;
            let inverse = reciprocal(magnitude << up) >> (14_u32.wrapping_sub(up) & 31);
            (inverse as i32, 0)
        } else {
            (1 << 29, 1 << 17)
        };
        let inverse = if slope.0 < 0 {
            steepness.wrapping_neg()
        } else {
            steepness
        };
        let offset = (product(origin.0, inverse) >> (16 + LENGTH_BITS)) as i32;
        keep(|| offset.unsigned_abs() <= 1 << 30);
        let (back, margin) = (offset.wrapping_neg(), (steepness >> 18).wrapping_add(3));
        CullAxis::new(
            inverse,
            back.wrapping_sub(margin),
            back.wrapping_add(margin).wrapping_add(parallel),
        )
    }
}

#[cfg(test)]
mod tests;
