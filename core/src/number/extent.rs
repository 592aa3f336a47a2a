//! The largest of three coordinates.

use crate::number::Arithmetic;
use crate::target::inline_unless_small;

inline_unless_small!(
    /// The larger of two extents, for error bounds.
    pub(crate) fn extent<N: Arithmetic>(coordinates: [N; 3]) -> N {
        coordinates[0]
            .abs()
            .max(coordinates[1].abs())
            .max(coordinates[2].abs())
    }
);

/// Returns true if a wide number is finite: false for NaN and infinities.
#[inline(always)]
pub(crate) fn is_finite<N: Arithmetic>(wide: N::Wide) -> bool {
    N::wide_times(wide, 0) == N::Wide::default()
}

/// The largest magnitude of far coordinates.
#[inline(always)]
pub(crate) fn far_extent<N: Arithmetic>(coordinates: [N::Wide; 3]) -> N::Wide {
    let [x, y, z] = coordinates.map(N::magnitude);
    let larger = if x > y { x } else { y };
    if larger > z { larger } else { z }
}

/// The sum of the magnitudes of far coordinates: the length of a way, or up to √3 times as much.
#[inline(always)]
pub(crate) fn taxicab<N: Arithmetic>(coordinates: [N::Wide; 3]) -> N::Wide {
    let [x, y, z] = coordinates.map(N::magnitude);
    x + y + z
}
