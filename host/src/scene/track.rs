//! Tracks: how the camera, lights and materials of a scene change with time.

use super::source_span::SourceSpan;
use glam::DVec3;
pub use gridel_core::format::track::{Interpolation, TrackTarget};

/// The values of one property at some times.
///
/// Positions are in scene units, angles in degrees. The direction of a light is the way the light travels.
#[derive(Clone, Debug, PartialEq)]
pub struct Track {
    pub target: TrackTarget,
    /// The number of the light or material; 0 for the camera.
    pub index: usize,
    pub interpolation: Interpolation,
    /// At least one, by rising times.
    pub keys: Vec<Key>,
    /// Where the scene file says so, for messages.
    pub place: SourceSpan,
}

/// A value at a time. Of values with fewer than four components the others are 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Key {
    pub seconds: f64,
    pub value: [f64; 4],
    /// For splines: the change per second with which the value is reached.
    pub entering: [f64; 4],
    /// For splines: the change per second with which it is left.
    pub leaving: [f64; 4],
}

impl Key {
    /// A key of a vector, without tangents.
    pub fn of_vector(seconds: f64, vector: DVec3) -> Self {
        let [x, y, z] = vector.to_array();
        Self {
            seconds,
            value: [x, y, z, 0.0],
            ..Self::default()
        }
    }

    /// The first three components of the value.
    pub fn vector(&self) -> DVec3 {
        let [x, y, z, _] = self.value;
        DVec3::new(x, y, z)
    }
}
