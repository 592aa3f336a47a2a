//! Culling arithmetic of floats.

use crate::accel::cull_axis::CullArithmetic;
use crate::accel::cull_axis::CullAxis;
/// The largest inverse slope in culling.
const STEEPEST: f64 = 536_870_912.0;

/// [`CullArithmetic::cull_axis`](crate::accel::cull_axis::CullArithmetic::cull_axis) of an axis along which the ray
/// hardly moves, given the origin times the steepest inverse slope.
#[cold]
fn parallel_axis(offset: i32, descending: bool) -> CullAxis {
    const INVERSE: i32 = STEEPEST as i32;
    const MARGIN: i32 = (INVERSE >> 18) + 3;
    let (inverse, offset) = if descending {
        (-INVERSE, offset)
    } else {
        (INVERSE, offset.wrapping_neg())
    };
    CullAxis::new(
        inverse,
        offset.wrapping_sub(MARGIN),
        offset.wrapping_add(MARGIN + (1 << 17)),
    )
}

macro_rules! cull_arithmetic {
    ($float:ident) => {
        impl CullArithmetic for $float {
            #[inline(always)]
            fn from_cull(steps: i32) -> Self {
                steps as $float * 0.5
            }

            #[inline(always)]
            fn to_cull(self) -> i32 {
                (self * 2.0) as i32
            }

            #[inline(always)]
            fn cull_axis(slope: Self, origin: Self) -> CullAxis {
                let inverse = 131_072.0 / slope;
                let steepness = inverse.abs();
                if steepness < STEEPEST as $float {
                    let offset = -(origin * inverse * (1.0 / 65_536.0));
                    let margin = steepness * (1.0 / 262_144.0) + 3.0;
                    CullAxis::new(
                        inverse as i32,
                        (offset - margin) as i32,
                        (offset + margin) as i32,
                    )
                } else {
                    parallel_axis(
                        (origin * (STEEPEST / 65_536.0) as $float) as i32,
                        slope < 0.0,
                    )
                }
            }
        }
    };
}

cull_arithmetic!(f32);
cull_arithmetic!(f64);
