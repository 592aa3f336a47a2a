//! Projection in floats.

use crate::geometry::Project;
use crate::geometry::project::AxisProjection;
use crate::number::error_free::SPLITTER_F64;
use crate::number::error_free::product_error;
use core::cmp::Ordering;
/// Compares `a b` to `c d`, exactly: products of `f32` fit `f64`.
fn compare_products_f32(a: f32, b: f32, c: f32, d: f32) -> Ordering {
    let (left, right) = (f64::from(a) * f64::from(b), f64::from(c) * f64::from(d));
    left.partial_cmp(&right).unwrap_or(Ordering::Equal)
}

/// Compares `a b` to `c d`, exactly: where the rounded products are equal, by their errors.
///
/// Dekker's product gives the rounding error of each (T. J. Dekker, "A floating-point technique for extending the
/// available precision", 1971). It is exact as long as nothing underflows. The ray's set-up ensures that: the origin's
/// coordinates and the slopes are 0 or at least 2^-100.
fn compare_products_f64(a: f64, b: f64, c: f64, d: f64) -> Ordering {
    let rounded = (a * b).partial_cmp(&(c * d)).unwrap_or(Ordering::Equal);
    rounded.then_with(|| {
        let error = |a, b| product_error(a, b, SPLITTER_F64);
        let (left, right) = (error(a, b), error(c, d));
        left.partial_cmp(&right).unwrap_or(Ordering::Equal)
    })
}

/// [`Project::surrounds_origin`](crate::geometry::Project::surrounds_origin) by the exact signs of the edges, given how two products compare.
#[cold]
#[inline(never)]
fn surround_exactly<F: Copy>(
    a: [F; 2],
    b: [F; 2],
    c: [F; 2],
    compare: impl Fn(F, F, F, F) -> Ordering,
) -> bool {
    let side = |p: [F; 2], q: [F; 2]| compare(p[0], q[1], p[1], q[0]);
    let sides = [side(b, c), side(c, a), side(a, b)];
    sides.contains(&Ordering::Less) != sides.contains(&Ordering::Greater)
}

macro_rules! project {
    ($float:ident, $compare_products:path) => {
        impl Project for $float {
            #[inline(always)]
            fn axis_projection(origin: Self, _: Self, bits: u32) -> AxisProjection<Self> {
                AxisProjection {
                    offset: -(origin * (1_u32 << (bits & 31)) as $float),
                    scale: 1,
                }
            }

            #[inline(always)]
            fn project(coordinate: i32, axis: &AxisProjection<Self>) -> Self {
                coordinate as $float + axis.offset
            }

            #[inline(always)]
            fn shear(slope: Self, major: Self) -> Self {
                // The latter is 1 or -1.
                -(slope * major)
            }

            #[inline(always)]
            fn shear_by(depth: Self, shear: Self) -> Self {
                depth * shear
            }

            #[inline(always)]
            fn surrounds_origin(a: [Self; 2], b: [Self; 2], c: [Self; 2]) -> bool {
                // Rounding is monotone, so the difference of the rounded products has the right
                // sign unless it is zero.
                let cross = |a: [Self; 2], b: [Self; 2]| a[0] * b[1] - a[1] * b[0];
                // Two that differ in sign have a product below zero; one that is zero decides nothing.
                let (u, v) = (cross(b, c), cross(c, a));
                let first = u * v;
                // Few triangles reach this code.
                if first < 0.0 {
                    return false;
                }
                let second = v * cross(a, b);
                if second < 0.0 {
                    return false;
                }
                first > 0.0 && second > 0.0 || surround_exactly(a, b, c, $compare_products)
            }

            fn side(p: [Self; 2], q: [Self; 2]) -> Ordering {
                $compare_products(p[0], q[1], p[1], q[0])
            }
        }
    };
}

project!(f32, compare_products_f32);
project!(f64, compare_products_f64);
