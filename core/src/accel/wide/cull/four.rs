//! The culling form of four rays at once: the operations of [`Single::of`](crate::accel::single::Single::of), with a
//! lane for each ray instead of one for each axis.

use super::WideLanes;
use crate::accel::single::Single;
use crate::ray::FourRays;
use glam::{Mat4, Vec4};

impl WideLanes {
    /// Writes the culling form of four rays.
    #[inline(always)]
    pub(crate) fn write_four(rays: &FourRays, four: [&mut Self; 4]) {
        let axis = |k: usize| {
            let (origin, slope) = (rays.origin[k].into(), rays.slope[k].into());
            Single::of_lanes(origin, slope)
        };
        let [x, y, z] = [axis(0), axis(1), axis(2)];
        let columns = |x: Vec4, y: Vec4, z: Vec4, last: Vec4| {
            let rows = Mat4::from_cols(x, y, z, last).transpose();
            [rows.x_axis, rows.y_axis, rows.z_axis, rows.w_axis]
        };
        let inverse = columns(x.inverse, y.inverse, z.inverse, Vec4::ONE);
        let near = columns(x.near, y.near, z.near, rays.tmin.into());
        let far = columns(x.far, y.far, z.far, Vec4::ZERO);
        for (lane, cull) in four.into_iter().enumerate() {
            cull.inverse = inverse[lane];
            cull.near = near[lane];
            cull.far = far[lane];
            cull.descends = inverse[lane].is_negative_bitmask();
        }
    }
}
