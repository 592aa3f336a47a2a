//! The lattice of one scene: from scene units to integers, and what that displaces.

use super::CompileError;
use glam::DVec3;

/// Fewest and most bits that a coordinate can be snapped to.
pub const BITS: std::ops::RangeInclusive<u8> = 10..=24;

/// Snaps coordinates. The step is a power of two and the origin a multiple of it, so a coordinate
/// that already lies on the lattice is kept bit for bit.
#[derive(Clone, Copy, Debug)]
pub struct Lattice {
    /// Bits of a coordinate.
    pub bits: u8,
    /// One unit of the core is 2 to this power scene units.
    pub unit_exponent: i16,
    /// Scene coordinates of the lattice's zero.
    pub origin: DVec3,
}

impl Lattice {
    /// The finest lattice of a number of bits that holds the box from `lowest` to `highest`, or one
    /// so many powers of two coarser.
    pub fn around(
        [lowest, highest]: [DVec3; 2],
        bits: u8,
        coarser: i32,
    ) -> Result<Self, CompileError> {
        let half = ((highest - lowest) * 0.5).max_element();
        if !half.is_finite() {
            return Err(CompileError::Extent { size: 2.0 * half });
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
        let middle = (lowest + highest) * 0.5;
        let steps = (middle / step).round();
        if steps.abs().max_element() > exp2(52) {
            return Err(CompileError::TooFar {
                middle,
                size: 2.0 * half,
            });
        }
        lattice.origin = steps * step;
        Ok(lattice)
    }

    /// Scene units of one unit of the core.
    pub fn unit(&self) -> f64 {
        exp2(self.unit_exponent.into())
    }

    /// Scene units of one step.
    pub fn step(&self) -> f64 {
        self.unit() * exp2(16 - i32::from(self.bits))
    }

    /// 1/256 units of one step.
    pub fn fine_steps(&self) -> f64 {
        exp2(24 - i32::from(self.bits))
    }

    /// A point in units of the core, not snapped.
    pub fn in_units(&self, point: DVec3) -> DVec3 {
        (point - self.origin) / self.unit()
    }

    /// A point in 1/256 unit, not snapped.
    pub fn in_fine(&self, point: DVec3) -> DVec3 {
        self.in_units(point) * 256.0
    }

    /// A length in 1/256 unit, not snapped.
    pub fn length_in_fine(&self, length: f64) -> f64 {
        length / self.unit() * 256.0
    }

    /// A point in 1/256 unit, snapped.
    pub fn snap(&self, point: DVec3) -> [i32; 3] {
        let steps = ((point - self.origin) / self.step()).round() * self.fine_steps();
        steps.to_array().map(|x| x as i32)
    }

    /// A length in 1/256 unit, snapped.
    pub fn snap_length(&self, length: f64) -> i32 {
        ((length / self.step()).round() * self.fine_steps()) as i32
    }
}

fn exp2(exponent: i32) -> f64 {
    f64::powi(2.0, exponent)
}

/// An integer whose power of two is at most `x`, and not much less.
fn log2_below(x: f64) -> i32 {
    x.log2().floor() as i32 - 1
}
