//! Infinite planes. They lie in no structure, because a ray can cross them anywhere. A ray is tested from the origin of
//! its caller, before it is moved to the scene's box.
//!
//! A plane at right angles to an axis is exact: the hit's coordinate on that axis is the plane's own. Where a hit lies
//! beyond the lengths of [`Fixed`](crate::Fixed) less 16 units, its point is a nearer point of the plane. `t` is still
//! the plane's.

use crate::axis::pick;
use crate::format::layout::records;
use crate::format::limits::{FARTHEST_HIT, FARTHEST_POINT, ROOM_FOR_ERRORS};
use crate::format::range::Ranges;
use crate::format::record::UnitBox;
use crate::format::{BlobError, Reason};
use crate::geometry::primitive::{InScene, Primitive};
use crate::geometry::{Crossing, Part, Surface, cross_plane, flat};
use crate::number::{Arithmetic, Format, extent};
use crate::ray::Ray;
use bytemuck::{Pod, Zeroable};

/// In sub-steps: up to this distance, a quotient with 31 bits is right to a sub-step.
const PRECISE: i64 = 1 << 31;

records! {
    /// An infinite plane.
    ///
    /// It has no box, and the header's bounds do not hold it. No structure leads to planes: every query tests all of them.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(24)]
    pub struct Plane {
        /// A point of it in 1/256 unit, at most 2^17 units from the lattice's middle on every axis.
        #[valid(Point: -FARTHEST_POINT..=FARTHEST_POINT)]
        pub point: [i32; 3],
        /// Normal of any length, not zero.
        #[valid(Normal: -(1 << 24)..=1 << 24)]
        pub normal: [i32; 3],
    }
}

impl Plane {
    /// The stored normal, scaled by a power of two without any rounding.
    fn direction<N: Arithmetic>(&self) -> [N; 3] {
        N::direction(self.normal.map(i64::from))
    }

    /// The axis of the normal, if it has one.
    fn axis(&self) -> Option<usize> {
        match self.normal {
            [_, 0, 0] => Some(0),
            [0, _, 0] => Some(1),
            [0, 0, _] => Some(2),
            _ => None,
        }
    }

    fn coordinate<N: Arithmetic>(&self, axis: usize) -> N::Wide {
        // 13 fraction bits.
        N::far(i64::from(pick(self.point, axis)) << 5)
    }

    /// The plane's point as seen from another.
    fn seen_from<N: Arithmetic>(&self, place: [N::Wide; 3]) -> [N::Wide; 3] {
        let axis = |k: usize| self.coordinate::<N>(k) - pick(place, k);
        [axis(0), axis(1), axis(2)]
    }

    /// The distance from a far place to the plane along a ray, in [`Fixed`](crate::Fixed) with 31 bits. Out of line,
    /// because it is called in several places.
    #[inline(never)]
    fn far_t<N: Arithmetic>(&self, place: [N::Wide; 3], slope: [N; 3]) -> N::Wide {
        let normal = self.direction();
        let along_normal = far_dot(self.seen_from::<N>(place), normal);
        N::far_over(along_normal, N::dot(normal, slope))
    }

    /// A point of the plane, moved towards the plane's own point until it is a length on every axis, with room for error
    /// bounds. So it stays in the plane.
    fn within_reach<N: Arithmetic>(&self, mut place: [N::Wide; 3]) -> [N::Wide; 3] {
        // More halvings than a far coordinate has bits.
        for _ in 0..64 {
            if place.iter().all(|&x| held::<N>(x).widen() == x) {
                break;
            }
            place = [0, 1, 2].map(|k| {
                let own = self.coordinate::<N>(k);
                own + N::wide_over(pick(place, k) - own, 2)
            });
        }
        place
    }
}

impl Primitive for Plane {
    const FLAT: bool = true;
    const BOUNDED: bool = false;

    fn bounds(&self) -> UnitBox {
        UnitBox([[i16::MIN, i16::MAX]; 3])
    }

    fn cross<N: Arithmetic>(&self, _: &Ray<N>, _: N) -> Option<Crossing<N>> {
        None
    }

    fn cross_far<N: Arithmetic>(&self, place: [N::Wide; 3], slope: [N; 3]) -> Option<N::Wide> {
        let normal = self.direction();
        let approach = N::dot(normal, slope);
        let far = self.seen_from::<N>(place);
        let near = far.map(N::narrow);
        let t = cross_plane(normal, near, approach)?;
        if near.map(N::widen) == far && t.abs() < N::FAR {
            return Some(t.widen());
        }
        let t = self.far_t(place, slope);
        let is_beyond = |end: i64| !(-N::far(end) < t && t < N::far(end));
        if N::FORMAT != Format::Fixed || !is_beyond(PRECISE) || is_beyond(FARTHEST_HIT) {
            return Some(t);
        }
        let along = |k: usize| pick(place, k) + N::wide_scale(t, pick(slope, k));
        let rest = self.far_t([along(0), along(1), along(2)], slope);
        Some(t + rest)
    }

    fn surface<N: Arithmetic>(&self, ray: &Ray<N>, _: Part, point: [N; 3]) -> Surface<N> {
        let met = ray.meet_far(|place| self.cross_far(place, ray.slope));
        let place = met.map_or(point.map(N::widen), |met| met.coordinates(ray.slope));
        let place = self.within_reach::<N>(place);
        if let Some(axis) = self.axis() {
            let is_upper = pick(self.normal, axis) > 0;
            let coordinate = held(self.coordinate::<N>(axis));
            return flat::face(axis, is_upper, coordinate, place.map(held));
        }
        let normal = N::normalize(self.direction()).0;
        let relative = self.seen_from::<N>(place);
        // Onto the plane along the normal.
        let away = N::narrow(far_dot(relative, normal));
        let axis = |k: usize| held(pick(place, k) + (away * normal[k]).widen());
        let point = [axis(0), axis(1), axis(2)];
        let relative = relative.map(N::narrow);
        // A quarter of it, where the sum would leave the range.
        let error = if extent(relative) < N::FAR.half() {
            N::plane_error(normal, relative, point)
        } else {
            let part = N::plane_error(normal, relative.map(|x| x.half().half()), point);
            part + part + part + part
        };
        Surface {
            normal,
            point,
            error,
            is_exact: false,
        }
    }

    fn validate(&self, scene: InScene<'_>) -> Result<(), BlobError> {
        let at = scene.at;
        self.check_ranges(at.location())?;
        at.ensure(self.normal != [0; 3], Reason::ZeroNormal)
    }
}

/// The product of a far vector with one of ratios.
fn far_dot<N: Arithmetic>(far: [N::Wide; 3], ratios: [N; 3]) -> N::Wide {
    let part = |k: usize| N::wide_scale(pick(far, k), pick(ratios, k));
    part(0) + part(1) + part(2)
}

/// Returns a far coordinate as a length: the nearest that leaves room for error bounds.
fn held<N: Arithmetic>(coordinate: N::Wide) -> N {
    let most = N::narrow(N::far(1 << 60)) - N::from_unit(ROOM_FOR_ERRORS);
    N::narrow(coordinate).max(-most).min(most)
}
