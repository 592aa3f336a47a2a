//! Real numbers with 320 bits: no test here can distinguish them from exact ones.

use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

const PRECISION: usize = 320;

/// A real number, rounded to 320 bits by every operation.
#[derive(Clone, Debug)]
pub struct Real(FBig<HalfEven, 2>);

/// Three real numbers.
pub type Vector = [Real; 3];

impl Real {
    /// Converts a finite float exactly.
    pub fn of(value: f64) -> Self {
        let exact = FBig::<HalfEven, 2>::try_from(value).expect("a finite number");
        Self(exact.with_precision(PRECISION).value())
    }

    pub fn to_f64(&self) -> f64 {
        self.0.to_f64().value()
    }

    /// Square root; 0 for anything negative.
    pub fn sqrt(&self) -> Self {
        if self.is_positive() {
            let rounded = self.0.clone().with_precision(PRECISION).value();
            Self(rounded.sqrt())
        } else {
            Self::of(0.0)
        }
    }

    pub fn is_positive(&self) -> bool {
        *self > Self::of(0.0)
    }

    pub fn is_negative(&self) -> bool {
        *self < Self::of(0.0)
    }

    pub fn abs(&self) -> Self {
        if self.is_negative() {
            -self
        } else {
            self.clone()
        }
    }

    /// Returns whether this is zero within the roundings of 320 bits.
    pub fn is_zero(&self) -> bool {
        self.abs() < Self::of(f64::powi(2.0, -200))
    }

    pub fn max(self, other: Self) -> Self {
        if other > self { other } else { self }
    }

    pub fn min(self, other: Self) -> Self {
        if other < self { other } else { self }
    }
}

impl PartialEq for Real {
    fn eq(&self, other: &Self) -> bool {
        self.0 == other.0
    }
}

impl PartialOrd for Real {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.0.cmp(&other.0))
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl $trait<&Real> for &Real {
            type Output = Real;
            fn $method(self, other: &Real) -> Real {
                Real((&self.0).$method(&other.0))
            }
        }

        impl $trait<Real> for Real {
            type Output = Real;
            fn $method(self, other: Real) -> Real {
                (&self).$method(&other)
            }
        }

        impl $trait<&Real> for Real {
            type Output = Real;
            fn $method(self, other: &Real) -> Real {
                (&self).$method(other)
            }
        }

        impl $trait<Real> for &Real {
            type Output = Real;
            fn $method(self, other: Real) -> Real {
                self.$method(&other)
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl Neg for &Real {
    type Output = Real;
    fn neg(self) -> Real {
        Real(-self.0.clone())
    }
}

impl Neg for Real {
    type Output = Real;
    fn neg(self) -> Real {
        -&self
    }
}

/// Converts a vector of finite floats exactly.
pub fn vector(v: impl Into<[f64; 3]>) -> Vector {
    v.into().map(Real::of)
}

pub fn dot(a: &Vector, b: &Vector) -> Real {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

pub fn minus(a: &Vector, b: &Vector) -> Vector {
    [0, 1, 2].map(|k| &a[k] - &b[k])
}

/// `a + s b`.
pub fn along(a: &Vector, s: &Real, b: &Vector) -> Vector {
    [0, 1, 2].map(|k| &a[k] + s * &b[k])
}

pub fn cross(a: &Vector, b: &Vector) -> Vector {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &a[i] * &b[j] - &a[j] * &b[i])
}

pub fn norm(v: &Vector) -> Real {
    dot(v, v).sqrt()
}

pub fn scaled(v: &Vector, s: &Real) -> Vector {
    [0, 1, 2].map(|k| &v[k] * s)
}

/// Returns a vector of length 1; a zero vector stays zero.
pub fn unit(v: &Vector) -> Vector {
    let length = norm(v);
    if length.is_zero() {
        v.clone()
    } else {
        scaled(v, &(Real::of(1.0) / length))
    }
}

/// A line: where t is 0, and what t is multiplied with.
#[derive(Clone, Debug)]
pub struct Line {
    pub origin: Vector,
    pub slope: Vector,
}

impl Line {
    pub fn new(origin: [f64; 3], slope: [f64; 3]) -> Self {
        Self {
            origin: vector(origin),
            slope: vector(slope),
        }
    }

    pub fn at(&self, t: &Real) -> Vector {
        along(&self.origin, t, &self.slope)
    }
}
