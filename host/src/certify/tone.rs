//! Conversion of the mean of samples to display values, in exact arithmetic.

use super::number::*;
use gridel_core::Effects;
use gridel_core::format::record::View;

/// The effects that let samples brighter than display white count.
const DEVELOPING: [Effects; 4] = [
    Effects::TONE_MAPPING,
    Effects::INDIRECT,
    Effects::ENVIRONMENT,
    Effects::GLOSSY,
];

/// Returns the most of a sample's radiance that counts, 1 being display white.
pub fn brightest(effects: Effects) -> i64 {
    if DEVELOPING.iter().any(|&it| effects.contains(it)) {
        16
    } else if effects.contains(Effects::AREA_LIGHT) {
        4
    } else {
        1
    }
}

/// Returns a channel of the mean of samples, as it is shown; `None` if it may be far below 0.
pub fn developed<N: Enclosure>(encoding: u8, channel: N) -> Option<N> {
    if encoding < View::REINHARD {
        return Some(channel);
    }
    let channel = channel.at_least(N::zero());
    let ratio = channel.div(channel + N::one())?;
    if encoding != View::ACES {
        return Some(ratio);
    }
    // The curve's two parts, times half the square of 1 - r.
    let rest = N::one() - ratio;
    let constant = ratio_of::<N>;
    let above = ratio * (constant(1_331_439_862) * ratio + constant(16_106_127));
    let below = ratio * (constant(987_842_478) * ratio + constant(316_753_838))
        + constant(75_161_928) * rest.square();
    Some(above.div(below)?.at_most(N::one()))
}
