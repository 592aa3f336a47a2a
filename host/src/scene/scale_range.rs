//! Ranges of the scales of joints, and of joints that hang on each other.
//!
//! A program composes motions joint by joint, from the one that hangs on no other on, and moves each composed scale
//! into its range. Where a scale is moved, all that hangs on the joint has another size than its tracks say. A scale
//! moved up to the least one leaves at most 1/256: what follows grows at most as far as the largest scale, because each
//! joint's range has the 1 of its rest.

use super::joint::{LARGEST_SCALE, LEAST_SCALE};
use super::track::{Interpolation, Key, extremes};
use crate::table::significant;

/// Rounding of products.
const ROUNDING: f64 = 1e-9;

/// The scales that a joint, and those that it hangs on, lead to at any time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ScaleRange {
    least: f64,
    greatest: f64,
}

impl ScaleRange {
    /// No scale.
    pub(crate) const REST: Self = Self {
        least: 1.0,
        greatest: 1.0,
    };

    /// The range of a track, with that at rest.
    pub(crate) fn of(interpolation: Interpolation, keys: &[Key]) -> Self {
        let scales = extremes(interpolation, keys);
        // A greater one than the largest is a fault.
        let scales = scales.map(|it| it.max(LEAST_SCALE));
        scales.fold(Self::REST, |range, it| Self {
            least: range.least.min(it),
            greatest: range.greatest.max(it),
        })
    }

    /// The least and the greatest scale.
    pub(crate) fn ends(&self) -> [f64; 2] {
        [self.least, self.greatest]
    }

    /// Returns the range of a joint that hangs on one with this range `above`.
    pub(crate) fn under(&self, above: &Self) -> Self {
        Self {
            least: (self.least * above.least).max(LEAST_SCALE),
            greatest: self.greatest * above.greatest,
        }
    }

    /// Returns the reason why a program cannot compose the scales; `None` if it can.
    pub(crate) fn fault(&self) -> Option<String> {
        (self.greatest > LARGEST_SCALE * (1.0 + ROUNDING)).then(|| {
            format!(
                "scales to {} times its size at rest with the joints above it; at most {LARGEST_SCALE} are possible",
                significant(self.greatest)
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The control points of a spline lead farther than the spline.
    #[test]
    fn ranges_of_splines_are_those_of_their_values() {
        let key = |seconds: f64, scale: f64, change: f64| Key {
            seconds,
            value: [scale, 0.0, 0.0, 0.0],
            entering: [change, 0.0, 0.0, 0.0],
            leaving: [change, 0.0, 0.0, 0.0],
        };
        for (keys, least, greatest) in [
            ([key(0.0, 1.0, -3.0), key(1.0, 0.1, 0.0)], 0.097_222, 1.0),
            ([key(0.0, 1.0, 0.0), key(1.0, 60.0, 20.0)], 1.0, 60.0),
            ([key(0.0, 1.0, 8.0), key(2.0, 1.0, -8.0)], 1.0, 5.0),
            ([key(0.0, 1.0, 0.0), key(1.0, 60.0, -80.0)], 1.0, 65.145_355),
        ] {
            let [low, high] = ScaleRange::of(Interpolation::Cubic, &keys).ends();
            assert!(
                (low - least).abs() < 1e-5 && (high - greatest).abs() < 1e-5,
                "{low} {high}"
            );
        }
    }
}
