//! The choice of a scene's lattice.

use crate::compile::CompileError;
use crate::shape::{Lattice, exp2};
use glam::DVec3;

/// Fewest and most bits that a coordinate can be snapped to.
pub const BITS: std::ops::RangeInclusive<u8> = 10..=24;

impl Lattice {
    /// Returns the finest lattice of a number of bits that holds the box from `lowest` to
    /// `highest`. With `coarser` above 0 it is coarser by that many powers of two.
    pub fn around(
        [lowest, highest]: [DVec3; 2],
        bits: u8,
        coarser: i32,
    ) -> Result<Self, CompileError> {
        let mut half = ((highest - lowest) * 0.5).max_element();
        if !half.is_finite() {
            return Err(CompileError::Extent { size: 2.0 * half });
        }
        let middle = (lowest + highest) * 0.5;
        // Planes through one point: as far as they are from the camera that is supplied.
        if half == 0.0 && middle != DVec3::ZERO {
            half = middle.abs().max_element().max(1.0);
        }
        // Two steps to spare, for the rounding of the origin and of the coordinates.
        let units = f64::from(i16::MAX) - 2.0 * exp2(16 - i32::from(bits)).max(1.0);
        let mut exponent = if half > 0.0 {
            log2_below(half / units)
        } else {
            0
        };
        while half > units * exp2(exponent) {
            exponent += 1;
        }
        exponent += coarser;
        // Keeps steps and their inverses normal numbers.
        if !(-900..=900).contains(&exponent) {
            return Err(CompileError::Extent { size: 2.0 * half });
        }
        let mut lattice = Self {
            bits,
            unit_exponent: exponent as i16,
            origin: DVec3::ZERO,
        };
        let step = lattice.step();
        let steps = (middle / step).round();
        if steps.abs().max_element() > exp2(52) {
            return Err(CompileError::TooFar {
                middle,
                size: 2.0 * half,
                most: step * exp2(52),
            });
        }
        lattice.origin = steps * step;
        Ok(lattice)
    }
}

/// An integer whose power of two is at most `x`, and not much less.
fn log2_below(x: f64) -> i32 {
    // The logarithm of 0, to which a tiny quotient is rounded, is minus infinity.
    libm::log2(x).floor().max(-1075.0) as i32 - 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::{Options, compile};
    use crate::scene::read;

    #[test]
    fn planes_through_one_point_keep_their_places() {
        for (place, bits) in [(0.3, 10), (0.3, 24), (-1e3, 16), (1e9, 12), (1e-9, 16)] {
            let file =
                format!("[[object]]\nkind = 'plane'\npoint = [0, {place}, 0]\nnormal = [0, 1, 0]");
            let imported = read("ground.toml".as_ref(), file.into(), &Default::default());
            let options = Options {
                lattice_bits: bits,
                ..Options::default()
            };
            let report = compile(&imported.unwrap().scene, &options).unwrap().report;
            let most = f64::max(1.0, f64::abs(place)) * exp2(1 - i32::from(bits));
            assert!(report.largest_displacement <= most, "{place} {bits}");
        }
    }

    #[test]
    fn extents_of_every_size_have_a_lattice_or_an_error() {
        for size in [1e-323, 1e-320, 1e-310, 1e-300, 1e300, f64::MAX] {
            let found = Lattice::around([DVec3::ZERO, DVec3::splat(size)], 16, 0);
            assert!(
                matches!(found, Err(CompileError::Extent { .. })),
                "{size:e}"
            );
        }
        for size in [0.0, 1e-250, 1.0, 1e250] {
            let found = Lattice::around([DVec3::ZERO, DVec3::splat(size)], 16, 0);
            assert!(found.is_ok(), "{size:e}");
        }
    }
}
