//! The samples of one pixel, ray by ray.

use crate::accel::{Accel, Number};
use crate::observe::count::Observer;
use crate::observe::event::Event;
use crate::render::encoding::Linear;
use crate::render::sample_pattern::place;
use crate::render::start::Start;
use crate::render::{Renderer, WorkspaceView};
use crate::shade::Color;
use crate::shade::sampler::Sampler;

/// A pixel that is being rendered: the number of its sample, and its radiance so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Samples<N: Number> {
    index: u16,
    /// The sum of the samples before this one.
    sum: Color<N>,
    /// The radiance of this sample so far.
    radiance: Color<N>,
}

impl<N: Number> Samples<N> {
    pub(super) fn new() -> Self {
        Self {
            index: 0,
            sum: Color::BLACK,
            radiance: Color::BLACK,
        }
    }

    /// Returns a pixel, linear. `renderer_of` is the renderer of a sample, counted from 0.
    #[inline(always)]
    pub(super) fn trace<'r, 's: 'r, 'a: 's, A: Accel + 'r, C: Observer, const EFFECTS: u32>(
        pixel: [u16; 2],
        renderer_of: impl Fn(u16) -> &'r Renderer<'s, 'a, N, A, EFFECTS>,
        space: &mut WorkspaceView<'_, N>,
        count: &mut C,
    ) -> Linear
    where
        N: 'r,
    {
        space.work.clear();
        let mut samples = Self::new();
        loop {
            let renderer = renderer_of(samples.index);
            if let Some(linear) = samples.step(renderer, pixel, space, count) {
                return linear;
            }
        }
    }

    /// Traces one ray. Returns the pixel, linear, if that was its last ray. The work list holds rays of the pixel's
    /// current sample, and is empty when a sample begins.
    #[inline(always)]
    pub(super) fn step<A: Accel, C: Observer, const EFFECTS: u32>(
        &mut self,
        renderer: &Renderer<'_, '_, N, A, EFFECTS>,
        [x, y]: [u16; 2],
        space: &mut WorkspaceView<'_, N>,
        count: &mut C,
    ) -> Option<Linear> {
        let samples = renderer.settings().samples;
        let start = Start::Camera(renderer.rays(), [x, y], [self.index, samples]);
        let radiance = &mut self.radiance;
        let ray_loop = renderer.ray_loop();
        let sampler = Sampler::new([x, y], self.index);
        if !ray_loop.step::<N, A, C, EFFECTS>(sampler, start, radiance, space, count) {
            return None;
        }
        let headroom = ray_loop.headroom::<EFFECTS>();
        // Limited before they are averaged, so that the edge of a highlight is smooth.
        let seen = headroom.limit(self.radiance);
        let (full, shift) = headroom.room_for_samples();
        let part = if samples > full {
            seen.scaled(N::ratio(1 << (30 - shift)))
        } else {
            seen
        };
        self.sum = self.sum.plus_displayable(part);
        if C::ENABLED {
            count.event(Event::SampleFinished {
                at: Some(place([x, y], self.index, samples)),
                radiance: seen.to_f64(),
            });
        }
        self.radiance = Color::BLACK;
        self.index = self.index.saturating_add(1);
        if self.index < samples {
            return None;
        }
        let mean = if samples == 1 {
            self.sum
        } else {
            // `Renderer::with_settings` rejects 0 samples.
            let one = (1 << 30) / i32::from(samples.max(1));
            let part = if samples > full { one << shift } else { one };
            self.sum.scaled(N::ratio(part))
        };
        let shown = ray_loop.developed::<N, A, C, EFFECTS>(mean, space, count);
        Some(renderer.to_linear(shown))
    }
}
