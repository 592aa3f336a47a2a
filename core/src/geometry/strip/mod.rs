//! Strips of triangles: the test of [`triangle`](crate::geometry::triangle) on six triangles at once.
//!
//! Every vertex is projected once and every edge crossed once. The operations are exactly those of the test of one
//! triangle, so the signs are the same. Where a product difference rounds to zero, its sign needs exact arithmetic. The
//! triangles at that edge are then tested one by one. That happens to one ray in some ten thousand.
//!
//! **Behind.** A ray that leaves a surface hits that surface's triangle again, just behind its start. Lanes detect
//! that, too, and then the triangle needs no exact test. With depths `d` along the major axis, the test's t is the
//! quotient of two determinants, of the three vertices and of their projections. The first is
//! `d0 (x1 y2 - x2 y1) + d1 (x2 y0 - x0 y2) + d2 (x0 y1 - x1 y0)`. The second is the sum of the brackets, with the sign
//! of the ray's direction.
//!
//! Let `m` be the largest magnitude of the `x`, `y` and `d`, and `e` 2^-24. An `x` is off by 6 e m and a bracket by 28
//! e m^2. The determinants that lanes compute are off by 108 e m^3 and 96 e m^2. The test computes t from normal,
//! offset and slope, which have no component above 32 m^2, 2 m and 1. Their products are off by less than 8 e each: in
//! sum by 768 e m^3 and 512 e m^2. So where both determinants are above 1024 e times m^3 or m^2, both computations have
//! their signs. Where these signs say so, the test's t is below 0.
//!
//! It is then clamped to the interval of the triangle's box (see
//! [`accept_in_box`](crate::accel::clamp::accept_in_box)). That interval also starts below 0 if on every axis the box
//! does not begin ahead of the ray's start. This is true if some vertex lies there. No hit starts below 0.

#[cfg(all(feature = "avx2", target_arch = "x86_64"))]
mod four;

use crate::format::cluster::{Rows, Strip};
use crate::format::record::{Vertex16, Vertex24};
use crate::geometry::Project;
use crate::geometry::Strips;
use crate::geometry::triangle::Projection;
use crate::number::Format;
use crate::ray::Ray;
use crate::simd::{F32x8, Simd};

/// A ray in the form in which strips are tested.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StripRay<N> {
    projection: Projection<N>,
    /// The axis of each role: the two minor ones, then the major one. They are bits of one word, because a load cannot
    /// join parts that were just stored.
    axes: u32,
    /// One bit for each role whose axis the ray runs down.
    descends: u32,
}

impl<N: Project> StripRay<N> {
    /// The axes of the roles for each major axis.
    const AXES: [u32; 3] = [0b00_10_01, 0b01_00_10, 0b10_01_00];

    /// A ray for the strips of a scene.
    #[inline(always)]
    pub(crate) fn new(ray: &Ray<N>, strips: &Strips<'_>) -> Self {
        let projection = match (strips, ray.major) {
            (Strips::S16(_), 0) => Projection::of::<0, Vertex16>(ray),
            (Strips::S16(_), 1) => Projection::of::<1, Vertex16>(ray),
            (Strips::S16(_), _) => Projection::of::<2, Vertex16>(ray),
            (Strips::S24(_), 0) => Projection::of::<0, Vertex24>(ray),
            (Strips::S24(_), 1) => Projection::of::<1, Vertex24>(ray),
            (Strips::S24(_), _) => Projection::of::<2, Vertex24>(ray),
        };
        let below = |axis: usize| u32::from(ray.slope[axis] < N::ZERO);
        let signs = below(0) | below(1) << 1 | below(2) << 2;
        let [first, second, third] = Self::AXES;
        let (axes, descends) = match ray.major {
            0 => (first, signs >> 1 | signs << 2),
            1 => (second, signs >> 2 | signs << 1),
            _ => (third, signs),
        };
        Self {
            projection,
            axes,
            descends,
        }
    }

    /// All bits if the ray runs down the axis of a role, or none.
    #[inline(always)]
    fn descends(&self, role: u32) -> u32 {
        0_u32.wrapping_sub(self.descends >> role & 1)
    }

    /// Returns the places of a strip whose triangles the ray hits, as [`Projection::meets`] does. Some triangles that
    /// the ray hits only behind its start are left out.
    ///
    /// Cost in `f32`: some 100 operations in four lanes.
    #[inline(always)]
    pub(crate) fn hit_lanes<S: Simd, T: Strip>(&self, simd: S, strip: &T) -> u32 {
        if N::FORMAT != Format::F32 {
            return self.hits_one_by_one(strip, strip.members().lanes());
        }
        let (met, doubtful) = self.hits_by_lanes(simd, strip);
        if doubtful == 0 {
            return met;
        }
        met & !doubtful | self.hits_one_by_one(strip, doubtful)
    }

    /// The places that the ray hits, and those that lanes cannot decide.
    #[inline(always)]
    fn hits_by_lanes<S: Simd, T: Strip>(&self, simd: S, strip: &T) -> (u32, u32) {
        let Projection { axes, shear, .. } = &self.projection;
        // No closures, because the compiler does not always inline them.
        let rows = strip.rows();
        let last = rows.measure(simd, axis(self.axes, 2));
        let depth = last + simd.splat(axes[2].offset.to_f32());
        let first = rows.measure(simd, axis(self.axes, 0));
        let right = first + simd.splat(axes[0].offset.to_f32());
        let second = rows.measure(simd, axis(self.axes, 1));
        let up = second + simd.splat(axes[1].offset.to_f32());
        let x = right + depth * simd.splat(shear[0].to_f32());
        let y = up + depth * simd.splat(shear[1].to_f32());
        let (x1, y1) = (x.next(), y.next());
        let (x2, y2) = (x1.next(), y1.next());
        // From each vertex to the next, and to the one after that.
        let side = x * y1 - y * x1;
        let across = x * y2 - y * x2;
        let (side_zero, across_zero) = (side.zero(), across.zero());
        let doubtful = side_zero | side_zero >> 1 | across_zero;
        // The signs of differences that are not zero.
        let (left, back) = (side.signs(), across.signs());
        let places = strip.members().lanes();
        // The sides of a triangle are two of these and, backwards, the edge across.
        let (met, doubtful) = (
            !(left ^ left >> 1) & (left ^ back) & places,
            doubtful & places,
        );
        if met == 0 {
            return (0, doubtful);
        }
        // The places where some vertex lies behind the ray's start on every axis.
        let mut near = met;
        for (role, offset) in [(2, depth), (0, right), (1, up)] {
            let vertices = offset.signs() ^ self.descends(role);
            near &= vertices | vertices >> 1 | vertices >> 2;
            if near == 0 {
                return (met, doubtful);
            }
        }
        near &= self.behind(simd, [x, y, depth], side, across);
        (met & !near, doubtful)
    }

    /// Returns the places that the ray certainly hits only behind its start. The candidates are those that are not
    /// doubtful and where some vertex lies behind the start on every axis; see above.
    #[inline(always)]
    fn behind<S: Simd>(
        &self,
        simd: S,
        [x, y, depth]: [S::F32x8; 3],
        side: S::F32x8,
        across: S::F32x8,
    ) -> u32 {
        let (depth1, side1) = (depth.next(), side.next());
        let volume = depth * side1 - depth1 * across + depth1.next() * side;
        let area = side + side1 - across;
        let reach = x.abs().max(y.abs()).max(depth.abs());
        let reach1 = reach.next();
        let reach = reach.max(reach1).max(reach1.next());
        let area_error = reach * reach * simd.splat(1.0 / 16_384.0);
        let certain = area_error.at_most(area.abs()) & (area_error * reach).at_most(volume.abs());
        certain & (volume.signs() ^ area.signs() ^ self.descends(2))
    }

    /// Tests triangles in a number format's own arithmetic.
    #[inline(never)]
    fn hits_one_by_one<T: Strip>(&self, strip: &T, places: u32) -> u32 {
        match axis(self.axes, 2) {
            0 => hits_along::<0, N, T>(&self.projection, strip, places),
            1 => hits_along::<1, N, T>(&self.projection, strip, places),
            _ => hits_along::<2, N, T>(&self.projection, strip, places),
        }
    }
}

/// The axis of a role.
#[inline(always)]
fn axis(axes: u32, role: u32) -> usize {
    (axes >> (2 * role) & 3) as usize
}

fn hits_along<const MAJOR: usize, N: Project, T: Strip>(
    projection: &Projection<N>,
    strip: &T,
    places: u32,
) -> u32 {
    let mut met = 0;
    let mut rest = places;
    while rest != 0 {
        let place = rest.trailing_zeros();
        rest &= rest - 1;
        if let Some([a, b, c]) = strip.vertices(place) {
            let meets = projection.meets::<MAJOR, <T::Rows as Rows>::Vertex>(&a, &b, &c);
            met |= u32::from(meets) << place;
        }
    }
    met
}
