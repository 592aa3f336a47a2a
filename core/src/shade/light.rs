//! Lights: the way to them from a point, and their arriving light.

use crate::accel::Number;
use crate::format::record::Light;
use crate::number::{Format, far_extent};
use crate::shade::departure::Origin;

/// The longest distance that `fixed` holds, with 13 fraction bits.
const LONGEST: i64 = i32::MAX as i64;

impl Light {
    /// The way from a surface to this light, of any length, and how far along its largest component the light is; `None`
    /// for infinitely far.
    #[inline(always)]
    pub(crate) fn seen_from<N: Number>(
        &self,
        origin: &Origin<'_, N>,
    ) -> ([N::Wide; 3], Option<N::Wide>) {
        if self.kind == Self::DIRECTIONAL {
            return (self.vector.map(N::far), None);
        }
        let place = origin.place();
        let axis = |k: usize| N::far(self.vector[k]) - place[k];
        let way = [axis(0), axis(1), axis(2)];
        (way, Some(far_extent::<N>(way)))
    }
}

/// A length with 13 fraction bits.
#[inline(always)]
pub(crate) fn length<N: Number>(q13: i32) -> N {
    N::narrow(N::far(q13.into()))
}

/// √½, with 30 fraction bits.
pub(crate) const ROOT_OF_HALF: i32 = 759_250_125;

/// Half of a distance, over a power of two by which it fits every format.
#[derive(Clone, Copy)]
pub(crate) struct Distance<N> {
    pub(crate) half: N,
    shift: u32,
}

impl<N: Number> Distance<N> {
    /// Returns a distance along a direction whose largest component is 1, given its length there and the direction's.
    #[inline(always)]
    pub(crate) fn of(mut along: N::Wide, norm: N) -> Self {
        let mut shift = 0;
        if let Format::Fixed = N::FORMAT {
            while along > N::far(LONGEST) && shift < 24 {
                along = N::wide_over(along, 1 << 6);
                shift += 6;
            }
        }
        let half = N::narrow(along).half() * norm;
        Self { half, shift }
    }

    /// A distance that fits every format, given by its half.
    #[inline(always)]
    pub(crate) fn near(half: N) -> Self {
        Self { half, shift: 0 }
    }

    /// Returns the distance at which the light of a point is what it is at this distance, times twice a ratio.
    #[inline(always)]
    pub(crate) fn for_twice(self, ratio: N) -> Self {
        let half = (self.half * N::ratio(ROOT_OF_HALF)).div(ratio.sqrt());
        Self { half, ..self }
    }

    /// Returns half of a length with 13 fraction bits, over the same power of two.
    #[inline(always)]
    pub(crate) fn half_length(&self, q13: i32) -> N {
        length::<N>(q13 >> self.shift).half()
    }

    /// Returns a length that was over that power of two.
    #[inline(always)]
    pub(crate) fn whole(&self, length: N) -> N::Wide {
        if self.shift == 0 {
            length.widen()
        } else {
            N::wide_times(length.widen(), 1 << self.shift)
        }
    }
}

/// A way by its direction and its length.
pub(crate) struct Way<N> {
    /// The direction, of length 1.
    pub(crate) unit: [N; 3],
    /// The way's length.
    pub(crate) distance: Distance<N>,
}

impl<N: Number> Way<N> {
    /// Returns them for a way and its length along its largest component; `None` if it has no length, or no end.
    pub(crate) fn of(way: [N::Wide; 3], distance: Option<N::Wide>) -> Option<Self> {
        let (slopes, _) = N::slopes(way)?;
        let (unit, norm) = N::normalize(slopes);
        let distance = Distance::of(distance?, norm);
        Some(Self { unit, distance })
    }
}
