//! Tori: the solid that a disc sweeps along a circle around an axis.
//!
//! Let `R` be the circle's radius, `r` the disc's, `rho` a point's distance from the axis and `y` its height along it.
//! A point lies in the solid where `h = (rho - R)^2 + y^2 - r^2` is not positive. So a spindle torus (`r > R`) has only
//! its outer surface. The textbook's quartic is `h ((rho + R)^2 + y^2 - r^2)`. It is neither expanded nor solved in
//! radicals, because its coefficients lose the tube of a thin ring to rounding: see `torus/profile.rs`.
//!
//! The line's origin is its point closest to the center, so lengths are those of the solid, wherever the ray starts.
//!
//! **Ranges of `fixed`.** The reach `R + r` is at most 2^16 units, or 2^29 sub-steps, and scaled up below that. A line
//! that passes farther from the center is rejected, and it counts only within reach. So no position exceeds 2^29 by
//! more than the rounding, and no sum of three squares exceeds 2^60.

mod frame;
mod profile;

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
use frame::{Frame, unit};
use profile::Profile;

records! {
    /// A torus: the solid that a disc of the minor radius sweeps along the circle of the major radius.
    ///
    /// Where the minor radius is larger, the surface is the outer one alone.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(44)]
    pub struct Torus {
        /// Center in 1/256 unit.
        pub center: [i32; 3],
        /// The axis of rotation, of any length, not zero.
        #[valid(Axis: -(1 << 24)..=1 << 24)]
        pub axis: [i32; 3],
        /// Radius of the circle in 1/256 unit. 0 makes a sphere; the sum of both radii is at most 16776704.
        #[valid(Radius: 0..=MAX_RADIUS)]
        pub major_radius: i32,
        /// Radius of the disc that is swept along the circle in 1/256 unit.
        #[valid(Radius: 1..=MAX_RADIUS)]
        pub minor_radius: i32,
        /// The box, rounded outward from the true shape. A ray that misses the box misses the shape, and hits are
        /// clamped to the box.
        pub bounds: UnitBox,
    }
}

/// A point near the surface as seen from the center.
struct TorusPoint<N> {
    /// The way from the axis to the point, in the frame: of length 1.
    outward: [N; 2],
    /// Height along the axis.
    y: N,
    /// The way from the circle to the point, outward and along the axis: of length 1.
    away: [N; 2],
}

impl Torus {
    fn radii<N: Arithmetic>(&self) -> [N; 2] {
        [self.major_radius, self.minor_radius].map(N::from_lattice)
    }

    /// The frame of a point near the surface. On the axis any direction across is outward, and on the circle any
    /// direction is away from it.
    fn place<N: Arithmetic>(&self, frame: &Frame<N>, point: [N; 3]) -> TorusPoint<N> {
        let q = |k: usize| point[k] - N::from_lattice(self.center[k]);
        let [major, minor] = self.radii::<N>();
        let bits = N::headroom(major + minor);
        let (y, across) = frame.parts([q(0), q(1), q(2)].map(|x| x.scale_up(bits)));
        let (outward, rho) = unit(across, [N::ONE, N::ZERO]);
        let (away, _) = unit([rho - major.scale_up(bits), y], [N::ONE, N::ZERO]);
        TorusPoint {
            outward,
            y: y.scale_down(bits),
            away,
        }
    }

    /// Returns the point at a place with another distance from the circle.
    fn offset_point<N: Arithmetic>(
        &self,
        frame: &Frame<N>,
        place: &TorusPoint<N>,
        distance: N,
    ) -> [N; 3] {
        let across = N::from_lattice(self.major_radius) + distance * place.away[0];
        let across = place.outward.map(|x| across * x);
        let q = frame.vector(distance * place.away[1], across);
        let axis = |k: usize| N::from_lattice(self.center[k]) + q[k];
        [axis(0), axis(1), axis(2)]
    }

    /// The surface where it meets the axis, seen from where `toward` leads. A point of the axis at a height `y` is
    /// `sqrt(R^2 + y^2) - r` away from the solid.
    #[cold]
    fn pit<N: Arithmetic>(
        &self,
        (frame, place): (&Frame<N>, &TorusPoint<N>),
        error: N,
        toward: [N; 3],
    ) -> Surface<N> {
        let [major, minor] = self.radii::<N>();
        let height = |r: N| N::root(r.wide(r) - major.wide(major));
        let (bottom, clear) = (height(minor), height(minor + error));
        let (rise, _) = frame.parts(toward);
        let is_up = place.y > N::ZERO || place.y == N::ZERO && rise >= N::ZERO;
        let turn = |x: N| if is_up { x } else { -x };
        let q = frame.vector(turn(bottom), [N::ZERO; 2]);
        let axis = |k: usize| N::from_lattice(self.center[k]) + q[k];
        Surface {
            normal: frame.vector(turn(N::ONE), [N::ZERO; 2]),
            point: [axis(0), axis(1), axis(2)],
            error: clear - bottom + error,
            is_exact: false,
        }
    }
}

impl Torus {
    /// Returns the first crossing whose end counts.
    #[inline(always)]
    fn first_crossing<N: Arithmetic>(
        &self,
        ray: &Ray<N>,
        recip_norm2: N,
        counts: impl Fn(N) -> bool,
    ) -> Option<Crossing<N>> {
        let axis = |k: usize| N::from_lattice(self.center[k]) - ray.origin[k];
        let relative = [axis(0), axis(1), axis(2)];
        let closest = N::from_wide(N::wide_scale(N::dot(relative, ray.slope), recip_norm2));
        let axis = |k: usize| closest * ray.slope[k] - relative[k];
        let apart = [axis(0), axis(1), axis(2)];
        let reach = N::from_lattice(self.major_radius.wrapping_add(self.minor_radius));
        // The box is tested first, so that squares stay in range.
        let near = |k: usize| apart[k].abs() <= reach;
        if !(near(0) && near(1) && near(2) && N::dot(apart, apart) <= reach.wide(reach)) {
            return None;
        }

        // From here on lengths are shifted up as far as their products allow.
        let bits = N::headroom(reach);
        let radii =
            [self.major_radius, self.minor_radius].map(|x| N::from_lattice(x).scale_up(bits));
        let apart = apart.map(|x| x.scale_up(bits));
        let reach = reach.scale_up(bits);
        let half_chord = reach.wide(reach) - N::dot(apart, apart);
        let half_chord = N::root(N::wide_scale(half_chord, recip_norm2));
        let profile = Profile::new(&Frame::new(self.axis), (apart, ray.slope), radii);
        let cuts = profile.cuts(half_chord, recip_norm2)?;
        let back = |s: N| closest + s.scale_down(bits);
        let (enter, leave) = profile.first_inside(cuts, |leave| counts(back(leave)))?;
        Some(Crossing {
            enter: (back(enter), 0),
            leave: (back(leave), 0),
        })
    }
}

impl Primitive for Torus {
    const NEEDS_NORM: bool = true;
    const TESTS_BOX: bool = true;
    // In a pit, where only the way along the axis leads out, the normal stays.
    const LEVELED: bool = false;

    #[inline(always)]
    fn bounds(&self) -> UnitBox {
        self.bounds
    }

    /// Returns the first interval of the line inside the solid that does not end before the ray's interval.
    /// `recip_norm2` is [`Vectors::recip_norm2`](crate::number::Vectors::recip_norm2) of the ray's slopes.
    fn cross<N: Arithmetic>(&self, ray: &Ray<N>, recip_norm2: N) -> Option<Crossing<N>> {
        self.first_crossing(ray, recip_norm2, |leave| leave >= ray.tmin)
    }

    fn cross_after<N: Arithmetic>(
        &self,
        ray: &Ray<N>,
        recip_norm2: N,
        after: N,
    ) -> Option<Crossing<N>> {
        self.first_crossing(ray, recip_norm2, |leave| leave > after)
    }

    /// The normal points outward.
    ///
    /// Next to the axis, in the pit of a spindle torus and at the center of a horn torus, the surface has no normal. A
    /// step away from one of its sides leads through the other. There the normal is the axis, and the error bound is
    /// the length of the way to where the pit is wide enough.
    fn surface<N: Arithmetic>(&self, ray: &Ray<N>, part: Part, point: [N; 3]) -> Surface<N> {
        let frame = Frame::new(self.axis);
        let place = self.place(&frame, point);
        let [major, minor] = self.radii::<N>();
        let center = self.center.map(N::from_lattice);
        let error = N::error_bound(extent(center) + major + minor);
        if major + minor * place.away[0] <= error {
            let leaves = part & LEAVING != 0;
            let toward = ray.slope.map(|x| if leaves { x } else { -x });
            return self.pit((&frame, &place), error, toward);
        }
        let point = self.offset_point(&frame, &place, minor);
        // The error of the rounded point, which turns the normals of thin rings far from the lattice's middle.
        let TorusPoint { outward, away, .. } = self.place(&frame, point);
        let normal = frame.vector(away[1], outward.map(|x| away[0] * x));
        let mut surface = Surface {
            normal: N::normalize(normal).0,
            point,
            error,
            is_exact: false,
        };
        let against = N::dot(surface.normal, ray.slope) < N::Wide::default();
        if against == (part & LEAVING != 0) {
            surface.normal = surface.level_with(ray);
        }
        surface
    }

    /// Returns a point `depth` beneath a point of the surface, or on the circle where the tube is thinner.
    fn inside<N: Arithmetic>(&self, [point, _]: [[N; 3]; 2], depth: N) -> [N; 3] {
        let [_, minor] = self.radii::<N>();
        let frame = Frame::new(self.axis);
        let place = self.place(&frame, point);
        self.offset_point(&frame, &place, (minor - depth).max(N::ZERO))
    }

    fn validate(&self, scene: InScene<'_>) -> Result<(), BlobError> {
        let at = scene.at;
        scene.point(Field::Center, self.center)?;
        self.check_ranges(at.location())?;
        at.ensure(self.axis != [0; 3], Reason::ZeroAxis)?;
        let [major, minor] = [self.major_radius, self.minor_radius].map(i64::from);
        // The sum of both is the reach.
        at.within(Field::Radius, major, 0, MAX_RADIUS.saturating_sub(minor))?;
        scene.inner(&self.bounds)
    }
}

#[cfg(test)]
mod tests;
