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

/// The largest magnitude of far coordinates.
#[inline(always)]
pub(crate) fn far_extent<N: Arithmetic>(coordinates: [N::Wide; 3]) -> N::Wide {
    let magnitude = |wide: N::Wide| {
        if wide < N::Wide::default() {
            -wide
        } else {
            wide
        }
    };
    let [x, y, z] = coordinates.map(magnitude);
    let larger = if x > y { x } else { y };
    if larger > z { larger } else { z }
}
