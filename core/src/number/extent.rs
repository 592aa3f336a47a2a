//! The largest of three coordinates.

use crate::number::Arithmetic;

/// The larger of two extents, for error bounds.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn extent<N: Arithmetic>(coordinates: [N; 3]) -> N {
    coordinates[0]
        .abs()
        .max(coordinates[1].abs())
        .max(coordinates[2].abs())
}
