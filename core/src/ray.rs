//! Rays, in the one form that every kernel uses.

use crate::axis::pick;
use crate::format::limits::FARTHEST;
use crate::format::record::UnitBox;
use crate::number::{Arithmetic, Format};
use crate::observe::event::Event;
use crate::target::SMALL;
use core::cmp::Ordering;
use core::fmt;
pub(crate) use unmoved::Unmoved;
use unmoved::{FarPlace, Place, rounded, unmoved};

mod unmoved;

/// A half-line with an interval, ready to be traced through one scene.
///
/// A ray is parametrised along the *major axis* of its direction, the one with the largest
/// component: `point = origin + t * slope`, where the slope of the major axis is 1 or -1 and the
/// others lie between. `t` is therefore a length in units (see [`Number`](crate::Number)), never
/// overflows, and needs no normalised direction. For a direction `d` of any length, the parameter
/// in multiples of `d` is `t / |d[major]|`.
///
/// An origin before the scene's box is moved along the ray to the plane in which the box begins,
/// and `t` is counted from there inside the kernels; [`Hit::t`](crate::Hit) is counted from the
/// origin that was given.
///
/// # Limits
/// - **Origin:** each coordinate is at most 2^37 units ([`FARTHEST`]), or the ray is rejected with
///   [`RayError::Distance`]. A scene's box is at most 2^16 units wide, so rays from 2^20 times its width
///   are answered. The origin is moved in twice the format's precision, by the direction as it is given
///   and not by its rounded slopes: from any distance the ray starts where it comes to the box, within two
///   roundings of the largest coordinate there (in `f32`: of the largest coordinate of a scene, 2^15
///   units).
/// - **Direction:** any finite length but 0, down to the smallest denormal number and up to the largest
///   finite one.
/// - **`tmin`, `tmax`:** anything but NaN; infinite ones are endless.
/// - **`t` of a hit** is rounded to the format: in `f32` it is off by up to 2^-24 of itself, in `f64` by
///   2^-53, and in `fixed` by a sub-step, 2^-13 of a unit. [`Hit::point`](crate::Hit::point) is not taken
///   from it, and is as good as that of a ray from near by.
#[derive(Clone, Copy, Debug)]
pub struct Ray<N: Arithmetic> {
    pub(crate) origin: [N; 3],
    pub(crate) slope: [N; 3],
    pub(crate) major: usize,
    /// How far the origin was moved.
    pub(crate) moved: N::Wide,
    pub(crate) tmin: N,
    pub(crate) tmax: N,
    pub(crate) unmoved: Unmoved<N>,
}

/// Why something is not a ray.
// As wide as a number in single precision: what shares its place in a `Result` is then loaded as it was stored.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayError {
    /// The direction is zero, infinite or NaN.
    Direction,
    /// The origin is infinite or NaN.
    Origin,
    /// The origin is farther than [`FARTHEST`] along an axis.
    Distance,
    /// `tmin` is greater than `tmax`, or one of them is NaN.
    Interval,
}

impl fmt::Display for RayError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            RayError::Direction => "the ray's direction is zero, infinite or NaN",
            RayError::Origin => "the ray's origin is infinite or NaN",
            RayError::Distance => {
                "the ray's origin is too far from the scene: more than 2^37 units, which is 2^21 times \
                 the width of the largest scene; move it closer along the ray"
            }
            RayError::Interval => "the ray's tmin is greater than its tmax, or one of them is NaN",
        })
    }
}

impl core::error::Error for RayError {}

/// How far rays are moved that run up or down one axis, from a coordinate on it: to the plane in which the scene's
/// box begins, or towards it for hits behind the point.
#[cfg_attr(not(feature = "small"), inline(always))]
fn way_to_box<N: Arithmetic>(
    bounds: &UnitBox,
    origin: N::Wide,
    (axis, forward): (usize, bool),
    tmin: N::Wide,
) -> N::Wide {
    let zero = N::Wide::default();
    let [first, last] = pick(bounds.0, axis);
    // Of what is too far away it may be anything.
    let to_box = if forward {
        N::difference(N::from_unit(first).widen(), origin)
    } else {
        N::difference(origin, N::from_unit(last).widen())
    };
    if to_box > zero {
        to_box
    } else if tmin < zero {
        if tmin > to_box { tmin } else { to_box }
    } else {
        zero
    }
}

/// An interval counted from where a ray was moved to.
#[inline(always)]
fn interval<N: Arithmetic>(tmin: N::Wide, tmax: N::Wide, moved: N::Wide) -> [N; 2] {
    let tmin = if tmin > moved {
        N::excess(tmin, moved)
    } else {
        N::ZERO
    };
    [tmin, end_after(tmax, moved)]
}

/// The end of an interval, counted likewise.
#[inline(always)]
fn end_after<N: Arithmetic>(tmax: N::Wide, moved: N::Wide) -> N {
    // An interval that ends before it starts holds no hit.
    if tmax < moved {
        -N::ONE
    } else {
        N::excess(tmax, moved)
    }
}

/// How far from the lattice's middle a ray may start on any axis, with 13 fraction bits: on its way
/// through the scene's box, which ends at 2^15 units, a ray rises by at most 2^16. Kernels keep their
/// ranges up to here.
const REACH: i64 = (3 * i16::MAX as i64) << 13;

/// Whether every ray that is moved so far along its major axis starts within [`REACH`]: slopes are at
/// most 1, and along its major axis a ray moves to the box. Never for numbers that are saturated.
#[inline(always)]
fn is_near<N: Arithmetic>(origin: [N; 3], major: usize, moved: N) -> bool {
    let (reach, moved) = (N::narrow(N::far(REACH)), moved.abs());
    let within = |axis: usize| {
        let reach = if axis == major {
            reach + moved
        } else {
            reach - moved
        };
        origin[axis].abs() < reach
    };
    // What is taken for far comes out the same, and needs less code. Twice the reach is a number; more
    // need not be.
    !SMALL && moved < reach && within(0) && within(1) && within(2)
}

/// Where a ray starts that is moved from an origin [near](is_near) the scene.
#[inline(always)]
fn near_start<N: Arithmetic>(origin: [N; 3], moved: N, slope: [N; 3]) -> [N; 3] {
    let start = |axis: usize| N::flush_tiny(origin[axis] + moved * slope[axis]);
    [start(0), start(1), start(2)]
}

/// Where a ray starts that is moved from an origin anywhere, how far that is, and whether it lies within
/// [`REACH`]: else it meets nothing. `EXACT` says that slopes and lengths are not rounded.
#[cfg_attr(not(feature = "small"), inline(always))]
fn far_start<N: Arithmetic, const EXACT: bool>(
    bounds: &UnitBox,
    origin: [N::Wide; 3],
    direction: [N::Wide; 3],
    (slope, major): ([N; 3], usize),
    moved: N::Wide,
) -> ([N; 3], N::Wide, bool) {
    let reach = N::narrow(N::far(REACH));
    let (start, moved) = if EXACT || N::narrow(moved).abs() < reach {
        let start = |axis: usize| far_coordinate(origin[axis], moved, slope[axis]);
        ([start(0), start(1), start(2)], moved)
    } else {
        // Rounded slopes and lengths would lose the ray's place.
        let [first, last] = pick(bounds.0, major);
        let forward = pick(slope, major) > N::ZERO;
        let plane = N::from_unit(if forward { first } else { last });
        let (from, stride) = (pick(origin, major), pick(direction, major));
        let start = |axis: usize| N::carry(origin[axis], from, plane, direction[axis], stride);
        let depth = plane.widen() - from;
        let moved = if forward { depth } else { -depth };
        ([start(0), start(1), start(2)], moved)
    };
    if start.iter().all(|x| x.abs() <= reach) {
        (start, moved, true)
    } else {
        ([N::ZERO; 3], moved, false)
    }
}

/// [`far_start`] of a ray that is to run along its slopes as they are.
#[inline(always)]
fn far_start_along<N: Arithmetic>(
    bounds: &UnitBox,
    origin: [N::Wide; 3],
    (slope, major): ([N; 3], usize),
    moved: N::Wide,
) -> ([N; 3], N::Wide, bool) {
    let direction = slope.map(N::widen);
    if N::FORMAT == Format::Fixed {
        far_start::<N, true>(bounds, origin, direction, (slope, major), moved)
    } else {
        far_start::<N, false>(bounds, origin, direction, (slope, major), moved)
    }
}

/// One coordinate of a start, in a register: through memory all three would burden near rays too.
#[cold]
#[inline(never)]
fn far_coordinate<N: Arithmetic>(origin: N::Wide, moved: N::Wide, slope: N) -> N {
    N::flush_tiny(N::narrow(origin + N::wide_scale(moved, slope)))
}

/// An error unless every coordinate of an origin is a number of at most [`FARTHEST`].
#[cold]
#[inline(never)]
fn check_origin<N: Arithmetic>(x: N::Wide, y: N::Wide, z: N::Wide) -> Result<(), RayError> {
    let most = N::far(FARTHEST);
    let origin = [x, y, z];
    // Not so for NaN.
    if origin.iter().all(|&x| -most <= x && x <= most) {
        Ok(())
    } else if origin.into_iter().all(N::is_finite) {
        Err(RayError::Distance)
    } else {
        Err(RayError::Origin)
    }
}

/// An error unless an interval is one.
#[inline(always)]
fn check_interval<W: Copy + PartialOrd>(tmin: W, tmax: W) -> Result<(), RayError> {
    if tmin.partial_cmp(&tmax).is_none_or(Ordering::is_gt) {
        return Err(RayError::Interval);
    }
    Ok(())
}

/// All rays without end from one point: what they share is computed once.
///
/// Gives the same rays as [`Ray::new`], bit for bit, for half of its cost or less where the point
/// is not much farther from the scene's box than the box is wide.
#[derive(Clone, Copy, Debug)]
pub struct Pencil<N: Arithmetic>(Origin<N>);

/// Where the rays of a pencil begin.
#[derive(Clone, Copy, Debug)]
enum Origin<N: Arithmetic> {
    /// [Near](is_near) the scene, whichever way a ray is moved.
    Near {
        origin: [N; 3],
        /// How far rays are moved to the box: `[axis][0 down it, 1 up it]`.
        moved: [[N; 2]; 3],
    },
    Far {
        origin: [N::Wide; 3],
        bounds: UnitBox,
    },
}

impl<N: Arithmetic> Pencil<N> {
    /// The rays from a point, with all `t` that are not negative: see [`Ray::new`].
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{Ray, Scene};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let ray = Ray::<f64>::new(scene.bounds(), [0.0; 3], [3.0, -4.0, 0.0], 0.0, 100.0)?;
    /// assert_eq!(ray.slope(), [0.75, -1.0, 0.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the origin is infinite or NaN, or farther than [`FARTHEST`].
    pub fn new(bounds: &UnitBox, origin: [N::Wide; 3]) -> Result<Self, RayError> {
        let [x, y, z] = origin;
        check_origin::<N>(x, y, z)?;
        Ok(Self::of(bounds, origin))
    }

    /// The rays from a point that is no farther than [`FARTHEST`].
    pub(crate) fn of(bounds: &UnitBox, origin: [N::Wide; 3]) -> Self {
        let zero = N::Wide::default();
        let moved = [0, 1, 2].map(|axis| {
            [false, true]
                .map(|forward| way_to_box::<N>(bounds, pick(origin, axis), (axis, forward), zero))
        });
        let single = (origin.map(N::narrow), moved.map(|ways| ways.map(N::narrow)));
        let near = |axis: usize| {
            let [down, up] = pick(single.1, axis);
            is_near(single.0, axis, down) && is_near(single.0, axis, up)
        };
        Self(if near(0) && near(1) && near(2) {
            let (origin, moved) = single;
            Origin::Near { origin, moved }
        } else {
            Origin::Far {
                origin,
                bounds: *bounds,
            }
        })
    }

    /// The ray in a direction of any length.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{Pencil, Ray, Scene};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let pencil = Pencil::<f64>::new(scene.bounds(), [0.0; 3])?;
    /// let ray = pencil.ray([1.0, 0.5, 0.0])?;
    /// let alone = Ray::<f64>::new(scene.bounds(), [0.0; 3], [1.0, 0.5, 0.0], 0.0, f64::INFINITY)?;
    /// assert_eq!(ray.slope(), alone.slope());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the direction is zero, infinite or NaN.
    #[inline(always)]
    pub fn ray(&self, direction: [N::Wide; 3]) -> Result<Ray<N>, RayError> {
        let (slope, major) = N::slopes(direction).ok_or(RayError::Direction)?;
        let toward = |bounds: &UnitBox, origin: &[N::Wide; 3], moved: N::Wide| {
            far_start::<N, false>(bounds, *origin, direction, (slope, major), moved)
        };
        Ok(self.ray_from(slope, major, toward))
    }

    /// The ray along slopes, given with their major axis.
    #[inline(always)]
    pub(crate) fn ray_along(&self, slope: [N; 3], major: usize) -> Ray<N> {
        let along = |bounds: &UnitBox, origin: &[N::Wide; 3], moved: N::Wide| {
            far_start_along(bounds, *origin, (slope, major), moved)
        };
        self.ray_from(slope, major, along)
    }

    /// The ray along slopes, from a start that is found by a function where it is far.
    #[inline(always)]
    fn ray_from(
        &self,
        slope: [N; 3],
        major: usize,
        far: impl Fn(&UnitBox, &[N::Wide; 3], N::Wide) -> ([N; 3], N::Wide, bool),
    ) -> Ray<N> {
        let forward = pick(slope, major) > N::ZERO;
        let zero = N::Wide::default();
        let (start, moved, within) = match &self.0 {
            Origin::Near { origin, moved } => {
                let [down, up] = pick(*moved, major);
                let moved = if forward { up } else { down };
                (near_start(*origin, moved, slope), moved.widen(), true)
            }
            Origin::Far { origin, bounds } => {
                let moved = way_to_box::<N>(bounds, pick(*origin, major), (major, forward), zero);
                far(bounds, origin, moved)
            }
        };
        let origin = || match &self.0 {
            Origin::Near { origin, .. } => origin.map(N::widen),
            Origin::Far { origin, .. } => *origin,
        };
        Ray {
            origin: start,
            slope,
            major,
            moved,
            tmin: N::ZERO,
            tmax: if within { N::FAR } else { -N::ONE },
            unmoved: unmoved(origin, [zero, N::far(i64::MAX)], within),
        }
    }
}

/// A length beyond every scene, however far from it a ray begins.
#[cfg(test)]
fn endless<N: Arithmetic>() -> N::Wide {
    N::far(i64::MAX)
}

impl<N: Arithmetic> Ray<N> {
    /// A ray through a scene whose box is `bounds` (see [`Scene::bounds`](crate::Scene::bounds)).
    ///
    /// Origin and interval are lengths in units; the direction is of any length but 0. Hits are
    /// reported for `tmin <= t <= tmax`, in lengths along the major axis; `tmin` may be negative.
    ///
    /// # Errors
    /// If the direction is zero, or anything is NaN, or the origin or direction infinite, or the origin
    /// farther than [`FARTHEST`] along an axis, or `tmin > tmax`: see the limits of [`Ray`].
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
        check_interval(tmin, tmax)?;
        let forward = pick(slope, major) > N::ZERO;
        let moved = way_to_box::<N>(bounds, pick(origin, major), (major, forward), tmin);
        let single = (origin.map(N::narrow), N::narrow(moved));
        let (start, moved, within) = if is_near(single.0, major, single.1) {
            (near_start(single.0, single.1, slope), moved, true)
        } else {
            let [x, y, z] = origin;
            check_origin::<N>(x, y, z)?;
            far_start::<N, false>(bounds, origin, direction, (slope, major), moved)
        };
        let unmoved = unmoved(|| origin, [tmin, tmax], within);
        let [tmin, tmax] = interval(tmin, tmax, moved);
        Ok(Self {
            origin: start,
            slope,
            major,
            moved,
            tmin,
            tmax: if within { tmax } else { -N::ONE },
            unmoved,
        })
    }

    /// A ray from a place in the scene, as hits give places, with all `t` up to `tmax` but 0, where it
    /// meets what it starts on. `None` if the direction is zero.
    #[cfg_attr(feature = "wide", inline(always))]
    #[cfg_attr(not(feature = "wide"), inline)]
    pub(crate) fn from_inside(
        bounds: &UnitBox,
        origin: [N; 3],
        direction: [N::Wide; 3],
        tmax: N::Wide,
    ) -> Option<Self> {
        let (slope, major) = N::slopes(direction)?;
        let forward = pick(slope, major) > N::ZERO;
        // A place beside the box at most: always near.
        let from = pick(origin, major).widen();
        let zero = N::Wide::default();
        let moved = way_to_box::<N>(bounds, from, (major, forward), zero);
        let beside = N::step_beside(N::ZERO);
        Some(Self {
            unmoved: unmoved(|| origin.map(N::widen), [beside.widen(), tmax], true),
            origin: near_start(origin, N::narrow(moved), slope),
            slope,
            major,
            moved,
            tmin: if moved > zero { N::ZERO } else { beside },
            tmax: end_after(tmax, moved),
        })
    }

    /// [`from_inside`](Self::from_inside) of a place that can lie far outside of the scene's box, on a shape without
    /// bounds.
    #[cold]
    pub(crate) fn from_anywhere(
        bounds: &UnitBox,
        origin: [N; 3],
        direction: [N::Wide; 3],
        tmax: Option<N::Wide>,
    ) -> Option<Self> {
        let beside = N::step_beside(N::ZERO).widen();
        let tmax = tmax.unwrap_or(N::far(i64::MAX));
        Self::new(bounds, origin.map(N::widen), direction, beside, tmax).ok()
    }

    /// A ray given in double precision, rounded to this format only after its origin was moved to
    /// the scene: what hosts use, and tests.
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
    /// As [`Ray::new`].
    #[cfg_attr(feature = "wide", inline(always))]
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
            moved: N::far_from_f64(exact.moved),
            tmin: N::length_from_f64(exact.tmin),
            tmax: N::length_from_f64(exact.tmax),
            unmoved: rounded(exact.unmoved, N::far_from_f64),
        })
    }

    /// The axis along which `t` is measured: 0, 1 or 2.
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

    /// The direction, scaled so that its major component is 1 or -1.
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

    /// Where the ray starts inside of the kernels, in units: its own origin, or where it comes to the
    /// scene's box.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// let scene = gridel_core::Scene::from_bytes(BLOB)?;
    /// // From far away a ray starts where it comes to the scene's box.
    /// let ray = gridel_core::Ray::<f64>::from_f64(scene.bounds(), [0.0, 1e6, 0.0], [0.0, -1.0, 0.0], 0.0, 1e9)?;
    /// assert_eq!(ray.start()[1] + ray.moved(), 1e6);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
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

    /// The interval as the caller gave it, counted from the origin: it can begin before [`start`](Self::start). It counts
    /// for shapes without bounds, and is empty in builds without them.
    pub fn unmoved_interval(&self) -> [N::Wide; 2] {
        let none = [N::far(1), N::Wide::default()];
        self.unmoved.first().map_or(none, |ray| ray.interval)
    }

    /// A place on the ray, and its t as the caller counts it: the ray's [`start`](Self::start), or its origin where
    /// it passes the scene so far away that it has no start.
    pub fn base(&self) -> ([N::Wide; 3], N::Wide) {
        let start = self.start_place();
        self.unmoved.first().map_or(start, |ray| ray.base(start))
    }

    fn start_place(&self) -> Place<N> {
        (self.origin.map(N::widen), self.moved)
    }

    /// Where the ray crosses a surface without bounds, given how far from a place on the ray that is.
    pub(crate) fn meet_far(
        &self,
        cross: impl Fn([N::Wide; 3]) -> Option<N::Wide>,
    ) -> Option<FarPlace<N>> {
        self.unmoved.first()?.meet(self.start_place(), cross)
    }

    /// The place at a `t` that is counted from the origin, which can lie anywhere.
    pub(crate) fn far_place(&self, t: N::Wide) -> Option<[N::Wide; 3]> {
        let place = self.unmoved.first()?.place(self.start_place(), t);
        Some(place.coordinates(self.slope))
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

    /// The ray with an interval that ends at a t, which the caller counts, where that is less; the end as it is
    /// counted inside of the kernels.
    pub(crate) fn until(&self, t: N::Wide) -> Self {
        let tmax = self
            .tmax
            .min(end_after::<N>(t, self.moved).min(N::FAR.half()));
        Self { tmax, ..*self }
    }

    /// The point at a parameter that is counted inside the kernels.
    #[cfg_attr(not(feature = "small"), inline(always))]
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

    fn same_ray<N: Arithmetic>(origin: [f64; 3], direction: [f64; 3]) {
        let bounds = UnitBox([[-300, 400], [-1000, 32_000], [5, 6]]);
        let origin = origin.map(N::far_from_f64);
        let direction = direction.map(N::far_from_f64);
        let endless = endless::<N>();
        let alone = Ray::<N>::new(&bounds, origin, direction, N::Wide::default(), endless);
        let shared = Pencil::new(&bounds, origin).and_then(|pencil| pencil.ray(direction));
        // Debug tells every bit, those of -0.0 and NaN included. The order of checks may differ.
        let text = |ray: Result<Ray<N>, RayError>| ray.map(|ray| format!("{ray:?}"));
        let (alone, shared) = (text(alone), text(shared));
        assert_eq!(alone.is_ok(), shared.is_ok());
        if alone.is_ok() {
            assert_eq!(alone, shared);
        }
    }

    fn length() -> impl Strategy<Value = f64> {
        prop_oneof![
            -1e3..1e3,
            -1e5..1e5,
            -1e7..1e7,
            Just(0.0),
            Just(f64::NAN),
            -1e12..1e12
        ]
    }

    /// What is near starts as what is far: all that is saved is arithmetic.
    fn same_start<N: Arithmetic>(origin: [f64; 3], direction: [f64; 3], tmin: f64) {
        let bounds = UnitBox([[-300, 400], [-32_768, 32_767], [5, 6]]);
        let origin = origin.map(N::far_from_f64);
        let direction = direction.map(N::far_from_f64);
        let Some((slope, major)) = N::slopes(direction) else {
            return;
        };
        let forward = pick(slope, major) > N::ZERO;
        let tmin = N::far_from_f64(tmin);
        let moved = way_to_box::<N>(&bounds, pick(origin, major), (major, forward), tmin);
        let single = (origin.map(N::narrow), N::narrow(moved));
        if is_near(single.0, major, single.1) {
            let near = near_start(single.0, single.1, slope);
            let far = far_start::<N, false>(&bounds, origin, direction, (slope, major), moved);
            assert_eq!((near, moved, true), far);
        }
    }

    /// Three finite numbers may have a sum that is not.
    #[test]
    fn origins_are_rejected_with_the_reason() {
        fn origins<N: Arithmetic<Wide = N>>(largest: N, infinite: N) {
            let bounds = UnitBox([[-300, 400], [-1000, 32_000], [5, 6]]);
            let (zero, end) = (N::ZERO, N::FAR);
            let made = |origin: [N; 3]| {
                let direction = [N::ONE; 3];
                let alone = Ray::<N>::new(&bounds, origin, direction, zero, end);
                let pencil = Pencil::<N>::new(&bounds, origin);
                assert_eq!(alone.err(), pencil.err());
                alone.err()
            };
            let most = N::far(FARTHEST);
            assert_eq!(made([most; 3]), None);
            assert_eq!(made([-most, -most, zero]), None);
            assert_eq!(made([largest; 3]), Some(RayError::Distance));
            for axis in 0..3 {
                let with = |x: N| {
                    let mut origin = [zero; 3];
                    origin[axis] = x;
                    made(origin)
                };
                for far in [most + most, -most - most, largest, -largest] {
                    assert_eq!(with(far), Some(RayError::Distance));
                }
                for wrong in [infinite, -infinite, infinite - infinite] {
                    assert_eq!(with(wrong), Some(RayError::Origin));
                }
            }
            // Nor does one that is not finite vanish beside its opposite.
            assert_eq!(made([infinite, -infinite, zero]), Some(RayError::Origin));
        }
        origins::<f32>(f32::MAX, f32::INFINITY);
        origins::<f64>(f64::MAX, f64::INFINITY);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[test]
        fn near_rays_start_as_far_ones(
            origin in [length(), length(), length()],
            direction in [length(), length(), length()],
            tmin in length(),
        ) {
            same_start::<Fixed>(origin, direction, tmin);
            same_start::<f32>(origin, direction, tmin);
            same_start::<f64>(origin, direction, tmin);
        }

        #[test]
        fn a_pencil_gives_the_rays_that_are_made_one_by_one(
            origin in [length(), length(), length()],
            direction in [length(), length(), length()],
        ) {
            same_ray::<Fixed>(origin, direction);
            same_ray::<f32>(origin, direction);
            same_ray::<f64>(origin, direction);
        }
    }
}
