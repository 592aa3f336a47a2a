//! Conversion of multiples of a direction to lengths in the core, and back.

use super::Rejection;
use glam::DVec3;

/// The largest component of a direction in units. `t` is larger in the core by this factor. It is a factor and a power
/// of two, because units and directions can have any magnitude that numbers have.
#[derive(Clone, Copy, Debug)]
pub struct DirectionScale {
    factor: f64,
    exponent: i32,
    /// The length at which the core's ray counts 0.
    begin: f64,
}

impl DirectionScale {
    /// Powers of two up to which no product with a length leaves the range of numbers.
    pub(super) const ORDINARY: std::ops::Range<f64> =
        1.0 / (1_u128 << 100) as f64..(1_u128 << 100) as f64;

    /// Returns the scale of a direction, and the direction with its length brought near 1 where it is extreme.
    pub(super) fn of(direction: DVec3, unit: f64, per_unit: f64) -> (Self, DVec3) {
        Self::of_ordinary(direction, per_unit).map_or_else(
            || Self::of_extremes(direction, unit),
            |direction_scale| (direction_scale, direction),
        )
    }

    /// Returns the scale of a direction that is not extreme.
    #[inline(always)]
    pub(super) fn of_ordinary(direction: DVec3, per_unit: f64) -> Option<Self> {
        let largest = direction.abs().max_element();
        let factor = largest * per_unit;
        let is_ordinary = Self::ORDINARY.contains(&factor) && Self::ORDINARY.contains(&largest);
        is_ordinary.then_some(Self::of_factor(factor))
    }

    /// The scale of a direction that is not extreme, by its largest component in units.
    #[inline(always)]
    pub(super) fn of_factor(factor: f64) -> Self {
        Self {
            factor,
            exponent: 0,
            begin: 0.0,
        }
    }

    #[cold]
    #[inline(never)]
    fn of_extremes(direction: DVec3, unit: f64) -> (Self, DVec3) {
        let (factor, exponent) = libm::frexp(direction.abs().max_element());
        let (_, one) = libm::frexp(unit);
        // A unit is a power of two, which is half of two to its exponent.
        let direction_scale = Self {
            factor,
            exponent: exponent - (one - 1),
            begin: 0.0,
        };
        let scaled = direction
            .to_array()
            .map(|component| libm::scalbn(component, -exponent));
        (direction_scale, DVec3::from_array(scaled))
    }

    /// The length at which the core's ray counts 0.
    pub(crate) fn begin(&self) -> f64 {
        self.begin
    }

    /// Sets the length along the ray from which lengths of hits count.
    pub(super) fn begin_at(&mut self, begin: f64) {
        self.begin = begin;
    }

    /// Moves the start from which multiples of hits count by `t`, in multiples of the direction.
    pub fn count_from(&mut self, t: f64) {
        self.begin += self.length(t);
    }

    /// A length in units along the largest component, from multiples of the direction; infinite beyond all
    /// numbers.
    #[inline(always)]
    pub(super) fn length(&self, t: f64) -> f64 {
        if t == 0.0 {
            0.0
        } else if self.exponent == 0 {
            t * self.factor
        } else {
            libm::scalbn(t * self.factor, self.exponent)
        }
    }

    /// The nearest multiple of the direction to a length in units; infinite beyond all numbers.
    pub(super) fn nearest(&self, length: f64) -> f64 {
        libm::scalbn(length / self.factor, -self.exponent)
    }

    /// Multiples of the direction, from a length in units that is known within `error`.
    ///
    /// # Errors
    /// If there is no such number, or the nearest is farther away than that.
    #[inline(always)]
    pub fn multiple(&self, length: f64, error: impl Fn() -> f64) -> Result<f64, Rejection> {
        if self.exponent == 0 {
            Ok(self.ordinary_multiple(length))
        } else {
            self.extreme_multiple(length, error())
        }
    }

    /// Multiples of a direction that is not extreme.
    #[inline(always)]
    pub(super) fn ordinary_multiple(&self, length: f64) -> f64 {
        (length + self.begin) / self.factor
    }

    #[cold]
    #[inline(never)]
    fn extreme_multiple(&self, length: f64, error: f64) -> Result<f64, Rejection> {
        let t = self.nearest(length + self.begin);
        if t.is_infinite() {
            return Err(Rejection::TooShort);
        }
        // Denormal numbers are rounded to multiples of 2^-1074.
        let rounding = libm::scalbn(self.factor, self.exponent.saturating_sub(1075));
        if t.abs() < f64::MIN_POSITIVE && length != 0.0 && rounding > error {
            return Err(Rejection::TooLong);
        }
        Ok(t)
    }
}
