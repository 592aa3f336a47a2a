//! Ranges of the scales of joints, and of joints that hang on each other.
//!
//! A program composes motions joint by joint, from the one that hangs on no other on, and moves each composed scale into
//! its range. Where a scale is moved, all that hangs on the joint has another size than its tracks say.

use super::joint::{LARGEST_SCALE, LEAST_SCALE};
use super::track::{Interpolation, Key, control_points};

/// Up to this size an instance whose composed scale was moved to the least one is as good as gone.
const NOTHING: f64 = 1.0 / 256.0;

/// Rounding of products.
const ROUNDING: f64 = 1e-9;

/// The scales that a joint, and those that it hangs on, lead to at any time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ScaleRange {
    least: f64,
    greatest: f64,
    /// The largest scale that is left of one that was moved to the least one.
    raised: f64,
}

impl ScaleRange {
    /// No scale.
    pub(crate) const REST: Self = Self {
        least: 1.0,
        greatest: 1.0,
        raised: 0.0,
    };

    /// The range of a track, with that at rest.
    pub(crate) fn of(interpolation: Interpolation, keys: &[Key]) -> Self {
        let scales = control_points(interpolation, keys).map(|it| it.x);
        let scales = scales.map(|it| it.clamp(LEAST_SCALE, LARGEST_SCALE));
        scales.fold(Self::REST, |range, it| Self {
            least: range.least.min(it),
            greatest: range.greatest.max(it),
            ..range
        })
    }

    /// The least and the greatest scale.
    pub(crate) fn ends(&self) -> [f64; 2] {
        [self.least, self.greatest]
    }

    /// Returns the range of a joint that hangs on one with this range `above`.
    pub(crate) fn under(&self, above: &Self) -> Self {
        let least = self.least * above.least;
        let raised = above.raised * self.greatest;
        Self {
            least: least.max(LEAST_SCALE),
            greatest: self.greatest * above.greatest,
            raised: match least < LEAST_SCALE * (1.0 - ROUNDING) {
                true => raised.max(LEAST_SCALE),
                false => raised,
            },
        }
    }

    /// Why a program cannot compose the scales; `None` if it can.
    pub(crate) fn fault(&self) -> Option<String> {
        if self.greatest > LARGEST_SCALE * (1.0 + ROUNDING) {
            return Some(format!(
                "scales to {:.4} times its size at rest with the joints above it; at most {LARGEST_SCALE} are possible",
                self.greatest
            ));
        }
        (self.raised > NOTHING * (1.0 + ROUNDING)).then(|| {
            String::from(
                "scales with the joints above it to less than 1/16384 of its size at rest and up again; at least \
                 1/16384 is possible",
            )
        })
    }
}
