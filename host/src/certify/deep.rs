//! Balls around numbers of 128 or 256 bits.
//!
//! A ball is a middle of many bits and a radius of double precision. The rounding of an operation is added to the
//! radius, which is rounded up. Exact results stay exact, so that sums and products of a blob's integers are compared
//! exactly.
//!
//! The numbers lie in a table of the thread, which [`with_bits`] clears. So a ball is an index, and kernels copy it as
//! they copy floats.

use super::number::Enclosure;
use dashu_float::round::mode::HalfEven;
use dashu_float::{Context, FBig};
use std::cell::RefCell;
use std::cmp::Ordering;
use std::ops::{Add, Mul, Neg, Sub};

type Big = FBig<HalfEven, 2>;

/// A ball in the table of the thread.
#[derive(Clone, Copy, Debug)]
pub struct Ball(u32);

/// The balls of one evaluation.
struct Balls {
    bits: usize,
    most: usize,
    all: Vec<(Big, f64)>,
}

thread_local! {
    static BALLS: RefCell<Balls> = const {
        RefCell::new(Balls { bits: 128, most: MOST, all: Vec::new() })
    };
}

/// Most balls of one evaluation, some 500 MB per thread; [`is_full`] says that they are used up. It is asked before each
/// test of a primitive, each light and each ray.
const MOST: usize = 3 << 20;

/// Runs an evaluation with a precision. Balls must not leave it.
pub fn with_bits<R>(bits: usize, evaluate: impl FnOnce() -> R) -> R {
    BALLS.with_borrow_mut(|balls| {
        balls.bits = bits;
        balls.all.clear();
    });
    let result = evaluate();
    BALLS.with_borrow_mut(|balls| {
        balls.all.clear();
        balls.all.shrink_to(1 << 16);
    });
    result
}

/// Returns whether an evaluation took more numbers than there is room for.
pub fn is_full() -> bool {
    BALLS.with_borrow(|balls| balls.all.len() >= balls.most)
}

/// Runs an evaluation with room for fewer balls, and returns how many it took, too.
#[cfg(test)]
pub fn with_room<R>(most: usize, evaluate: impl FnOnce() -> R) -> (R, usize) {
    BALLS.with_borrow_mut(|balls| balls.most = most);
    let result = evaluate();
    let taken = BALLS.with_borrow_mut(|balls| {
        balls.most = MOST;
        balls.all.len()
    });
    (result, taken)
}

/// A bound of a computed radius, which a few roundings may have made too small.
fn up(radius: f64) -> f64 {
    (radius * (1.0 + 1e-14)).next_up()
}

/// At least the magnitude.
fn magnitude(big: &Big) -> f64 {
    if *big == zero() {
        return 0.0;
    }
    up(big.to_f64().value().abs())
}

/// A bound of a product: 0 if a factor is, and above it if it is too small for a float.
fn product(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 {
        return 0.0;
    }
    up(a * b)
}

fn zero() -> Big {
    Big::ZERO
}

impl Balls {
    fn push(&mut self, middle: Big, radius: f64) -> Ball {
        let index = self.all.len() as u32;
        self.all.push((middle, radius));
        Ball(index)
    }

    fn context(&self) -> Context<HalfEven> {
        Context::new(self.bits)
    }

    /// Returns a bound of the rounding of a number.
    fn rounding(&self, rounded: &Big) -> f64 {
        magnitude(rounded) * f64::powi(2.0, 2 - self.bits as i32)
    }

    /// A rounded middle, and a radius with what was rounded.
    fn rounded(&mut self, middle: (Big, bool), radius: f64) -> Ball {
        let (middle, is_exact) = middle;
        let radius = match (is_exact, radius == 0.0) {
            (true, true) => 0.0,
            (true, false) => up(radius),
            (false, _) => up(radius + self.rounding(&middle)),
        };
        self.push(middle, radius)
    }

    fn get(&self, ball: Ball) -> (&Big, f64) {
        let (middle, radius) = &self.all[ball.0 as usize];
        (middle, *radius)
    }
}

/// An operation on the table.
fn on_balls<R>(operation: impl FnOnce(&mut Balls) -> R) -> R {
    BALLS.with_borrow_mut(operation)
}

impl Add for Ball {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        on_balls(|balls| {
            let ((a, r), (b, s)) = (balls.get(self), balls.get(other));
            let sum = balls.context().add(a.repr(), b.repr());
            let sum = sum.expect("finite numbers").value_with_exact();
            balls.rounded(sum, r + s)
        })
    }
}

impl Sub for Ball {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        on_balls(|balls| {
            let ((a, r), (b, s)) = (balls.get(self), balls.get(other));
            let difference = balls.context().sub(a.repr(), b.repr());
            let difference = difference.expect("finite numbers").value_with_exact();
            balls.rounded(difference, r + s)
        })
    }
}

impl Neg for Ball {
    type Output = Self;
    fn neg(self) -> Self {
        on_balls(|balls| {
            let (a, r) = balls.get(self);
            let negative = -a.clone();
            balls.push(negative, r)
        })
    }
}

impl Mul for Ball {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        on_balls(|balls| {
            let ((a, r), (b, s)) = (balls.get(self), balls.get(other));
            let exact = balls.context().mul(a.repr(), b.repr());
            let exact = exact.expect("finite numbers").value_with_exact();
            let radius = product(magnitude(a), s) + product(magnitude(b), r) + product(r, s);
            balls.rounded(exact, radius)
        })
    }
}

impl Enclosure for Ball {
    fn scaled(integer: i64, places: u32) -> Self {
        on_balls(|balls| {
            let exact = Big::from_parts(integer.into(), -(places as isize));
            balls.push(exact, 0.0)
        })
    }

    fn float(value: f64) -> Self {
        // No number of a scene comes near the ends of the range: an infinite bound becomes the largest float.
        let value = value.clamp(-f64::MAX, f64::MAX);
        let exact = Big::try_from(value).unwrap_or(zero());
        on_balls(|balls| balls.push(exact, 0.0))
    }

    fn bounds(self) -> [f64; 2] {
        on_balls(|balls| {
            let (middle, radius) = balls.get(self);
            let near = middle.to_f64().value();
            // A float that is the number itself needs no margin.
            if radius == 0.0 && Big::try_from(near).is_ok_and(|exact| exact == *middle) {
                return [near, near];
            }
            let (low, high) = (near.next_down(), near.next_up());
            [(low - radius).next_down(), (high + radius).next_up()]
        })
    }

    fn sign(self) -> Option<Ordering> {
        on_balls(|balls| {
            let (middle, radius) = balls.get(self);
            let sign = middle.cmp(&zero());
            if radius == 0.0 {
                return Some(sign);
            }
            // Below the magnitude by more than what makes it a float.
            let magnitude = middle.to_f64().value().abs();
            let is_apart = magnitude * (1.0 - 1e-15) > radius;
            is_apart.then_some(sign)
        })
    }

    fn div(self, divisor: Self) -> Option<Self> {
        divisor.sign().filter(|sign| sign.is_ne())?;
        on_balls(|balls| {
            let ((a, r), (b, s)) = (balls.get(self), balls.get(divisor));
            let quotient = balls.context().div(a.repr(), b.repr());
            let quotient = quotient.expect("finite numbers").value_with_exact();
            // 0 over anything is 0.
            let radius = if r == 0.0 && (s == 0.0 || *a == zero()) {
                0.0
            } else {
                // |a / b - (a + r') / (b + s')| <= (r + |a / b| s) / (|b| - s)
                let least = b.to_f64().value().abs() * (1.0 - 1e-15) - s;
                let size = magnitude(&quotient.0) + balls.rounding(&quotient.0);
                up(up(r + up(size * s)) / (least * (1.0 - 1e-15)))
            };
            if !radius.is_finite() {
                return None;
            }
            Some(balls.rounded(quotient, radius))
        })
    }

    fn square(self) -> Self {
        self * self
    }

    fn sqrt(self) -> Self {
        let [low, high] = self.bounds();
        if high <= 0.0 {
            return Self::zero();
        }
        if self.sign() != Some(Ordering::Greater) || low <= 0.0 {
            let half = (up(high.sqrt()) * 0.5).min(f64::MAX);
            return on_balls(|balls| {
                let middle = Big::try_from(half).expect("a finite number");
                balls.push(middle, half)
            });
        }
        on_balls(|balls| {
            let (a, r) = balls.get(self);
            let root = balls.context().sqrt(a.repr());
            let root = root.expect("a positive number").value_with_exact();
            // The difference of two roots is that of the numbers over the roots' sum.
            let radius = if r == 0.0 {
                0.0
            } else {
                up(r / (root.0.to_f64().value() * (1.0 - 1e-15)))
            };
            balls.rounded(root, radius)
        })
    }

    fn exp_neg(self) -> Self {
        let [low, high] = self.bounds();
        if high <= 0.0 {
            return Self::one();
        }
        if low <= 0.0 {
            return Self::one().hull(Self::float(high).exp_neg());
        }
        if low > 700.0 {
            return Self::zero().hull(Self::float(f64::MIN_POSITIVE.max(libm::exp(-low) * 1.001)));
        }
        on_balls(|balls| {
            let (a, r) = balls.get(self);
            let negative = -a.clone();
            let precise = Context::<HalfEven>::new(balls.bits + 32);
            let power = precise.exp(negative.repr(), None);
            let power = power.expect("a finite number").value();
            // The slope is at most 1 where the exponent is not positive.
            let radius = up(r + balls.rounding(&power));
            balls.rounded((power, false), radius)
        })
    }

    fn point(self) -> Self {
        on_balls(|balls| {
            let middle = balls.get(self).0.clone();
            balls.push(middle, 0.0)
        })
    }

    fn radius(self) -> f64 {
        on_balls(|balls| balls.get(self).1)
    }

    fn hull(self, other: Self) -> Self {
        on_balls(|balls| {
            let ((a, r), (b, s)) = (balls.get(self), balls.get(other));
            if a == b {
                let (middle, radius) = (a.clone(), r.max(s));
                return balls.push(middle, radius);
            }
            let context = balls.context();
            let sum = context.add(a.repr(), b.repr());
            let (sum, _) = sum.expect("finite numbers").value_with_exact();
            let apart = context.sub(a.repr(), b.repr());
            let (apart, _) = apart.expect("finite numbers").value_with_exact();
            let half = Big::from_parts(1.into(), -1);
            let middle = context.mul(sum.repr(), half.repr());
            let middle = middle.expect("finite numbers").value_with_exact();
            let rounded = balls.rounding(&sum) + balls.rounding(&apart);
            let radius = up(up(magnitude(&apart) * 0.5) + r.max(s) + rounded);
            balls.rounded(middle, radius)
        })
    }
}
