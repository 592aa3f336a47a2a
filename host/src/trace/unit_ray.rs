//! Rays in the core's units.

use gridel_core::{Number, Ray, Scene};

/// A ray in the core's units, not yet in a number format.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitRay {
    pub origin: [f64; 3],
    pub direction: [f64; 3],
    pub tmin: f64,
    pub tmax: f64,
}

impl UnitRay {
    /// Returns a ray with tmin 0 and without an end.
    pub fn new(origin: [f64; 3], direction: [f64; 3]) -> Self {
        Self {
            origin,
            direction,
            tmin: 0.0,
            tmax: f64::INFINITY,
        }
    }

    /// Returns the ray in the core's form; `None` if it is invalid.
    pub fn ready<N: Number>(&self, scene: &Scene<'_>) -> Option<Ray<N>> {
        let Self {
            origin,
            direction,
            tmin,
            tmax,
        } = *self;
        Ray::from_f64(scene.bounds(), origin, direction, tmin, tmax).ok()
    }
}
