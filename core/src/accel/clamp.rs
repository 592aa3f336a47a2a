//! Crossings clamped to the culling interval of the primitive's box.

use crate::accel::cull::Culling;
use crate::accel::number::Number;
use crate::format::record::UnitBox;
use crate::geometry::{Crossing, LEAVING, Part, accept};
use crate::ray::Ray;

/// Accepts a hit as [`accept`] does, for a crossing that a kernel can have rounded out of the primitive's box.
///
/// `t` is clamped to the interval of the primitive's own box, which holds the true `t`. So clamping never adds to an
/// error, and culling is conservative whatever a kernel rounded.
#[inline(always)]
pub(crate) fn accept_in_box<N: Number, K: Culling<N>>(
    ray: &Ray<N>,
    cull: &K,
    crossing: Crossing<N>,
    bounds: UnitBox,
    tmax: N,
) -> Option<(N, Part)> {
    let Crossing { enter, leave } = crossing;
    // A `t` that clamping would not change needs no interval.
    if leave.0 >= enter.0 && K::holds(ray, enter.0, &bounds) {
        if enter.0 >= ray.tmin {
            return (enter.0 <= tmax).then_some(enter);
        }
        if leave.0 == enter.0 {
            return None;
        }
        if K::holds(ray, leave.0, &bounds) {
            let is_hit = leave.0 >= ray.tmin && leave.0 <= tmax;
            return is_hit.then_some((leave.0, leave.1 | LEAVING));
        }
    }
    let interval = cull.exact(ray).interval(&bounds);
    if interval.near > interval.far {
        return None;
    }
    let (near, far) = (N::from_cull(interval.near), N::from_cull(interval.far));
    let clamp = |t: N| {
        if t < near {
            near
        } else if t > far {
            far
        } else {
            t
        }
    };
    let clamped = Crossing {
        enter: (clamp(enter.0), enter.1),
        leave: (clamp(leave.0), leave.1),
    };
    accept(ray, clamped, tmax)
}

#[cfg(test)]
mod tests;
