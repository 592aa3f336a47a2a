//! Rays, in the one form that every kernel uses.

use crate::blob::record::UnitBox;
use crate::event::Event;
use crate::number::{Number, pick};
use core::cmp::Ordering;
use core::fmt;

/// A half-line with an interval, ready to be traced through one scene.
///
/// A ray is parametrised along the *major axis* of its direction, the one with the largest
/// component: `point = origin + t * slope`, where the slope of the major axis is 1 or -1 and the
/// others lie between. `t` is therefore a length in units (see [`Number`]), never
/// overflows, and needs no normalised direction. For a direction `d` of any length, the parameter
/// in multiples of `d` is `t / |d[major]|`.
///
/// An origin before the scene's box is moved along the ray to the plane in which the box begins,
/// and `t` is counted from there inside the kernels; [`Hit::t`](crate::Hit) is counted from the
/// origin that was given. So origins may be arbitrarily far away.
#[derive(Clone, Copy, Debug)]
pub struct Ray<N: Number> {
    pub(crate) origin: [N; 3],
    pub(crate) slope: [N; 3],
    pub(crate) major: usize,
    /// How far the origin was moved.
    pub(crate) moved: N::Wide,
    pub(crate) tmin: N,
    pub(crate) tmax: N,
}

/// Why something is not a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayError {
    /// The direction is zero, infinite or NaN.
    Direction,
    /// The origin is infinite or NaN.
    Origin,
    /// `tmin` is greater than `tmax`, or one of them is NaN.
    Interval,
}

impl fmt::Display for RayError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            RayError::Direction => "the ray's direction is zero, infinite or NaN",
            RayError::Origin => "the ray's origin is infinite or NaN",
            RayError::Interval => "the ray's tmin is greater than its tmax, or one of them is NaN",
        })
    }
}

impl core::error::Error for RayError {}

impl<N: Number> Ray<N> {
    /// A ray through a scene whose box is `bounds` (see [`Scene::bounds`](crate::Scene::bounds)).
    ///
    /// Origin and interval are lengths in units; the direction is of any length but 0. Hits are
    /// reported for `tmin <= t <= tmax`, in lengths along the major axis; `tmin` may be negative.
    ///
    /// # Errors
    /// If the direction is zero, or anything is NaN, or the origin or direction infinite, or
    /// `tmin > tmax`. Queries for which no ray can be made have no hit.
    #[inline]
    pub fn new(
        bounds: &UnitBox,
        origin: [N::Wide; 3],
        direction: [N::Wide; 3],
        tmin: N::Wide,
        tmax: N::Wide,
    ) -> Result<Self, RayError> {
        let (slope, major) = N::slopes(direction).ok_or(RayError::Direction)?;
        if tmin.partial_cmp(&tmax).is_none_or(Ordering::is_gt) {
            return Err(RayError::Interval);
        }
        let zero = N::Wide::default();
        let sum = origin[0] + origin[1] + origin[2];
        if !N::is_finite(sum) {
            return Err(RayError::Origin);
        }

        let [first, last] = pick(bounds.0, major);
        let forward = pick(slope, major) > N::ZERO;
        let origin_major = pick(origin, major);
        let to_box = if forward {
            N::from_unit(first).widen() - origin_major
        } else {
            origin_major - N::from_unit(last).widen()
        };
        let moved = if to_box > zero {
            to_box
        } else if tmin < zero {
            if tmin > to_box { tmin } else { to_box }
        } else {
            zero
        };
        let (tmin, tmax) = (tmin - moved, tmax - moved);
        let far = N::FAR.widen();
        // A ray rises by at most 2^16 units on its way through the box.
        let reach = N::from_unit(i16::MAX).widen();
        let reach = reach + reach + reach;
        let start = |axis: usize| origin[axis] + N::wide_scale(moved, slope[axis]);
        let start = [start(0), start(1), start(2)];
        let within = |axis: usize| start[axis] <= reach && -start[axis] <= reach;
        let meets = tmax >= zero && within(0) && within(1) && within(2);
        // A ray that misses the scene starts anywhere in it, so that every kernel keeps its range.
        let coordinate = |axis: usize| {
            if meets {
                N::settle(N::narrow(start[axis]))
            } else {
                N::ZERO
            }
        };
        Ok(Self {
            origin: [coordinate(0), coordinate(1), coordinate(2)],
            slope,
            major,
            moved,
            tmin: if tmin > zero {
                N::narrow(if tmin < far { tmin } else { far })
            } else {
                N::ZERO
            },
            // An interval that ends before it starts holds no hit.
            tmax: if !meets {
                -N::ONE
            } else if tmax < far {
                N::narrow(tmax)
            } else {
                N::FAR
            },
        })
    }

    /// A ray given in double precision, rounded to this format only after its origin was moved to
    /// the scene: what hosts use, and tests.
    ///
    /// # Errors
    /// As [`Ray::new`].
    pub fn from_f64(
        bounds: &UnitBox,
        origin: [f64; 3],
        direction: [f64; 3],
        tmin: f64,
        tmax: f64,
    ) -> Result<Self, RayError> {
        let exact = Ray::<f64>::new(bounds, origin, direction, tmin, tmax)?;
        Ok(Self {
            origin: exact.origin.map(|x| N::settle(N::length_from_f64(x))),
            slope: exact.slope.map(N::ratio_from_f64),
            major: exact.major,
            moved: N::far_from_f64(exact.moved),
            tmin: N::length_from_f64(exact.tmin),
            tmax: N::length_from_f64(exact.tmax),
        })
    }

    /// The axis along which `t` is measured: 0, 1 or 2.
    pub fn major_axis(&self) -> usize {
        self.major
    }

    /// The direction, scaled so that its major component is 1 or -1.
    pub fn slope(&self) -> [N; 3] {
        self.slope
    }

    /// Where the ray starts inside of the kernels, in units: its own origin, or where it comes to the
    /// scene's box.
    pub fn start(&self) -> [N; 3] {
        self.origin
    }

    /// The t of [`start`](Self::start), as the caller counts it.
    pub fn moved(&self) -> N::Wide {
        self.moved
    }

    /// The interval that counts, from [`start`](Self::start).
    pub fn interval(&self) -> [N; 2] {
        [self.tmin, self.tmax]
    }

    /// A query along this ray, as events tell it.
    pub(crate) fn query(&self, any: bool) -> Event {
        Event::Query {
            origin: self.origin.map(N::length_to_f64),
            slope: self.slope.map(N::ratio_to_f64),
            moved: N::far_to_f64(self.moved),
            interval: [self.tmin, self.tmax].map(N::length_to_f64),
            any,
        }
    }

    /// The point at a parameter that is counted inside the kernels.
    #[inline(always)]
    pub(crate) fn at(&self, t: N) -> [N; 3] {
        let along = |axis: usize| self.origin[axis] + t * self.slope[axis];
        [along(0), along(1), along(2)]
    }
}
