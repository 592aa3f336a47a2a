//! Rays and answers as the kernels of a format have them: rounded, and so exact numbers.

use crate::shape::Solid;
use crate::shape::exact::Line;
use crate::shape::rounding::step;
use gridel_core::{Format, Kind, Number, Ray, Scene};

/// A ray as the kernels of a format have it, rounded; every number is exact.
#[derive(Clone, Copy, Debug)]
pub struct RoundedRay {
    pub start: [f64; 3],
    pub slope: [f64; 3],
    /// The interval that counts, from `start`.
    pub interval: [f64; 2],
    /// The interval that counts for shapes without bounds.
    pub far_interval: [f64; 2],
    /// The t of `start` as hits count it.
    pub moved: f64,
}

impl RoundedRay {
    pub fn of<N: Number>(ray: &Ray<N>) -> Self {
        let (start, moved) = ray.reference_point();
        let moved = N::far_to_f64(moved);
        Self {
            start: start.map(N::far_to_f64),
            slope: ray.slope().map(N::ratio_to_f64),
            interval: ray.interval().map(N::length_to_f64),
            far_interval: ray.given_interval().map(|t| N::far_to_f64(t) - moved),
            moved,
        }
    }

    /// Returns the ray in double precision.
    pub fn in_f64(&self, scene: &Scene<'_>) -> Option<Ray<f64>> {
        let mut kinds = Kind::ALL.into_iter();
        let bounded = kinds.all(|kind| kind.is_bounded() || scene.count(kind) == 0);
        let [first, last] = self.interval_of(bounded);
        Ray::from_f64(scene.bounds(), self.start, self.slope, first, last).ok()
    }

    /// Returns the interval that counts, from `start`, for shapes with bounds or without.
    pub fn interval_of(&self, bounded: bool) -> [f64; 2] {
        if bounded {
            self.interval
        } else {
            self.far_interval
        }
    }

    /// Returns the cosine of the angle between the ray and a vector of length 1.
    pub fn cosine(&self, unit: [f64; 3]) -> f64 {
        let dot = |v: [f64; 3]| (0..3).map(|k| self.slope[k] * v[k]).sum::<f64>();
        dot(unit) / dot(self.slope).sqrt()
    }

    pub(super) fn line(&self) -> Line {
        Line::new(self.start, self.slope)
    }

    /// Returns the largest magnitude among the coordinates of a ray up to a t.
    pub fn magnitude(&self, t: f64) -> f64 {
        largest(self.start).max(t.abs()).max(self.moved.abs())
    }

    /// Returns the step of a format at a shape. A ray that begins far away may hit a shape without bounds nearer to its
    /// origin than to its start. Slopes are rounded on the path between the two.
    pub fn step(&self, format: Format, t: f64, solid: &Solid) -> f64 {
        let near = step(format, self.magnitude(t).max(solid.extent()));
        let from_origin = (t + self.moved).abs() < t.abs();
        if solid.is_bounded() || format != Format::Fixed || !from_origin {
            return near;
        }
        near.max(f64::powi(2.0, -30) * self.moved.abs())
    }
}

fn largest(v: [f64; 3]) -> f64 {
    v.iter().fold(0.0, |most, x| most.max(x.abs()))
}

/// The primitive of a hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HitId {
    /// In scene-file order.
    pub primitive: u32,
    /// The place of its instance among those of the blob.
    pub instance: Option<u32>,
}

/// An answer of a kernel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// The t of the hit from the ray's start.
    pub t: f64,
    pub hit: HitId,
}
