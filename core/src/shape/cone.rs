//! Capped cylinders, cones and frusta: one solid of revolution between two flat caps.
//!
//! With the point of the line that is closest to the solid's middle as origin, `y` along the axis
//! and the half angle of the cone as `sin`, `cos`, the line is in the solid's mantle where
//! `cos |Q + D s| <= g - e s`; `Q` and `D` are position and direction without their axial parts,
//! `g = cos r - sin y` and `e = sin d.y`. The axial parts are removed *before* anything is squared.
//! The discriminant of that quadratic factors:
//! `B^2 - A C = cos^2 (|g D + e Q| - cos |Q x D|) (|g D + e Q| + cos |Q x D|)`, and `A` and `C` are
//! differences of squares too, so nothing large cancels. The mantle's interval on the line is then
//! cut with that of the two caps, and since both solids are convex there is no seam: no hole at a
//! rim, no double count, no mirrored nappe.

use super::{Crossing, Part, Surface, extent};
use crate::blob::record::Cone;
use crate::number::Number;
use crate::ray::Ray;

/// Part numbers.
const MANTLE: Part = 0;
const BASE: Part = 1;
const APEX: Part = 2;

/// The solid's frame, from its integers.
struct Frame<N> {
    /// From base to apex, of length 1.
    axis: [N; 3],
    /// Half of the height.
    half_height: N,
    /// Cosine and sine of the angle between axis and mantle, positive where it narrows to the apex.
    cos: N,
    sin: N,
    /// Radius halfway.
    radius: N,
}

impl Cone {
    #[inline(always)]
    fn frame<N: Number>(&self) -> Frame<N> {
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

    #[inline(always)]
    fn middle<N: Number>(&self) -> [N; 3] {
        let axis = |k: usize| N::from_lattice(self.base[k].wrapping_add(self.apex[k])).half();
        [axis(0), axis(1), axis(2)]
    }

    /// The crossing with the solid. `recip_norm2` is [`Number::recip_norm2`] of the ray's slopes.
    ///
    /// Cost: some 20 multiplications and additions to reject by the sphere around the solid; some
    /// 100, six divisions and five square roots to accept.
    pub(crate) fn cross<N: Number>(&self, ray: &Ray<N>, recip_norm2: N) -> Option<Crossing<N>> {
        let zero = N::Wide::default();
        let frame = self.frame::<N>();
        let middle = self.middle::<N>();
        let axis = |k: usize| middle[k] - ray.origin[k];
        let relative = [axis(0), axis(1), axis(2)];
        let closest = N::from_wide(N::wide_scale(N::dot(relative, ray.slope), recip_norm2));
        let axis = |k: usize| closest * ray.slope[k] - relative[k];
        let apart = [axis(0), axis(1), axis(2)];
        let widest = N::from_lattice(self.base_radius.max(self.apex_radius));
        let reach = frame.half_height + widest;
        if !(apart[0].abs() <= reach && apart[1].abs() <= reach && apart[2].abs() <= reach) {
            return None;
        }

        // From here on lengths are shifted up as far as their products allow.
        let bits = N::headroom(reach);
        let q = apart.map(|x| x.scale_up(bits));
        let half_height = frame.half_height.scale_up(bits);
        let d = ray.slope;
        let q_axial = N::from_wide(N::dot(q, frame.axis));
        let d_axial = N::from_wide(N::dot(d, frame.axis));

        // Between the caps.
        let (mut enter, mut leave) = ((-N::FAR, BASE), (N::FAR, APEX));
        if d_axial == N::ZERO {
            if q_axial.abs() > half_height {
                return None;
            }
        } else {
            let base = (-half_height - q_axial).over(d_axial);
            let apex = (half_height - q_axial).over(d_axial);
            (enter, leave) = if d_axial > N::ZERO {
                ((base, BASE), (apex, APEX))
            } else {
                ((apex, APEX), (base, BASE))
            };
        }

        // In the mantle.
        let across = |v: [N; 3], axial: N| {
            let axis = |k: usize| v[k] - axial * frame.axis[k];
            [axis(0), axis(1), axis(2)]
        };
        let (q_across, d_across) = (across(q, q_axial), across(d, d_axial));
        let (cos, sin) = (frame.cos, frame.sin);
        let g = frame.radius.scale_up(bits) * cos - q_axial * sin;
        let e = d_axial * sin;
        let cross =
            |i: usize, j: usize| q_across[i].wide(d_across[j]) - q_across[j].wide(d_across[i]);
        let twist = N::wide_scale(N::wide_norm([cross(1, 2), cross(2, 0), cross(0, 1)]), cos);
        let lever = |k: usize| d_across[k].wide(g) + q_across[k].wide(e);
        let lever = N::wide_norm([lever(0), lever(1), lever(2)]);
        if lever < twist {
            return None;
        }
        let root = N::wide_scale(N::geometric_mean(lever - twist, lever + twist), cos);
        let (_, d_norm) = N::normalize(d_across);
        let (_, q_norm) = N::normalize(q_across);
        let a = (d_norm * cos - e).wide(d_norm * cos + e);
        let b = N::wide_scale(N::wide_scale(N::dot(q_across, d_across), cos), cos) + g.wide(e);
        let c = (q_norm * cos - g).wide(q_norm * cos + g);
        let sum = if b < zero { -b + root } else { -(b + root) };
        // The roots of a s^2 + 2 b s + c = 0, without a difference of near equals.
        let (first, second) = (N::divide(sum, a), N::divide(c, sum));
        let (low, high) = if first < second {
            (first, second)
        } else {
            (second, first)
        };
        let (from, to) = if a > zero {
            // Both roots lie on one nappe: the real one if g is positive halfway between them.
            if g * N::from_wide(a) + N::from_wide(b) * e < N::ZERO {
                return None;
            }
            (low, high)
        } else if a < zero {
            // One root on each nappe; on the real one g - e s is positive.
            if e > N::ZERO {
                (-N::FAR, low)
            } else {
                (high, N::FAR)
            }
        } else if b == zero || e == N::ZERO {
            // (So nearly parallel, perhaps, that the square of the slope vanishes.)
            // Along a line of the mantle, or parallel to the axis of a cylinder: inside or not.
            if c > zero {
                return None;
            }
            (-N::FAR, N::FAR)
        } else if (b > zero) != (e > N::ZERO) {
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
        if from > enter.0 {
            enter = (from, MANTLE);
        }
        if to < leave.0 {
            leave = (to, MANTLE);
        }
        let back = |(s, part): (N, Part)| (closest + s.scale_down(bits), part);
        // Written so that a NaN is no crossing.
        (enter.0 <= leave.0).then(|| Crossing {
            enter: back(enter),
            leave: back(leave),
        })
    }

    /// Outward; at the tip of a cone along the axis.
    pub(crate) fn surface<N: Number>(&self, part: Part, point: [N; 3]) -> Surface<N> {
        let frame = self.frame::<N>();
        let middle = self.middle::<N>();
        let normal = match part {
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
                if distance == N::ZERO {
                    if axial > N::ZERO {
                        frame.axis
                    } else {
                        frame.axis.map(|x| -x)
                    }
                } else {
                    let axis = |k: usize| outward[k] * frame.cos + frame.axis[k] * frame.sin;
                    N::normalize([axis(0), axis(1), axis(2)]).0
                }
            }
        };
        Surface {
            normal,
            extent: extent(middle) + frame.half_height + frame.radius + frame.radius,
        }
    }
}
