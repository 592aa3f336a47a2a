//! Four rays that are set up at once, with AVX2.
//!
//! The operations on each ray are those of [`Ray::from_f64`], so its bits are the same. They have no branches, which
//! for rays in all directions are mispredicted. A ray that needs other operations is left to that function: its origin
//! is far away, its interval begins before the origin, or it is invalid.

use super::Ray;
use super::given::given;
use super::start::REACH;
use crate::format::record::UnitBox;
use crate::number::Scalar;
use crate::number::float::SMALLEST_F64;
use crate::simd::{Avx2, F64x4};

/// The smallest and the largest length of a direction, along its largest component.
const LENGTHS: [f64; 2] = [SMALLEST_F64, 1.0 / SMALLEST_F64];

/// Four rays in units. Each row has a number of every ray.
#[derive(Clone, Copy, Debug)]
pub struct FourGivenRays {
    /// The origins of the rays.
    pub origin: [F64x4; 3],
    /// Directions of any length.
    pub direction: [F64x4; 3],
    /// The length from which on hits are reported.
    pub tmin: F64x4,
    /// The length up to which hits are reported.
    pub tmax: F64x4,
}

/// Four rays. Each row has a number of every ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FourRays {
    /// One bit for each ray that is set up. The others are left to [`Ray::from_f64`].
    pub(crate) ready: u32,
    pub(crate) origin: [[f32; 4]; 3],
    pub(crate) slope: [[f32; 4]; 3],
    /// The origins in the order of the axes' roles: the two minor ones, then the major one.
    pub(crate) role_origin: [[f32; 4]; 3],
    /// The slopes in this order.
    pub(crate) role_slope: [[f32; 4]; 3],
    pub(crate) tmin: [f32; 4],
    tmax: [f32; 4],
    start_t: [f32; 4],
    /// One bit for each ray whose major axis is the first, and for each whose major axis is the second.
    major: [u32; 2],
}

impl FourRays {
    /// Sets up four rays through a scene whose box is `bounds`.
    #[inline(always)]
    pub(crate) fn new(avx2: Avx2, bounds: &UnitBox, rays: &FourGivenRays) -> Self {
        let number = |value: f64| F64x4::splat(avx2, value);
        let (zero, one) = (number(0.0), number(1.0));
        let [x, y, z] = rays.direction;
        let [a, b, c] = [x.abs(), y.abs(), z.abs()];
        let largest = a.max(b).max(c);
        // False for NaN.
        let is_direction = a.at_most(largest) & b.at_most(largest) & c.at_most(largest);
        let [shortest, longest] = LENGTHS;
        let is_ordinary = number(shortest).at_most(largest) & largest.at_most(number(longest));
        let is_first = b.at_most(a) & c.at_most(a);
        let is_second = c.at_most(b);
        let pick = |[x, y, z]: [F64x4; 3]| is_first.select(x, is_second.select(y, z));

        let inverse = one / largest;
        let slope = |component: F64x4| flush_tiny(avx2, component * inverse + zero);
        let major_slope = one.copysign(pick([x, y, z]));
        let minor = [slope(x), slope(y), slope(z)];
        let slope = [
            is_first.select(major_slope, minor[0]),
            is_first.select(minor[1], is_second.select(major_slope, minor[1])),
            is_first.select(minor[2], is_second.select(minor[2], major_slope)),
        ];

        let side = |number_of: usize| {
            let sides = bounds.0.map(|axis| number(axis[number_of].into()));
            pick(sides)
        };
        let from = pick(rays.origin);
        let to_box = zero
            .below(major_slope)
            .select(side(0) - from, from - side(1));
        let start_t = to_box.max(zero);

        let reach = number(REACH as f64 / 8192.0);
        let [along, across] = [reach + start_t, reach - start_t];
        let [x, y, z] = rays.origin.map(F64x4::abs);
        let is_near = start_t.below(reach)
            & x.below(is_first.select(along, across))
            & y.below(is_first.select(across, is_second.select(along, across)))
            & z.below(is_first.select(across, is_second.select(across, along)));
        let is_interval = zero.at_most(rays.tmin) & rays.tmin.at_most(rays.tmax);

        let start = |axis: usize| flush_tiny(avx2, rays.origin[axis] + start_t * slope[axis]);
        let start = [start(0), start(1), start(2)];
        let far = number(f64::FAR);
        let after = |t: F64x4| (t - start_t).min(far);
        let tmin = start_t.below(rays.tmin).select(after(rays.tmin), zero);
        let tmax = rays
            .tmax
            .below(start_t)
            .select(zero - one, after(rays.tmax));
        let by_role = |[x, y, z]: [F64x4; 3]| {
            singles([
                is_first.select(y, is_second.select(z, x)),
                is_first.select(z, is_second.select(x, y)),
                pick([x, y, z]),
            ])
        };
        Self {
            ready: (is_direction & is_ordinary & is_near & is_interval).bits(),
            origin: singles(start),
            slope: singles(slope),
            role_origin: by_role(start),
            role_slope: by_role(slope),
            tmin: tmin.to_f32(),
            tmax: tmax.to_f32(),
            start_t: start_t.to_f32(),
            major: [is_first.bits(), is_second.bits()],
        }
    }

    /// The major axis of a ray.
    #[inline(always)]
    pub(crate) fn major(&self, lane: usize) -> usize {
        let [is_first, is_second] = self.major.map(|lanes| (lanes >> (lane & 3) & 1) as usize);
        (1 - is_first) * (2 - is_second)
    }

    /// Writes a ray, except for what only shapes without bounds need of it.
    #[inline(always)]
    pub(crate) fn write(&self, lane: usize, ray: &mut Ray<f32>) {
        let lane = lane & 3;
        let three = |rows: &[[f32; 4]; 3]| [rows[0][lane], rows[1][lane], rows[2][lane]];
        ray.origin = three(&self.origin);
        ray.slope = three(&self.slope);
        ray.major = self.major(lane);
        ray.start_t = self.start_t[lane];
        ray.tmin = self.tmin[lane];
        ray.tmax = self.tmax[lane];
    }
}

impl Ray<f32> {
    /// A ray that is to be written.
    pub(crate) fn unwritten() -> Self {
        Self {
            origin: [0.0; 3],
            slope: [0.0; 3],
            major: 0,
            start_t: 0.0,
            tmin: 0.0,
            tmax: -1.0,
            given: given(|| [0.0; 3], [0.0; 2], false),
        }
    }
}

/// The numbers in single precision.
#[inline(always)]
fn singles([x, y, z]: [F64x4; 3]) -> [[f32; 4]; 3] {
    [x.to_f32(), y.to_f32(), z.to_f32()]
}

/// [`Scalar::flush_tiny`] of double precision.
#[inline(always)]
fn flush_tiny(avx2: Avx2, numbers: F64x4) -> F64x4 {
    let [smallest, _] = LENGTHS;
    let zero = F64x4::splat(avx2, 0.0);
    let is_tiny = numbers.abs().below(F64x4::splat(avx2, smallest));
    is_tiny.select(zero, numbers)
}

#[cfg(test)]
mod tests;
