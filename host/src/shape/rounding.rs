//! The steps by which number formats round.

use gridel_core::Format;

/// Returns the step of a format. For `fixed` it is a sub-step. For the others it is the unit of rounding times the
/// largest magnitude among the coordinates of ray, hit and shape.
pub fn step(format: Format, magnitude: f64) -> f64 {
    match format {
        Format::Fixed => f64::powi(2.0, -13),
        Format::F32 => f64::powi(2.0, -24) * magnitude,
        Format::F64 => f64::powi(2.0, -53) * magnitude,
    }
}
