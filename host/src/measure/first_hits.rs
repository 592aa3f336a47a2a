//! The part of a first hit that errors are measured by.

use crate::render::PixelHit;
use serde::{Deserialize, Serialize};

/// The first hit of the ray through the middle of a pixel.
///
/// Serialized as `[object, distance]`, and as `[object, distance, instance]` in an instance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "Fields", into = "Fields")]
pub struct FirstHit {
    pub object: u32,
    /// The number of the instance that the object is in, in the order of the scene file.
    pub instance: Option<u32>,
    /// In scene units.
    pub distance: f64,
}

#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Fields {
    Placed(u32, f64, u32),
    Own(u32, f64),
}

impl From<Fields> for FirstHit {
    fn from(fields: Fields) -> Self {
        let (object, distance, instance) = match fields {
            Fields::Placed(object, distance, instance) => (object, distance, Some(instance)),
            Fields::Own(object, distance) => (object, distance, None),
        };
        Self {
            object,
            instance,
            distance,
        }
    }
}

impl From<FirstHit> for Fields {
    fn from(hit: FirstHit) -> Self {
        match hit.instance {
            Some(instance) => Self::Placed(hit.object, hit.distance, instance),
            None => Self::Own(hit.object, hit.distance),
        }
    }
}

impl From<PixelHit> for FirstHit {
    fn from(hit: PixelHit) -> Self {
        Self {
            object: hit.object,
            instance: hit.instance,
            distance: hit.distance,
        }
    }
}

impl FirstHit {
    /// Returns whether both hit the same object, of the same instance.
    pub fn is_on(&self, other: &Self) -> bool {
        (self.object, self.instance) == (other.object, other.instance)
    }
}
