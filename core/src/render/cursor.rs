//! The state of rendering: the sample of a pixel, the pixel of a rectangle. Rendering can stop after any ray and
//! continue later. So a call takes a bounded time, and the picture is the same bit for bit.

use crate::accel::{Accel, Number};
use crate::observe::count::Observer;
use crate::render::encoding::Pixel;
use crate::render::order::{Block, CoarseToFine, Rows};
use crate::render::pixel_samples::Samples;
use crate::render::renderer::Renderer;
use crate::render::workspace::WorkspaceView;

/// A rectangle of a picture that is rendered a few rays at a time, for firmware with deadlines.
///
/// `step` traces a number of rays and returns. The next call continues exactly where it stopped, and every pixel is
/// handed out as soon as its last ray was traced. Pixels have the bits of [`Renderer::row`], whatever the steps and the
/// order.
///
/// The order of the pixels is `O`: [`Renderer::cursor`] goes row by row, [`Renderer::coarse_to_fine`] shows
/// the whole rectangle in blocks first, and refines them.
///
/// Between two steps the waiting rays stay in the workspace, so the cursor borrows the workspace as long as it lives.
/// The picture of a dropped cursor can be unfinished. On a 32-bit board the cursor takes 60 bytes in `f32` and `fixed`
/// and at most 88 in `f64`. From coarse to fine, it takes up to 8 more.
///
/// # What a ray costs
/// A step counts the rays from the camera, off mirrors and through glass. Each ray costs one closest hit. If it hits a
/// surface, each light that shines on that surface costs one shadow ray. A shadow ray costs one any-hit query, unless
/// light can pass surfaces: of glass, or with alpha. Then it costs one closest hit, and one more for every surface that
/// it passes, of which there are at most [`MAX_SHADOW_SURFACES`](crate::format::limits::MAX_SHADOW_SURFACES). That is
/// so where the scene has such surfaces. In builds without the feature `wide` it is so in every scene if the renderer's
/// effects hold one that lets light pass. No other step depends on the scene.
#[derive(Debug)]
pub struct Cursor<'r, 's, 'a, N: Number, A: Accel, const EFFECTS: u32, O = Rows> {
    renderer: &'r Renderer<'s, 'a, N, A, EFFECTS>,
    space: WorkspaceView<'r, N>,
    samples: Samples<N>,
    order: O,
}

impl<'r, 's, 'a, N: Number, A: Accel, const EFFECTS: u32, O> Cursor<'r, 's, 'a, N, A, EFFECTS, O> {
    fn new(
        renderer: &'r Renderer<'s, 'a, N, A, EFFECTS>,
        order: O,
        space: WorkspaceView<'r, N>,
    ) -> Self {
        space.work.clear();
        Self {
            renderer,
            space,
            samples: Samples::new(),
            order,
        }
    }

    /// Traces one ray of a pixel. Returns the pixel if that was its last ray.
    #[inline(always)]
    fn trace<P: Pixel, C: Observer>(&mut self, pixel: [u16; 2], count: &mut C) -> Option<P> {
        let linear = self
            .samples
            .step(self.renderer, pixel, &mut self.space, count)?;
        self.samples = Samples::new();
        let dither = self.renderer.settings().dither;
        Some(P::encode(linear, dither.then_some(pixel)))
    }
}

impl<N: Number, A: Accel, const EFFECTS: u32> Cursor<'_, '_, '_, N, A, EFFECTS> {
    /// Returns true if all pixels were handed out.
    pub fn is_done(&self) -> bool {
        self.order.is_done()
    }

    /// Traces at most this many rays, and hands out the pixels that they complete, row by row from the upper left
    /// corner.
    pub fn step<P: Pixel, C: Observer>(
        &mut self,
        rays: u32,
        count: &mut C,
        mut sink: impl FnMut(u16, u16, P),
    ) {
        for _ in 0..rays {
            if self.is_done() {
                return;
            }
            let [x, y] = self.order.pixel;
            let Some(pixel) = self.trace([x, y], count) else {
                continue;
            };
            sink(x, y, pixel);
            self.order.advance();
        }
    }
}

impl<N: Number, A: Accel, const EFFECTS: u32> Cursor<'_, '_, '_, N, A, EFFECTS, CoarseToFine> {
    /// Returns true if all pixels were handed out.
    pub fn is_done(&self) -> bool {
        self.order.side() == 0
    }

    /// Traces at most this many rays, and hands out the pixels that they complete. Each comes with a block of pixels:
    /// fill the whole block with its color, until finer pixels replace it.
    pub fn step<P: Pixel, C: Observer>(
        &mut self,
        rays: u32,
        count: &mut C,
        mut sink: impl FnMut(Block, P),
    ) {
        for _ in 0..rays {
            let Some(block) = self.order.block() else {
                return;
            };
            let Some(pixel) = self.trace([block.x, block.y], count) else {
                continue;
            };
            sink(block, pixel);
            self.order.advance();
        }
    }
}

impl<'s, 'a, N: Number, A: Accel, const EFFECTS: u32> Renderer<'s, 'a, N, A, EFFECTS> {
    /// Starts to render a rectangle a few rays at a time: see [`Cursor`].
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{NoCount, Renderer, Rgb888, Scene, Workspace};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let renderer = Renderer::new(&scene)?;
    /// let mut space = Workspace::for_any_scene();
    /// let mut cursor = renderer.cursor([0, 0], [4, 4], space.as_view());
    /// let mut pixels = 0;
    /// while !cursor.is_done() {
    ///     // Time for something else between every ten rays.
    ///     cursor.step(10, &mut NoCount, |_, _, Rgb888(_)| pixels += 1);
    /// }
    /// assert_eq!(pixels, 16);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn cursor<'r>(
        &'r self,
        corner: [u16; 2],
        size: [u16; 2],
        space: WorkspaceView<'r, N>,
    ) -> Cursor<'r, 's, 'a, N, A, EFFECTS> {
        Cursor::new(self, Rows::new(corner, size), space)
    }

    /// Starts to render a rectangle a few rays at a time, from coarse to fine: see [`CoarseToFine`].
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{NoCount, Renderer, Rgb565, Scene, Workspace};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let renderer = Renderer::new(&scene)?;
    /// let mut space = Workspace::for_any_scene();
    /// let mut display = [[Rgb565(0); 20]; 10];
    /// let mut cursor = renderer.coarse_to_fine([0, 0], [20, 10], space.as_view());
    /// while !cursor.is_done() {
    ///     // Time for something else between every ten rays: the knob may have been turned.
    ///     cursor.step(10, &mut NoCount, |block, pixel| {
    ///         for row in &mut display[block.y.into()..][..block.height.into()] {
    ///             row[block.x.into()..][..block.width.into()].fill(pixel);
    ///         }
    ///     });
    /// }
    /// let mut row = [Rgb565(0); 20];
    /// renderer.row(0, 7, &mut row, &mut space.as_view(), &mut NoCount);
    /// assert_eq!(display[7], row);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn coarse_to_fine<'r>(
        &'r self,
        corner: [u16; 2],
        size: [u16; 2],
        space: WorkspaceView<'r, N>,
    ) -> Cursor<'r, 's, 'a, N, A, EFFECTS, CoarseToFine> {
        Cursor::new(self, CoarseToFine::new(corner, size), space)
    }
}

/// The size that the documentation states for boards.
#[cfg(target_pointer_width = "32")]
const _: () = {
    use crate::Fixed;
    use crate::accel::list::List;
    assert!(size_of::<Cursor<'_, '_, '_, f32, List, 0>>() <= 60);
    assert!(size_of::<Cursor<'_, '_, '_, Fixed, List, 0>>() <= 60);
    assert!(size_of::<Cursor<'_, '_, '_, f64, List, 0>>() <= 88);
    assert!(size_of::<Cursor<'_, '_, '_, f32, List, 0, CoarseToFine>>() <= 64);
    assert!(size_of::<Cursor<'_, '_, '_, Fixed, List, 0, CoarseToFine>>() <= 64);
    assert!(size_of::<Cursor<'_, '_, '_, f64, List, 0, CoarseToFine>>() <= 96);
};
