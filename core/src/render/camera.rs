//! The pinhole camera, set up for pictures of one size.

use super::sample::SUBPIXELS;
use crate::blob::record::{UnitBox, View};
use crate::number::Number;
use crate::ray::{Pencil, Ray, RayError};

/// Makes directions for the pixels of a picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Camera<N: Number> {
    eye: Pencil<N>,
    forward: [N::Wide; 3],
    /// What half a subpixel to the right adds.
    right: [N::Wide; 3],
    /// What half a subpixel upwards adds.
    up: [N::Wide; 3],
    width: i32,
    height: i32,
}

/// A row of a picture: the direction to its middle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row<N: Number>([N::Wide; 3]);

impl<N: Number> Camera<N> {
    pub(crate) fn new(bounds: &UnitBox, view: &View, width: u16, height: u16) -> Self {
        // Bits below the camera's own, so that a step a subpixel is exact enough.
        let fine = |q: i32| N::far(i64::from(q) << 24);
        let step = |q: i32| N::wide_over(fine(q), SUBPIXELS * i32::from(height));
        Self {
            eye: Pencil::endless(bounds, view.eye.map(N::far)),
            forward: view.forward.map(fine),
            right: view.right.map(step),
            up: view.up.map(step),
            width: width.into(),
            height: height.into(),
        }
    }

    /// The row that lies `y` subpixels below the upper edge.
    #[inline(always)]
    pub(crate) fn row(&self, y: i32) -> Row<N> {
        let rise = SUBPIXELS * self.height - 2 * y;
        let axis = |k: usize| self.forward[k] + N::wide_times(self.up[k], rise);
        Row([axis(0), axis(1), axis(2)])
    }

    /// The ray to the point of a row that lies `x` subpixels from the left edge.
    #[inline(always)]
    pub(crate) fn ray(&self, row: &Row<N>, x: i32) -> Result<Ray<N>, RayError> {
        let shift = 2 * x - SUBPIXELS * self.width;
        let axis = |k: usize| row.0[k] + N::wide_times(self.right[k], shift);
        self.eye.ray([axis(0), axis(1), axis(2)])
    }
}
