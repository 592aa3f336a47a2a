//! IEEE 754 arithmetic in single and double precision.
//!
//! Uses only operations whose result is the same on every machine. There is no fused multiply-add, and no `min` and
//! `max` of the standard library (they differ on signed zeros).

use crate::axis::pick;
use crate::number::Convert;
use crate::number::ErrorBounds;
use crate::number::Powers;
use crate::number::Products;
use crate::number::Scalar;
use crate::number::Vectors;
use crate::number::error_free::{SPLITTER_F32, SPLITTER_F64, carry, product_error, two_sum};
use crate::number::root;
use crate::number::scalar::Sealed;
use crate::number::{Arithmetic, Format};
use crate::number::{extent, is_finite};

/// 2^-60 and 2^-100: smaller numbers need care.
const SMALLEST_F32: f32 = 1.0 / (1u64 << 60) as f32;
pub(crate) const SMALLEST_F64: f64 = 1.0 / (1u64 << 50) as f64 / (1u64 << 50) as f64;

/// A finite vector that is not 0, halved or doubled until its largest component lies between 1 and 2.
fn near_one<N: Arithmetic<Wide = N>>(mut v: [N; 3]) -> [N; 3] {
    let double = N::ONE + N::ONE;
    for _ in 0..1100 {
        let largest = extent(v);
        if largest < N::ONE {
            v = v.map(|component| component * double);
        } else if largest > double {
            v = v.map(N::half);
        } else {
            break;
        }
    }
    v
}

/// Returns one of the [`Vectors::slopes`](crate::number::Vectors::slopes) of a direction whose length is far from 1.
/// Magnitudes of \[2^-149, 2^128\] or \[2^-1074, 2^1024\] are first halved or doubled until they are in range. Returns
/// `None` where there are no slopes.
///
/// One at a time, because a single number returns in a register; memory would cost all rays time.
#[cold]
#[inline(never)]
fn slope_of_extremes<N: Arithmetic<Wide = N>>(
    x: N,
    y: N,
    z: N,
    axis: usize,
    major: usize,
) -> Option<N> {
    let scaled = [x, y, z];
    let ordinary = scaled.iter().all(|&component| is_finite::<N>(component));
    if !ordinary || extent(scaled) == N::ZERO {
        return None;
    }
    let scaled = near_one(scaled);
    let component = pick(scaled, axis);
    Some(if axis != major {
        (component * N::ONE.div(extent(scaled)) + N::ZERO).flush_tiny()
    } else if component < N::ZERO {
        -N::ONE
    } else {
        N::ONE
    })
}

/// Returns all slopes. Not a closure, because its captures would lie in memory for all rays.
#[inline(always)]
fn slopes_of_extremes<N: Arithmetic<Wide = N>>(
    x: N,
    y: N,
    z: N,
    major: usize,
) -> Option<([N; 3], usize)> {
    let slope = |axis: usize| slope_of_extremes(x, y, z, axis, major);
    Some(([slope(0)?, slope(1)?, slope(2)?], major))
}

macro_rules! float_number {
    ($float:ident, $format:expr, $precision:expr, $smallest:expr, $sqrt:path, $exp:path,
     $compare_products:path, $splitter:expr, $flush_tiny:expr, $direction:expr) => {
        impl Sealed for $float {}

        impl Scalar for $float {
            type Wide = $float;

            type Quotient = Self;

            const FORMAT: Format = $format;

            const ZERO: Self = 0.0;

            const ONE: Self = 1.0;

            const FAR: Self = 262_144.0;

            #[inline(always)]
            fn abs(self) -> Self {
                $float::abs(self)
            }

            #[inline(always)]
            fn half(self) -> Self {
                self * 0.5
            }

            #[inline(always)]
            fn flush_tiny(self) -> Self {
                $flush_tiny(self)
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                if self > 0.0 { $sqrt(self) } else { 0.0 }
            }

            #[inline(always)]
            fn quotient(self, divisor: Self) -> Self {
                if self == 0.0 { 0.0 } else { self / divisor }
            }

            #[inline(always)]
            fn rounded(quotient: Self) -> Self {
                quotient
            }

            fn exp_neg(self, coefficient_q32: u32, shift: u32) -> Self {
                let scale = (1_u32 << (shift & 15)) as $float * (1.0 / 4_294_967_296.0);
                $exp(-(self * (coefficient_q32 as $float * scale)))
            }

            fn cell(self, size: Self) -> i32 {
                let quotient = self / size;
                let whole = quotient as i32;
                whole.saturating_sub((whole as $float > quotient).into())
            }
        }

        impl Convert for $float {
            #[inline(always)]
            fn from_lattice(steps: i32) -> Self {
                steps as $float * (1.0 / 256.0)
            }

            #[inline(always)]
            fn from_unit(unit: i16) -> Self {
                $float::from(unit)
            }

            #[inline(always)]
            fn ratio(q30: i32) -> Self {
                q30 as $float * (1.0 / 1_073_741_824.0)
            }

            #[inline(always)]
            fn radiance(q20: i32) -> Self {
                q20 as $float * (1.0 / 1_048_576.0)
            }

            #[inline(always)]
            fn radiance_sum(self, other: Self) -> Self {
                self + other
            }

            #[inline(always)]
            fn to_linear16(self) -> u16 {
                (self * 65535.0 + 0.5) as u16
            }

            fn length_from_f64(units: f64) -> Self {
                if units == units { units as $float } else { 0.0 }
            }

            fn ratio_from_f64(value: f64) -> Self {
                Self::length_from_f64(value)
            }

            fn far_from_f64(units: f64) -> Self {
                Self::length_from_f64(units)
            }

            fn far_to_f64(wide: Self) -> f64 {
                wide as f64
            }

            fn far_to_q13(wide: Self) -> i64 {
                let q13 = wide * 8192.0;
                // With a half itself, sums that are no numbers of the format would be rounded up.
                const HALF: $float = (0.5 as $float).next_down();
                (q13 + HALF.copysign(q13)) as i64
            }

            #[inline(always)]
            fn to_f32(self) -> f32 {
                self as f32
            }

            #[inline(always)]
            fn to_q13(self) -> i32 {
                (self * 8192.0) as i32
            }

            #[inline(always)]
            fn to_q30(self) -> i32 {
                (self * 1_073_741_824.0) as i32
            }

            fn length_to_f64(self) -> f64 {
                self as f64
            }

            fn ratio_to_f64(self) -> f64 {
                self as f64
            }

            fn radiance_to_f64(self) -> f64 {
                self as f64
            }
        }

        impl Products for $float {
            #[inline(always)]
            fn wide(self, other: Self) -> Self {
                self * other
            }

            #[inline(always)]
            fn widen(self) -> Self {
                self
            }

            #[inline(always)]
            fn narrow(wide: Self) -> Self {
                wide
            }

            #[inline(always)]
            fn magnitude(wide: Self) -> Self {
                $float::abs(wide)
            }

            #[inline(always)]
            fn wide_times(wide: Self, factor: i32) -> Self {
                wide * factor as $float
            }

            #[inline(always)]
            fn wide_over(wide: Self, divisor: i32) -> Self {
                wide / divisor as $float
            }

            #[inline(always)]
            fn upper(wide: Self) -> Self {
                wide
            }

            #[inline(always)]
            fn far(q13: i64) -> Self {
                q13 as $float * (1.0 / 8192.0)
            }

            #[inline(always)]
            fn difference(a: Self, b: Self) -> Self {
                a - b
            }

            #[inline(always)]
            fn difference_as_length(a: Self, b: Self) -> Self {
                (a - b).min(Self::FAR)
            }

            #[cold]
            #[inline(never)]
            fn carry(origin: Self, from: Self, plane: Self, step: Self, stride: Self) -> Self {
                let is_ordinary = stride.abs() >= $smallest && stride.abs() <= 1.0 / $smallest;
                let [step, stride, _] = if is_ordinary {
                    [step, stride, 0.0]
                } else {
                    near_one([step, stride, 0.0])
                };
                let slope = step.div(stride);
                let rest = (step - slope * stride) - product_error(slope, stride, $splitter);
                let slope = (slope, rest.div(stride));
                carry(origin, two_sum(plane, -from), slope, $splitter)
            }

            #[inline(always)]
            fn from_wide(product: Self) -> Self {
                product
            }

            #[inline(always)]
            fn wide_scale(wide: Self, ratio: Self) -> Self {
                wide * ratio
            }

            fn far_over(wide: Self, ratios: Self) -> Self {
                wide / ratios
            }

            fn remainder(wide: Self, period: Self) -> Self {
                let rest = wide % period;
                if rest < 0.0 { rest + period } else { rest }
            }

            #[inline(always)]
            fn divide(numerator: Self, denominator: Self) -> Self {
                numerator.div(denominator)
            }

            #[inline(always)]
            fn root(square: Self) -> Self {
                Scalar::sqrt(square)
            }

            fn wide_norm(v: [Self; 3]) -> Self {
                Scalar::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
            }

            fn geometric_mean(a: Self, b: Self) -> Self {
                Scalar::sqrt(a * b)
            }
        }

        impl Vectors for $float {
            #[inline(always)]
            fn direction(v: [i64; 3]) -> [Self; 3] {
                $direction(v)
            }

            #[inline(always)]
            fn proportions(v: [Self; 3]) -> [Self; 3] {
                v
            }

            #[inline(always)]
            fn slopes(v: [Self; 3]) -> Option<([Self; 3], usize)> {
                // Magnitudes order like integers, NaN above all.
                let magnitude = |x: $float| x.to_bits() << 1;
                let [x, y, z] = v.map(magnitude);
                let (low, high) = (magnitude($smallest), magnitude(1.0 / $smallest));
                let is_ordinary =
                    |x: $float| magnitude(x).wrapping_sub(low) <= high.wrapping_sub(low);
                let one = |x: $float| (1.0 as $float).copysign(x);
                // Adding zero turns -0.0 into 0.0.
                let over =
                    |x: $float, largest: $float| $flush_tiny(x * (1.0 / largest.abs()) + 0.0);
                let [a, b, c] = v;
                // Written out by axis, so that nothing is looked up.
                if x >= y && x >= z {
                    if !is_ordinary(a) {
                        return slopes_of_extremes(a, b, c, 0);
                    }
                    Some(([one(a), over(b, a), over(c, a)], 0))
                } else if y >= z {
                    if !is_ordinary(b) {
                        return slopes_of_extremes(a, b, c, 1);
                    }
                    Some(([over(a, b), one(b), over(c, b)], 1))
                } else {
                    if !is_ordinary(c) {
                        return slopes_of_extremes(a, b, c, 2);
                    }
                    Some(([over(a, c), over(b, c), one(c)], 2))
                }
            }

            #[inline(always)]
            fn slopes_of(v: [Self; 3]) -> Option<([Self; 3], usize)> {
                Self::slopes(v)
            }

            #[inline(always)]
            fn recip_norm2(d: [Self; 3]) -> Self {
                1.0 / Self::dot(d, d)
            }

            #[inline(always)]
            fn normalize(v: [Self; 3]) -> ([Self; 3], Self) {
                let norm = Self::wide_norm(v);
                if norm > 0.0 {
                    let inverse = 1.0 / norm;
                    (v.map(|component| component * inverse), norm)
                } else {
                    ([0.0; 3], 0.0)
                }
            }

            #[inline(always)]
            fn headroom(_: Self) -> u32 {
                0
            }

            #[inline(always)]
            fn scale_up(self, _: u32) -> Self {
                self
            }

            #[inline(always)]
            fn scale_down(self, _: u32) -> Self {
                self
            }
        }

        impl Powers for $float {
            fn far_of_product(product: Self, exponent: i32) -> Self {
                Self::far_times_power(product, exponent)
            }

            fn far_times_power(wide: Self, exponent: i32) -> Self {
                let power = 1_u32.wrapping_shl(exponent.unsigned_abs()) as Self;
                if exponent < 0 {
                    wide * (1.0 / power)
                } else {
                    wide * power
                }
            }
        }

        impl ErrorBounds for $float {
            // Sixteen roundings of coordinates. They are the point's product and sum, t's three products, sums and
            // quotient, the plane's normal, and the next test of the same surface.
            const RELATIVE_ERROR: Self = 16.0 * $precision;

            // Doubled, so that the largest coordinate of such a step along a normal is not flushed to zero.
            const ABSOLUTE_ERROR: Self = $smallest + $smallest;

            // A sum is rounded to the next number if it lies more than half way there, which is at most u of the
            // coordinate.
            #[inline(always)]
            fn step_beside(coordinate: Self) -> Self {
                coordinate.abs() * ($precision * (1.0 + 4.0 * $precision)) + $smallest
            }

            // In parts of u. **The point.** `n . r` moves the point onto the plane. Each of its terms is off by 7: the
            // normal's component by 3, `r` by 1, the product by 1, the sums by 2. The sum that moves the point rounds
            // each coordinate by 1: 7 sum|n r| + sum|n p| in all. **The start** of a ray rounds each coordinate by 1
            // more. **The next test** uses the sign of t from the same sum with a normal that is not normalized: 6
            // sum|n r|. So 13 sum|n r| + 2 sum|n p| is enough.
            #[inline(always)]
            fn plane_error(normal: [Self; 3], relative: [Self; 3], point: [Self; 3]) -> Self {
                let part = |v: [Self; 3], k: usize| $float::abs(normal[k] * v[k]);
                let sum = |v: [Self; 3]| part(v, 0) + part(v, 1) + part(v, 2);
                Self::error_bound(sum(relative) + sum(point) * 0.25)
            }

            // In parts of u, for a sphere of radius r. **The point** is off by 4.5 r because the normal's length
            // differs from 1 by that. Its product with the radius adds r, and the sum adds sum|n p|. **The start**
            // rounds each coordinate by 1 more. **The next test** is that of a ray that leaves. The center as seen from
            // there is off by r, and the closest point by 7 r. Half the chord is a root of `r^2 - |apart|^2`, off by 8
            // r^2. That counts 4 r where half the chord must be less than the way to the closest point. So 17.5 r + 2
            // sum|n p| is enough.
            #[inline(always)]
            fn curve_error(size: Self, normal: [Self; 3], point: [Self; 3]) -> Self {
                let part = |k: usize| $float::abs(normal[k] * point[k]);
                Self::error_bound(size + (size + part(0) + part(1) + part(2)) * 0.25)
            }
        }
    };
}

float_number!(
    f32,
    Format::F32,
    1.0 / 16_777_216.0,
    SMALLEST_F32,
    root::of_f32,
    libm::expf,
    compare_products_f32,
    SPLITTER_F32,
    // No product of two coordinates in single precision underflows in double precision.
    |x: f32| x,
    |v: [i64; 3]| {
        // By halves, which cores with a single-precision unit convert in one instruction each.
        v.map(|component| {
            let high = (component.wrapping_add(1 << 25) >> 26) as i32;
            let low = (component as i32).wrapping_sub(high << 26);
            high as f32 * 67_108_864.0 + low as f32
        })
    }
);

float_number!(
    f64,
    Format::F64,
    1.0 / 9_007_199_254_740_992.0,
    SMALLEST_F64,
    root::of_f64,
    libm::exp,
    compare_products_f64,
    SPLITTER_F64,
    |x: f64| if x.abs() < SMALLEST_F64 { 0.0 } else { x },
    |v: [i64; 3]| v.map(|component| component as f64)
);
