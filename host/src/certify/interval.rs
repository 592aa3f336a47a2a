//! Intervals of double precision, rounded outward.
//!
//! A rounded result is off by less than the distance to the next float, so its neighboring floats enclose the exact
//! one. For sums, the side of the exact result is known, and they are widened to that side alone: integers stay exact.

use super::number::Enclosure;
use std::cmp::Ordering;
use std::ops::{Add, Mul, Neg, Sub};

/// All real numbers from `low` to `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    pub low: f64,
    pub high: f64,
}

impl Interval {
    pub fn new(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    fn exact(value: f64) -> Self {
        Self::new(value, value)
    }
}

fn down(value: f64) -> f64 {
    value.next_down()
}

fn up(value: f64) -> f64 {
    value.next_up()
}

/// Returns the exact error of a rounded sum; NaN where the sum is not finite.
#[inline(always)]
fn lacks(a: f64, b: f64, sum: f64) -> f64 {
    let b_part = sum - a;
    (a - (sum - b_part)) + (b - b_part)
}

#[inline(always)]
fn sum_below(a: f64, b: f64) -> f64 {
    let sum = a + b;
    if lacks(a, b, sum) >= 0.0 {
        sum
    } else {
        down(sum)
    }
}

#[inline(always)]
fn sum_above(a: f64, b: f64) -> f64 {
    let sum = a + b;
    if lacks(a, b, sum) <= 0.0 {
        sum
    } else {
        up(sum)
    }
}

impl Add for Interval {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(
            sum_below(self.low, other.low),
            sum_above(self.high, other.high),
        )
    }
}

impl Sub for Interval {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Neg for Interval {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.high, -self.low)
    }
}

/// A product with infinity is 0 where the other factor is: bounds are limits.
#[inline(always)]
fn product(a: f64, b: f64) -> f64 {
    let product = a * b;
    if product.is_nan() { 0.0 } else { product }
}

impl Mul for Interval {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let (a, b) = (self, other);
        // By 0 and by 1, which directions along axes consist of.
        let is = |it: Self, value: f64| it.low == value && it.high == value;
        if is(a, 0.0) || is(b, 1.0) {
            return a;
        }
        if is(b, 0.0) || is(a, 1.0) {
            return b;
        }
        let products = [
            product(a.low, b.low),
            product(a.low, b.high),
            product(a.high, b.low),
            product(a.high, b.high),
        ];
        let low = products[0]
            .min(products[1])
            .min(products[2].min(products[3]));
        let high = products[0]
            .max(products[1])
            .max(products[2].max(products[3]));
        // Without a negative factor there is no negative product.
        let low = if low == 0.0 && a.low >= 0.0 && b.low >= 0.0 {
            0.0
        } else {
            down(low)
        };
        Self::new(low, up(high))
    }
}

impl Enclosure for Interval {
    fn scaled(integer: i64, places: u32) -> Self {
        let power = f64::powi(2.0, -(places as i32));
        let rounded = integer as f64;
        let exact = rounded.abs() < 9.0e15 || rounded as i128 == i128::from(integer);
        let (low, high) = if exact {
            (rounded, rounded)
        } else {
            (down(rounded), up(rounded))
        };
        Self::new(low * power, high * power)
    }

    fn float(value: f64) -> Self {
        Self::exact(value)
    }

    fn bounds(self) -> [f64; 2] {
        [self.low, self.high]
    }

    #[inline(always)]
    fn sign(self) -> Option<Ordering> {
        if self.low > 0.0 {
            Some(Ordering::Greater)
        } else if self.high < 0.0 {
            Some(Ordering::Less)
        } else if self.low == 0.0 && self.high == 0.0 {
            Some(Ordering::Equal)
        } else {
            None
        }
    }

    fn div(self, divisor: Self) -> Option<Self> {
        if !(divisor.low > 0.0 || divisor.high < 0.0) {
            return None;
        }
        if self.low == 0.0 && self.high == 0.0 {
            return Some(self);
        }
        let quotients = [
            self.low / divisor.low,
            self.low / divisor.high,
            self.high / divisor.low,
            self.high / divisor.high,
        ];
        if quotients.iter().any(|x| x.is_nan()) {
            return None;
        }
        let low = quotients
            .iter()
            .fold(f64::INFINITY, |least, &x| least.min(x));
        let high = quotients
            .iter()
            .fold(f64::NEG_INFINITY, |most, &x| most.max(x));
        Some(Self::new(down(low), up(high)))
    }

    fn square(self) -> Self {
        let (a, b) = (self.low.abs(), self.high.abs());
        let (least, most) = if self.low <= 0.0 && self.high >= 0.0 {
            (0.0, a.max(b))
        } else {
            (a.min(b), a.max(b))
        };
        let low = if least == 0.0 {
            0.0
        } else {
            down(least * least).max(0.0)
        };
        let high = if most == 0.0 { 0.0 } else { up(most * most) };
        Self::new(low, high)
    }

    fn sqrt(self) -> Self {
        let low = if self.low > 0.0 {
            down(self.low.sqrt())
        } else {
            0.0
        };
        let high = if self.high > 0.0 {
            up(self.high.sqrt())
        } else {
            0.0
        };
        Self::new(low, high)
    }

    fn exp_neg(self) -> Self {
        // The library's function is off by less than one unit in the last place; four are allowed.
        let exp = |x: f64| libm::exp(-x.max(0.0));
        let low = exp(self.high);
        let high = exp(self.low);
        let margin = |x: f64| x * f64::powi(2.0, -50) + f64::MIN_POSITIVE;
        Self::new((low - margin(low)).max(0.0), (high + margin(high)).min(1.0))
    }

    fn point(self) -> Self {
        let middle = self.low + (self.high - self.low) * 0.5;
        Self::exact(if middle.is_finite() {
            middle.clamp(self.low, self.high)
        } else {
            self.low.max(-f64::MAX).min(self.high)
        })
    }

    fn radius(self) -> f64 {
        ((self.high - self.low) * 0.5).next_up()
    }

    fn half(self) -> Self {
        // Exact, except for numbers near the smallest floats.
        let half = |x: f64| x * 0.5;
        let is_exact = |x: f64| x == 0.0 || x.abs() > 1e-300;
        if is_exact(self.low) && is_exact(self.high) {
            return Self::new(half(self.low), half(self.high));
        }
        Self::new(down(half(self.low)), up(half(self.high)))
    }

    fn hull(self, other: Self) -> Self {
        Self::new(self.low.min(other.low), self.high.max(other.high))
    }

    fn at_least(self, other: Self) -> Self {
        Self::new(self.low.max(other.low), self.high.max(other.high))
    }

    fn at_most(self, other: Self) -> Self {
        Self::new(self.low.min(other.low), self.high.min(other.high))
    }
}
