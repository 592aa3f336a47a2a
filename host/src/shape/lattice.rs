//! The lattice of one scene: from scene units to integers.

use glam::DVec3;

/// Snaps coordinates. The step is a power of two and the origin a multiple of it. So a coordinate
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

    /// Converts a point to units of the core, not snapped.
    pub fn in_units(&self, point: DVec3) -> DVec3 {
        (point - self.origin) / self.unit()
    }

    /// Converts a point to 1/256 unit, not snapped.
    pub fn in_fine(&self, point: DVec3) -> DVec3 {
        self.in_units(point) * 256.0
    }

    /// Converts a length to 1/256 unit, not snapped.
    pub fn length_in_fine(&self, length: f64) -> f64 {
        length / self.unit() * 256.0
    }

    /// Converts a point to 1/256 unit, snapped.
    pub fn snap(&self, point: DVec3) -> [i32; 3] {
        let steps = ((point - self.origin) / self.step()).round() * self.fine_steps();
        steps.to_array().map(|x| x as i32)
    }

    /// Converts a length to 1/256 unit, snapped.
    pub fn snap_length(&self, length: f64) -> i32 {
        ((length / self.step()).round() * self.fine_steps()) as i32
    }
}

pub(crate) fn exp2(exponent: i32) -> f64 {
    f64::powi(2.0, exponent)
}
