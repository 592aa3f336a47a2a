//! The spread of the rays of neighboring samples.

use crate::format::record::View;
use crate::number::log2::{log2, log2_of_length, log2_of_power};
use crate::target::TextureLevelsOnly;

/// The value of [`Tracer::spread`](crate::shade::effect::Tracer::spread), in builds with effects that need it.
pub(super) type Spread = TextureLevelsOnly<Option<i32>>;

/// The spread of a camera: the distance of pixels in the middle of the picture, over the square root of the samples of
/// a pixel.
pub(super) fn spread(view: &View, height: u16, samples: u16) -> Spread {
    TextureLevelsOnly::new(|| {
        let [up, forward] = [view.up, view.forward].map(|it| log2_of_length(it.map(i64::from)));
        // The vector up covers half of the height.
        let pixel = up
            .wrapping_add(log2_of_power(1))
            .wrapping_sub(forward)
            .wrapping_sub(log2(height.into()));
        Some(pixel.wrapping_sub(log2(samples.into()) >> 1))
    })
}

/// The spread of rays of the caller's own.
pub(super) fn no_spread() -> Spread {
    TextureLevelsOnly::new(|| None)
}
