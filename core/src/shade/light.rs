//! Lights: the way to them from a point, and their arriving light.

use crate::accel::Number;
use crate::format::record::Light;

impl Light {
    /// The way from a point to this light, of any length, and how far along its largest component
    /// the light is; `None` for infinitely far.
    #[inline(always)]
    pub(crate) fn seen_from<N: Number>(&self, point: [N; 3]) -> ([N::Wide; 3], Option<N::Wide>) {
        if self.directional == 1 {
            return (self.vector.map(N::far), None);
        }
        let axis = |k: usize| N::far(self.vector[k]) - point[k].widen();
        let way = [axis(0), axis(1), axis(2)];
        (way, Some(largest::<N>(way)))
    }
}

/// The magnitude of the largest component.
#[inline(always)]
pub(crate) fn largest<N: Number>(way: [N::Wide; 3]) -> N::Wide {
    let zero = N::Wide::default();
    way.iter().fold(zero, |largest, &component| {
        let magnitude = if component < zero {
            -component
        } else {
            component
        };
        if magnitude > largest {
            magnitude
        } else {
            largest
        }
    })
}

/// A length with 13 fraction bits.
#[inline(always)]
pub(crate) fn length<N: Number>(q13: i32) -> N {
    N::narrow(N::far(q13.into()))
}

/// The direction and the length of a way.
pub(crate) struct Reach<N> {
    /// The direction, of length 1.
    pub(crate) unit: [N; 3],
    /// Half the way's length, which fits every format; at most half of [`FAR`](crate::number::Scalar::FAR) along the
    /// largest component.
    pub(crate) half_length: N,
}

impl<N: Number> Reach<N> {
    /// From a way and its length along its largest component; `None` if it has no length, or no end.
    pub(crate) fn of(way: [N::Wide; 3], distance: Option<N::Wide>) -> Option<Self> {
        let (slopes, _) = N::slopes(way)?;
        let (unit, norm) = N::normalize(slopes);
        let half_length = N::narrow(distance?).half() * norm;
        Some(Self { unit, half_length })
    }
}
