//! The ray with which a sample begins. A type, and no function of the caller's, so that all callers share the ray loop.

use crate::accel::Number;
use crate::ray::Ray;
use crate::render::pixel_rays::PixelRays;
use crate::render::sample::place;
use core::hint::black_box;

/// The ray with which a sample begins.
pub(super) enum Start<'r, N: Number> {
    /// That of the camera for a sample of a pixel: the number of the sample, and of how many.
    Camera(&'r PixelRays<N>, [u16; 2], [u16; 2]),
    /// One of the caller's own.
    Own(&'r Ray<N>),
}

impl<N: Number> Start<'_, N> {
    #[inline(always)]
    pub(super) fn ray(self) -> Option<Ray<N>> {
        match self {
            Self::Camera(rays, pixel, [sample, samples]) => {
                let [x, y] = place(pixel, sample, samples);
                // Moved out of the loops around this, its fields would go to the stack and come back.
                let rays = black_box(rays);
                rays.ray(&rays.row(y), x).ok()
            }
            Self::Own(ray) => Some(*ray),
        }
    }
}
