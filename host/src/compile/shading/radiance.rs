//! Colors of light in a blob.

use crate::scene::Color;

/// Converts a color of light to that of a blob's records: 20 fraction bits, 0 to 2,047.999999; saturates.
///
/// ```
/// assert_eq!(gridel_host::compile::radiance([1.0, 0.5, 0.0]), [1 << 20, 1 << 19, 0]);
/// assert_eq!(gridel_host::compile::radiance([1e9; 3]), [i32::MAX; 3]);
/// ```
pub fn radiance(color: Color) -> [i32; 3] {
    color.map(|channel| (channel * f64::from(1 << 20)).round().max(0.0) as i32)
}
