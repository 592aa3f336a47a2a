//! The state of rendering: the sample of a pixel, the pixel of a rectangle. Rendering can stop after any ray and go
//! on later, so a call takes a bounded time, and the picture is the same bit for bit.

use crate::accel::{Accel, Number};
use crate::observe::count::Observer;
use crate::render::pixel::Pixel;
use crate::render::renderer::Renderer;
use crate::render::samples::Samples;
use crate::render::trace::WorkspaceView;

/// A rectangle of a picture that is rendered a few rays at a time, for firmware with deadlines.
///
/// [`step`](Self::step) traces so many rays and returns; the next call goes on exactly where it
/// stopped, and every pixel is handed out as soon as its last ray was traced. Pixels have the bits
/// that [`Renderer::row`] gives them, whatever the steps.
///
/// Between two steps the rays that wait stay in the workspace, which is therefore borrowed as long
/// as the cursor lives; a cursor that is dropped may leave its picture unfinished. It takes 60
/// bytes in `f32` and `fixed` and at most 88 in `f64` on a 32-bit board.
///
/// # What a ray costs
/// A step counts the rays from the camera, off mirrors and through glass. Each of them costs one
/// closest hit, and if it meets a surface, each light that shines on that surface one shadow ray:
/// any hit in a scene without glass, else up to 64 closest hits, one for every surface of glass on
/// the way. Nothing else takes time that depends on the scene.
#[derive(Debug)]
pub struct Cursor<'r, 's, 'a, N: Number, A: Accel, const EFFECTS: u32> {
    renderer: &'r Renderer<'s, 'a, N, A, EFFECTS>,
    space: WorkspaceView<'r, N>,
    samples: Samples<N>,
    /// The pixel that is being rendered.
    pixel: [u16; 2],
    /// The first column and the last.
    columns: [u16; 2],
    /// Rows that are not done.
    rows: u16,
}

impl<'r, 's, 'a, N: Number, A: Accel, const EFFECTS: u32> Cursor<'r, 's, 'a, N, A, EFFECTS> {
    pub(super) fn new(
        renderer: &'r Renderer<'s, 'a, N, A, EFFECTS>,
        corner: [u16; 2],
        [width, height]: [u16; 2],
        space: WorkspaceView<'r, N>,
    ) -> Self {
        space.work.clear();
        // There are no pixels beyond number 65535.
        let [x, y] = corner;
        let rows = if y == 0 {
            height
        } else {
            height.min((u16::MAX - y).saturating_add(1))
        };
        Self {
            renderer,
            space,
            samples: Samples::new(),
            pixel: corner,
            columns: [x, x.saturating_add(width.saturating_sub(1))],
            rows: if width == 0 { 0 } else { rows },
        }
    }

    /// Whether all pixels were handed out.
    pub fn is_done(&self) -> bool {
        self.rows == 0
    }

    /// Traces at most so many rays, and hands out the pixels that they complete, row by row from
    /// the upper left corner.
    pub fn step<P: Pixel, C: Observer>(
        &mut self,
        rays: u32,
        count: &mut C,
        mut sink: impl FnMut(u16, u16, P),
    ) {
        let dither = self.renderer.settings().dither;
        for _ in 0..rays {
            if self.is_done() {
                return;
            }
            let pixel = self.pixel;
            let traced = self
                .samples
                .step(self.renderer, pixel, &mut self.space, count);
            let Some(linear) = traced else { continue };
            let [x, y] = pixel;
            sink(x, y, P::encode(linear, dither.then_some(pixel)));
            self.samples = Samples::new();
            let [first, last] = self.columns;
            self.pixel = if x < last {
                [x.saturating_add(1), y]
            } else {
                self.rows = self.rows.saturating_sub(1);
                [first, y.saturating_add(1)]
            };
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
        Cursor::new(self, corner, size, space)
    }
}

/// The size that the documentation states, on boards.
#[cfg(target_pointer_width = "32")]
const _: () = {
    use crate::Fixed;
    use crate::accel::list::List;
    assert!(size_of::<Cursor<'_, '_, '_, f32, List, 0>>() <= 60);
    assert!(size_of::<Cursor<'_, '_, '_, Fixed, List, 0>>() <= 60);
    assert!(size_of::<Cursor<'_, '_, '_, f64, List, 0>>() <= 88);
};
