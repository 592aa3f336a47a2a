//! Capped cylinders, cones and frusta: one solid of revolution between two flat caps.
//!
//! The origin is the point of the line that is closest to the solid's middle. `y` is along the axis, and `sin`, `cos`
//! belong to the half angle of the cone. The line is in the solid's mantle where `cos |Q + D s| <= g - e s`. `Q` and
//! `D` are position and direction without their axial parts, `g = cos r - sin y` and `e = sin d.y`. The axial parts are
//! removed *before* anything is squared.
//!
//! The corresponding quadric `A s^2 + 2 B s + C` is evaluated at its vertex: the origin slides to `s = -B/A` (as far as
//! the line is between the caps). There `C = (cos |Q| - g) (cos |Q| + g)` alone decides whether the line hits the
//! mantle, and the roots' `B^2 - A C` is no difference of near equals. At the tip, the mantle is thin against the
//! solid. A root there is computed again from an origin that slid there, because the quadric's error is that of the
//! mantle's radius at its origin.
//!
//! The mantle's interval on the line is then intersected with that of the two caps. Both solids are convex, so there is
//! no seam: no hole at a rim, no double count, no mirrored nappe.
//!
//! **Ranges of `fixed`.** A solid lies in the scene's box. So its reach (half the height and the widest radius) is
//! below 80,300 units, or 2^29.3 sub-steps, and scaled up below 2^29. The closest point lies within one reach of the
//! middle, and the origin slides by at most one reach along the major axis. So no point is farther than two reaches
//! from the middle. `cos |Q| + g` is at most that and a radius: three reaches, below 2^31. Squares are below 2^62.

use crate::axis::{dot, pick};
use crate::format::layout::records;
use crate::format::range::Ranges;
use crate::format::record::UnitBox;
use crate::format::{BlobError, Field, Reason};
use crate::geometry::primitive::{InScene, MAX_RADIUS, Primitive};
use crate::geometry::{Crossing, LEAVING, Part, Surface};
use crate::number::Arithmetic;
use crate::number::extent;
use crate::ray::Ray;
use bytemuck::{Pod, Zeroable};

records! {
    /// A solid of revolution between two flat caps: cylinder, cone or frustum.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(44)]
    pub struct Cone {
        /// Center of the base in 1/256 unit, like all of the record perhaps finer than the lattice.
        pub base: [i32; 3],
        /// Center of the other cap in 1/256 unit, not equal to `base`.
        pub apex: [i32; 3],
        /// Radius of the base in 1/256 unit.
        #[valid(Radius: 0..=MAX_RADIUS)]
        pub base_radius: i32,
        /// Radius of the other cap in 1/256 unit; not both radii are 0.
        #[valid(Radius: 0..=MAX_RADIUS)]
        pub apex_radius: i32,
        /// The box, rounded outward from the true shape. A ray that misses the box misses the shape, and hits are
        /// clamped to the box.
        pub bounds: UnitBox,
    }
}

/// Part numbers.
const MANTLE: Part = 0;
const BASE: Part = 1;
const APEX: Part = 2;

/// Half the height and the widest radius of the largest solid in a scene's box, in 1/256 unit.
const MOST_REACH: i64 = 80_300 << 8;

/// Maximum number of times the origin slides on towards the tip, where the solid is thinner by half than at the last
/// place.
const SLIDES: usize = 4;

/// The solid's frame, from its integers.
struct Frame<N> {
    /// The direction from base to apex, of length 1.
    axis: [N; 3],
    /// Half of the height.
    half_height: N,
    /// Cosine and sine of the angle between axis and mantle, positive where it narrows to the apex.
    cos: N,
    sin: N,
    /// Radius halfway.
    radius: N,
}

/// The inequality for a line inside the infinite mantle: `cos |q + d s| <= g - e s`.
struct Mantle<N: Arithmetic> {
    q: [N; 3],
    d: [N; 3],
    cos: N,
    g: N,
    e: N,
    a: N::Wide,
    /// Crossings beyond twice this length are ignored, on either side.
    reach: N,
}

impl<N: Arithmetic> Mantle<N> {
    /// `C` and `B` of the quadric around a point `q` of the line.
    #[inline(always)]
    fn terms(&self, q: [N; 3], g: N) -> (N::Wide, N::Wide) {
        let (_, distance) = N::normalize(q);
        let c = (distance * self.cos - g).wide(distance * self.cos + g);
        let b = N::wide_scale(N::wide_scale(N::dot(q, self.d), self.cos), self.cos);
        (c, b + g.wide(self.e))
    }

    /// Returns the distances at which the line enters and leaves, from the roots around the origin moved to `s`.
    fn roots(&self, s: N) -> Option<(N, N)> {
        let zero = N::Wide::default();
        let axis = |k: usize| self.q[k] + s * self.d[k];
        let g = self.g - self.e * s;
        let (c, b) = self.terms([axis(0), axis(1), axis(2)], g);
        let a = self.a;
        let magnitude = |x: N::Wide| if x < zero { -x } else { x };
        let mean = N::geometric_mean(magnitude(a), magnitude(c));
        let root = if (a < zero) != (c < zero) {
            N::wide_norm([b, mean, zero])
        } else if magnitude(b) >= mean {
            N::geometric_mean(magnitude(b) - mean, magnitude(b) + mean)
        } else if a < zero {
            // Steeper than the mantle: such a line always hits it, here at the tip.
            zero
        } else {
            return None;
        };
        let sum = if b < zero { root - b } else { -(b + root) };
        // The roots of a s^2 + 2 b s + c = 0, without a difference of near equals.
        let (first, second) = (N::divide(sum, a), N::divide(c, sum));
        let (low, high) = if first < second {
            (first, second)
        } else {
            (second, first)
        };
        let (from, to) = if a > zero {
            // Both roots lie on one nappe: the real one if g is positive halfway between them.
            if g * N::from_wide(a) + N::from_wide(b) * self.e < N::ZERO {
                return None;
            }
            (low, high)
        } else if a < zero {
            // One root on each nappe; on the real one g - e s is positive.
            if self.e > N::ZERO {
                (-N::FAR, low)
            } else {
                (high, N::FAR)
            }
        } else if b == zero || self.e == N::ZERO {
            // Along a line of the mantle, or parallel to the axis of a cylinder: inside or not. (Or so nearly parallel
            // that the square of the slope underflows.)
            if c > zero {
                return None;
            }
            (-N::FAR, N::FAR)
        } else if (b > zero) != (self.e > N::ZERO) {
            // Parallel to a line of the mantle, on the mirrored nappe.
            return None;
        } else {
            let root = N::divide(-c, b).half();
            if b > zero {
                (-N::FAR, root)
            } else {
                (root, N::FAR)
            }
        };
        let end = self.reach + self.reach;
        let (lowest, highest) = (-end - s, end - s);
        Some((
            s + from.max(lowest).min(highest),
            s + to.max(lowest).min(highest),
        ))
    }

    /// Returns the distances at which the line enters and leaves, between two places and two ends. Near the tip, where the
    /// radius is less than `thin`, they are computed again from where it is thinner.
    #[inline(always)]
    fn cut(&self, [nearest, farthest]: [N; 2], [enter, leave]: [N; 2], thin: N) -> Option<(N, N)> {
        let within = |s: N| s.max(nearest).min(farthest);
        let (_, b) = self.terms(self.q, self.g);
        let mut cut = self.roots(within(N::divide(-b, self.a)))?;
        let mut thin = thin;
        for _ in 0..SLIDES {
            let (first, last) = (within(cut.0.max(enter)), within(cut.1.min(leave)));
            let (g_first, g_last) = (self.g - self.e * first, self.g - self.e * last);
            let (s, g) = if g_first < g_last {
                (first, g_first)
            } else {
                (last, g_last)
            };
            if g >= thin {
                break;
            }
            cut = self.roots(s)?;
            thin = g.half();
        }
        Some(cut)
    }
}

impl Cone {
    #[inline(always)]
    fn frame<N: Arithmetic>(&self) -> Frame<N> {
        let along = |k: usize| N::from_lattice(self.apex[k].wrapping_sub(self.base[k]));
        let (axis, height) = N::normalize([along(0), along(1), along(2)]);
        let narrowing = N::from_lattice(self.base_radius.wrapping_sub(self.apex_radius));
        let ([cos, sin, _], _) = N::normalize([height, narrowing, N::ZERO]);
        Frame {
            axis,
            half_height: height.half(),
            cos,
            sin,
            radius: N::from_lattice(self.base_radius.wrapping_add(self.apex_radius)).half(),
        }
    }

    /// Returns the axis of coordinates at right angles to the caps, if there is one.
    #[inline(always)]
    fn axis(&self) -> Option<usize> {
        let same = |k: usize| self.base[k] == self.apex[k];
        match (same(0), same(1), same(2)) {
            (false, true, true) => Some(0),
            (true, false, true) => Some(1),
            (true, true, false) => Some(2),
            _ => None,
        }
    }

    #[inline(always)]
    fn middle<N: Arithmetic>(&self) -> [N; 3] {
        let axis = |k: usize| N::from_lattice(self.base[k].wrapping_add(self.apex[k])).half();
        [axis(0), axis(1), axis(2)]
    }
}

impl Primitive for Cone {
    const NEEDS_NORM: bool = true;
    // The most expensive test of all.
    const TESTS_BOX: bool = true;

    #[inline(always)]
    fn bounds(&self) -> UnitBox {
        self.bounds
    }

    /// The crossing with the solid. `recip_norm2` is [`Vectors::recip_norm2`](crate::number::Vectors::recip_norm2) of
    /// the ray's slopes.
    ///
    /// Cost: some 20 multiplications and additions to reject by the sphere around the solid; some
    /// 100, five divisions and six square roots to accept.
    fn cross<N: Arithmetic>(&self, ray: &Ray<N>, recip_norm2: N) -> Option<Crossing<N>> {
        let frame = self.frame::<N>();
        let middle = self.middle::<N>();
        let axis = |k: usize| middle[k] - ray.origin[k];
        let relative = [axis(0), axis(1), axis(2)];
        let closest = N::from_wide(N::wide_scale(N::dot(relative, ray.slope), recip_norm2));
        let axis = |k: usize| closest * ray.slope[k] - relative[k];
        let apart = [axis(0), axis(1), axis(2)];
        let widest = N::from_lattice(self.base_radius.max(self.apex_radius));
        let reach = frame.half_height + widest;
        // The box first, so that squares stay in range.
        let near = |k: usize| apart[k].abs() <= reach;
        if !(near(0) && near(1) && near(2) && N::dot(apart, apart) <= reach.wide(reach)) {
            return None;
        }

        let beyond = reach + reach;
        // From here on lengths are shifted up as far as their products allow.
        let bits = N::headroom(reach);
        let reach = reach.scale_up(bits);
        let q = apart.map(|x| x.scale_up(bits));
        let half_height = frame.half_height.scale_up(bits);
        let d = ray.slope;
        let q_axial = N::from_wide(N::dot(q, frame.axis));
        let d_axial = N::from_wide(N::dot(d, frame.axis));

        // Between the caps. If they are at right angles to an axis, the ray crosses their planes at the t that it has
        // for every face in these planes, to the last bit.
        let face = self.axis();
        let (mut enter, mut leave) = ((-N::FAR, BASE), (N::FAR, APEX));
        let (mut first_t, mut last_t) = (N::ZERO, N::ZERO);
        if d_axial == N::ZERO {
            if q_axial.abs() > half_height {
                return None;
            }
        } else {
            let (to_base, to_apex, along) = match face {
                Some(k) => {
                    let side =
                        |center: [i32; 3]| N::from_lattice(pick(center, k)) - pick(ray.origin, k);
                    (side(self.base), side(self.apex), pick(d, k))
                }
                None => (-half_height - q_axial, half_height - q_axial, d_axial),
            };
            let (first, last) = if d_axial > N::ZERO {
                ((to_base, BASE), (to_apex, APEX))
            } else {
                ((to_apex, APEX), (to_base, BASE))
            };
            (first_t, last_t) = (first.0.div(along), last.0.div(along));
            let ends = if face.is_some() {
                let s = |t: N| {
                    let s = N::narrow(t.widen() - closest.widen());
                    s.max(-beyond).min(beyond).scale_up(bits)
                };
                (s(first_t), s(last_t))
            } else {
                (first_t, last_t)
            };
            (enter, leave) = ((ends.0, first.1), (ends.1, last.1));
        }

        // In the mantle.
        let across = |v: [N; 3], axial: N| {
            let axis = |k: usize| v[k] - axial * frame.axis[k];
            [axis(0), axis(1), axis(2)]
        };
        let (cos, sin) = (frame.cos, frame.sin);
        let d_across = across(d, d_axial);
        let (_, d_norm) = N::normalize(d_across);
        let e = d_axial * sin;
        let mantle = Mantle {
            q: across(q, q_axial),
            d: d_across,
            cos,
            g: frame.radius.scale_up(bits) * cos - q_axial * sin,
            e,
            a: (d_norm * cos - e).wide(d_norm * cos + e),
            reach,
        };
        // Between the caps and within reach: a line along the mantle has its vertex farther away.
        let (nearest, farthest) = (enter.0.max(-reach), leave.0.min(reach));
        if nearest > farthest {
            return None;
        }
        let thin = (widest.scale_up(bits) * cos).half();
        let cut = mantle.cut([nearest, farthest], [enter.0, leave.0], thin)?;
        if cut.0 > enter.0 {
            enter = (cut.0, MANTLE);
        }
        if cut.1 < leave.0 {
            leave = (cut.1, MANTLE);
        }
        // Ends beyond the limit are infinite. Written so that a NaN is no crossing.
        let (start, end) = (-reach - reach, reach + reach);
        if !(enter.0 <= leave.0 && enter.0 > start && leave.0 < end) {
            return None;
        }
        let back = |(s, part): (N, Part), t: N| {
            let is_face = part != MANTLE && face.is_some();
            (
                if is_face {
                    t
                } else {
                    closest + s.scale_down(bits)
                },
                part,
            )
        };
        let (enter, leave) = (back(enter, first_t), back(leave, last_t));
        // Each end has its own rounding, so the ends can change places.
        (enter.0 <= leave.0).then(|| Crossing {
            enter: ray.ahead(enter),
            leave,
        })
    }

    /// A point of the solid near a point of its surface, at least `depth` away from mantle and caps. Where the solid is
    /// thinner, the point lies on the axis.
    fn inside<N: Arithmetic>(&self, [point, _]: [[N; 3]; 2], depth: N) -> [N; 3] {
        let Frame {
            axis,
            half_height,
            cos,
            sin,
            radius,
        } = self.frame::<N>();
        let middle = self.middle::<N>();
        let k = |k: usize| point[k] - middle[k];
        let q = [k(0), k(1), k(2)];
        let mut along = N::from_wide(N::dot(q, axis));
        let k = |k: usize| q[k] - along * axis[k];
        let (outward, mut across) = N::normalize([k(0), k(1), k(2)]);
        // The mantle's distance from the axis's middle, less the depth: inside is where
        // `cos across + sin along` is at most that.
        let mantle = radius * cos - depth;
        let highest = (half_height - depth).max(N::ZERO);
        let excess = (across * cos + along * sin - mantle).max(N::ZERO);
        across = across - excess * cos;
        along = (along - excess * sin).max(-highest).min(highest);
        // Next to a cap the mantle can be near again; next to the tip there is only the axis.
        let left = mantle - along * sin;
        if left <= N::ZERO {
            across = N::ZERO;
            along = mantle.div(sin).max(-highest).min(highest);
        } else if across * cos > left {
            across = left.div(cos);
        }
        let k = |k: usize| middle[k] + along * axis[k] + across.max(N::ZERO) * outward[k];
        [k(0), k(1), k(2)]
    }

    /// The normal points outward. Where the point determines the mantle's normal badly, mainly at the tip, the normal
    /// is at least turned to `toward`. A ray that enters comes from there, and a ray that leaves goes there.
    fn surface<N: Arithmetic>(&self, ray: &Ray<N>, part: Part, point: [N; 3]) -> Surface<N> {
        let toward = if part & LEAVING != 0 {
            ray.slope
        } else {
            ray.slope.map(|x| -x)
        };
        let frame = self.frame::<N>();
        let middle = self.middle::<N>();
        let size = extent(middle) + frame.half_height + frame.radius + frame.radius;
        let normal = match part & !LEAVING {
            BASE => frame.axis.map(|x| -x),
            APEX => frame.axis,
            _ => {
                let axis = |k: usize| point[k] - middle[k];
                let q = [axis(0), axis(1), axis(2)];
                let bits = N::headroom(extent(q) + N::from_lattice(1));
                let q = q.map(|x| x.scale_up(bits));
                let axial = N::from_wide(N::dot(q, frame.axis));
                let axis = |k: usize| q[k] - axial * frame.axis[k];
                let (outward, distance) = N::normalize([axis(0), axis(1), axis(2)]);
                // Next to the axis, the rest is partly rounding and leans. A ray that runs along the mantle would hit
                // it again. On the axis any direction is outward.
                let mut outward = upright(outward, frame.axis);
                let normal = |outward: [N; 3]| {
                    let axis = |k: usize| outward[k] * frame.cos + frame.axis[k] * frame.sin;
                    N::normalize([axis(0), axis(1), axis(2)]).0
                };
                // So near the axis the point can lie on the wrong side of it. Every normal supports the tip; elsewhere
                // a slightly wrong normal is made level with the ray.
                let astray = distance.scale_down(bits) <= N::error_bound(size);
                if astray && N::from_wide(N::dot(normal(outward), toward)) < -N::ratio(1 << 22) {
                    outward = upright(toward, frame.axis);
                }
                normal(outward)
            }
        };
        // The point is the ray's, with the rounding errors of all coordinates.
        let magnitude = extent(ray.origin).max(extent(point));
        Surface {
            normal,
            point,
            error: N::error_bound(size).max(N::error_bound(magnitude)),
            is_exact: false,
        }
    }

    fn validate(&self, scene: InScene<'_>) -> Result<(), BlobError> {
        scene.point(Field::BaseCenter, self.base)?;
        scene.point(Field::ApexCenter, self.apex)?;
        scene.at.ensure(self.base != self.apex, Reason::ZeroAxis)?;
        self.check_ranges(scene.at.location())?;
        let radii = [self.base_radius, self.apex_radius];
        scene.at.ensure(radii != [0; 2], Reason::ZeroRadii)?;
        let along = [0, 1, 2].map(|k: usize| self.apex[k].wrapping_sub(self.base[k]));
        let widest = i64::from(self.base_radius.max(self.apex_radius));
        let rest = MOST_REACH.wrapping_sub(widest).max(0).wrapping_mul(2);
        let fits = dot(along, along) <= rest.wrapping_mul(rest);
        scene.at.ensure(fits, Reason::OutsideScene)?;
        scene.inner(&self.bounds)
    }
}

/// A direction at right angles to an axis: `lean` without its part along the axis. If nothing is left, the axis of
/// coordinates that is farthest from it, without that part.
fn upright<N: Arithmetic>(lean: [N; 3], axis: [N; 3]) -> [N; 3] {
    let without = |v: [N; 3]| {
        let along = N::from_wide(N::dot(v, axis));
        let across = |k: usize| v[k] - along * axis[k];
        N::normalize([across(0), across(1), across(2)]).0
    };
    let [x, y, z] = axis.map(N::abs);
    let farthest = if x <= y && x <= z {
        [N::ONE, N::ZERO, N::ZERO]
    } else if y <= z {
        [N::ZERO, N::ONE, N::ZERO]
    } else {
        [N::ZERO, N::ZERO, N::ONE]
    };
    let upright = without(lean);
    // Once more, because the rest can be small.
    let upright = without(upright);
    if extent(upright) == N::ZERO {
        without(farthest)
    } else {
        upright
    }
}

#[cfg(test)]
mod tests;
