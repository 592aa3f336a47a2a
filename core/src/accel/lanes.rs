//! Culling on machines with SIMD registers: the planes of one axis of both children at once.
//!
//! Rule and margins are those of `single.rs`.

#![allow(dead_code, reason = "targets without SIMD registers cull in integers")]

use crate::accel::cull;
use crate::accel::cull::{Cull, Culling, PairCulling};
use crate::accel::cull_axis::CullArithmetic;
use crate::accel::cull_axis::Interval;
use crate::accel::single::Single;
use crate::format::record::{Pair, UnitBox};
use crate::ray::Ray;
use glam::Vec4;

/// The culling form of a ray in lanes of `f32`: t in units.
#[derive(Clone, Copy, Debug, Default)]
pub struct Lanes {
    /// One over the slope, in all lanes, per axis.
    inverse: [Vec4; 3],
    /// The offsets from products to t, for a lower plane in the first two lanes and an upper one in the
    /// others, per axis.
    offset: [Vec4; 3],
    start: f32,
}

/// Returns t as an integer of the same order; t is not negative where the order matters.
#[inline(always)]
fn in_order(t: f32) -> i32 {
    t.to_bits() as i32
}

impl Lanes {
    /// The first and last t of two boxes, in the first two lanes of each.
    #[inline(always)]
    fn intervals(&self, planes: &[[[i16; 2]; 2]; 3], start: f32, limit: f32) -> (Vec4, Vec4) {
        let axis = |axis: usize| {
            let [[a, b], [c, d]] = planes[axis];
            let planes = Vec4::new(f32::from(a), f32::from(b), f32::from(c), f32::from(d));
            let t = planes * self.inverse[axis] + self.offset[axis];
            // Both planes in every lane, so that the ray's direction does not matter.
            let other = Vec4::new(t.z, t.w, t.x, t.y);
            (t.min(other), t.max(other))
        };
        let ((near_x, far_x), (near_y, far_y), (near_z, far_z)) = (axis(0), axis(1), axis(2));
        let near = near_x.max(near_y).max(near_z.max(Vec4::splat(start)));
        let far = far_x.min(far_y).min(far_z.min(Vec4::splat(limit)));
        (near, far)
    }
}

impl<N: CullArithmetic> Culling<N> for Lanes {
    #[inline(always)]
    fn new(ray: &Ray<N>) -> Self {
        let Single { inverse, near, far } = Single::of(ray);
        let descending = inverse.cmplt(Vec4::ZERO);
        let lower = Vec4::select(descending, far, near).to_array();
        let upper = Vec4::select(descending, near, far).to_array();
        let offset = |axis: usize| Vec4::new(lower[axis], lower[axis], upper[axis], upper[axis]);
        Self {
            inverse: [
                Vec4::splat(inverse.x),
                Vec4::splat(inverse.y),
                Vec4::splat(inverse.z),
            ],
            offset: [offset(0), offset(1), offset(2)],
            start: ray.tmin.to_f32(),
        }
    }

    #[inline(always)]
    fn exact(&self, ray: &Ray<N>) -> Cull {
        Cull::new(ray)
    }

    fn units(place: i32) -> f64 {
        Single::units(place)
    }

    #[inline(always)]
    fn holds(ray: &Ray<N>, t: N, bounds: &UnitBox) -> bool {
        cull::holds(ray, t, bounds)
    }
}

impl<N: CullArithmetic> PairCulling<N> for Lanes {
    #[inline(always)]
    fn root(&self, bounds: &UnitBox, limit: i32) -> Interval {
        let planes = bounds.0.map(|[low, high]| [[low, low], [high, high]]);
        let (near, far) = self.intervals(&planes, self.start, f32::from_bits(limit as u32));
        Interval {
            near: in_order(near.x),
            far: in_order(far.x),
        }
    }

    #[inline(always)]
    fn limit(t: N) -> i32 {
        Single::limit(t)
    }

    #[inline(always)]
    fn children(&self, pair: &Pair, limit: i32) -> [Interval; 2] {
        let (near, far) = self.intervals(&pair.planes, self.start, f32::from_bits(limit as u32));
        [
            Interval {
                near: in_order(near.x),
                far: in_order(far.x),
            },
            Interval {
                near: in_order(near.y),
                far: in_order(far.y),
            },
        ]
    }
}
