//! The rays of a pinhole camera through the pixels of pictures of one size.
//!
//! In `fixed`, directions have 62 bits while they are added up, and 30 when their slopes are computed. So in square
//! pictures of up to 90 degrees a slope is off by less than 2^-26. In wider ones the error is larger, but below a
//! thousandth of the distance of two pixels. A direction to a pixel farther outside of the picture needs more bits than
//! that, and is added up with fewer fraction bits.

use crate::accel::Number;
use crate::axis::pick;
use crate::format::record::{UnitBox, View};
use crate::number::Format;
use crate::ray::{Pencil, Ray, RayError};
use crate::render::sample_pattern::SUBPIXELS;

/// Returns true if a format distinguishes the directions of neighboring pixels, each to an eighth of their distance or
/// better. It does not for a lens so long that only a very distant eye needs it. The picture would then show other
/// directions than the requested ones.
pub(crate) fn resolves<N: Number>(view: &View, height: u16) -> bool {
    // Components of directions have 24 bits in `f32`, and 30 or those of the blob's vectors elsewhere.
    let bits = if N::FORMAT == Format::F32 { 21 } else { 26 };
    let largest = |[x, y, z]: [i32; 3]| {
        let [x, y, z] = [x, y, z].map(i32::unsigned_abs);
        u64::from(x.max(y).max(z))
    };
    // The vector up covers half of the height. All are below 2^56.
    largest(view.up) << (bits + 1) >= largest(view.forward) * u64::from(height)
}

/// Computes the directions of the pixels of a picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PixelRays<N: Number> {
    eye: Pencil<N>,
    forward: [N::Wide; 3],
    /// The change over half a subpixel to the right.
    right: [N::Wide; 3],
    /// The change over half a subpixel upwards.
    up: [N::Wide; 3],
    /// The picture's width in subpixels.
    width: i32,
    height: i32,
}

/// A row of a picture: the direction to its middle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row<N: Number>([N::Wide; 3]);

impl<N: Number> PixelRays<N> {
    pub(crate) fn new(bounds: &UnitBox, view: &View, width: u16, height: u16) -> Self {
        // The largest component of any pixel's direction gets 62 bits, of which its ray uses the upper half.
        let aspect = width.div_ceil(height.max(1));
        let reach = |k: usize| {
            let size = |v: [i32; 3]| u64::from(pick(v, k).unsigned_abs());
            let right = size(view.right) * u64::from(aspect);
            right
                .wrapping_add(size(view.forward))
                .wrapping_add(size(view.up))
        };
        let largest = reach(0) | reach(1) | reach(2);
        let up = largest.leading_zeros().saturating_sub(2);
        let fine = |q: i32| N::far(i64::from(q).wrapping_shl(up));
        let step = |q: i32| N::wide_over(fine(q), SUBPIXELS * i32::from(height));
        Self {
            eye: Pencil::of(bounds, view.eye.map(N::far)),
            forward: view.forward.map(fine),
            right: view.right.map(step),
            up: view.up.map(step),
            width: SUBPIXELS * i32::from(width),
            height: SUBPIXELS * i32::from(height),
        }
    }

    /// The row that lies `y` subpixels below the upper edge.
    #[inline(always)]
    pub(crate) fn row(&self, y: i32) -> Row<N> {
        let rise = self.height.wrapping_sub(y.wrapping_mul(2));
        let axis = |k: usize| self.forward[k] + N::wide_times(self.up[k], rise);
        Row([axis(0), axis(1), axis(2)])
    }

    /// The ray to the point of a row that lies `x` subpixels from the left edge.
    #[inline(always)]
    pub(crate) fn ray(&self, row: &Row<N>, x: i32) -> Result<Ray<N>, RayError> {
        let shift = x.wrapping_mul(2).wrapping_sub(self.width);
        let axis = |k: usize| N::upper(row.0[k] + N::wide_times(self.right[k], shift));
        let slopes = N::slopes_of([axis(0), axis(1), axis(2)]);
        let (slope, major) = slopes.ok_or(RayError::Direction)?;
        Ok(self.eye.ray_along(slope, major))
    }

    /// The ray to a point so many subpixels, at most 2^24, to the right of the picture's upper left corner and below: on
    /// any side of the picture.
    pub(crate) fn ray_anywhere(&self, [x, y]: [i32; 2]) -> Result<Ray<N>, RayError> {
        let is_inside = (0..=self.width).contains(&x) && (0..=self.height).contains(&y);
        if is_inside || N::FORMAT != Format::Fixed {
            return self.ray(&self.row(y), x);
        }
        let rise = self.height.wrapping_sub(y.wrapping_mul(2));
        let shift = x.wrapping_mul(2).wrapping_sub(self.width);
        let ratio = |part: i32, whole: i32| {
            let ratio = part.unsigned_abs().checked_div(whole.unsigned_abs());
            ratio.unwrap_or(0)
        };
        let farther = ratio(shift, self.width).max(ratio(rise, self.height));
        // The point is less than this many halves of the picture away from its middle.
        let divisor = 2_i32.wrapping_shl(u32::BITS.wrapping_sub(farther.leading_zeros()));
        let axis = |k: usize| {
            let over = |wide: N::Wide| N::wide_over(wide, divisor);
            let row = over(self.forward[k]) + N::wide_times(over(self.up[k]), rise);
            row + N::wide_times(over(self.right[k]), shift)
        };
        let slopes = N::slopes([axis(0), axis(1), axis(2)]);
        let (slope, major) = slopes.ok_or(RayError::Direction)?;
        Ok(self.eye.ray_along(slope, major))
    }
}
