//! A picture with its time, its rays and its tests.

use crate::render::{Job, Picture, render};
use gridel_core::render::RenderError;
use gridel_core::{Format, Scene, Settings, Structure};
use std::time::Instant;

/// A picture, and its cost.
pub struct Rendered {
    pub picture: Picture,
    /// Seconds of rendering alone, on the threads of the pool that it was called in.
    pub seconds: f64,
}

impl Rendered {
    /// Renders a whole picture; counts its rays and tests if `count`.
    ///
    /// # Errors
    /// If the settings are out of their range, or the scene does not hold the structure.
    pub fn new(
        scene: &Scene<'_>,
        (structure, format): (Structure, Format),
        settings: Settings,
        count: bool,
    ) -> Result<Self, RenderError> {
        let job = Job {
            count,
            ..Job::whole(format, structure, settings)
        };
        let begun = Instant::now();
        let picture = render(scene, &job, &|| ())?;
        let seconds = begun.elapsed().as_secs_f64();
        Ok(Self { picture, seconds })
    }

    /// Rays of all kinds; 0 if they were not counted.
    pub fn rays(&self) -> u64 {
        self.picture.counters.unwrap_or_default().rays()
    }

    /// Returns the [tests](gridel_core::Counters::tests) of all rays; 0 if they were not counted.
    pub fn tests(&self) -> u64 {
        self.picture.counters.unwrap_or_default().tests()
    }

    /// Tests per ray.
    pub fn tests_per_ray(&self) -> f64 {
        self.tests() as f64 / self.rays().max(1) as f64
    }
}
