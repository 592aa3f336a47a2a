//! Three channels of radiance, or of ratios that weigh it.

use crate::accel::Number;
use crate::target::inline_unless_small;

/// Red, green and blue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Color<N>(pub(crate) [N; 3]);

impl<N: Number> Color<N> {
    pub(crate) const BLACK: Self = Self([N::ZERO; 3]);
    pub(crate) const WHITE: Self = Self([N::ONE; 3]);

    /// Ratios with 30 fraction bits.
    #[inline(always)]
    pub(crate) fn ratios(q30: [i32; 3]) -> Self {
        Self(q30.map(N::ratio))
    }

    /// Radiance with 20 fraction bits.
    #[inline(always)]
    pub(crate) fn radiance(q20: [i32; 3]) -> Self {
        Self(q20.map(N::radiance))
    }

    #[inline(always)]
    fn zip(self, other: Self, join: impl Fn(N, N) -> N) -> Self {
        let ([a, b, c], [d, e, f]) = (self.0, other.0);
        Self([join(a, d), join(b, e), join(c, f)])
    }

    inline_unless_small!(
        /// Channel by channel; one of the two holds ratios.
        pub(crate) fn times(self, ratios: Self) -> Self {
            self.zip(ratios, |a, b| a * b)
        }
    );

    inline_unless_small!(
        /// All channels by one ratio.
        pub(crate) fn scaled(self, ratio: N) -> Self {
            Self(self.0.map(|channel| channel * ratio))
        }
    );

    /// The sum of two radiances.
    #[inline(always)]
    pub(crate) fn plus(self, other: Self) -> Self {
        self.zip(other, N::radiance_sum)
    }

    /// The sum of displayable radiances, of which there are no more than samples in a pixel.
    #[inline(always)]
    pub(crate) fn plus_displayable(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }

    /// The sum of two sets of ratios, none above 1.
    #[inline(always)]
    pub(crate) fn plus_up_to_one(self, other: Self) -> Self {
        self.zip(other, |a, b| if a > N::ONE - b { N::ONE } else { a + b })
    }

    /// Radiance of which no channel is below 0 or above a limit, given with 20 fraction bits.
    #[inline(always)]
    pub(crate) fn limited(self, most: i32) -> Self {
        let most = N::radiance(most);
        Self(self.0.map(|channel| channel.max(N::ZERO).min(most)))
    }

    /// Radiance, as events report it.
    pub(crate) fn to_f64(self) -> [f64; 3] {
        self.0.map(N::radiance_to_f64)
    }

    /// Ratios, as events report them.
    pub(crate) fn ratios_to_f64(self) -> [f64; 3] {
        self.0.map(N::ratio_to_f64)
    }

    /// The largest channel.
    #[inline(always)]
    pub(crate) fn peak(self) -> N {
        let [red, green, blue] = self.0;
        red.max(green).max(blue)
    }
}
