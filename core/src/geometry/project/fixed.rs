//! Projection in fixed point.

use crate::geometry::Project;
use crate::geometry::project::AxisProjection;
use crate::number::Fixed;
use crate::number::Products;
use crate::number::Scalar;
use crate::number::fixed::base::LENGTH_BITS;
use crate::number::fixed::base::RATIO_BITS;
use crate::number::fixed::base::assert_in_range;
use crate::number::fixed::halves;
use crate::number::fixed::halves::product;
use crate::number::fixed::wide::Product;
use crate::target::{NARROW_PRODUCTS, SMALL, inline_unless_small};
use core::cmp::Ordering;

/// [`Project::surrounds_origin`](crate::geometry::Project::surrounds_origin) by the sides on which the edges leave the
/// origin, where they differ. Edges that lead through it are on neither side.
fn surround_by_sides(sides: [i64; 3]) -> bool {
    let negative = sides.iter().any(|&side| side < 0);
    let positive = sides.iter().any(|&side| side > 0);
    negative != positive
}

impl Project for Fixed {
    #[inline(always)]
    fn axis_projection(origin: Self, slope: Self, bits: u32) -> AxisProjection<Self> {
        // All projected values are counted in the direction of the ray. So values are rounded down alike in a mirrored
        // scene.
        let turned = slope.0 >> 31;
        let turn = |x: i32| (x ^ turned).wrapping_sub(turned);
        AxisProjection {
            offset: Fixed(turn(origin.0.wrapping_neg())),
            scale: turn(1_i32.wrapping_shl(LENGTH_BITS.wrapping_sub(bits))),
        }
    }

    // Twice as far: with the 31 fraction bits of a shear, the upper half of a product is a length.
    #[inline(always)]
    fn depth_projection(origin: Self, slope: Self, bits: u32) -> AxisProjection<Self> {
        let AxisProjection { offset, scale } = Self::axis_projection(origin, slope, bits);
        assert_in_range(|| offset.0.unsigned_abs() < 1 << 30);
        AxisProjection {
            offset: Fixed(offset.0.wrapping_shl(1)),
            scale: scale.wrapping_shl(1),
        }
    }

    #[inline(always)]
    fn project(coordinate: i32, axis: &AxisProjection<Self>) -> Self {
        Fixed(coordinate.wrapping_mul(axis.scale)) + axis.offset
    }

    #[inline(always)]
    fn shear(slope: Self, _: Self) -> Self {
        // With 31 fraction bits, of which -1 has room.
        Fixed((slope.0.unsigned_abs() << 1).wrapping_neg() as i32)
    }

    #[inline(always)]
    fn shear_by(depth: Self, shear: Self) -> Self {
        // The upper half of a product, which is the cheapest to compute.
        Fixed((product(depth.0, shear.0) >> 32) as i32)
    }

    inline_unless_small!(
        fn surrounds_origin(a: [Self; 2], b: [Self; 2], c: [Self; 2]) -> bool {
            if NARROW_PRODUCTS && let Some(surround) = halves::surround(a, b, c) {
                return surround;
            }
            let cross = |a: [Self; 2], b: [Self; 2]| (a[0].wide(b[1]) - a[1].wide(b[0])).0;
            let (u, v) = (cross(b, c), cross(c, a));
            // Few triangles reach this code. Where an upper half is not 0, the whole is not 0 either.
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
    );

    fn side(p: [Self; 2], q: [Self; 2]) -> Ordering {
        (p[0].wide(q[1]) - p[1].wide(q[0])).0.cmp(&0)
    }

    #[inline(always)]
    fn same_sign(v: [Self; 3]) -> bool {
        let zero = Self::ZERO;
        v[0] < zero && v[1] < zero && v[2] < zero || v[0] > zero && v[1] > zero && v[2] > zero
    }

    #[inline(always)]
    fn is_steep(approach: Product) -> bool {
        // 2^-8 with 60 fraction bits; the upper half decides. Code that is optimized for size has one path for all.
        const LEAST: i32 = 1 << (2 * RATIO_BITS - 8 - 32);
        let upper = (approach.0 >> 32) as i32;
        !SMALL && !(-LEAST..LEAST).contains(&upper)
    }
}
