//! The ray with which a sample begins. It is a type and not a function of the caller's, so that all callers share the
//! ray loop.

use crate::accel::Number;
use crate::ray::Ray;
use crate::render::pixel_rays::PixelRays;
use crate::render::sample_pattern::place;
use core::hint::black_box;

/// The ray with which a sample begins.
pub(super) enum Start<'r, N: Number> {
    /// The camera's ray for a sample of a pixel: the number of the sample, and the number of samples.
    Camera(&'r PixelRays<N>, [u16; 2], [u16; 2]),
    /// A ray of the caller's own.
    Own(&'r Ray<N>),
}

impl<N: Number> Start<'_, N> {
    #[inline(always)]
    pub(super) fn ray(self) -> Option<Ray<N>> {
        match self {
            Self::Camera(rays, pixel, [sample, samples]) => {
                let [x, y] = place(pixel, sample, samples);
                // If this moved out of the loops around it, its fields would be stored to the stack and loaded again.
                let rays = black_box(rays);
                rays.ray(&rays.row(y), x).ok()
            }
            Self::Own(ray) => Some(*ray),
        }
    }
}
