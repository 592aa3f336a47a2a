//! A ray as its caller gave it, before it is moved to the scene's box. Shapes without bounds need it, because a ray can
//! hit them anywhere.

use crate::format::limits::{FARTHEST_HIT, UNBOUNDED};
use crate::number::Arithmetic;
use crate::target::InSomeBuilds;

/// A ray before it is moved to the scene's box. It is absent in builds without shapes that need it.
pub(crate) type Given<N> = InSomeBuilds<GivenRay<N>, { UNBOUNDED as usize }>;

/// A ray's origin and interval before the ray is moved to the scene's box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GivenRay<N: Arithmetic> {
    origin: [N::Wide; 3],
    pub(super) interval: [N::Wide; 2],
    /// True if the ray's start is a point of the ray. It is false where the ray passes the scene far away.
    pub(super) holds_start: bool,
}

/// A point of a ray, and its t, counted from the origin.
pub(super) type RayPoint<N> = (
    [<N as crate::number::Scalar>::Wide; 3],
    <N as crate::number::Scalar>::Wide,
);

/// The place where a ray hits a shape without bounds, counted from a place on the ray that is not far away.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FarPoint<N: Arithmetic> {
    reference: [N::Wide; 3],
    /// The t of `reference`, counted from the origin.
    pub(super) at: N::Wide,
    /// The t from there.
    pub(super) rest: N::Wide,
}

/// Computes the origin only where it is kept.
#[inline(always)]
pub(super) fn given<N: Arithmetic>(
    origin: impl Fn() -> [N::Wide; 3],
    interval: [N::Wide; 2],
    holds_start: bool,
) -> Given<N> {
    Given::new(|| GivenRay {
        origin: origin(),
        interval,
        holds_start,
    })
}

impl<N: Arithmetic> GivenRay<N> {
    /// Returns the ray's start if that is a point of the ray, and else its origin.
    pub(super) fn reference_point(&self, start: RayPoint<N>) -> RayPoint<N> {
        if self.holds_start {
            start
        } else {
            (self.origin, N::Wide::default())
        }
    }

    /// Returns where a ray crosses a surface, given the distance of the crossing from a place on the ray.
    ///
    /// The place is the origin or the start, whichever is nearer to the crossing. So numbers are precise where the
    /// crossing is, and a ray that begins outside a surface stays outside.
    pub(super) fn meet(
        &self,
        start: RayPoint<N>,
        cross: impl Fn([N::Wide; 3]) -> Option<N::Wide>,
    ) -> Option<FarPoint<N>> {
        let from = |(reference, at): RayPoint<N>| {
            let rest = cross(reference)?;
            Some(FarPoint::<N> {
                reference,
                at,
                rest,
            })
        };
        let first = from((self.origin, N::Wide::default()))?;
        let second = from(self.reference_point(start))?;
        let is_nearer = magnitude::<N>(second.rest) < magnitude::<N>(first.rest);
        let nearer = if is_nearer { second } else { first };
        (magnitude::<N>(nearer.rest) < N::far(FARTHEST_HIT)).then_some(nearer)
    }

    /// The place at a `t` that is counted from the origin.
    pub(super) fn point(&self, start: RayPoint<N>, t: N::Wide) -> FarPoint<N> {
        let (reference, at) = self.reference_point(start);
        if magnitude::<N>(t - at) < magnitude::<N>(t) {
            let rest = t - at;
            FarPoint {
                reference,
                at,
                rest,
            }
        } else {
            let (reference, at, rest) = (self.origin, N::Wide::default(), t);
            FarPoint {
                reference,
                at,
                rest,
            }
        }
    }
}

impl<N: Arithmetic> FarPoint<N> {
    /// Counted from the origin.
    pub(crate) fn t(&self) -> N::Wide {
        self.at + self.rest
    }

    pub(crate) fn coordinates(&self, slope: [N; 3]) -> [N::Wide; 3] {
        let [x, y, z] = self.reference;
        let along = |from: N::Wide, slope: N| from + N::wide_scale(self.rest, slope);
        [along(x, slope[0]), along(y, slope[1]), along(z, slope[2])]
    }
}

fn magnitude<N: Arithmetic>(wide: N::Wide) -> N::Wide {
    if wide < N::Wide::default() {
        -wide
    } else {
        wide
    }
}
