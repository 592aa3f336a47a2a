//! The arithmetic of fixed point.

use crate::number::Convert;
use crate::number::ErrorBounds;
use crate::number::Fixed;
use crate::number::Format;
use crate::number::Powers;
use crate::number::Products;
use crate::number::Scalar;
use crate::number::Vectors;
use crate::number::fixed::base::{
    LENGTH_BITS, RADIANCE_BITS, RATIO_BITS, assert_in_range, round_off, saturate, with_sign,
};
use crate::number::fixed::exponential::exp_neg;
use crate::number::fixed::halves::product;
use crate::number::fixed::quotient::Quotient;
use crate::number::fixed::root::nearest_root;
use crate::number::fixed::root::scaled_root;
use crate::number::fixed::vector;
use crate::number::fixed::wide::Product;
use crate::number::scalar::Sealed;
use crate::target::inline_unless_small;
use core::ops::Mul;

impl Mul for Fixed {
    type Output = Self;
    #[inline(always)]
    fn mul(self, ratio: Self) -> Self {
        let product = round_off(product(self.0, ratio.0), RATIO_BITS);
        assert_in_range(|| i32::try_from(product).is_ok());
        Self(product as i32)
    }
}

impl Sealed for Fixed {}

impl Scalar for Fixed {
    type Wide = Product;

    type Quotient = Quotient;

    const FORMAT: Format = Format::Fixed;

    const ZERO: Self = Fixed(0);

    const ONE: Self = Fixed(1 << RATIO_BITS);

    const FAR: Self = Fixed(i32::MAX);

    #[inline(always)]
    fn abs(self) -> Self {
        Fixed(self.0.saturating_abs())
    }

    #[inline(always)]
    fn half(self) -> Self {
        Fixed(self.0 >> 1)
    }

    #[inline(always)]
    fn flush_tiny(self) -> Self {
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
    fn exp_neg(self, coefficient_q32: u32, shift: u32) -> Self {
        exp_neg(self, coefficient_q32, shift)
    }

    fn cell(self, size: Self) -> i32 {
        self.0.checked_div_euclid(size.0).unwrap_or(0)
    }
}

impl Convert for Fixed {
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
    fn radiance_sum(self, other: Self) -> Self {
        assert_in_range(|| self.0 >= 0 && other.0 >= 0);
        let sum = self.0.wrapping_add(other.0);
        Fixed(if sum < 0 { i32::MAX } else { sum })
    }

    #[inline(always)]
    fn to_linear16(self) -> u16 {
        let clamped = self.0.clamp(0, 1 << RADIANCE_BITS) as u64;
        ((clamped * 65535 + (1 << (RADIANCE_BITS - 1))) >> RADIANCE_BITS) as u16
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

    #[inline(always)]
    fn far_to_q13(wide: Product) -> i64 {
        wide.0
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
}

impl Products for Fixed {
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
    fn magnitude(wide: Product) -> Product {
        Product(wide.0.wrapping_abs())
    }

    #[inline(always)]
    fn wide_times(wide: Product, factor: i32) -> Product {
        wide.times(factor)
    }

    #[inline(always)]
    fn wide_over(wide: Product, divisor: i32) -> Product {
        wide.div(divisor)
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
    fn difference_as_length(a: Product, b: Product) -> Self {
        // Without a sign, every difference fits.
        let difference = a.0.wrapping_sub(b.0) as u64;
        Fixed(difference.min(i32::MAX as u64) as i32)
    }

    #[cold]
    #[inline(never)]
    fn carry(origin: Product, from: Product, plane: Self, step: Product, stride: Product) -> Self {
        let depth = plane.widen() - from;
        Self::narrow(origin + depth.times_ratio(step, stride))
    }

    inline_unless_small!(
        fn from_wide(product: Product) -> Self {
            saturate(round_off(product.0, RATIO_BITS))
        }
    );

    #[inline(always)]
    fn wide_scale(wide: Product, ratio: Self) -> Product {
        wide.scaled(ratio)
    }

    #[inline(always)]
    fn divide(numerator: Product, denominator: Product) -> Self {
        numerator.divided_by(denominator)
    }

    fn far_over(wide: Product, ratios: Product) -> Product {
        wide.over_ratios(ratios)
    }

    fn remainder(wide: Product, period: Self) -> Self {
        // Without signs: no other code needs a signed division of 64 bits, which would be linked for this alone.
        let period = period.0.unsigned_abs();
        let rest = wide.0.unsigned_abs().checked_rem(period.into());
        let rest = rest.unwrap_or(0) as u32;
        let rest = match wide.0 < 0 && rest != 0 {
            true => period.wrapping_sub(rest),
            false => rest,
        };
        Fixed(rest as i32)
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
}

impl Vectors for Fixed {
    #[inline(always)]
    fn direction(v: [i64; 3]) -> [Self; 3] {
        vector::direction(v)
    }

    #[inline(always)]
    fn proportions(v: [Product; 3]) -> [Self; 3] {
        vector::proportions(v)
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
        assert_in_range(|| self.0.unsigned_abs().leading_zeros() > bits);
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
}

impl Powers for Fixed {
    fn far_of_product(product: Product, exponent: i32) -> Product {
        product.shifted(exponent.wrapping_sub(RATIO_BITS as i32))
    }

    fn far_times_power(wide: Product, exponent: i32) -> Product {
        wide.shifted(exponent)
    }
}

impl ErrorBounds for Fixed {
    const RELATIVE_ERROR: Self = Fixed(0);

    // Eight sub-steps: two from the slopes over the longest ray, one each from t, the point's three products and the
    // plane's normal. One more is spare.
    const ABSOLUTE_ERROR: Self = Fixed(8);

    #[inline(always)]
    fn step_beside(_: Self) -> Self {
        Fixed(1)
    }

    // In sub-steps. A normal's components are cut off below 2^-30 of a vector whose length is at least 1/2, and once
    // more when it is normalized. That is 3 parts in 2^30 of the way to `relative`'s point. It moves the point by .5
    // less than it should, and each coordinate is rounded by .5, so all three by .9. The start of a ray rounds by .9
    // more. The next test has the same normal and is exact, except for t. It rounds t to 0 where the point is within 1
    // of the plane. The sum is 3.3 and 3 sum|r| / 2^30.
    #[inline(always)]
    fn plane_error(_: [Self; 3], relative: [Self; 3], _: [Self; 3]) -> Self {
        let [x, y, z] = relative.map(|component| component.0.unsigned_abs());
        // Three lengths within the scene: below 2^31.
        Fixed((x.wrapping_add(y).wrapping_add(z) >> 28).wrapping_add(4) as i32)
    }

    // In sub-steps, for a sphere. The point is off by .8 and by 3 parts in 2^30 of a radius of up to 2^28. The rounding
    // of its coordinates adds .9, and the start of a ray .9. The next test's closest point is off by 1, half the chord
    // by 1, and the lateral vector by .9. The sum is 5.5, and 1 for a t that is below 0.
    #[inline(always)]
    fn curve_error(_: Self, _: [Self; 3], _: [Self; 3]) -> Self {
        Self::ABSOLUTE_ERROR
    }
}
