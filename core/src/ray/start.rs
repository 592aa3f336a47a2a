//! The start of a ray: an origin before the scene's box is moved along the ray to the box.

use crate::axis::pick;
use crate::format::limits::FARTHEST;
use crate::format::record::UnitBox;
use crate::number::{Arithmetic, Format, is_finite};
use crate::ray::error::RayError;
use crate::target::{SMALL, inline_unless_small};
use core::cmp::Ordering;

inline_unless_small!(
    /// The lengths by which rays are moved that run up or down one axis, from a coordinate on it. They are moved to the
    /// plane in which the scene's box begins, or towards it for hits behind the point.
    pub(super) fn distance_to_box<N: Arithmetic>(
        bounds: &UnitBox,
        origin: N::Wide,
        (axis, forward): (usize, bool),
        tmin: N::Wide,
    ) -> N::Wide {
        let zero = N::Wide::default();
        let [first, last] = pick(bounds.0, axis);
        // For a place that is too far away, any value is allowed.
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
);

/// Moves a start four units further back. Rounding moves no hit of the scene's box before it, as it does where the start
/// lies on the box. (One unit would do; after four, slopes with few bits keep their products short.)
#[inline(always)]
pub(super) fn further_back<N: Arithmetic>(
    start: [N; 3],
    start_t: N::Wide,
    slope: [N; 3],
) -> ([N; 3], N::Wide) {
    let length = N::from_unit(4);
    let back = |k: usize| start[k] - length * slope[k];
    (
        [back(0), back(1), back(2)],
        N::difference(start_t, length.widen()),
    )
}

/// An interval counted from the moved origin of a ray.
#[inline(always)]
pub(super) fn interval<N: Arithmetic>(tmin: N::Wide, tmax: N::Wide, start_t: N::Wide) -> [N; 2] {
    let tmin = if tmin > start_t {
        N::difference_as_length(tmin, start_t)
    } else {
        N::ZERO
    };
    [tmin, end_after(tmax, start_t)]
}

/// The end of an interval, counted likewise.
#[inline(always)]
pub(super) fn end_after<N: Arithmetic>(tmax: N::Wide, start_t: N::Wide) -> N {
    // An interval that ends before it starts holds no hit.
    if tmax < start_t {
        -N::ONE
    } else {
        N::difference_as_length(tmax, start_t)
    }
}

/// The greatest distance of a ray's start from the lattice's middle on any axis, with 13 fraction bits. On its way
/// through the scene's box, which ends at 2^15 units, a ray rises by at most 2^16. Kernels keep their ranges up to
/// here.
pub(super) const REACH: i64 = (3 * i16::MAX as i64) << 13;

/// Returns true if every ray that is moved by this length along its major axis starts within [`REACH`]. Slopes are at
/// most 1, and along its major axis a ray moves to the box. Always false for saturated numbers.
#[inline(always)]
pub(super) fn is_near<N: Arithmetic>(origin: [N; 3], major: usize, start_t: N) -> bool {
    let (reach, start_t) = (N::narrow(N::far(REACH)), start_t.abs());
    let within = |axis: usize| {
        let reach = if axis == major {
            reach + start_t
        } else {
            reach - start_t
        };
        origin[axis].abs() < reach
    };
    // A place that counts as far gives the same result, and needs less code. Twice the reach is a number; a larger one
    // need not be.
    !SMALL && start_t < reach && within(0) && within(1) && within(2)
}

/// Returns the start of a ray that is moved from an origin [near](is_near) the scene.
#[inline(always)]
pub(super) fn near_start<N: Arithmetic>(origin: [N; 3], start_t: N, slope: [N; 3]) -> [N; 3] {
    let start = |axis: usize| N::flush_tiny(origin[axis] + start_t * slope[axis]);
    [start(0), start(1), start(2)]
}

inline_unless_small!(
    /// Returns the start of a ray that is moved from an origin anywhere, how far it is moved, and whether it lies
    /// within [`REACH`]. Outside it the ray hits nothing. `EXACT` states that slopes and lengths are not rounded.
    pub(super) fn far_start<N: Arithmetic, const EXACT: bool>(
        bounds: &UnitBox,
        origin: [N::Wide; 3],
        direction: [N::Wide; 3],
        (slope, major): ([N; 3], usize),
        start_t: N::Wide,
    ) -> ([N; 3], N::Wide, bool) {
        let reach = N::narrow(N::far(REACH));
        let (start, start_t) = if EXACT || N::narrow(start_t).abs() < reach {
            let start = |axis: usize| far_coordinate(origin[axis], start_t, slope[axis]);
            ([start(0), start(1), start(2)], start_t)
        } else {
            // Rounded slopes and lengths would lose the ray's place.
            let [first, last] = pick(bounds.0, major);
            let forward = pick(slope, major) > N::ZERO;
            let plane = N::from_unit(if forward { first } else { last });
            let (from, stride) = (pick(origin, major), pick(direction, major));
            let start = |axis: usize| N::carry(origin[axis], from, plane, direction[axis], stride);
            let depth = plane.widen() - from;
            let start_t = if forward { depth } else { -depth };
            ([start(0), start(1), start(2)], start_t)
        };
        if start.iter().all(|x| x.abs() <= reach) {
            (start, start_t, true)
        } else {
            ([N::ZERO; 3], start_t, false)
        }
    }
);

/// [`far_start`] for a ray that runs along exactly its slopes.
#[inline(always)]
pub(super) fn far_start_along<N: Arithmetic>(
    bounds: &UnitBox,
    origin: [N::Wide; 3],
    (slope, major): ([N; 3], usize),
    start_t: N::Wide,
) -> ([N; 3], N::Wide, bool) {
    let direction = slope.map(N::widen);
    if N::FORMAT == Format::Fixed {
        far_start::<N, true>(bounds, origin, direction, (slope, major), start_t)
    } else {
        far_start::<N, false>(bounds, origin, direction, (slope, major), start_t)
    }
}

/// One coordinate of a start, in a register: all three would go through memory and cost near rays time, too.
#[cold]
#[inline(never)]
fn far_coordinate<N: Arithmetic>(origin: N::Wide, start_t: N::Wide, slope: N) -> N {
    N::flush_tiny(N::narrow(origin + N::wide_scale(start_t, slope)))
}

/// Returns an error unless every coordinate of an origin is a number of at most [`FARTHEST`].
#[cold]
#[inline(never)]
pub(super) fn check_origin<N: Arithmetic>(
    x: N::Wide,
    y: N::Wide,
    z: N::Wide,
) -> Result<(), RayError> {
    let most = N::far(FARTHEST);
    let origin = [x, y, z];
    // False for NaN.
    if origin.iter().all(|&x| -most <= x && x <= most) {
        Ok(())
    } else if origin.into_iter().all(is_finite::<N>) {
        Err(RayError::Distance)
    } else {
        Err(RayError::Origin)
    }
}

/// Returns an error unless an interval is valid.
#[inline(always)]
pub(super) fn check_interval<W: Copy + PartialOrd>(tmin: W, tmax: W) -> Result<(), RayError> {
    if tmin.partial_cmp(&tmax).is_none_or(Ordering::is_gt) {
        return Err(RayError::Interval);
    }
    Ok(())
}
