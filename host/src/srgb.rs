//! The curve of sRGB (IEC 61966-2-1), with the powers of `libm`: those of the standard library differ from one machine
//! to another.

/// Returns the linear value of a channel in sRGB, 0 to 1. The curve goes on above 1.
///
/// ```
/// assert!((gridel_host::srgb::linear_of_srgb(0.5) - 0.21404).abs() < 1e-5);
/// ```
pub fn linear_of_srgb(encoded: f64) -> f64 {
    if encoded <= 0.04045 {
        encoded / 12.92
    } else {
        libm::pow((encoded + 0.055) / 1.055, 2.4)
    }
}

/// Returns the channel in sRGB of a linear value, 0 to 1.
///
/// ```
/// assert!((gridel_host::srgb::srgb_of_linear(0.21404) - 0.5).abs() < 1e-5);
/// ```
pub fn srgb_of_linear(linear: f64) -> f64 {
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055
    }
}
