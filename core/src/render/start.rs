//! The ray with which a sample begins. A type, and no function of the caller's, so that all callers share the ray loop.

use crate::accel::{Accel, Number};
use crate::ray::Ray;
use crate::render::Renderer;
use crate::render::sample::place;
use core::hint::black_box;

/// The ray with which a sample begins.
pub(super) enum Start<'r, 's, 'a, N: Number, A: Accel, const EFFECTS: u32> {
    /// That of the camera for a sample of a pixel, by its number.
    Camera(&'r Renderer<'s, 'a, N, A, EFFECTS>, [u16; 2], u16),
    /// One of the caller's own.
    Own(&'r Ray<N>),
}

impl<N: Number, A: Accel, const EFFECTS: u32> Start<'_, '_, '_, N, A, EFFECTS> {
    #[inline(always)]
    pub(super) fn ray(self) -> Option<Ray<N>> {
        match self {
            Self::Camera(renderer, pixel, sample) => {
                let [x, y] = place(pixel, sample, renderer.settings().samples);
                // Moved out of the loops around this, its fields would go to the stack and come back.
                black_box(renderer).ray_through(x, y).ok()
            }
            Self::Own(ray) => Some(*ray),
        }
    }
}
