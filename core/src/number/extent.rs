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
