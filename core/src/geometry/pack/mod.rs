//! Packs of spheres: the test of [`sphere`](crate::geometry::sphere) on eight at once.
//!
//! In `f32` every operation of that test is done in lanes, up to the square root.

#[cfg(all(feature = "avx2", target_arch = "x86_64"))]
pub(crate) mod normals;

use crate::format::cluster::{LANES, Pack, Rows};
use crate::geometry::{Crossing, sphere};
use crate::number::Arithmetic;
use crate::ray::Ray;
use crate::simd::{F32x8, Simd};

/// The spheres of a pack that the line of a ray hits, one bit each, and the values from which a crossing is computed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LaneHits {
    pub(crate) lanes: u32,
    /// In units.
    closest: [f32; LANES],
    /// The radius squared less the line's distance squared, in units squared.
    square: [f32; LANES],
}

impl LaneHits {
    /// The crossing with the sphere in a lane: that of [`sphere::cross`].
    #[inline(always)]
    pub(crate) fn crossing<N: Arithmetic>(
        &self,
        ray: &Ray<N>,
        recip_norm2: N,
        lane: usize,
    ) -> Crossing<N> {
        let closest = N::length_from_f64(self.closest[lane & 7].into());
        let square = N::length_from_f64(self.square[lane & 7].into());
        sphere::tangent_crossing(ray, closest, square.widen(), recip_norm2)
    }
}

/// Tests all spheres of a pack, in `f32`.
///
/// Cost: some 40 operations in eight lanes.
#[inline(always)]
pub(crate) fn hit_lanes<N: Arithmetic, S: Simd, P: Pack>(
    simd: S,
    ray: &Ray<N>,
    recip_norm2: N,
    pack: &P,
) -> LaneHits {
    // No closures, because the compiler does not always inline them.
    let ([x, y, z], rows) = (ray.origin, pack.rows());
    let x = rows.units(simd, 0) - simd.splat(x.to_f32());
    let y = rows.units(simd, 1) - simd.splat(y.to_f32());
    let z = rows.units(simd, 2) - simd.splat(z.to_f32());
    let [right, up, ahead] = ray.slope;
    let slope = [
        simd.splat(right.to_f32()),
        simd.splat(up.to_f32()),
        simd.splat(ahead.to_f32()),
    ];
    let recip_norm2 = simd.splat(recip_norm2.to_f32());
    let closest = (x * slope[0] + y * slope[1] + z * slope[2]) * recip_norm2;
    let apart = [
        x - closest * slope[0],
        y - closest * slope[1],
        z - closest * slope[2],
    ];
    let radii = pack.radii(simd);
    let farthest = apart[0].abs().max(apart[1].abs()).max(apart[2].abs());
    let square = radii * radii - (apart[0] * apart[0] + apart[1] * apart[1] + apart[2] * apart[2]);
    LaneHits {
        // Lanes without a sphere have no radius.
        lanes: farthest.at_most(radii) & simd.splat(0.0).at_most(square) & !radii.zero(),
        closest: closest.to_array(),
        square: square.to_array(),
    }
}
