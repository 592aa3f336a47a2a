//! Rays, in the form that all kernels use.

mod error;
#[cfg(all(feature = "avx2", target_arch = "x86_64"))]
mod four;
mod given;
mod pencil;
mod start;

pub use error::RayError;
#[cfg(all(feature = "avx2", target_arch = "x86_64"))]
#[doc(hidden)]
pub use four::FourGivenRays;
#[cfg(all(feature = "avx2", target_arch = "x86_64"))]
pub(crate) use four::FourRays;
pub(crate) use given::{FarPoint, Given};
pub use pencil::Pencil;

use crate::axis::pick;
use crate::format::record::UnitBox;
use crate::number::Arithmetic;
use crate::observe::event::Event;
use crate::target::{inline_on_hosts, inline_on_hosts_hint_on_boards, inline_unless_small};
use given::{RayPoint, given};
use start::{
    check_interval, check_origin, distance_to_box, end_after, far_start, further_back, interval,
    is_near, near_start,
};

/// A half-line with an interval, ready to be traced through one scene.
///
/// A ray is parametrized along the *major axis* of its direction, the one with the largest component:
/// `point = origin + t * slope`. The slope of the major axis is 1 or -1 and the others lie between. `t` is therefore a
/// length in units (see [`Number`](crate::Number)), never overflows, and needs no normalized direction. For a direction
/// `d` of any length, the parameter in multiples of `d` is `t / |d[major]|`.
///
/// An origin before the scene's box is moved along the ray to the plane in which the box begins. Inside the kernels `t`
/// is counted from there. [`Hit::t`](crate::Hit) is counted from the caller's origin.
///
/// # Limits
/// - **Origin:** each coordinate is at most 2^37 units ([`FARTHEST`](crate::format::limits::FARTHEST)), or the ray is
///   rejected with [`RayError::Distance`]. A scene's box is at most 2^16 units wide, so rays from 2^20 times its width
///   are supported. The origin is moved in twice the format's precision, by the caller's direction and not by its
///   rounded slopes. So from any distance the ray starts where it reaches the box, within two roundings of the largest
///   coordinate there. In `f32` that is the largest coordinate of a scene, 2^15 units.
/// - **Direction:** any finite length but 0, down to the smallest denormal number and up to the largest
///   finite one.
/// - **`tmin`, `tmax`:** anything but NaN; infinite ones are endless.
/// - **`t` of a hit** is rounded to the format, twice. It is off by up to 2^-23 of itself in `f32`, by 2^-52 in `f64`,
///   and by a sub-step, 2^-13 of a unit, in `fixed`. With a `tmin` below 0 these are parts of the larger of `t` and the
///   way from the origin back to where the ray enters the box. [`Hit::point`](crate::Hit::point) is not computed from
///   it, and is as precise as that of a ray from near by.
#[derive(Clone, Copy, Debug)]
pub struct Ray<N: Arithmetic> {
    pub(crate) origin: [N; 3],
    pub(crate) slope: [N; 3],
    pub(crate) major: usize,
    /// The t of `origin`, as the caller counts it.
    pub(crate) start_t: N::Wide,
    pub(crate) tmin: N,
    pub(crate) tmax: N,
    pub(crate) given: Given<N>,
}

impl<N: Arithmetic> Ray<N> {
    inline_on_hosts_hint_on_boards!(
        /// Returns a ray through a scene whose box is `bounds` (see [`Scene::bounds`](crate::Scene::bounds)).
        ///
        /// Origin and interval are lengths in units; the direction is of any length but 0. Hits are reported for
        /// `tmin <= t <= tmax`, in lengths along the major axis; `tmin` can be negative.
        ///
        /// ```
        /// # static BLOB: &[u8] =
        /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
        /// use gridel_core::{Ray, RayError, Scene};
        ///
        /// let scene = Scene::from_bytes(BLOB)?;
        /// let ray = Ray::<f32>::new(scene.bounds(), [0.0; 3], [0.0, 3.0, -4.0], 0.0, 1e9)?;
        /// assert_eq!(ray.slope(), [0.0, 0.75, -1.0]);
        /// let nowhere = Ray::<f32>::new(scene.bounds(), [0.0; 3], [0.0; 3], 0.0, 1e9);
        /// assert_eq!(nowhere.err(), Some(RayError::Direction));
        /// # Ok::<(), Box<dyn std::error::Error>>(())
        /// ```
        ///
        /// # Errors
        /// If the direction is zero, anything is NaN, the origin or direction is infinite, or `tmin > tmax`. Also if
        /// the origin is farther than [`FARTHEST`](crate::format::limits::FARTHEST) along an axis: see the limits of
        /// [`Ray`].
        // Hosts have enough memory for copies; passing a ray through memory would double its cost.
        pub fn new(
            bounds: &UnitBox,
            origin: [N::Wide; 3],
            direction: [N::Wide; 3],
            tmin: N::Wide,
            tmax: N::Wide,
        ) -> Result<Self, RayError> {
            let (slope, major) = N::slopes(direction).ok_or(RayError::Direction)?;
            check_interval(tmin, tmax)?;
            let forward = pick(slope, major) > N::ZERO;
            let start_t = distance_to_box::<N>(bounds, pick(origin, major), (major, forward), tmin);
            let single = (origin.map(N::narrow), N::narrow(start_t));
            let (mut start, mut start_t, within) = if is_near(single.0, major, single.1) {
                (near_start(single.0, single.1, slope), start_t, true)
            } else {
                let [x, y, z] = origin;
                check_origin::<N>(x, y, z)?;
                far_start::<N, false>(bounds, origin, direction, (slope, major), start_t)
            };
            let is_moved_back = tmin < start_t && start_t < N::Wide::default();
            if is_moved_back && within {
                (start, start_t) = further_back(start, start_t, slope);
            }
            let given = given(|| origin, [tmin, tmax], within);
            let [tmin, tmax] = interval(tmin, tmax, start_t);
            Ok(Self {
                origin: start,
                slope,
                major,
                start_t,
                tmin,
                tmax: if within { tmax } else { -N::ONE },
                given,
            })
        }
    );

    inline_on_hosts_hint_on_boards!(
        /// Returns a ray from a place in the scene, in the form in which hits give places. It has all `t` up to `tmax`
        /// except 0, where it touches the surface on which it starts. `None` if the direction is zero.
        pub(crate) fn from_inside(
            bounds: &UnitBox,
            origin: [N; 3],
            direction: [N::Wide; 3],
            tmax: N::Wide,
        ) -> Option<Self> {
            let (slope, major) = N::slopes(direction)?;
            let forward = pick(slope, major) > N::ZERO;
            // The place lies at most an error bound outside the box, so it is always near.
            let from = pick(origin, major).widen();
            let zero = N::Wide::default();
            let start_t = distance_to_box::<N>(bounds, from, (major, forward), zero);
            let beside = N::step_beside(N::ZERO);
            Some(Self {
                given: given(|| origin.map(N::widen), [beside.widen(), tmax], true),
                origin: near_start(origin, N::narrow(start_t), slope),
                slope,
                major,
                start_t,
                tmin: if start_t > zero { N::ZERO } else { beside },
                tmax: end_after(tmax, start_t),
            })
        }
    );

    /// Returns where the ray enters a solid. A ray that starts where the scene's box begins enters nothing before its
    /// start, but what touches that plane can be rounded to there.
    #[inline(always)]
    pub(crate) fn ahead<P>(&self, (t, part): (N, P)) -> (N, P) {
        let starts_outside = self.tmin == N::ZERO && self.start_t > N::Wide::default();
        if t < N::ZERO && starts_outside {
            (N::ZERO, part)
        } else {
            (t, part)
        }
    }

    inline_on_hosts!(
        /// Returns a ray given in double precision, rounded to this format only after its origin was moved to the
        /// scene. For hosts and tests.
        ///
        /// ```
        /// # static BLOB: &[u8] =
        /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
        /// use gridel_core::{Fixed, Ray, RayError, Scene};
        ///
        /// let scene = Scene::from_bytes(BLOB)?;
        /// let ray = Ray::<Fixed>::from_f64(scene.bounds(), [0.0; 3], [0.0, 0.0, -2.0], 0.0, 1e9)?;
        /// assert_eq!(ray.major_axis(), 2);
        /// let zero = Ray::<Fixed>::from_f64(scene.bounds(), [0.0; 3], [0.0; 3], 0.0, 1e9);
        /// assert_eq!(zero.err(), Some(RayError::Direction));
        /// # Ok::<(), Box<dyn std::error::Error>>(())
        /// ```
        ///
        /// # Errors
        /// The errors of [`Ray::new`].
        pub fn from_f64(
            bounds: &UnitBox,
            origin: [f64; 3],
            direction: [f64; 3],
            tmin: f64,
            tmax: f64,
        ) -> Result<Self, RayError> {
            let exact = Ray::<f64>::new(bounds, origin, direction, tmin, tmax)?;
            Ok(Self {
                origin: exact.origin.map(|x| N::flush_tiny(N::length_from_f64(x))),
                slope: exact.slope.map(N::ratio_from_f64),
                major: exact.major,
                start_t: N::far_from_f64(exact.start_t),
                tmin: N::length_from_f64(exact.tmin),
                tmax: N::length_from_f64(exact.tmax),
                given: given(
                    || origin.map(N::far_from_f64),
                    [tmin, tmax].map(N::far_from_f64),
                    exact.holds_start(),
                ),
            })
        }
    );

    /// Returns the axis along which `t` is measured: 0, 1 or 2.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// let scene = gridel_core::Scene::from_bytes(BLOB)?;
    /// let ray = gridel_core::Ray::<f32>::from_f64(scene.bounds(), [0.0; 3], [1.0, 5.0, 1.0], 0.0, 1.0)?;
    /// assert_eq!(ray.major_axis(), 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn major_axis(&self) -> usize {
        self.major
    }

    /// Returns the direction, scaled so that its major component is 1 or -1.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// let scene = gridel_core::Scene::from_bytes(BLOB)?;
    /// let ray = gridel_core::Ray::<f32>::from_f64(scene.bounds(), [0.0; 3], [1.0, 2.0, -4.0], 0.0, 1.0)?;
    /// assert_eq!(ray.slope(), [0.25, 0.5, -1.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn slope(&self) -> [N; 3] {
        self.slope
    }

    /// Returns the ray's start inside the kernels, in units: its origin, or the point where it reaches the scene's box.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// let scene = gridel_core::Scene::from_bytes(BLOB)?;
    /// // From far away a ray starts where it comes to the scene's box.
    /// let ray = gridel_core::Ray::<f64>::from_f64(scene.bounds(), [0.0, 1e6, 0.0], [0.0, -1.0, 0.0], 0.0, 1e9)?;
    /// assert_eq!(ray.start()[1] + ray.start_t(), 1e6);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn start(&self) -> [N; 3] {
        self.origin
    }

    /// Returns the t of [`start`](Self::start), as the caller counts it.
    pub fn start_t(&self) -> N::Wide {
        self.start_t
    }

    /// Returns the interval in which hits are reported, counted from [`start`](Self::start).
    pub fn interval(&self) -> [N; 2] {
        [self.tmin, self.tmax]
    }

    /// Returns the interval as the caller gave it, counted from the origin: it can begin before [`start`](Self::start).
    /// Hits of unbounded shapes are reported in it; it is empty in builds without them.
    pub fn given_interval(&self) -> [N::Wide; 2] {
        let none = [N::far(1), N::Wide::default()];
        self.given.get().map_or(none, |ray| ray.interval)
    }

    /// Returns a point of the ray, and its t as the caller counts it. The point is the ray's [`start`](Self::start).
    /// Where the ray passes the scene so far away that it has no start, the point is its origin.
    pub fn reference_point(&self) -> ([N::Wide; 3], N::Wide) {
        let start = self.start_point();
        self.given
            .get()
            .map_or(start, |ray| ray.reference_point(start))
    }

    /// Returns true if the start is a point of the ray.
    pub(crate) fn holds_start(&self) -> bool {
        self.given.get().is_none_or(|ray| ray.holds_start)
    }

    fn start_point(&self) -> RayPoint<N> {
        (self.origin.map(N::widen), self.start_t)
    }

    /// Returns where the ray crosses a surface without bounds, given the distance of the crossing from a place on the
    /// ray.
    pub(crate) fn meet_far(
        &self,
        cross: impl Fn([N::Wide; 3]) -> Option<N::Wide>,
    ) -> Option<FarPoint<N>> {
        self.given.get()?.meet(self.start_point(), cross)
    }

    /// The place at a `t` that is counted from the origin, which can lie anywhere.
    pub(crate) fn far_point(&self, t: N::Wide) -> Option<[N::Wide; 3]> {
        let point = self.given.get()?.point(self.start_point(), t);
        Some(point.coordinates(self.slope))
    }

    /// A query along this ray, as events report it.
    pub(crate) fn query(&self, any: bool) -> Event {
        let (origin, start_t) = self.reference_point();
        let start_t = N::far_to_f64(start_t);
        Event::Query {
            origin: origin.map(N::far_to_f64),
            slope: self.slope.map(N::ratio_to_f64),
            start_t,
            interval: [self.tmin, self.tmax].map(N::length_to_f64),
            far_interval: self.given_interval().map(|t| N::far_to_f64(t) - start_t),
            any,
        }
    }

    /// Returns the distance from the ray's start to a hit with a surface without bounds. It has the same bits as the
    /// result of kernels for a shape there. It is at most half of the longest length, and negative for a hit before the
    /// start.
    pub(crate) fn after_start(&self, met: &FarPoint<N>) -> N {
        let difference = end_after::<N>(met.t(), self.start_t);
        let after = if difference >= N::ZERO && met.at == self.start_t {
            N::narrow(met.rest).max(N::ZERO)
        } else {
            difference
        };
        after.min(N::FAR.half())
    }

    /// The ray with an interval that ends so far behind its start, where that is less.
    pub(crate) fn until(&self, after_start: N) -> Self {
        let tmax = self.tmax.min(after_start);
        Self { tmax, ..*self }
    }

    inline_unless_small!(
        /// The point at a parameter that is counted inside the kernels.
        pub(crate) fn at(&self, t: N) -> [N; 3] {
            let along = |axis: usize| self.origin[axis] + t * self.slope[axis];
            [along(0), along(1), along(2)]
        }
    );
}

#[cfg(test)]
mod tests;
