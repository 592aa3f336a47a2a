//! Culling of a node's eight children, in the ray's own arithmetic: lanes of single precision for floats, integers for
//! [`Fixed`](crate::Fixed).
//!
//! In lanes, rule and margins are those of `single.rs`.

#[cfg(all(feature = "avx2", target_arch = "x86_64"))]
mod four;

use crate::accel::cull;
use crate::accel::cull::{Cull, Culling, PairCulling};
use crate::accel::cull_axis::CullArithmetic;
use crate::accel::single::Single;
use crate::format::cluster::LANES;
use crate::format::record::{UnitBox, WideNode};
use crate::ray::Ray;
use crate::simd::{F32x8, Simd};
use glam::Vec4;

/// A form of a ray that culls eight boxes at once.
pub trait WideCulling<N: CullArithmetic>: Culling<N> {
    /// The limit for hits at or before a length.
    fn limit(t: N) -> i32;
    /// Returns the first and the last place of the ray in a box up to a limit, in units, by the test of [`children`].
    ///
    /// [`children`]: Self::children
    fn span(&self, bounds: &UnitBox, limit: i32) -> [f64; 2];
    /// Returns the children that the ray can hit up to a limit, one bit each, and the places where it enters them.
    /// These compare with a limit.
    ///
    /// If `fused`, places are rounded once or twice, whichever is faster on the processor.
    fn children<S: Simd>(
        &self,
        simd: S,
        node: &WideNode,
        limit: i32,
        fused: bool,
    ) -> (u32, [i32; LANES]);
}

/// The culling form of a ray in eight lanes of `f32`: t in units.
#[derive(Clone, Copy, Debug, Default)]
pub struct WideLanes {
    /// One over the slope, per axis.
    inverse: Vec4,
    /// The offsets from the near planes' products to t; and the ray's start.
    near: Vec4,
    /// The offsets from the far planes' products to t.
    far: Vec4,
    /// One bit per axis, set where the ray runs down it: a node's upper row has the near planes there.
    descends: u32,
}

impl WideLanes {
    /// The rows of the axes' near planes.
    #[inline(always)]
    fn near_rows(&self) -> [usize; 3] {
        let descends = self.descends as usize;
        [descends & 1, descends >> 1 & 1, descends >> 2 & 1]
    }
}

impl<N: CullArithmetic> Culling<N> for WideLanes {
    #[inline(always)]
    fn new(ray: &Ray<N>) -> Self {
        let Single { inverse, near, far } = Single::of(ray);
        Self {
            inverse,
            near: near.with_w(ray.tmin.to_f32()),
            far,
            descends: inverse.is_negative_bitmask(),
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

impl<N: CullArithmetic> WideCulling<N> for WideLanes {
    #[inline(always)]
    fn limit(t: N) -> i32 {
        Single::limit(t)
    }

    fn span(&self, bounds: &UnitBox, limit: i32) -> [f64; 2] {
        let (mut enters, mut leaves) = (f64::from(self.near.w), Single::units(limit));
        for (axis, sides) in bounds.0.iter().enumerate() {
            let row = self.near_rows()[axis];
            let t = |plane: i16, rest: f32| f64::from(f32::from(plane) * self.inverse[axis] + rest);
            enters = enters.max(t(sides[row], self.near[axis]));
            leaves = leaves.min(t(sides[row ^ 1], self.far[axis]));
        }
        [enters, leaves]
    }

    #[inline(always)]
    fn children<S: Simd>(
        &self,
        simd: S,
        node: &WideNode,
        limit: i32,
        fused: bool,
    ) -> (u32, [i32; LANES]) {
        let Self {
            inverse, near, far, ..
        } = self;
        // Each is a function, because a function is certainly inlined and a closure is not.
        let ([x, y, z], [row_x, row_y, row_z]) = (&node.planes, self.near_rows());
        let (near_x, far_x) = between(simd, x, row_x, [inverse.x, near.x, far.x], fused);
        let (near_y, far_y) = between(simd, y, row_y, [inverse.y, near.y, far.y], fused);
        let (near_z, far_z) = between(simd, z, row_z, [inverse.z, near.z, far.z], fused);
        let start = near.w;
        let limit = f32::from_bits(limit as u32);
        let near = near_x.max(near_y).max(near_z.max(simd.splat(start)));
        let far = far_x.min(far_y).min(far_z.min(simd.splat(limit)));
        // Not below zero, so integers of the same bits have the same order.
        (
            near.at_most(far),
            near.to_array().map(|t| t.to_bits() as i32),
        )
    }
}

/// Returns where a ray passes the near and the far planes of one axis. The arguments are the rows of its lower and
/// upper planes, the number of the near row, and the ray's constants.
#[inline(always)]
fn between<S: Simd>(
    simd: S,
    rows: &[[i16; LANES]; 2],
    near: usize,
    [inverse, to_near, to_far]: [f32; 3],
    fused: bool,
) -> (S::F32x8, S::F32x8) {
    let (enters, leaves) = (simd.of_i16(&rows[near]), simd.of_i16(&rows[near ^ 1]));
    let inverse = simd.splat(inverse);
    let (to_near, to_far) = (simd.splat(to_near), simd.splat(to_far));
    if fused {
        (
            enters.mul_add(inverse, to_near),
            leaves.mul_add(inverse, to_far),
        )
    } else {
        (enters * inverse + to_near, leaves * inverse + to_far)
    }
}

impl<N: CullArithmetic> WideCulling<N> for Cull {
    #[inline(always)]
    fn limit(t: N) -> i32 {
        t.to_cull().saturating_add(1)
    }

    fn span(&self, bounds: &UnitBox, limit: i32) -> [f64; 2] {
        Cull::span(<Self as PairCulling<N>>::root(self, bounds, limit))
    }

    #[inline(always)]
    fn children<S: Simd>(&self, _: S, node: &WideNode, limit: i32, _: bool) -> (u32, [i32; LANES]) {
        let mut met = 0;
        let mut near = [0; LANES];
        for (lane, near) in near.iter_mut().enumerate() {
            let interval = <Self as PairCulling<N>>::root(self, &node.child_box(lane), limit);
            *near = interval.near;
            met |= u32::from(interval.near <= interval.far) << lane;
        }
        (met, near)
    }
}
