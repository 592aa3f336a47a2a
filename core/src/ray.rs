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

/// Where rays from one point begin that run along one axis in one direction.
#[derive(Clone, Copy, Debug)]
struct Start<N: Number> {
    /// How far the origin is moved, to the plane in which the scene's box begins.
    moved: N::Wide,
    tmin: N,
    tmax: N,
}

impl<N: Number> Start<N> {
    #[inline(always)]
    fn of(
        bounds: &UnitBox,
        origin: [N::Wide; 3],
        (axis, forward): (usize, bool),
        tmin: N::Wide,
        tmax: N::Wide,
    ) -> Self {
        let zero = N::Wide::default();
        let [first, last] = pick(bounds.0, axis);
        let origin = pick(origin, axis);
        let to_box = if forward {
            N::from_unit(first).widen() - origin
        } else {
            origin - N::from_unit(last).widen()
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
        Self {
            moved,
            tmin: if tmin > zero {
                N::narrow(if tmin < far { tmin } else { far })
            } else {
                N::ZERO
            },
            // An interval that ends before it starts holds no hit.
            tmax: if tmax < zero {
                -N::ONE
            } else if tmax < far {
                N::narrow(tmax)
            } else {
                N::FAR
            },
        }
    }

    /// The ray from here along a slope.
    #[inline(always)]
    fn ray(&self, origin: [N::Wide; 3], slope: [N; 3], major: usize) -> Ray<N> {
        // A ray rises by at most 2^16 units on its way through the box.
        let reach = N::from_unit(i16::MAX).widen();
        let reach = reach + reach + reach;
        let mut within = true;
        let mut start = |axis: usize| {
            let start = origin[axis] + N::wide_scale(self.moved, slope[axis]);
            if start <= reach && start >= -reach {
                N::settle(N::narrow(start))
            } else {
                within = false;
                N::ZERO
            }
        };
        let origin = [start(0), start(1), start(2)];
        Ray {
            origin,
            slope,
            major,
            moved: self.moved,
            tmin: self.tmin,
            tmax: if within { self.tmax } else { -N::ONE },
        }
    }
}

/// An error unless the origin is finite and the interval is one.
#[inline(always)]
fn check<W: Copy + PartialOrd>(finite: bool, tmin: W, tmax: W) -> Result<(), RayError> {
    if tmin.partial_cmp(&tmax).is_none_or(Ordering::is_gt) {
        return Err(RayError::Interval);
    }
    if finite {
        Ok(())
    } else {
        Err(RayError::Origin)
    }
}

/// All rays from one point with one interval: what they share is computed once.
///
/// Gives the same rays as [`Ray::new`], bit for bit, for two thirds of its cost or less.
#[derive(Clone, Copy, Debug)]
pub struct Pencil<N: Number> {
    origin: [N::Wide; 3],
    /// `[axis][0 down it, 1 up it]`.
    starts: [[Start<N>; 2]; 3],
}

impl<N: Number> Pencil<N> {
    /// The rays from a point: see [`Ray::new`].
    ///
    /// # Errors
    /// If anything is NaN, or the origin infinite, or `tmin > tmax`.
    pub fn new(
        bounds: &UnitBox,
        origin: [N::Wide; 3],
        tmin: N::Wide,
        tmax: N::Wide,
    ) -> Result<Self, RayError> {
        check(is_finite::<N>(origin), tmin, tmax)?;
        Ok(Self::of(bounds, origin, tmin, tmax))
    }

    /// The rays without end from a finite point.
    pub(crate) fn endless(bounds: &UnitBox, origin: [N::Wide; 3]) -> Self {
        Self::of(bounds, origin, N::Wide::default(), N::far(1 << 60))
    }

    fn of(bounds: &UnitBox, origin: [N::Wide; 3], tmin: N::Wide, tmax: N::Wide) -> Self {
        let starts = [0, 1, 2].map(|axis| {
            [false, true].map(|forward| Start::of(bounds, origin, (axis, forward), tmin, tmax))
        });
        Self { origin, starts }
    }

    /// The ray in a direction of any length.
    ///
    /// # Errors
    /// If the direction is zero, infinite or NaN.
    #[inline(always)]
    pub fn ray(&self, direction: [N::Wide; 3]) -> Result<Ray<N>, RayError> {
        let (slope, major) = N::slopes(direction).ok_or(RayError::Direction)?;
        let [down, up] = pick(self.starts.each_ref(), major);
        let start = if pick(slope, major) > N::ZERO {
            up
        } else {
            down
        };
        Ok(start.ray(self.origin, slope, major))
    }
}

fn is_finite<N: Number>(origin: [N::Wide; 3]) -> bool {
    origin.into_iter().all(N::is_finite)
}

impl<N: Number> Ray<N> {
    /// A ray through a scene whose box is `bounds` (see [`Scene::bounds`](crate::Scene::bounds)).
    ///
    /// Origin and interval are lengths in units; the direction is of any length but 0. Hits are
    /// reported for `tmin <= t <= tmax`, in lengths along the major axis; `tmin` may be negative.
    ///
    /// # Errors
    /// If the direction is zero, or anything is NaN, or the origin or direction infinite, or
    /// `tmin > tmax`. Queries for which no ray can be made have no hit.
    // Hosts have the room; through memory a ray would cost as much again.
    #[cfg_attr(feature = "wide", inline(always))]
    #[cfg_attr(not(feature = "wide"), inline)]
    pub fn new(
        bounds: &UnitBox,
        origin: [N::Wide; 3],
        direction: [N::Wide; 3],
        tmin: N::Wide,
        tmax: N::Wide,
    ) -> Result<Self, RayError> {
        let (slope, major) = N::slopes(direction).ok_or(RayError::Direction)?;
        check(is_finite::<N>(origin), tmin, tmax)?;
        let forward = pick(slope, major) > N::ZERO;
        let start = Start::of(bounds, origin, (major, forward), tmin, tmax);
        Ok(start.ray(origin, slope, major))
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Fixed;
    use proptest::prelude::*;

    fn same_ray<N: Number>(origin: [f64; 3], direction: [f64; 3], [tmin, tmax]: [f64; 2]) {
        let bounds = UnitBox([[-300, 400], [-1000, 32_000], [5, 6]]);
        let origin = origin.map(N::far_from_f64);
        let direction = direction.map(N::far_from_f64);
        let (tmin, tmax) = (N::far_from_f64(tmin), N::far_from_f64(tmax));
        let alone = Ray::<N>::new(&bounds, origin, direction, tmin, tmax);
        let pencil = Pencil::new(&bounds, origin, tmin, tmax);
        let shared = pencil.and_then(|pencil| pencil.ray(direction));
        // Debug tells every bit, those of -0.0 and NaN included. The order of checks may differ.
        let text = |ray: Result<Ray<N>, RayError>| ray.map(|ray| format!("{ray:?}"));
        let (alone, shared) = (text(alone), text(shared));
        assert_eq!(alone.is_ok(), shared.is_ok());
        if alone.is_ok() {
            assert_eq!(alone, shared);
        }
    }

    fn length() -> impl Strategy<Value = f64> {
        prop_oneof![-1e3..1e3, -1e7..1e7, Just(0.0), Just(f64::NAN), -1e12..1e12]
    }

    /// Three finite numbers may have a sum that is not.
    #[test]
    fn every_finite_origin_is_one() {
        fn origins<N: Number<Wide = N>>(most: N, infinite: N) {
            let bounds = UnitBox([[-300, 400], [-1000, 32_000], [5, 6]]);
            let (zero, end) = (N::ZERO, N::FAR);
            let made = |origin: [N; 3]| {
                let direction = [N::ONE; 3];
                let alone = Ray::<N>::new(&bounds, origin, direction, zero, end);
                let pencil = Pencil::<N>::new(&bounds, origin, zero, end);
                assert_eq!(alone.err(), pencil.err());
                alone.err()
            };
            assert_eq!(made([most; 3]), None);
            assert_eq!(made([-most, -most, zero]), None);
            for axis in 0..3 {
                for wrong in [infinite, -infinite, infinite - infinite] {
                    let mut origin = [zero; 3];
                    origin[axis] = wrong;
                    assert_eq!(made(origin), Some(RayError::Origin));
                }
            }
            // Nor does one that is not finite vanish beside its opposite.
            assert_eq!(made([infinite, -infinite, zero]), Some(RayError::Origin));
        }
        origins::<f32>(f32::MAX, f32::INFINITY);
        origins::<f64>(f64::MAX, f64::INFINITY);
    }

    proptest! {
        #[test]
        fn a_pencil_gives_the_rays_that_are_made_one_by_one(
            origin in [length(), length(), length()],
            direction in [length(), length(), length()],
            interval in [length(), length()],
        ) {
            same_ray::<Fixed>(origin, direction, interval);
            same_ray::<f32>(origin, direction, interval);
            same_ray::<f64>(origin, direction, interval);
        }
    }
}
