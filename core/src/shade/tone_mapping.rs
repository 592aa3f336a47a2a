//! Tone mapping: the mean of a pixel's samples is mapped to the range of a display.
//!
//! Each channel *x*, 1 being display white, becomes
//!
//! - **Reinhard**: x / (1 + x) (Reinhard, Stark, Shirley and Ferwerda, "Photographic Tone Reproduction for Digital
//!   Images", 2002);
//! - **ACES-like**: x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14), at most 1. The curve is near that of the Academy
//!   Color Encoding System (Narkowicz, "ACES Filmic Tone Mapping Curve", 2015).
//!
//! Both are computed from r = x / (1 + x), a ratio in every number format.

use crate::accel::Number;
use crate::format::Effects;
use crate::format::record::View;
use crate::shade::Color;
use crate::shade::effect::{Effect, Tracer};

pub(crate) struct ToneMapping;

impl Effect for ToneMapping {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects::TONE_MAPPING;
    const DEVELOPS: bool = true;

    fn is_required_by_view(view: &View) -> bool {
        view.encoding >= View::REINHARD
    }

    #[inline(always)]
    fn develop<'s, N: Number, X: Tracer<'s, N>>(tracer: &mut X, (): &mut (), mean: &mut Color<N>) {
        let encoding = tracer.scene().view().encoding;
        if encoding >= View::REINHARD {
            mean.0 = mean
                .0
                .map(|channel| mapped(channel, encoding == View::ACES));
        }
    }
}

/// A channel of radiance, mapped.
#[inline(never)]
fn mapped<N: Number>(channel: N, is_aces: bool) -> N {
    let white = N::radiance(1 << 20);
    let channel = channel.max(N::ZERO);
    let ratio = channel.div(channel + white);
    if !is_aces {
        return white * ratio;
    }
    // Both parts of the fraction times (1 - r)² / 2, which keeps them below 2; the constants have 30 fraction bits.
    let rest = N::ONE - ratio;
    let above = ratio * (N::ratio(1_331_439_862) * ratio + N::ratio(16_106_127));
    let below = ratio * (N::ratio(987_842_478) * ratio + N::ratio(316_753_838))
        + N::ratio(75_161_928) * rest * rest;
    white * above.div(below).min(N::ONE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Fixed;

    fn value<N: Number>(x: f64, is_aces: bool) -> f64 {
        mapped(N::radiance((x * 1_048_576.0) as i32), is_aces).radiance_to_f64()
    }

    #[test]
    fn curves_have_the_values_of_their_formulas() {
        for x in [0.0_f64, 0.001, 0.18, 0.5, 1.0, 3.0, 8.0, 16.0] {
            let reinhard = x / (1.0 + x);
            let aces = (x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)).min(1.0);
            for (is_aces, exact) in [(false, reinhard), (true, aces)] {
                for found in [
                    value::<Fixed>(x, is_aces),
                    value::<f32>(x, is_aces),
                    value::<f64>(x, is_aces),
                ] {
                    assert!((found - exact).abs() < 2e-6, "{x}: {found}, exact {exact}");
                }
            }
        }
    }

    #[test]
    fn negative_radiance_is_black() {
        assert_eq!(value::<f32>(-1.0, false), 0.0);
        assert_eq!(value::<Fixed>(-1.0, true), 0.0);
    }
}
