//! Culling arithmetic of fixed point.

use crate::accel::cull_axis::CullArithmetic;
use crate::accel::cull_axis::CullAxis;
use crate::number::Fixed;
use crate::number::fixed::base::LENGTH_BITS;
use crate::number::fixed::base::RATIO_BITS;
use crate::number::fixed::base::assert_in_range;
use crate::number::fixed::base::saturate;
use crate::number::fixed::halves::leading_zeros;
use crate::number::fixed::halves::product;
use crate::number::fixed::reciprocal::reciprocal;
impl CullArithmetic for Fixed {
    #[inline(always)]
    fn from_cull(steps: i32) -> Self {
        saturate((steps as i64) << (LENGTH_BITS - 1))
    }

    #[inline(always)]
    fn to_cull(self) -> i32 {
        self.0 >> (LENGTH_BITS - 1)
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
        assert_in_range(|| offset.unsigned_abs() <= 1 << 30);
        let (back, margin) = (offset.wrapping_neg(), (steepness >> 18).wrapping_add(3));
        CullAxis::new(
            inverse,
            back.wrapping_sub(margin),
            back.wrapping_add(margin).wrapping_add(parallel),
        )
    }
}
