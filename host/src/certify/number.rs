//! Numbers that enclose a real one.

use std::cmp::Ordering;
use std::ops::{Add, Mul, Neg, Sub};

/// A number with a lower and an upper bound.
///
/// Every operation returns an enclosure of all results that the enclosed numbers can have.
pub trait Enclosure:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
    /// An integer over a power of two.
    fn scaled(integer: i64, down: u32) -> Self;

    /// A finite float, exactly.
    fn float(value: f64) -> Self;

    /// Floats at or below, and at or above, every number that is enclosed.
    fn bounds(self) -> [f64; 2];

    /// The sign; `None` if numbers of both signs, or zero and others, are enclosed.
    fn sign(self) -> Option<Ordering>;

    /// The quotient; `None` if the divisor may be 0.
    fn div(self, divisor: Self) -> Option<Self>;

    /// The square of one and the same number.
    fn square(self) -> Self;

    /// The square root; negative numbers count as 0.
    fn sqrt(self) -> Self;

    /// e to the power of minus this number, which is not negative.
    fn exp_neg(self) -> Self;

    /// One of the numbers that are enclosed, exactly.
    fn point(self) -> Self;

    /// An upper bound of the distance of the enclosed numbers from [`point`](Self::point).
    fn radius(self) -> f64;

    /// Encloses what both enclose, and all in between.
    fn hull(self, other: Self) -> Self;

    /// An integer.
    fn int(integer: i64) -> Self {
        Self::scaled(integer, 0)
    }

    /// Some float near the middle.
    fn middle(self) -> f64 {
        let [low, high] = self.bounds();
        low + (high - low) * 0.5
    }

    /// Returns the largest distance of the bounds.
    fn width(self) -> f64 {
        let [low, high] = self.bounds();
        (high - low).next_up()
    }

    fn zero() -> Self {
        Self::scaled(0, 0)
    }

    fn one() -> Self {
        Self::scaled(1, 0)
    }

    fn half(self) -> Self {
        self * Self::scaled(1, 1)
    }

    /// The magnitude.
    fn abs(self) -> Self {
        match self.sign() {
            Some(Ordering::Less) => -self,
            Some(_) => self,
            None => {
                let [low, high] = self.bounds();
                Self::zero().hull(Self::float(high.max(-low)))
            }
        }
    }

    /// The larger of two, or an enclosure of both where that is open.
    fn at_least(self, other: Self) -> Self {
        match (self - other).sign() {
            Some(Ordering::Less) => other,
            Some(_) => self,
            // Values below `other` are enclosed too, which does no harm.
            None => self.hull(other),
        }
    }

    /// The smaller of two, or an enclosure of both where that is open.
    fn at_most(self, other: Self) -> Self {
        -(-self).at_least(-other)
    }
}

/// Returns whether a number is above 0; `None` if that is open.
pub fn positive<N: Enclosure>(number: N) -> Option<bool> {
    let [low, high] = number.bounds();
    match number.sign() {
        Some(sign) => Some(sign == Ordering::Greater),
        // Zero or less, or zero or more, is open in one direction alone.
        None if high <= 0.0 => Some(false),
        None if low > 0.0 => Some(true),
        None => None,
    }
}

/// A vector or a color.
pub type Three<N> = [N; 3];

pub fn dot<N: Enclosure>(a: Three<N>, b: Three<N>) -> N {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Returns the product with itself.
pub fn norm2<N: Enclosure>(a: Three<N>) -> N {
    a[0].square() + a[1].square() + a[2].square()
}

pub fn minus<N: Enclosure>(a: Three<N>, b: Three<N>) -> Three<N> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `a + s b`.
pub fn along<N: Enclosure>(a: Three<N>, s: N, b: Three<N>) -> Three<N> {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

pub fn scale<N: Enclosure>(a: Three<N>, s: N) -> Three<N> {
    a.map(|x| x * s)
}

pub fn times<N: Enclosure>(a: Three<N>, b: Three<N>) -> Three<N> {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2]]
}

pub fn plus<N: Enclosure>(a: Three<N>, b: Three<N>) -> Three<N> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub fn hull<N: Enclosure>(a: Three<N>, b: Three<N>) -> Three<N> {
    [a[0].hull(b[0]), a[1].hull(b[1]), a[2].hull(b[2])]
}

pub fn cross<N: Enclosure>(a: Three<N>, b: Three<N>) -> Three<N> {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub fn opposite<N: Enclosure>(a: Three<N>) -> Three<N> {
    a.map(|x| -x)
}

/// Returns the vector at length 1; `None` if it may have no length.
pub fn unit<N: Enclosure>(v: Three<N>) -> Option<Three<N>> {
    // Squares of very long and very short vectors would leave the range of floats, so they are scaled by a power of
    // two.
    let largest = v.iter().fold(0.0_f64, |most, x| {
        let [low, high] = x.bounds();
        most.max(high.abs()).max(low.abs())
    });
    if !(largest > 0.0 && largest < f64::INFINITY) {
        return None;
    }
    let power = f64::powi(2.0, -(libm::ilogb(largest)).clamp(-900, 900));
    let v = scale(v, N::float(power));
    let length = norm2(v).sqrt();
    let mut unit = [N::zero(); 3];
    for (unit, x) in unit.iter_mut().zip(v) {
        *unit = x.div(length)?;
    }
    Some(unit)
}

/// Converts a radiance with 20 fraction bits.
pub fn radiance_of<N: Enclosure>(q20: i32) -> N {
    N::scaled(q20.into(), 20)
}

/// Converts a ratio with 30 fraction bits.
pub fn ratio_of<N: Enclosure>(q30: i32) -> N {
    N::scaled(q30.into(), 30)
}
