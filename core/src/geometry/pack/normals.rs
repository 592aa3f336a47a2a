//! Normals of eight spheres at once, in `f32` with AVX2.
//!
//! The operations on each sphere are those of [`sphere::surface`](crate::geometry::sphere::surface), without branches, so
//! the bits are the same. They are a chain of two square roots and two divisions, which takes as long for eight as for
//! one.

use crate::format::cluster::LANES;
use crate::number::Convert;
use crate::ray::Ray;
use crate::simd::{Avx2, Simd};

type Lanes = <Avx2 as Simd>::F32x8;

/// Where rays meet up to eight spheres. Each row has a number of every sphere.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct MetSpheres {
    /// One bit for each sphere that is met.
    met: u32,
    /// One bit for each ray that leaves its sphere.
    leaving: u32,
    point: [[f32; LANES]; 3],
    slope: [[f32; LANES]; 3],
    center: [[f32; LANES]; 3],
    radius: [f32; LANES],
}

/// Normals of spheres, and the lanes in which they are known. The others have a radius that is lost to rounding, or the
/// rounded normal points to the wrong side of the ray.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LaneNormals {
    known: u32,
    rows: [[f32; LANES]; 3],
}

impl MetSpheres {
    /// Forgets all spheres.
    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        (self.met, self.leaving) = (0, 0);
    }

    /// Adds a sphere, whose center and radius are in 1/256 unit, and where a ray enters or leaves it.
    #[inline(always)]
    pub(crate) fn add(
        &mut self,
        lane: usize,
        (center, radius): ([i32; 3], i32),
        (ray, t): (&Ray<f32>, f32),
        leaves: bool,
    ) {
        let lane = lane & 7;
        self.met |= 1 << lane;
        self.leaving |= u32::from(leaves) << lane;
        let point = ray.at(t);
        for axis in 0..3 {
            self.point[axis][lane] = point[axis];
            self.slope[axis][lane] = ray.slope[axis];
            self.center[axis][lane] = f32::from_lattice(center[axis]);
        }
        self.radius[lane] = f32::from_lattice(radius);
    }

    /// Returns the normals of the spheres that were added.
    #[inline(always)]
    pub(crate) fn normals(&self, avx2: Avx2) -> LaneNormals {
        if self.met == 0 {
            return LaneNormals::default();
        }
        let three = |rows: &[[f32; LANES]; 3]| {
            let [x, y, z] = rows;
            [avx2.lanes(x), avx2.lanes(y), avx2.lanes(z)]
        };
        let center = three(&self.center);
        let radius = avx2.lanes(&self.radius);
        let (first, first_known) = outward(avx2, three(&self.point), center);
        let axis = |k: usize| center[k] + radius * first[k];
        let point = [axis(0), axis(1), axis(2)];
        let (normal, known) = outward(avx2, point, center);
        let along = dot(normal, three(&self.slope));
        let against = along.signs() & !along.zero();
        LaneNormals {
            known: self.met & first_known & known & (against ^ self.leaving),
            rows: [
                normal[0].to_array(),
                normal[1].to_array(),
                normal[2].to_array(),
            ],
        }
    }
}

impl LaneNormals {
    /// Returns the normal of a sphere; `None` if [`Shapes::surface`](crate::geometry::Shapes::surface) must compute it.
    #[inline(always)]
    pub(crate) fn get(&self, lane: usize) -> Option<[f32; 3]> {
        let lane = lane & 7;
        let is_known = self.known >> lane & 1 != 0;
        is_known.then(|| [self.rows[0][lane], self.rows[1][lane], self.rows[2][lane]])
    }
}

/// The directions from centers to points, of length 1, and one bit for each that has a length.
#[inline(always)]
fn outward(avx2: Avx2, point: [Lanes; 3], center: [Lanes; 3]) -> ([Lanes; 3], u32) {
    let way = [
        point[0] - center[0],
        point[1] - center[1],
        point[2] - center[2],
    ];
    let norm = dot(way, way).sqrt();
    let inverse = avx2.splat(1.0) / norm;
    let normal = [way[0] * inverse, way[1] * inverse, way[2] * inverse];
    (normal, !norm.zero())
}

#[inline(always)]
fn dot(a: [Lanes; 3], b: [Lanes; 3]) -> Lanes {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests;
