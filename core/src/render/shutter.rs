//! Motion blur: the samples of a pixel are taken at several moments while a shutter is open.

use crate::accel::{Accel, Number};
use crate::observe::count::Observer;
use crate::render::pixel_samples::Samples;
use crate::render::{Pixel, RenderError, Renderer, Settings, WorkspaceView};

/// A picture of a scene that moves while a shutter is open. It has a renderer for each of some moments.
///
/// Each moment is exact, and has its own camera, lights, materials and poses. The samples of a pixel are spread over
/// the moments in order. Of `n` samples and `k` moments, sample `i` is rendered at moment `i * k / n`, rounded down.
/// If `k` does not divide `n`, some moments have one sample more than others, and count for more.
/// Such a run of samples fills the pixel evenly, and so do the random points of effects. (Every `k`-th sample would
/// not: the points of every second sample lie in one half of the pixel.) Colors are averaged as those of other samples
/// are.
///
/// With one moment, pixels have the bits of its renderer. Several moments cost a multiplication and a division per ray,
/// and the memory of their renderers and of the data that these borrow.
#[derive(Clone, Copy, Debug)]
pub struct Shutter<'r, 's, 'a, N: Number, A: Accel, const EFFECTS: u32> {
    first: &'r Renderer<'s, 'a, N, A, EFFECTS>,
    moments: &'r [Renderer<'s, 'a, N, A, EFFECTS>],
}

impl<'r, 's, 'a, N: Number, A: Accel, const EFFECTS: u32> Shutter<'r, 's, 'a, N, A, EFFECTS> {
    /// Returns a shutter that is open over the moments of some renderers, in the order of time.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::render::Shutter;
    /// use gridel_core::{DualSplit, Effects, NoCount, Renderer, Rgb888, Scene, Settings, Workspace};
    ///
    /// type Moment<'s, 'a> = Renderer<'s, 'a, f32, DualSplit, { Effects::ALL.0 }>;
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// // The camera moves to the right, in steps of 2^-13 unit.
    /// let (mut moved, mut ahead) = (*scene.view(), *scene.view());
    /// moved.eye[0] += 1 << 20;
    /// ahead.eye[0] += 1 << 21;
    /// let scenes = [scene, scene.with_view(&moved)?, scene.with_view(&ahead)?];
    ///
    /// let settings = Settings { samples: 6, ..Settings::of(&scene) };
    /// let moments = scenes.each_ref().map(|scene| Moment::with_settings(scene, settings));
    /// let [first, second, third] = moments;
    /// let renderers = [first?, second?, third?];
    /// let shutter = Shutter::new(&renderers)?;
    /// let mut space = Workspace::for_any_scene();
    /// let Rgb888(_) = shutter.pixel(20, 15, &mut space.as_view(), &mut NoCount);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If there is no moment, there are more moments than samples per pixel, or their settings differ.
    pub fn new(moments: &'r [Renderer<'s, 'a, N, A, EFFECTS>]) -> Result<Self, RenderError> {
        let first = moments.first().ok_or(RenderError::NoMoments)?;
        let settings = first.settings();
        if moments.iter().any(|it| it.settings() != settings) {
            return Err(RenderError::MomentSettings);
        }
        let (found, samples) = (moments.len(), settings.samples);
        if found > samples.into() {
            return Err(RenderError::Moments { found, samples });
        }
        Ok(Self { first, moments })
    }

    /// Returns the settings of the picture.
    pub fn settings(&self) -> Settings {
        self.first.settings()
    }

    /// Returns one pixel, linear, 65535 being white: see [`Renderer::linear`].
    pub fn linear<C: Observer>(
        &self,
        x: u16,
        y: u16,
        space: &mut WorkspaceView<'_, N>,
        count: &mut C,
    ) -> [u16; 3] {
        Samples::trace([x, y], |sample| self.moment(sample), space, count)
    }

    /// Returns one pixel in a display's form: see [`Renderer::pixel`].
    pub fn pixel<P: Pixel, C: Observer>(
        &self,
        x: u16,
        y: u16,
        space: &mut WorkspaceView<'_, N>,
        count: &mut C,
    ) -> P {
        let dither = self.settings().dither.then_some([x, y]);
        P::encode(self.linear(x, y, space, count), dither)
    }

    /// A part of a row, as many pixels as `row` has, from column `x` on: see [`Renderer::row`].
    pub fn row<P: Pixel, C: Observer>(
        &self,
        x: u16,
        y: u16,
        row: &mut [P],
        space: &mut WorkspaceView<'_, N>,
        count: &mut C,
    ) {
        for (column, pixel) in (x..=u16::MAX).zip(row) {
            *pixel = self.pixel(column, y, space, count);
        }
    }

    /// The renderer of a sample.
    #[inline(always)]
    fn moment(&self, sample: u16) -> &'r Renderer<'s, 'a, N, A, EFFECTS> {
        if let [only] = self.moments {
            return only;
        }
        // There are at most as many moments as samples, 4,096.
        let place = u32::from(sample).wrapping_mul(self.moments.len() as u32);
        let moment = place.checked_div(self.settings().samples.into());
        let moment = moment.and_then(|moment| self.moments.get(moment as usize));
        moment.unwrap_or(self.first)
    }
}
