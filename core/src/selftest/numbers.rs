//! Arithmetic, compared with exact arithmetic in wider integers.

use crate::accel::Number;
use crate::geometry::Project;
use crate::number::Fixed;
use crate::number::Products;
use crate::number::Scalar;
use crate::selftest::checks::{Checks, FNV_START, Random, hash, name};

type Product = <Fixed as crate::number::Scalar>::Wide;

const ROUNDS: usize = 2_000;

/// A quotient rounded to nearest, ties away from zero.
fn nearest(numerator: i128, denominator: i128) -> i128 {
    let magnitude = (2 * numerator.abs() + denominator.abs()) / (2 * denominator.abs()).max(1);
    if (numerator < 0) == (denominator < 0) {
        magnitude
    } else {
        -magnitude
    }
}

fn saturated(value: i128) -> i128 {
    value.clamp(-i128::from(i32::MAX), i128::from(i32::MAX))
}

pub(super) fn products(checks: &mut Checks<'_>) {
    let mut random = Random(1);
    for round in 0..ROUNDS {
        let (a, b) = (random.integer(31) as i32, random.integer(30) as i32);
        let (x, y) = (Fixed(a), Fixed(b));
        let (a, b) = (i128::from(a), i128::from(b));
        let one = 1_i128 << 30;
        checks.equal(
            format_args!("{a} * {b} ({round})"),
            (x * y).0.into(),
            nearest(a * b, one),
        );
        if b != 0 {
            checks.equal(
                format_args!("{a} over {b}"),
                x.div(y).0.into(),
                saturated(nearest(a * one, b)),
            );
        }
        let wide = random.integer(62);
        let scaled = Fixed::wide_scale(Product::far_of(wide), y).value();
        let exact = i128::from(wide) * b / one;
        checks.that(
            format_args!("{wide} scaled by {b}"),
            (i128::from(scaled) - exact).abs() <= 2,
            format_args!("is {scaled} and should be {exact}"),
        );
        let denominator = random.integer(62);
        if denominator != 0 {
            let quotient = Fixed::divide(Product::far_of(wide), Product::far_of(denominator));
            let exact = saturated(nearest(i128::from(wide) * one, denominator.into()));
            // The divisor has 32 bits, so the quotient has an error of 2^-31 and a rounding.
            checks.that(
                format_args!("{wide} / {denominator}"),
                (i128::from(quotient.0) - exact).abs() <= 1 + (exact.abs() >> 30),
                format_args!("is {} and should be {exact}", quotient.0),
            );
        }
    }
    let largest = Fixed(i32::MAX);
    checks.equal(format_args!("1 over 0"), Fixed::ONE.div(Fixed(0)), largest);
    checks.equal(format_args!("0 over 0"), Fixed(0).div(Fixed(0)), Fixed(0));
}

/// Names for the products of `Fixed`.
trait Exact {
    fn far_of(value: i64) -> Self;
    fn value(self) -> i64;
}

impl Exact for Product {
    fn far_of(value: i64) -> Self {
        Fixed::far(value)
    }

    fn value(self) -> i64 {
        self.0
    }
}

pub(super) fn roots(checks: &mut Checks<'_>) {
    let mut random = Random(2);
    let edges = [
        0,
        1,
        2,
        3,
        4,
        (1 << 31) - 1,
        1 << 31,
        1 << 32,
        (1 << 62) - 1,
    ];
    let squares = (1..31).flat_map(|bits| {
        let square = (1_i64 << bits) * (1_i64 << bits);
        [square - 1, square, square + 1]
    });
    let drawn = core::iter::repeat_with(|| random.integer(61).abs()).take(ROUNDS);
    for square in edges.into_iter().chain(squares).chain(drawn) {
        let root = i128::from(Fixed::root(Fixed::far(square)).0);
        let four = 4 * i128::from(square);
        checks.that(
            format_args!("root of {square}"),
            (2 * root - 1).max(0).pow(2) <= four && four <= (2 * root + 1).pow(2)
                || root == i128::from(i32::MAX),
            format_args!("is {root}"),
        );
    }
    for (ratio, root) in [(0, 0), (1 << 30, 1 << 30), (1 << 28, 1 << 29), (-5, 0)] {
        checks.equal(
            format_args!("root of {ratio}"),
            Fixed(ratio).sqrt(),
            Fixed(root),
        );
    }
}

/// Two plane vectors that are nearly, or exactly, parallel.
fn nearly_parallel(random: &mut Random, bits: u32) -> ([i64; 2], [i64; 2]) {
    let half = bits / 2;
    let (x, y) = (random.integer(half), random.integer(half));
    let (p, q) = (random.integer(half - 1), random.integer(half - 1));
    let jitter = [random.integer(2) / 2, random.integer(2) / 2];
    ([x * p + jitter[0], y * p], [x * q, y * q + jitter[1]])
}

/// A triangle of integers. One of its edges leads closely past the origin, or through it.
fn triangle(random: &mut Random, bits: u32) -> [[i64; 2]; 3] {
    let (a, b) = nearly_parallel(random, bits);
    let c = [0, 1].map(|k| -(a[k] / 2) - b[k] / 2);
    if random.integer(1) == 0 {
        [a, b, c]
    } else {
        [b, c, a]
    }
}

fn surrounds_exactly([a, b, c]: [[i64; 2]; 3]) -> bool {
    let side = |p: [i64; 2], q: [i64; 2]| {
        let ([px, py], [qx, qy]) = (p.map(i128::from), q.map(i128::from));
        px * qy - py * qx
    };
    let sides = [side(a, b), side(b, c), side(c, a)];
    sides.iter().any(|&side| side > 0) != sides.iter().any(|&side| side < 0)
}

pub(super) fn fixed_signs(checks: &mut Checks<'_>) {
    let mut random = Random(3);
    for _ in 0..ROUNDS {
        let corners = triangle(&mut random, 31);
        let [a, b, c] = corners.map(|v| v.map(|x| Fixed(x as i32)));
        let found = Fixed::surrounds_origin(a, b, c);
        let expected = surrounds_exactly(corners);
        checks.equal(format_args!("{corners:?}"), found, expected);
    }
}

pub(super) fn float_signs(checks: &mut Checks<'_>) {
    let mut random = Random(4);
    for _ in 0..ROUNDS {
        let corners = triangle(&mut random, 24);
        let [a, b, c] = corners.map(|v| v.map(|x| x as f32 / 256.0));
        let found = f32::surrounds_origin(a, b, c);
        let expected = surrounds_exactly(corners);
        checks.equal(format_args!("f32 {corners:?}"), found, expected);
        let corners = triangle(&mut random, 52);
        let [a, b, c] = corners.map(|v| v.map(|x| x as f64 / 256.0));
        let found = f64::surrounds_origin(a, b, c);
        let expected = surrounds_exactly(corners);
        checks.equal(format_args!("f64 {corners:?}"), found, expected);
    }
}

/// Whatever instruction computes them, down to the smallest number and up to the largest.
pub(super) fn float_roots(checks: &mut Checks<'_>) {
    let mut random = Random(7);
    let ends = [1, 0x007f_ffff, 0x0080_0000, 0x3f80_0001, f32::MAX.to_bits()];
    let drawn = core::iter::repeat_with(|| random.integer(31).unsigned_abs() as u32);
    let finite = drawn
        .take(ROUNDS)
        .filter(|bits| *bits < f32::INFINITY.to_bits());
    for bits in finite.chain(ends) {
        let x = f32::from_bits(bits);
        let (found, expected) = (Scalar::sqrt(x).to_bits(), libm::sqrtf(x).to_bits());
        checks.equal(format_args!("root of {bits:#x}"), found, expected);
    }
}

pub(super) fn vectors(checks: &mut Checks<'_>) {
    // The distance from 1 to the next number.
    vectors_in::<Fixed>(checks, 1.0 / 1_073_741_824.0);
    vectors_in::<f32>(checks, f32::EPSILON.into());
    vectors_in::<f64>(checks, f64::EPSILON);
}

fn vectors_in<N: Number>(checks: &mut Checks<'_>, ulp: f64) {
    // A sum of three squares, a root and a quotient: less than four roundings.
    let tolerance = 4.0 * ulp;
    let mut random = Random(5);
    for _ in 0..ROUNDS / 4 {
        let v = [0; 3].map(|_: i32| random.integer(40));
        if v == [0; 3] {
            continue;
        }
        let what = name::<N>();
        let exact = v.map(|x| x as f64);
        let largest = exact.iter().fold(0.0, |most, x: &f64| x.abs().max(most));
        let Some((slopes, axis)) = N::slopes(v.map(N::far)) else {
            checks.equal(format_args!("{what} slopes of {v:?}"), "rejected", "made");
            continue;
        };
        checks.near(
            format_args!("{what} major slope of {v:?}"),
            slopes[axis].ratio_to_f64().abs(),
            1.0,
            0.0,
        );
        let (unit, _) = N::normalize(slopes);
        let square = unit.iter().fold(0.0, |sum, x| {
            let x = x.ratio_to_f64();
            sum + x * x
        });
        checks.near(
            format_args!("{what} unit length of {v:?}"),
            square,
            1.0,
            tolerance,
        );
        for axis in 0..3 {
            checks.near(
                format_args!("{what} slope {axis} of {v:?}"),
                slopes[axis].ratio_to_f64(),
                exact[axis] / largest,
                tolerance,
            );
        }
    }
    let zero = N::slopes([N::Wide::default(); 3]).is_none();
    checks.equal(format_args!("zero vector has no slopes"), zero, true);
}

/// Long chains of every operation: if one bit differs anywhere, the hash differs.
pub(super) fn bits(checks: &mut Checks<'_>) {
    checks.equal(format_args!("f32"), chain::<f32>(), 1_029_389_503);
    checks.equal(format_args!("f64"), chain::<f64>(), 2_651_187_688);
    checks.equal(format_args!("fixed"), chain::<Fixed>(), 973_768_781);
}

fn chain<N: Number>() -> u32 {
    let mut random = Random(6);
    let results = core::iter::repeat_with(|| {
        let ratio = |random: &mut Random| N::ratio(random.integer(30) as i32);
        let (a, b, c) = (ratio(&mut random), ratio(&mut random), ratio(&mut random));
        let length = N::from_lattice(random.integer(24) as i32);
        let (unit, norm) = N::normalize([a, b, c]);
        let sum = (a * b - c.half()).abs().sqrt() + unit[0] * unit[1] + norm.half();
        let faded = length
            .abs()
            .exp_neg(random.integer(20).unsigned_abs() as u32, 0);
        let quotient = N::divide(length.wide(a), N::dot(unit, unit));
        let cell = length.cell(N::from_unit(3));
        [
            sum.ratio_to_f64(),
            faded.ratio_to_f64(),
            quotient.length_to_f64(),
            cell.into(),
        ]
    });
    let values = results.take(ROUNDS / 4).flatten();
    // Zeros can differ in their sign, on which nothing depends.
    hash(
        FNV_START,
        values.flat_map(|value| (value + 0.0).to_bits().to_le_bytes()),
    )
}
